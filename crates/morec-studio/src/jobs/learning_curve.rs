//! Learning curve of the labels in the database.

use std::path::Path;

use morec_ops::{CrossvalSettings, LearningCurve, OperationError, TrainSettings};

use super::progress::{JobError, JobProgress};
use super::train::{material, tested};

/// Cross-validates the database at `path` with ever more samples and people.
pub fn learn(
    path: &Path,
    train: &TrainSettings,
    how: &CrossvalSettings,
    progress: &JobProgress,
) -> Result<LearningCurve, JobError> {
    let curve = || -> Result<_, OperationError> {
        let data = material(path, &train.classes)?;
        how.learning_curve(&tested(&data), train, progress)
    };
    curve().map_err(|error| JobError::of("No learning curve", error))
}
