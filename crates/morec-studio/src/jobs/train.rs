//! Training in the background.

use std::path::Path;
use std::sync::Arc;

use morec::index::MotionIndex;
use morec::train::{TrainingData, TrainingReport};
use morec_db::MotionDb;
use morec_ops::{MaterialBeside, OperationError, TrainSettings, training_data};

use super::progress::{JobError, JobProgress};

/// Result of training.
pub struct TrainedIndex {
    pub index: Arc<MotionIndex>,
    pub bytes: Vec<u8>,
    pub report: TrainingReport,
    pub secs: f64,
}

/// Samples and clips of the database at `path` for training.
pub fn material(path: &Path, classes: &[String]) -> Result<TrainingData, OperationError> {
    training_data(
        &MotionDb::open_read_only(path)?,
        classes,
        MaterialBeside::default(),
    )
}

/// Trains an index of the database at `path`.
pub fn run(
    path: &Path,
    settings: &TrainSettings,
    progress: &JobProgress,
) -> Result<Box<TrainedIndex>, JobError> {
    let begun = std::time::Instant::now();
    let trained = || -> Result<_, OperationError> {
        let data = material(path, &settings.classes)?;
        let (index, mut report) = settings.train(&data, progress)?;
        report.notes.extend(data.notes);
        Ok((index.to_bytes()?, index, report))
    };
    let (bytes, index, report) =
        trained().map_err(|error| JobError::of("Training stopped", error))?;
    Ok(Box::new(TrainedIndex {
        index: Arc::new(index),
        bytes,
        report,
        secs: begun.elapsed().as_secs_f64(),
    }))
}
