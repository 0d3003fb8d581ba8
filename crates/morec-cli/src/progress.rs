//! A bar for work that takes more than a second, on standard error, if that is a terminal.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use anyhow::Result;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::interrupt::stop_on_ctrl_c;

/// A bar that shows itself only once a second has passed.
pub struct SlowProgress {
    bar: ProgressBar,
    begun: Instant,
    shown: bool,
}

impl SlowProgress {
    /// A bar over `steps` steps of `what`.
    pub fn new(steps: usize, what: &'static str) -> Self {
        let bar = ProgressBar::with_draw_target(Some(steps as u64), ProgressDrawTarget::hidden());
        if let Ok(style) = ProgressStyle::with_template("{msg} [{bar:30}] {pos}/{len} {eta}") {
            bar.set_style(style);
        }
        bar.set_message(what);
        Self {
            bar,
            begun: Instant::now(),
            shown: false,
        }
    }

    /// One step is done.
    pub fn step(&mut self) {
        if !self.shown && self.begun.elapsed() > Duration::from_secs(1) {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
            self.shown = true;
        }
        self.bar.inc(1);
    }

    /// Runs `print` with the bar out of the way.
    pub fn suspend<T>(&self, print: impl FnOnce() -> T) -> T {
        self.bar.suspend(print)
    }
}

impl Drop for SlowProgress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// A bar that follows a long job of the library, stage by stage; it shows itself only once a second has passed.
pub struct StageBar {
    bar: ProgressBar,
    begun: Instant,
    stop: Arc<AtomicBool>,
}

impl StageBar {
    /// A hidden bar.
    pub fn new() -> Self {
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
        if let Ok(style) = ProgressStyle::with_template("{msg} [{bar:30}] {pos}/{len}") {
            bar.set_style(style);
        }
        Self {
            bar,
            begun: Instant::now(),
            stop: Arc::default(),
        }
    }

    /// A hidden bar under which Ctrl-C asks the job to stop as soon as it can leave things whole; a second one ends the
    /// program at once. One for each run of the program.
    pub fn stoppable() -> Result<Self> {
        let mut bar = Self::new();
        bar.stop = stop_on_ctrl_c()?;
        Ok(bar)
    }
}

impl morec::progress::Progress for StageBar {
    fn report(&self, stage: &str, done: usize, total: usize) {
        if self.bar.is_hidden() && self.begun.elapsed() > Duration::from_secs(1) {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        self.bar.set_message(stage.to_owned());
        self.bar.set_length(total as u64);
        self.bar.set_position(done as u64);
    }

    fn cancelled(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }
}

impl Drop for StageBar {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
