//! Time from a mark on the live stream to the index that knows it.

use std::path::Path;
use std::time::{Duration, Instant};

use crate::screenshot::Headless;
use crate::state::live::Choice;
use crate::state::{Command, LiveCommand, Panel, TrainCommand};

/// Longest wait for an index.
const PATIENCE: Duration = Duration::from_secs(120);
/// Time that passes on the stream with each frame, seconds.
const FRAME_SECS: f64 = 1.0 / 60.0;

/// Times of marks on a live stream, wall-clock seconds.
#[derive(Debug, Clone, Default)]
pub struct TeachingTimes {
    /// Accepted samples before the first mark.
    pub samples: usize,
    /// The training before the first mark, with everything that is made once.
    pub first_secs: f64,
    /// From each mark to the index in use.
    pub in_use_secs: Vec<f64>,
    /// The training alone.
    pub training_secs: Vec<f64>,
}

/// Plays the first labelled clip of a database as a live stream and marks its first label `times` times over, as its
/// class; measures how long each mark takes until the stream is recognised with an index that was trained with it. The
/// window draws meanwhile.
///
/// # Errors
/// No database, no label in it, or an index that is not trained in two minutes.
pub fn teaching(database: &Path, times: usize) -> Result<TeachingTimes, String> {
    let mut window = Headless::new(&[database.to_owned()], [1400, 860], 1.0, true);
    window.settle();
    let store = window.studio.state.store.as_ref();
    let snapshot = &store.ok_or("the database cannot be opened")?.snapshot;
    let label = snapshot.accepted().next().ok_or("no label")?.clone();
    let samples = snapshot.accepted().count();
    window.command(Command::Show(Panel::Live));
    window.command(Command::Train(TrainCommand::Train));
    window.settle();
    let first_secs = window.studio.state.train.secs;
    let choice = Choice::Clip(Some(label.clip));
    window.command(Command::Live(LiveCommand::Choose(choice)));
    window.command(Command::Live(LiveCommand::Start));
    window.settle();
    while now(&window) < label.stop_secs + 1.0 {
        window.frame(FRAME_SECS);
    }
    let mut lessons = TeachingTimes {
        samples,
        first_secs,
        ..TeachingTimes::default()
    };
    for number in 0..times {
        // The same stretch twice is a duplicate: each begins a little earlier.
        let start = label.start_secs - 0.05 * number as f64;
        let range = Some((start, label.stop_secs));
        window.command(Command::Live(LiveCommand::Range(range)));
        let taken = mark(&mut window, &label.class)?;
        lessons.in_use_secs.push(taken);
        lessons.training_secs.push(window.studio.state.train.secs);
    }
    Ok(lessons)
}

/// Time of the stream, seconds.
fn now(window: &Headless) -> f64 {
    let run = window.studio.state.live.run.as_ref();
    run.map_or(f64::INFINITY, |run| run.now_secs)
}

/// Marks the selected stretch and waits for the index that knows it.
fn mark(window: &mut Headless, class: &str) -> Result<f64, String> {
    let before = window.studio.state.live.index().cloned();
    let begun = Instant::now();
    window.command(Command::Live(LiveCommand::MarkAs(class.to_owned())));
    loop {
        let drawn = Instant::now();
        window.frame(FRAME_SECS);
        let state = &window.studio.state;
        let same = match (&before, state.live.index()) {
            (Some(before), Some(now)) => std::sync::Arc::ptr_eq(before, now),
            _ => state.live.index().is_none(),
        };
        if !same {
            return Ok(begun.elapsed().as_secs_f64());
        }
        if let Some(notice) = state.notices.first() {
            return Err(notice.text.clone());
        }
        if begun.elapsed() > PATIENCE {
            return Err("no index in two minutes".to_owned());
        }
        // A screen shows sixty frames a second and no more.
        let left = Duration::from_secs_f64(FRAME_SECS).saturating_sub(drawn.elapsed());
        std::thread::sleep(left);
    }
}
