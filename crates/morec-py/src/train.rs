//! Training.

use std::sync::Arc;

use morec::train::train_index;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::{morec_error, warn};
use crate::index::PyIndex;
use crate::job;
use crate::material::{TrainingInput, recipe};

/// Trains an index from material as `morec._learn` lays it out.
#[pyfunction]
pub fn train(
    py: Python<'_>,
    material: &Bound<'_, PyDict>,
    classes: Vec<String>,
    how: &Bound<'_, PyDict>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<PyIndex> {
    let recipe = recipe(how)?;
    let given = TrainingInput::new(material, &classes)?;
    let trained = job::run(py, progress, |progress| {
        train_index(&given.data, &recipe, progress)
    })?;
    let (index, report) = trained.map_err(morec_error)?;
    warn(py, &report.notes)?;
    Ok(PyIndex {
        index: Arc::new(index),
        report: serde_json::to_value(&report).ok(),
    })
}
