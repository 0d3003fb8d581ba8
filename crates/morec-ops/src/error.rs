//! Errors of operations.

use morec::index::IndexError;
use morec::live::OptionError;
use morec::pca::PcaError;
use morec::pivots::NoPivots;
use morec::train::{DataError, TrainError};
#[cfg(feature = "db")]
use morec_db::DbError;
use morec_measure::crossval::CrossvalError;
use morec_measure::eval::EvalError;

use crate::ParamError;

/// Why an operation failed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OperationError {
    /// Unknown parameter, or a value that it cannot have.
    #[error(transparent)]
    Param(#[from] ParamError),
    /// Settings that contradict each other.
    #[error("{0}")]
    Settings(String),
    /// An option that the index does not have, or that cannot be.
    #[error(transparent)]
    Option(#[from] OptionError),
    /// Clips and labels that do not fit together.
    #[error(transparent)]
    Data(#[from] DataError),
    /// Training failed.
    #[error(transparent)]
    Train(#[from] TrainError),
    /// Cross-validation failed.
    #[error(transparent)]
    Crossval(#[from] CrossvalError),
    /// What was recognised cannot be measured.
    #[error(transparent)]
    Measure(#[from] EvalError),
    /// A clip has no rotations that poses of the method of 2009 could be made of.
    #[error("{clip}: {source}")]
    NoPivots {
        /// Name of the clip.
        clip: String,
        /// What it lacks.
        source: NoPivots,
    },
    /// Poses have no such principal components.
    #[error(transparent)]
    Pca(#[from] PcaError),
    /// The index cannot be written.
    #[error(transparent)]
    Index(#[from] IndexError),
    /// The database cannot be read.
    #[cfg(feature = "db")]
    #[error(transparent)]
    Database(#[from] DbError),
}

impl OperationError {
    /// True if the receiver of progress cancelled.
    pub fn is_cancelled(&self) -> bool {
        match self {
            OperationError::Train(error) => *error == TrainError::Cancelled,
            OperationError::Crossval(CrossvalError::Train { source, .. }) => {
                *source == TrainError::Cancelled
            }
            #[cfg(feature = "db")]
            OperationError::Database(error) => matches!(error, DbError::Cancelled),
            _ => false,
        }
    }
}
