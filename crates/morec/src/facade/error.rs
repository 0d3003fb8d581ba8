//! One error type over the errors of all areas, for callers that do not distinguish them.

/// Any error of this library's main path: files to takes, takes to an index, an index to a recogniser.
///
/// Every area has an error type of its own, which its functions return; each converts into this one.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Bytes are not what they should be.
    #[error(transparent)]
    Parse(#[from] crate::ParseError),
    /// A file on disk cannot be used.
    #[cfg(feature = "files")]
    #[error(transparent)]
    File(#[from] crate::files::FileError),
    /// An index cannot be read or written as bytes.
    #[cfg(feature = "live")]
    #[error(transparent)]
    Index(#[from] crate::index::IndexError),
    /// A stream cannot be recognised with an index.
    #[cfg(feature = "live")]
    #[error(transparent)]
    Start(#[from] crate::live::StartError),
    /// A session cannot be opened.
    #[cfg(feature = "live")]
    #[error(transparent)]
    Session(#[from] crate::live::SessionError),
    /// The sensitivity of an index cannot be changed.
    #[cfg(feature = "live")]
    #[error(transparent)]
    Sensitivity(#[from] crate::index::SensitivityError),
    /// An index cannot be set to the performer that is expected.
    #[cfg(feature = "live")]
    #[error(transparent)]
    Performer(#[from] crate::index::PerformerError),
    /// A recorded stream does not make a clip.
    #[cfg(feature = "live")]
    #[error(transparent)]
    Recording(#[from] crate::live::RecordingError),
    /// Takes and labels do not make training data.
    #[cfg(feature = "train")]
    #[error(transparent)]
    Data(#[from] crate::train::DataError),
    /// Nothing can be learned from the training data.
    #[cfg(feature = "train")]
    #[error(transparent)]
    Train(#[from] crate::train::TrainError),
}
