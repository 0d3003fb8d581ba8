//! Training in the background.

use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use morec::index::MotionIndex;
use morec::train::{TrainingData, TrainingReport};
use morec_db::MotionDb;
use morec_measure::crossval::CrossvalData;
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

/// The same for a cross-validation of its labels.
pub fn tested(data: &TrainingData) -> CrossvalData<'_> {
    CrossvalData {
        clips: &data.clips,
        samples: &data.samples,
        classes: &data.classes,
        unknown: &[],
        tests: None,
    }
}

/// Trains an index of the database at `path`.
pub fn run(
    path: &Path,
    settings: &TrainSettings,
    progress: &JobProgress,
) -> Result<Box<TrainedIndex>, JobError> {
    let begun = Instant::now();
    let trained = || {
        let data = material(path, &settings.classes)?;
        index(&data, settings, begun, progress)
    };
    let trained = trained().map_err(|error| JobError::of("Training stopped", error))?;
    Ok(Box::new(trained))
}

/// Trains an index on `data`.
pub fn index(
    data: &TrainingData,
    settings: &TrainSettings,
    begun: Instant,
    progress: &JobProgress,
) -> Result<TrainedIndex, OperationError> {
    let (index, mut report) = settings.train(data, progress)?;
    report.notes.extend(data.notes.iter().cloned());
    Ok(TrainedIndex {
        bytes: index.to_bytes()?,
        index: Arc::new(index),
        report,
        secs: begun.elapsed().as_secs_f64(),
    })
}
