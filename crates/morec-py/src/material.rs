//! Clips, labels and people as training and cross-validation need them, from what Python gives.

use std::collections::{BTreeMap, BTreeSet};

use morec::TimeSpan;
use morec::labels::{ClipLength, Extent, Label, Labels, People, read_people};
use morec::reproduce::Setting;
use morec::train::thesis::SvrdmOptions;
use morec::train::{
    Everyday, Mirror, Recipe, StreamKind, TrainClip, TrainOptions, TrainParams, TrainingData,
};
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
        line,
    };
    Ok(Labels {
        rows: (0..).zip(rows).map(label).collect(),
        warnings: Vec::new(),
    })
}

/// The person of each clip.
fn people(given: &Bound<'_, PyAny>) -> PyResult<People> {
    if let Ok(bytes) = given.cast::<PyBytes>() {
        let table = read_people(bytes.as_bytes());
        return table.map_err(|error| morec_error(format!("people: {error}")));
    }
    Ok(People {
        by_clip: given.extract::<BTreeMap<String, String>>()?,
        warnings: Vec::new(),
    })
}

fn train_clip(data: &ClipData, source: StreamKind, people: &BTreeMap<String, String>) -> TrainClip {
    TrainClip {
        name: data.clip.name.clone(),
        clip: data.clip.clone(),
        roles: data.roles.clone(),
        rest: data.rest.clone(),
        source,
        person: people.get(&data.clip.name).cloned(),
    }
}

/// Clips and labels from Python, sorted out for training.
pub struct TrainingInput {
    /// Clips, samples and classes that fit together.
    pub data: TrainingData,
    /// Clips that hold none of the classes, for testing.
    pub unknown: Vec<TrainClip>,
}

impl TrainingInput {
    /// From the keys clips, labels, people, background and perhaps unknown. What was cut or left out is warned of.
    ///
    /// # Errors
    /// Clips and labels that do not fit together.
    pub fn new(material: &Bound<'_, PyDict>, classes: &[String]) -> PyResult<Self> {
        let py = material.py();
        let get = |name: &str| -> PyResult<Option<Bound<'_, PyAny>>> {
            Ok(material.get_item(name)?.filter(|value| !value.is_none()))
        };
        let clips = |name: &str| -> PyResult<Vec<Bound<'_, PyClip>>> {
            get(name)?.map_or_else(|| Ok(Vec::new()), |clips| clips.extract())
        };
        let given = get("labels")?.ok_or_else(|| value_error("labels: which?"))?;
        let mut labels = labels(&given)?;
        let mut by_clip = BTreeMap::new();
        warn(py, labels.warnings.iter().map(|w| format!("labels: {w}")))?;
        if let Some(given) = get("people")? {
            let people = people(&given)?;
            warn(py, people.warnings.iter().map(|w| format!("people: {w}")))?;
            labels.add_people(&people);
            by_clip = people.by_clip;
        }
        let named = labels.rows.iter();
        by_clip.extend(named.filter_map(|r| Some((r.clip.clone(), r.person.clone()?))));
        let (taught, background, unknown) =
            (clips("clips")?, clips("background")?, clips("unknown")?);
        let name = |clip: &Bound<'_, PyClip>| clip.get().data.clip.name.clone();
        let aside: BTreeSet<String> = background.iter().map(name).collect();
        let tested: BTreeSet<String> = unknown.iter().map(name).collect();
        let of = |source: StreamKind| {
            let by_clip = &by_clip;
            move |clip: &Bound<'_, PyClip>| train_clip(&clip.get().data, source, by_clip)
        };
        // In the order in which the command has them: background may lie among the clips.
        let mut all: Vec<TrainClip> = Vec::new();
        for clip in &taught {
            match (aside.contains(&name(clip)), tested.contains(&name(clip))) {
                (true, _) => all.push(of(StreamKind::Background)(clip)),
                (false, false) => all.push(of(StreamKind::Labelled)(clip)),
                (false, true) => {}
            }
        }
        let there: BTreeSet<String> = taught.iter().map(name).collect();
        let others = background
            .iter()
            .filter(|clip| !there.contains(&name(clip)));
        all.extend(others.map(of(StreamKind::Background)));
        let unknown = unknown.iter().map(of(StreamKind::Labelled)).collect();
        let data = TrainingData::new(all, &labels, classes).map_err(morec_error)?;
        warn(py, &data.notes)?;
        if !data.unused.is_empty() {
            let text = format!(
                "{} clips hold no sample of the classes and are not used (background if they hold none): {}",
                data.unused.len(),
                data.unused.join(", ")
            );
            warn(py, [text])?;
        }
        Ok(Self { data, unknown })
    }
}

