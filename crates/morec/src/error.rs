//! One error over those of the areas.

#[cfg(feature = "files")]
use crate::files::FileError;
use crate::formats::ParseError;
use crate::index::IndexError;
use crate::live::{RecordingError, SensitivityError, SessionError, StartError};
use crate::train::{DataError, TrainError};

/// Any error of this library's main path: files to takes, takes to an index, an index to a recogniser.
///
/// Every area has an error type of its own, which its functions return; each converts into this one.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A file on disk cannot be used.
    #[cfg(feature = "files")]
    #[error(transparent)]
    File(#[from] FileError),
    /// Bytes are not what they should be.
    #[error(transparent)]
    Parse(#[from] ParseError),
    /// Takes and labels do not make training data.
    #[error(transparent)]
    Data(#[from] DataError),
    /// Nothing can be learned from the training data.
    #[error(transparent)]
    Train(#[from] TrainError),
    /// An index cannot be read or written as bytes.
    #[error(transparent)]
    Index(#[from] IndexError),
    /// A stream cannot be recognised with an index.
    #[error(transparent)]
    Start(#[from] StartError),
    /// A session cannot be opened.
    #[error(transparent)]
    Session(#[from] SessionError),
    /// The sensitivity of an index cannot be changed.
    #[error(transparent)]
    Sensitivity(#[from] SensitivityError),
    /// A recorded stream does not make a clip.
    #[error(transparent)]
    Recording(#[from] RecordingError),
}
