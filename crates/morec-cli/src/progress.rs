//! Progress on standard error, for work of more than a second: a bar in a terminal, occasional lines otherwise.

use std::io::IsTerminal;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use anyhow::Result;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::interrupt::stop_on_ctrl_c;

/// LogLines in a log are so far apart, beginning so long after the work.
const BETWEEN_LINES: Duration = Duration::from_secs(10);

/// LogLines that say how far work is, for logs: where standard error is no terminal.
struct LogLines {
    last: Mutex<Option<Instant>>,
}

impl LogLines {
    fn new(begun: Instant) -> Self {
        let last = (!std::io::stderr().is_terminal()).then_some(begun);
        Self {
            last: Mutex::new(last),
        }
    }

    /// The line to be printed now, if it is time.
    fn line(&self, now: Instant, stage: &str, done: usize, total: usize) -> Option<String> {
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        if now.duration_since((*last)?) < BETWEEN_LINES {
            return None;
        }
        *last = Some(now);
        Some(match total {
            0 => format!("morec: {stage}: {done}"),
            _ => format!("morec: {stage}: {done} of {total}"),
        })
    }

    fn say(&self, stage: &str, done: usize, total: usize) {
        if let Some(line) = self.line(Instant::now(), stage, done, total) {
            eprintln!("{line}");
        }
    }
}

/// A bar that shows itself only once a second has passed.
pub struct SlowProgress {
    bar: ProgressBar,
    begun: Instant,
    shown: bool,
    what: &'static str,
    lines: LogLines,
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
            what,
            lines: LogLines::new(Instant::now()),
        }
    }

    /// One step is done.
    pub fn step(&mut self) {
        if !self.shown && self.begun.elapsed() > Duration::from_secs(1) {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
            self.shown = true;
        }
        self.bar.inc(1);
        let total = self.bar.length().unwrap_or_default();
        let done = self.bar.position();
        self.lines.say(self.what, done as usize, total as usize);
    }

    /// One step is done: what came of it, or `None` once its error is printed.
    pub fn step_of<T>(&mut self, done: anyhow::Result<T>) -> Option<T> {
        let printed = |error| self.suspend(|| eprintln!("morec: {error:#}"));
        let done = done.map_err(printed).ok();
        self.step();
        done
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
    lines: LogLines,
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
            lines: LogLines::new(Instant::now()),
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
        self.lines.say(stage, done, total);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_log_gets_a_line_now_and_then() {
        let begun = Instant::now();
        let at = |secs| begun + Duration::from_secs(secs);
        let lines = LogLines {
            last: Mutex::new(Some(begun)),
        };
        let line = lines.line(at(9), "importing", 3, 10);
        assert_eq!(line, None);
        let line = lines.line(at(10), "importing", 4, 10);
        assert_eq!(line.as_deref(), Some("morec: importing: 4 of 10"));
        assert_eq!(lines.line(at(19), "importing", 9, 10), None);
        let line = lines.line(at(25), "reading", 9, 0);
        assert_eq!(line.as_deref(), Some("morec: reading: 9"));
        // On a terminal there is a bar.
        let lines = LogLines {
            last: Mutex::new(None),
        };
        assert_eq!(lines.line(at(100), "importing", 4, 10), None);
    }
}
