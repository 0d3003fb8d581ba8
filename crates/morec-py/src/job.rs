//! Runs long jobs without the interpreter's lock, with progress and Ctrl-C.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use morec::progress::Progress;
use pyo3::prelude::*;

use crate::errors::morec_error;

/// Interval at which signals and progress are looked at while a job runs.
const LOOK: Duration = Duration::from_millis(50);

/// Progress of a job, and the wish to stop it.
#[derive(Default)]
pub struct JobState {
    last: Mutex<Option<(String, usize, usize)>>,
    cancelled: AtomicBool,
}

impl JobState {
    fn take(&self) -> Option<(String, usize, usize)> {
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        last.take()
    }
}

impl Progress for JobState {
    fn report(&self, stage: &str, done: usize, total: usize) {
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        *last = Some((stage.to_owned(), done, total));
    }

    fn cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }
}

/// Runs `job` on a thread of its own without the interpreter's lock. `progress`, if it is not `None`, is called as
/// `progress(stage, done, total)`. Ctrl-C, or an exception of `progress`, asks the job to stop, waits for it, and is
/// raised.
///
/// # Errors
/// Those, and a job that panicked.
pub fn run<T: Send>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    job: impl FnOnce(&dyn Progress) -> T + Send,
) -> PyResult<T> {
    let told = JobState::default();
    let (sender, receiver) = sync_channel(1);
    // Only one thread at a time waits on it; the lock makes it `Sync`.
    let receiver = Mutex::new(receiver);
    let (result, interrupted) = std::thread::scope(|scope| {
        scope.spawn(|| {
            let done = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| job(&told)));
            // The other end waits until this is sent.
            let _ = sender.send(done);
        });
        let mut interrupted = None;
        loop {
            let got = py.detach(|| {
                let receiver = receiver.lock().unwrap_or_else(PoisonError::into_inner);
                receiver.recv_timeout(LOOK)
            });
            match got {
                Ok(result) => return (Some(result), interrupted),
                Err(RecvTimeoutError::Disconnected) => return (None, interrupted),
                Err(RecvTimeoutError::Timeout) if interrupted.is_none() => {
                    if let Err(error) = look(py, progress, &told) {
                        told.cancelled.store(true, Ordering::Relaxed);
                        interrupted = Some(error);
                    }
                }
                Err(RecvTimeoutError::Timeout) => {}
            }
        }
    });
    if let Some(error) = interrupted {
        return Err(error);
    }
    if let Some(progress) = progress {
        if let Some(last) = told.take() {
            progress.call1(last)?;
        }
        progress.call1(("", 0, 0))?;
    }
    match result {
        Some(Ok(value)) => Ok(value),
        _ => Err(morec_error(
            "an internal error; please report it together with the input",
        )),
    }
}

fn look(py: Python<'_>, progress: Option<&Bound<'_, PyAny>>, told: &JobState) -> PyResult<()> {
    py.check_signals()?;
    if let (Some(progress), Some(last)) = (progress, told.take()) {
        progress.call1(last)?;
    }
    Ok(())
}
