//! `morec.evaluate`: measures detections against labels.

use std::collections::{BTreeMap, BTreeSet};

use morec::TimeSpan;
use morec::labels::{ClipLength, Extent, FoundRow, FoundTable, ReportedAt, read_detections};
use morec::train::TrainClip;
use morec_measure::crossval::measure_as_taught;
use morec_ops::EvaluateSettings;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::clip::PyClip;
use crate::errors::{morec_error, operation_error, value_error, warn};
use crate::index::PyIndex;
use crate::material::{keywords, labels, train_clip};
use crate::tables::plain;

/// Frames a second in which the length of a clip is counted that is known in seconds alone.
const COUNTED_HZ: f64 = 1e6;

/// A detection: clip, class, start and stop in seconds, score, time of report.
type FoundTuple = (String, String, f64, f64, Option<f64>, Option<f64>);

/// Every measure of detections held against labels; `clips` are clips, or seconds by name.
#[pyfunction]
#[pyo3(signature = (truth, found, clips, unknown, index, **settings))]
pub fn evaluate<'py>(
    truth: &Bound<'py, PyAny>,
    found: &Bound<'py, PyAny>,
    clips: &Bound<'py, PyAny>,
    unknown: &Bound<'py, PyAny>,
    index: Option<&Bound<'py, PyIndex>>,
    settings: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let py = truth.py();
    let settings: EvaluateSettings = keywords(settings)?;
    let (labels, table) = (labels(truth)?, detections(found)?);
    warn(py, labels.warnings.iter().map(|w| format!("truth: {w}")))?;
    warn(py, table.warnings.iter().map(|w| format!("found: {w}")))?;
    let mut all = lengths(clips)?;
    let unknown = lengths(unknown)?;
    let names: BTreeSet<String> = unknown.keys().cloned().collect();
    all.extend(unknown);
    let mut resolved = labels.resolve(&all);
    let of_whole_clips = resolved.samples.iter().any(|s| s.whole_clip);
    // Lengths alone do not say where the motion is.
    let moving: Vec<TrainClip> = match clips.extract::<Vec<Bound<'_, PyClip>>>() {
        Ok(clips) if of_whole_clips || index.is_some() => {
            let taught = |clip: &Bound<'_, PyClip>| train_clip(&clip.get().data, &BTreeSet::new());
            clips.iter().map(taught).collect()
        }
        Err(error) if index.is_some() => return Err(error),
        _ => Vec::new(),
    };
    py.detach(|| measure_as_taught(&mut resolved.samples, &moving));
    warn(py, resolved.warnings.iter().map(|w| format!("truth: {w}")))?;
    let (founds, absent) = table.resolve(&all);
    warn(py, absent.iter().map(|w| format!("found: {w}")))?;
    let measured = settings.evaluate(&all, &names, resolved, founds);
    let mut measures = measured.map_err(operation_error)?;
    warn(py, &measures.notes)?;
    if let Some(index) = index {
        let model = &index.get().index.model;
        py.detach(|| measures.explain(model, &moving));
    }
    plain(py, &measures)
}

/// Detections from rows, or from the bytes of a table.
fn detections(given: &Bound<'_, PyAny>) -> PyResult<FoundTable> {
    if let Ok(bytes) = given.cast::<PyBytes>() {
        let table = read_detections(bytes.as_bytes());
        return table.map_err(|error| morec_error(format!("found: {error}")));
    }
    let rows: Vec<FoundTuple> = given.extract()?;
    let row = |(line, (clip, class, start, stop, score, reported)): (u64, FoundTuple)| FoundRow {
        clip,
        class,
        extent: Extent::Secs(TimeSpan::new(start, stop)),
        score,
        reported: reported.map(ReportedAt::Secs),
        repetitions: None,
        line,
    };
    Ok(FoundTable {
        rows: (0..).zip(rows).map(row).collect(),
        warnings: Vec::new(),
    })
}

/// Lengths by name, of clips or of seconds by name.
pub fn lengths(given: &Bound<'_, PyAny>) -> PyResult<BTreeMap<String, ClipLength>> {
    if let Ok(secs) = given.extract::<BTreeMap<String, f64>>() {
        let length = |(name, secs): (String, f64)| {
            let length = ClipLength {
                frames: (secs * COUNTED_HZ).round() as usize,
                rate_hz: COUNTED_HZ,
            };
            (name, length)
        };
        return Ok(secs.into_iter().map(length).collect());
    }
    let clips: Vec<Bound<'_, PyClip>> = given.extract()?;
    let mut lengths = BTreeMap::new();
    for clip in &clips {
        let clip = &clip.get().data.clip;
        let again = lengths.insert(clip.name.clone(), clip.into());
        if again.is_some() {
            let why = format!("two clips are called {}; names must differ", clip.name);
            return Err(value_error(why));
        }
    }
    Ok(lengths)
}
