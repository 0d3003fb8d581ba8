//! Clips, labels and persons for training and cross-validation, from Python objects.

use std::collections::{BTreeMap, BTreeSet};

use morec::TimeSpan;
use morec::labels::{Extent, Label, Labels, People, read_people};
use morec::train::{StreamKind, TrainClip, TrainingData, TrainingMaterial};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::clip::PyClip;
use crate::clip_data::ClipData;
use crate::errors::{morec_error, value_error, warn};

/// A label: clip, class, frames, seconds, person. Without both extents, the whole clip.
type LabelRow = (
    String,
    String,
    Option<(usize, usize)>,
    Option<(f64, f64)>,
    Option<String>,
);

/// Labels from rows, or from the bytes of a table.
///
/// # Errors
/// A table with a mistake, which names its line.
pub fn labels(given: &Bound<'_, PyAny>) -> PyResult<Labels> {
    if let Ok(bytes) = given.cast::<PyBytes>() {
        let table = Labels::read(bytes.as_bytes());
        return table.map_err(|error| morec_error(format!("labels: {error}")));
    }
    let rows: Vec<LabelRow> = given.extract()?;
    let label = |(line, (clip, class, frames, secs, person)): (u64, LabelRow)| Label {
        clip,
        class,
        extent: match (frames, secs) {
            (_, Some((start, stop))) => Extent::Secs(TimeSpan::new(start, stop)),
            (Some((start, stop)), None) => Extent::Frames(start..stop),
            (None, None) => Extent::WholeClip,
        },
        person,
        annotator: None,
        line,
    };
    Ok(Labels {
        rows: (0..).zip(rows).map(label).collect(),
        warnings: Vec::new(),
    })
}

/// The person of each clip.
pub fn people(given: &Bound<'_, PyAny>) -> PyResult<People> {
    if let Ok(bytes) = given.cast::<PyBytes>() {
        let table = read_people(bytes.as_bytes());
        return table.map_err(|error| morec_error(format!("people: {error}")));
    }
    Ok(People {
        by_clip: given.extract::<BTreeMap<String, String>>()?,
        warnings: Vec::new(),
    })
}

/// Material under the keys clips, labels, people, background and perhaps unknown, sorted out for training. What was cut or
/// left out is warned of.
///
/// # Errors
/// Clips and labels that do not fit together.
pub fn training_data(material: &Bound<'_, PyDict>, classes: &[String]) -> PyResult<TrainingData> {
    let py = material.py();
    let get = |name: &str| -> PyResult<Option<Bound<'_, PyAny>>> {
        Ok(material.get_item(name)?.filter(|value| !value.is_none()))
    };
    let clips = |name: &str| -> PyResult<Vec<Bound<'_, PyClip>>> {
        get(name)?.map_or_else(|| Ok(Vec::new()), |clips| clips.extract())
    };
    let given = get("labels")?.ok_or_else(|| value_error("labels is required"))?;
    let labels = labels(&given)?;
    warn(py, labels.warnings.iter().map(|w| format!("labels: {w}")))?;
    let people = get("people")?.map(|given| people(&given)).transpose()?;
    let warnings = people.iter().flat_map(|people| &people.warnings);
    warn(py, warnings.map(|w| format!("people: {w}")))?;
    let (taught, background, unknown) = (clips("clips")?, clips("background")?, clips("unknown")?);
    let name = |clip: &Bound<'_, PyClip>| clip.get().data.clip.name.clone();
    let names = |clips: &[_]| -> BTreeSet<String> { clips.iter().map(name).collect() };
    // Background and unknown clips may lie among the clips, as for the command.
    let (there, aside) = (names(&taught), names(&background));
    let unknown_names = names(&unknown);
    let others = background
        .iter()
        .filter(|clip| !there.contains(&name(clip)));
    let tested = unknown
        .iter()
        .filter(|clip| !there.contains(&name(clip)) && !aside.contains(&name(clip)));
    let all = taught.iter().chain(others).chain(tested);
    let all = all
        .map(|clip| train_clip(&clip.get().data, &aside))
        .collect();
    let material = TrainingMaterial {
        labels: &labels,
        people: people.as_ref(),
        classes,
        unknown: &unknown_names,
    };
    let data = material.sort_out(all).map_err(morec_error)?;
    warn(py, &data.notes)?;
    Ok(data)
}

/// A clip for training, without a person.
pub fn train_clip(data: &ClipData, background: &BTreeSet<String>) -> TrainClip {
    TrainClip {
        name: data.clip.name.clone(),
        clip: data.clip.clone(),
        roles: data.roles.clone(),
        rest: data.rest.clone(),
        source: match background.contains(&data.clip.name) {
            true => StreamKind::Background,
            false => StreamKind::Labelled,
        },
        person: None,
    }
}

/// Settings of an operation from JSON: an object with those that are not as usual.
///
/// # Errors
/// A setting that there is not, or a value that it cannot have.
pub fn settings<S: Serialize + DeserializeOwned + Default>(given: &str) -> PyResult<S> {
    let fields: BTreeMap<String, serde_json::Value> =
        serde_json::from_str(given).map_err(value_error)?;
    morec_ops::from_fields(fields).map_err(value_error)
}

/// Settings of an operation from keywords; `None` is as usual.
///
/// # Errors
/// Those of [`settings`]; a value that JSON does not have.
pub fn keywords<S: Serialize + DeserializeOwned + Default>(
    given: Option<&Bound<'_, PyDict>>,
) -> PyResult<S> {
    let Some(given) = given else {
        return Ok(S::default());
    };
    let set = PyDict::new(given.py());
    for (name, value) in given.iter().filter(|(_, value)| !value.is_none()) {
        set.set_item(name, value)?;
    }
    let json = given.py().import("json")?.call_method1("dumps", (set,))?;
    settings(&json.extract::<String>()?)
}

/// Labels in a table, as rows for Python.
#[pyfunction]
pub fn rows_of_table(bytes: &Bound<'_, PyBytes>) -> PyResult<Vec<LabelRow>> {
    let row = |label: Label| {
        let (frames, secs) = match label.extent {
            Extent::Frames(span) => (Some((span.start, span.end)), None),
            Extent::Secs(span) => (None, Some((span.start_secs, span.stop_secs))),
            Extent::WholeClip => (None, None),
        };
        (label.clip, label.class, frames, secs, label.person)
    };
    Ok(labels(bytes)?.rows.into_iter().map(row).collect())
}

/// The labels of one clip: class, start and stop in seconds.
#[pyfunction]
pub fn resolve_labels(
    clip: &PyClip,
    labels: &Bound<'_, PyAny>,
) -> PyResult<Vec<(String, f64, f64)>> {
    let clip = &clip.data.clip;
    let lengths = BTreeMap::from([(clip.name.clone(), clip.into())]);
    let resolved = self::labels(labels)?.resolve(&lengths);
    let samples = resolved.samples.into_iter();
    Ok(samples
        .map(|s| (s.class, s.span.start_secs, s.span.stop_secs))
        .collect())
}