/// Options of training, from the words of the command.
///
/// # Errors
/// A word that is none of them, a parameter that there is not.
pub fn recipe(given: &Bound<'_, PyDict>) -> PyResult<Recipe> {
    let word = |name: &str| -> PyResult<String> {
        let value = given
            .get_item(name)?
            .ok_or_else(|| value_error(format!("{name}: which?")))?;
        value.extract()
    };
    let wrong = |name: &str, known: &[&str], found: &str| {
        let known: Vec<String> = known.iter().map(|word| format!("{word:?}")).collect();
        value_error(format!(
            "{name}: expected {}, found {found:?}",
            known.join(" or ")
        ))
    };
    let unlabelled_is_background = match word("unlabelled")?.as_str() {
        "background" => true,
        "ignore" => false,
        other => return Err(wrong("unlabelled", &["background", "ignore"], other)),
    };
    let params: Vec<(String, String)> = match given.get_item("params")? {
        Some(params) => params.extract()?,
        None => Vec::new(),
    };
    let setting = match word("svrdm")?.as_str() {
        "tuned" => Setting::Tuned,
        "faithful" => Setting::Faithful,
        other => return Err(wrong("svrdm", &["tuned", "faithful"], other)),
    };
    let everyday = match word("everyday")?.as_str() {
        "auto" => Everyday::Auto,
        "always" => Everyday::Always,
        "never" => Everyday::Never,
        other => return Err(wrong("everyday", &["auto", "always", "never"], other)),
    };
    let mirror = match word("mirror")?.as_str() {
        "auto" => Mirror::Auto,
        "yes" => Mirror::Yes,
        "no" => Mirror::No,
        other => return Err(wrong("mirror", &["auto", "yes", "no"], other)),
    };
    let names = |option: &str| -> PyResult<Vec<String>> {
        match given.get_item(option)? {
            Some(classes) => classes.extract(),
            None => Ok(Vec::new()),
        }
    };
    let method = word("method")?;
    let kinds = (names("activities")?, names("gestures")?);
    if method != "auto" && !(kinds.0.is_empty() && kinds.1.is_empty()) {
        return Err(value_error(
            "activities and gestures are for method \"auto\"",
        ));
    }
    match method.as_str() {
        "auto" | "templates" => Ok(TrainOptions {
            unlabelled_is_background,
            everyday,
            mirror,
            one_sided: names("one_sided")?,
            bones: word("bones")?
                .parse()
                .map_err(|error| value_error(format!("bones: {error}")))?,
            params: {
                let mut params = with_parameters(TrainParams::default(), &params)?;
                params.activities &= method == "auto";
                params.set_kinds(&kinds.0, &kinds.1);
                params
            },
        }
        .into()),
        "svrdm" => Ok(SvrdmOptions {
            params: with_parameters(setting.params(), &params)?,
            unlabelled_is_background,
        }
        .into()),
        other => Err(wrong("method", &["auto", "templates", "svrdm"], other)),
    }
}

/// `params` with values replaced, each named by its path.
fn with_parameters<P: Serialize + DeserializeOwned>(
    params: P,
    settings: &[(String, String)],
) -> PyResult<P> {
    let mut tree = serde_json::to_value(&params).map_err(value_error)?;
    for (name, value) in settings {
        let parameter = tree.pointer_mut(&format!("/{}", name.replace('.', "/")));
        let parameter = parameter
            .ok_or_else(|| value_error(format!("params: no parameter is called {name}")))?;
        *parameter = serde_json::from_str(value).map_err(value_error)?;
    }
    serde_json::from_value(tree).map_err(|error| value_error(format!("params: {error}")))
}

/// The rows of a table of labels.
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
    let length = ClipLength {
        frames: clip.frames,
        rate_hz: clip.rate_hz,
    };
    let lengths = BTreeMap::from([(clip.name.clone(), length)]);
    let resolved = self::labels(labels)?.resolve(&lengths);
    let samples = resolved.samples.into_iter();
    Ok(samples
        .map(|s| (s.class, s.span.start_secs, s.span.stop_secs))
        .collect())
}
