//! `morec.Crossval`: the results of a cross-validation.

use std::path::PathBuf;

use morec::train::TrainingData;
use morec_measure::crossval::CrossvalData;
use morec_measure::eval::{MEASURED_OVERLAP, timelines};
use morec_measure::report::{Report, TrainedClass};
use morec_ops::{CrossvalMeasures, CrossvalSettings, LeftOut, TrainSettings};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::{io_error, morec_error, operation_error, value_error};
use crate::job;
use crate::material::{settings, training_data};
use crate::tables::{DETECTION, plain, table};

/// Measures of a cross-validation.
#[pyclass(frozen, name = "Crossval", module = "morec")]
pub struct PyCrossval {
    measures: CrossvalMeasures,
    training: Vec<TrainedClass>,
    by: LeftOut,
}

/// Cross-validates material as `morec._learn` lays it out.
#[pyfunction]
pub fn crossval(
    py: Python<'_>,
    material: &Bound<'_, PyDict>,
    train: &str,
    how: &str,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<PyCrossval> {
    let (train, how) = both_settings(train, how)?;
    let data = training_data(material, &train.classes)?;
    let measures = job::run(py, progress, |progress| {
        how.crossval(&crossval_data(&data), &train, progress)
    })?;
    Ok(PyCrossval {
        measures: measures.map_err(operation_error)?,
        training: TrainedClass::count(&data.samples, &data.classes),
        by: how.by,
    })
}

/// What more samples and more people are worth, as `morec crossval --curve --json` prints it.
#[pyfunction]
pub fn learning_curve<'py>(
    py: Python<'py>,
    material: &Bound<'py, PyDict>,
    train: &str,
    how: &str,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let (train, how) = both_settings(train, how)?;
    let data = training_data(material, &train.classes)?;
    let curve = job::run(py, progress, |progress| {
        how.learning_curve(&crossval_data(&data), &train, progress)
    })?;
    plain(py, &curve.map_err(operation_error)?)
}

fn both_settings(train: &str, how: &str) -> PyResult<(TrainSettings, CrossvalSettings)> {
    let (train, how): (TrainSettings, CrossvalSettings) = (settings(train)?, settings(how)?);
    if how.by == LeftOut::Own {
        return Err(value_error(
            "by: expected \"person\", \"clip\" or \"half\", found \"own\"",
        ));
    }
    Ok((train, how))
}

fn crossval_data(data: &TrainingData) -> CrossvalData<'_> {
    CrossvalData {
        clips: &data.clips,
        samples: &data.samples,
        classes: &data.classes,
        unknown: &data.unknown,
        tests: None,
    }
}

#[pymethods]
impl PyCrossval {
    /// Every measure, as `morec crossval --json` prints them.
    #[getter]
    fn evaluation<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &self.measures.evaluation)
    }

    /// What each training leaves out, in words: "each person in turn, 3 people".
    #[getter]
    fn left_out(&self) -> &str {
        &self.measures.divided
    }

    /// Thesis accuracy; `None` if there is nothing to decide.
    #[getter]
    fn accuracy(&self) -> Option<f64> {
        self.measures.evaluation.thesis.accuracy
    }

    /// F1 at half overlap.
    #[getter]
    fn f1(&self) -> Option<f64> {
        self.measures.evaluation.f1_at(MEASURED_OVERLAP)
    }

    /// For each perturbation its measures.
    #[getter]
    fn perturbed<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        for (name, evaluation) in &self.measures.perturbed {
            dict.set_item(name.to_string(), plain(py, evaluation)?)?;
        }
        Ok(dict)
    }

    /// Measures at each rate of false alarms a minute.
    #[getter]
    fn sensitivities<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        for (rate, evaluation) in &self.measures.sensitivities {
            dict.set_item(rate, plain(py, evaluation)?)?;
        }
        Ok(dict)
    }

    /// Samples that were missed, and why.
    #[getter]
    fn missed<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &self.measures.tested.misses)
    }

    /// The folds, each with the part left out and its training report.
    #[getter]
    fn folds<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &self.measures.folds)
    }

    /// All detections.
    #[getter]
    fn found<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let mut rows = Vec::new();
        for found in &self.measures.tested.founds {
            rows.push(plain(py, found)?.cast_into::<PyDict>()?);
        }
        table(py, &DETECTION[..6], rows)
    }

    /// All labels.
    #[getter]
    fn truth<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let mut rows = Vec::new();
        for truth in &self.measures.tested.truths {
            rows.push(plain(py, truth)?.cast_into::<PyDict>()?);
        }
        table(py, &["clip", "class", "start_secs", "stop_secs"], rows)
    }

    /// Writes the report, one HTML file without outside links.
    #[pyo3(signature = (path, *, title="Cross-validation"))]
    fn report(&self, path: PathBuf, title: &str) -> PyResult<()> {
        std::fs::write(&path, self.html(title)?).map_err(|error| io_error(&path, &error))
    }

    fn __repr__(&self) -> String {
        let shown = |value: Option<f64>| value.map_or("-".to_owned(), |v| format!("{v:.3}"));
        format!(
            "<morec.Crossval by {}: accuracy {}, F1 {}, {} of {} samples found>",
            format!("{:?}", self.by).to_lowercase(),
            shown(self.accuracy()),
            shown(self.f1()),
            self.measures.evaluation.events.matched,
            self.measures.evaluation.totals.samples
        )
    }
}

impl PyCrossval {
    fn html(&self, title: &str) -> PyResult<String> {
        let t = &self.measures.tested;
        let timelines = timelines(&t.streams, &t.truths, &t.founds).map_err(morec_error)?;
        let about = [("left out".to_owned(), self.by.said().to_owned())];
        let report = Report {
            title,
            about: &about,
            evaluation: &self.measures.evaluation,
            timelines: &timelines,
            training: &self.training,
            misses: &self.measures.tested.misses,
            performances: &[],
            sensitivities: &self.measures.sensitivities,
            perturbed: &self.measures.perturbed,
            motion: None,
        };
        Ok(report.html())
    }
}
