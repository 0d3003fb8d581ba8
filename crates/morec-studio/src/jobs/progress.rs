//! Progress of a job, and how it ends without a result.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

use morec::progress::Progress;
use morec::train::DataError;
use morec_ops::OperationError;

use crate::store::Wake;

/// Progress of a job; shared with its thread.
pub struct JobProgress {
    state: Mutex<JobStage>,
    cancelled: AtomicBool,
    wake: Wake,
}

/// What a job does now and how far it is.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct JobStage {
    pub name: String,
    pub done: usize,
    pub total: usize,
}

impl JobStage {
    /// 0 to 1, if it is known.
    pub fn share(&self) -> Option<f32> {
        (self.total > 0).then(|| (self.done as f32 / self.total as f32).min(1.0))
    }
}

impl JobProgress {
    pub(super) fn new(wake: Wake) -> Self {
        Self {
            state: Mutex::default(),
            cancelled: AtomicBool::new(false),
            wake,
        }
    }

    pub(super) fn stage(&self) -> JobStage {
        let state = self.state.lock();
        state.unwrap_or_else(PoisonError::into_inner).clone()
    }

    pub(super) fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }
}

impl Progress for JobProgress {
    fn report(&self, stage: &str, done: usize, total: usize) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        *state = JobStage {
            name: stage.to_owned(),
            done,
            total,
        };
        drop(state);
        (self.wake)();
    }

    fn cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }
}

/// End of a job that has no result.
#[derive(Debug, Clone, PartialEq)]
pub enum JobError {
    /// It could not be done, and why.
    Failed(String),
    Cancelled,
}

impl JobError {
    /// Of an error of an operation or of the database, with what that means before it.
    pub(super) fn of(what: &str, error: impl Into<OperationError>) -> Self {
        match error.into() {
            error if error.is_cancelled() => Self::Cancelled,
            OperationError::Data(DataError::NoSample) => {
                Self::Failed("Nothing to train on: label a few motions first".to_owned())
            }
            error => Self::Failed(format!("{what}: {error}")),
        }
    }
}
