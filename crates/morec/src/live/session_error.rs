//! Reasons why a session cannot begin.

use super::StartError;

/// A session that could not begin.
#[derive(Debug, thiserror::Error)]
pub enum SessionError {
    /// The system gave no thread.
    #[error("cannot start a thread for {what}: {error}")]
    Thread {
        /// Purpose of the thread.
        what: &'static str,
        /// The system's error.
        error: std::io::Error,
    },
    /// Stages on threads of their own were asked for of a method that has none.
    #[error("layout in stages: expected an index of method svrdm, found {method}")]
    NoStages {
        /// The method of the model.
        method: &'static str,
    },
    /// The model's parts do not fit together.
    #[error(transparent)]
    Start(#[from] StartError),
}
