//! Progress and cancellation of long jobs.

/// Takes a long job's progress; is asked whether to go on.
///
/// Every method has a default that does nothing, so `()` is the silent listener.
pub trait Progress: Sync {
    /// `done` of `total` steps of `stage` are finished.
    fn report(&self, stage: &str, done: usize, total: usize) {
        let _ = (stage, done, total);
    }

    /// True if the job should stop as soon as it can.
    fn cancelled(&self) -> bool {
        false
    }
}

impl Progress for () {}
