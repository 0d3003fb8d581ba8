//! `morec.Crossval`: how good an index would be on what it has not seen.

use std::path::PathBuf;

use morec::TimeSpan;
use morec::crossval::{CrossvalData, CrossvalOptions, FoldBy, Tested, crossval as run_crossval};
use morec::eval::{
    ClipDetection, Evaluation, GroundTruth, MEASURED_OVERLAP, StreamInfo, timelines,
};
use morec::perturb::Perturbation;
use morec::report::{Report, TrainedClass};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::{io_error, morec_error, value_error};
use crate::job;
use crate::material::{TrainingInput, recipe};
use crate::tables::{DETECTION, plain, table};

/// Measures of a cross-validation.
#[pyclass(frozen, name = "Crossval", module = "morec")]
pub struct PyCrossval {
    tested: Tested,
    evaluation: Evaluation,
    perturbed: Vec<(Perturbation, Evaluation)>,
    sensitivities: Vec<(f64, Evaluation)>,
    folds: serde_json::Value,
    training: Vec<TrainedClass>,
    by: String,
}

/// Cross-validates material as `morec._learn` lays it out.
#[pyfunction]
pub fn crossval(
    py: Python<'_>,
    material: &Bound<'_, PyDict>,
    classes: Vec<String>,
    recipe: &Bound<'_, PyDict>,
    how: &Bound<'_, PyDict>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<PyCrossval> {
    let recipe = self::recipe(recipe)?;
    let (options, by) = options(how)?;
    let given = TrainingInput::new(material, &classes)?;
    let outcome = job::run(py, progress, |progress| {
        let of = CrossvalData {
            clips: &given.data.clips,
            samples: &given.data.samples,
            classes: &given.data.classes,
            unknown: &given.unknown,
            tests: None,
        };
        run_crossval(&of, &options, &recipe, progress)
    })?;
    let outcome = outcome.map_err(morec_error)?;
    let measure = |t: &Tested| Evaluation::of(&t.streams, &t.truths, &t.founds);
    let perturbed = outcome.perturbed.iter();
    let perturbed = perturbed.map(|(p, t)| Ok((*p, measure(t).map_err(morec_error)?)));
    let rates = outcome.sensitivities.iter();
    let rates = rates.map(|(rate, t)| Ok((*rate, measure(t).map_err(morec_error)?)));
    Ok(PyCrossval {
        evaluation: measure(&outcome.tested).map_err(morec_error)?,
        perturbed: perturbed.collect::<PyResult<_>>()?,
        sensitivities: rates.collect::<PyResult<_>>()?,
        folds: serde_json::to_value(&outcome.folds).map_err(morec_error)?,
        training: TrainedClass::count(&given.data.samples, &given.data.classes),
        tested: outcome.tested,
        by,
    })
}

fn options(how: &Bound<'_, PyDict>) -> PyResult<(CrossvalOptions, String)> {
    let get = |name: &str| -> PyResult<Bound<'_, PyAny>> {
        let value = how.get_item(name)?;
        value.ok_or_else(|| value_error(format!("{name}: which?")))
    };
    let by: String = get("by")?.extract()?;
    let seed = get("seed")?.extract()?;
    let options = CrossvalOptions {
        by: match by.as_str() {
            "person" => FoldBy::Person,
            "clip" => FoldBy::Clip,
            "half" => FoldBy::Half { seed },
            other => {
                return Err(value_error(format!(
                    "by: expected \"person\", \"clip\" or \"half\", found {other:?}"
                )));
            }
        },
        samples_per_class: get("samples")?.extract()?,
        sensitivities: get("sensitivities")?.extract()?,
        perturbations: get("perturb")?
            .extract::<Vec<String>>()?
            .iter()
            .map(|text| text.parse::<Perturbation>())
            .collect::<Result<_, _>>()
            .map_err(|error| value_error(format!("perturb: {error}")))?,
    };
    Ok((options, by))
}

#[pymethods]
impl PyCrossval {
    /// Every measure, as `morec crossval --json` prints them.
    #[getter]
    fn evaluation<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &self.evaluation)
    }

    /// Thesis accuracy; `None` if there is nothing to decide.
    #[getter]
    fn accuracy(&self) -> Option<f64> {
        self.evaluation.thesis.accuracy
    }

    /// F1 at half overlap.
    #[getter]
    fn f1(&self) -> Option<f64> {
        self.evaluation.f1_at(MEASURED_OVERLAP)
    }

    /// For each perturbation its measures.
    #[getter]
    fn perturbed<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        for (name, evaluation) in &self.perturbed {
            dict.set_item(name.to_string(), plain(py, evaluation)?)?;
        }
        Ok(dict)
    }

    /// For each rate of false alarms a minute its measures.
    #[getter]
    fn sensitivities<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        for (rate, evaluation) in &self.sensitivities {
            dict.set_item(rate, plain(py, evaluation)?)?;
        }
        Ok(dict)
    }

    /// Samples that were missed, and why.
    #[getter]
    fn missed<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &self.tested.misses)
    }

    /// Each fold: the part that was left out, and the report of its training.
    #[getter]
    fn folds<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &self.folds)
    }

    /// All detections.
    #[getter]
    fn found<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let mut rows = Vec::new();
        for found in &self.tested.founds {
            rows.push(plain(py, found)?.cast_into::<PyDict>()?);
        }
        table(py, &DETECTION[..6], rows)
    }

    /// All labels.
    #[getter]
    fn truth<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let mut rows = Vec::new();
        for truth in &self.tested.truths {
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
            self.by,
            shown(self.accuracy()),
            shown(self.f1()),
            self.evaluation.events.matched,
            self.evaluation.totals.samples
        )
    }
}

impl PyCrossval {
    fn html(&self, title: &str) -> PyResult<String> {
        let t = &self.tested;
        let timelines = timelines(&t.streams, &t.truths, &t.founds).map_err(morec_error)?;
        let about = [("left out".to_owned(), self.by.clone())];
        let report = Report {
            title,
            about: &about,
            evaluation: &self.evaluation,
            timelines: &timelines,
            training: &self.training,
            misses: &self.tested.misses,
            performances: &[],
            sensitivities: &self.sensitivities,
            perturbed: &self.perturbed,
            motion: None,
        };
        Ok(report.html())
    }
}

type SpanTuple = (String, String, f64, f64);
type HitTuple = (String, String, f64, f64, Option<f64>, Option<f64>);

/// Every measure of detections held against labels.
#[pyfunction]
pub fn evaluate<'py>(
    py: Python<'py>,
    streams: Vec<(String, f64)>,
    truth: Vec<SpanTuple>,
    found: Vec<HitTuple>,
) -> PyResult<Bound<'py, PyAny>> {
    let stream = |(clip, duration_secs)| StreamInfo {
        clip,
        duration_secs,
        unknown: false,
    };
    let label = |(clip, class, start_secs, stop_secs): SpanTuple| GroundTruth {
        clip,
        class,
        span: TimeSpan::new(start_secs, stop_secs),
    };
    let hit =
        |(clip, class, start_secs, stop_secs, score, reported_secs): HitTuple| ClipDetection {
            clip,
            class,
            span: TimeSpan::new(start_secs, stop_secs),
            score,
            reported_secs,
            repetitions: None,
        };
    let streams: Vec<_> = streams.into_iter().map(stream).collect();
    let truth: Vec<_> = truth.into_iter().map(label).collect();
    let found: Vec<_> = found.into_iter().map(hit).collect();
    plain(
        py,
        &Evaluation::of(&streams, &truth, &found).map_err(value_error)?,
    )
}
