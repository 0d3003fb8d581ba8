//! Training.

use std::sync::Arc;

use morec_ops::TrainSettings;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::{operation_error, warn};
use crate::index::PyIndex;
use crate::job;
use crate::material::{settings, training_data};

/// Trains an index from material as `morec._learn` lays it out.
#[pyfunction]
pub fn train(
    py: Python<'_>,
    material: &Bound<'_, PyDict>,
    settings: &str,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<PyIndex> {
    let settings: TrainSettings = self::settings(settings)?;
    let data = training_data(material, &settings.classes)?;
    let trained = job::run(py, progress, |progress| settings.train(&data, progress))?;
    let (index, report) = trained.map_err(operation_error)?;
    warn(py, &report.notes)?;
    Ok(PyIndex {
        index: Arc::new(index),
        report: serde_json::to_value(&report).ok(),
    })
}
