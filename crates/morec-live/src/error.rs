//! Why a source or a sink cannot be opened.

use std::io;

use morec::files::FileError;

/// Why a source or a sink cannot be opened.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LiveError {
    /// An address that names no source or sink, or an option that it does not have.
    #[error("{0}")]
    Address(String),
    /// An operation that the system refused.
    #[error("{what}")]
    Io {
        /// The operation, with the address.
        what: String,
        /// Why it could not.
        #[source]
        why: io::Error,
    },
    /// A clip that is to be played, or a skeleton, cannot be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// A clip or a skeleton that is read but cannot serve: its path and why.
    #[error("{0}")]
    Clip(String),
}

/// Adds the operation to a system's error.
pub(crate) trait Context<T> {
    /// The error with what was to be done.
    fn context(self, what: impl Into<String>) -> Result<T, LiveError>;
    /// The same, made only if needed.
    fn with_context(self, what: impl FnOnce() -> String) -> Result<T, LiveError>;
}

impl<T> Context<T> for io::Result<T> {
    fn context(self, what: impl Into<String>) -> Result<T, LiveError> {
        self.with_context(|| what.into())
    }

    fn with_context(self, what: impl FnOnce() -> String) -> Result<T, LiveError> {
        self.map_err(|why| LiveError::Io { what: what(), why })
    }
}
