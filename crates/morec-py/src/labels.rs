//! `morec.agree` and `morec.budget`: what labels say without any motion.

use morec::labels::{GroundTruth, Labels, SharedClips, TimeBudget};
use morec_measure::eval::LabelAgreement;
use pyo3::prelude::*;

use crate::errors::{value_error, warn};
use crate::evaluate::lengths;
use crate::material::{labels, people};
use crate::tables::plain;

/// Agreement of two annotators, as `morec agree --json` prints it; `clips` are clips, or seconds by name.
#[pyfunction]
pub fn agree<'py>(
    a: &Bound<'py, PyAny>,
    b: &Bound<'py, PyAny>,
    clips: &Bound<'py, PyAny>,
    time_unit: f64,
) -> PyResult<Bound<'py, PyAny>> {
    let py = a.py();
    if !(time_unit > 0.0 && time_unit.is_finite()) {
        return Err(value_error(format!(
            "time_unit: expected seconds above 0, found {time_unit}"
        )));
    }
    let lengths = lengths(clips)?;
    let read = |who: &str, given: &Bound<'py, PyAny>| -> PyResult<Vec<GroundTruth>> {
        let labels: Labels = labels(given)?;
        let resolved = labels.resolve(&lengths);
        let warnings = labels.warnings.iter().chain(&resolved.warnings);
        warn(py, warnings.map(|w| format!("{who}: {w}")))?;
        Ok(resolved
            .samples
            .into_iter()
            .map(GroundTruth::from)
            .collect())
    };
    let (mut first, mut second) = (read("a", a)?, read("b", b)?);
    let shared = SharedClips::of(&mut first, &mut second, &lengths);
    let alone = ["a", "b"].into_iter().zip(&shared.alone);
    let alone = alone.filter(|(_, clips)| !clips.is_empty());
    warn(
        py,
        alone.map(|(who, clips)| {
            let names = clips.join(", ");
            format!("{who} alone labels {names}: left out")
        }),
    )?;
    if shared.streams.is_empty() {
        return Err(value_error("no clip is labelled by both"));
    }
    let agreement = LabelAgreement::of(&shared.streams, &first, &second, time_unit);
    plain(py, &agreement.map_err(value_error)?)
}

/// How the time of clips is divided among classes, as `morec budget --json` prints it.
#[pyfunction]
pub fn budget<'py>(
    given: &Bound<'py, PyAny>,
    clips: &Bound<'py, PyAny>,
    of_people: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyAny>> {
    let py = given.py();
    let (lengths, mut labels) = (lengths(clips)?, labels(given)?);
    labels.add_people(&people(of_people)?);
    let resolved = labels.resolve(&lengths);
    let warnings = labels.warnings.iter().chain(&resolved.warnings);
    warn(py, warnings.map(|w| format!("labels: {w}")))?;
    plain(py, &TimeBudget::of(&resolved.samples, &lengths))
}
