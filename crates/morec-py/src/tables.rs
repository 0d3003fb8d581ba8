//! Rows of results: dictionaries in a `morec.Table`.

use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PyList, PyString};

use morec::decode::Repetitions;
use morec::live::{Detection, Event, Model};
use morec_measure::explain::MotionDeviation;
use serde::Serialize;

use crate::errors::morec_error;

/// A value of Python from one that serialises: dictionaries, lists, numbers, text, `None`.
///
/// # Errors
/// A value that JSON cannot say.
pub fn plain<'py>(py: Python<'py>, value: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    static LOADS: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    let text = serde_json::to_string(value).map_err(morec_error)?;
    LOADS
        .import(py, "json", "loads")?
        .call1((PyString::new(py, &text),))
}

/// Rows as a `morec.Table` with these columns, which it has even if there is no row.
pub fn table<'py>(
    py: Python<'py>,
    columns: &[&str],
    rows: Vec<Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    static TABLE: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    let rows = PyList::new(py, rows)?;
    TABLE
        .import(py, "morec._tables", "Table")?
        .call1((rows, columns.to_vec()))
}

/// Columns of tables of detections.
pub const DETECTION: [&str; 8] = [
    "clip",
    "class",
    "start_secs",
    "stop_secs",
    "score",
    "reported_secs",
    "repetitions",
    "period_secs",
];

/// A detection in the clip or stream `clip`, with the columns of [`DETECTION`].
pub fn detection<'py>(
    py: Python<'py>,
    clip: &str,
    class: &str,
    found: &Detection,
) -> PyResult<Bound<'py, PyDict>> {
    let row = PyDict::new(py);
    row.set_item("clip", clip)?;
    row.set_item("class", class)?;
    row.set_item("start_secs", found.span.start_secs)?;
    row.set_item("stop_secs", found.span.stop_secs)?;
    row.set_item("score", found.score)?;
    row.set_item("reported_secs", found.reported_secs)?;
    set_repetitions(&row, found.repetitions)?;
    Ok(row)
}

/// An event of a stream.
pub fn event<'py>(py: Python<'py>, model: &Model, event: &Event) -> PyResult<Bound<'py, PyDict>> {
    let row = PyDict::new(py);
    row.set_item("phase", event.phase.name())?;
    row.set_item("class", model.class_name(event.class))?;
    row.set_item("start_secs", event.span.start_secs)?;
    row.set_item("stop_secs", event.span.stop_secs)?;
    row.set_item("score", event.score)?;
    row.set_item("progress", event.progress)?;
    row.set_item("reported_secs", event.reported_secs)?;
    row.set_item("actor", event.actor.0)?;
    row.set_item("motion", event.motion)?;
    row.set_item("sequence", event.sequence)?;
    row.set_item("wall_secs", event.wall_secs)?;
    set_repetitions(&row, event.repetitions)?;
    let deviation = event.deviation;
    row.set_item("off_degrees", deviation.map(|d| d.off_degrees))?;
    row.set_item("pace", event.pace)?;
    row.set_item("worst_bone", deviation.map(|d| d.worst_bone))?;
    row.set_item("worst_degrees", deviation.map(|d| d.worst_degrees))?;
    Ok(row)
}

/// Events of a stream, in a list.
pub fn events<'py>(
    py: Python<'py>,
    model: &Model,
    events: &[Event],
) -> PyResult<Bound<'py, PyList>> {
    let rows = events.iter().map(|one| event(py, model, one));
    PyList::new(py, rows.collect::<PyResult<Vec<_>>>()?)
}

/// What was counted of an activity; `None` in both where nothing was.
fn set_repetitions(row: &Bound<'_, PyDict>, counted: Option<Repetitions>) -> PyResult<()> {
    row.set_item("repetitions", counted.map(|r| r.count))?;
    row.set_item("period_secs", counted.map(|r| r.period_secs))
}

/// The detections of several clips, one after the other.
pub fn detections<'py>(
    py: Python<'py>,
    model: &Model,
    of_clips: &[(String, FoundWithDeviation)],
    with_deviation: bool,
) -> PyResult<Bound<'py, PyAny>> {
    let mut rows = Vec::new();
    for (clip, founds) in of_clips {
        for (found, deviation) in founds {
            let row = detection(py, clip, model.class_name(found.class), found)?;
            if with_deviation {
                row.set_item("deviation", plain(py, deviation)?)?;
            }
            rows.push(row);
        }
    }
    let deviation: &[&str] = if with_deviation { &["deviation"] } else { &[] };
    table(py, &[&DETECTION, deviation].concat(), rows)
}

/// Detections, each with how it was performed if that was asked for.
pub type FoundWithDeviation = Vec<(Detection, Option<MotionDeviation>)>;
