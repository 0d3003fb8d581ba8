//! morec's own JSON: `{"labels": [{"clip": …, "class": …, "start_secs": …, "stop_secs": …}]}`.

use morec::formats::{ParseError, Place};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::annotation::{
    Annotation, ClipLengths, LabelContext, LabelFormat, ReadLabels, frames, json_error, secs,
};
use crate::labels::SampleState;

#[derive(Serialize, Deserialize)]
struct File {
    labels: Vec<JsonRow>,
}

#[derive(Serialize, Deserialize)]
struct JsonRow {
    clip: String,
    class: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    start_secs: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    stop_secs: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    start: Option<u64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    stop: Option<u64>,
    #[serde(default)]
    whole_clip: bool,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    person: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    score: Option<f64>,
    #[serde(default)]
    state: Option<SampleState>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    annotator: Option<String>,
}

/// Tells the forms in JSON apart.
pub fn which(bytes: &[u8]) -> LabelFormat {
    match serde_json::from_slice(bytes) {
        Ok(Value::Array(_)) => LabelFormat::LabelStudio,
        Ok(Value::Object(map)) if map.contains_key("labels") => LabelFormat::Json,
        Ok(Value::Object(map))
            if map.contains_key("predictions") || map.contains_key("annotations") =>
        {
            LabelFormat::LabelStudio
        }
        Ok(Value::Object(_)) => LabelFormat::Babel,
        _ => LabelFormat::Json,
    }
}

/// Reads morec's own JSON of labels.
///
/// # Errors
/// The JSON is invalid, a field is missing, or a stop is not after its start.
pub fn read(bytes: &[u8], context: &LabelContext) -> Result<ReadLabels, ParseError> {
    let expected = "{\"labels\": [{\"clip\", \"class\", \"start_secs\", \"stop_secs\"}]}";
    let file: File = serde_json::from_slice(bytes).map_err(|error| json_error(&error, expected))?;
    let mut read = ReadLabels::default();
    for (index, row) in file.labels.into_iter().enumerate() {
        let rate = context.rate_of(&row.clip);
        let extent = match (
            row.start_secs.zip(row.stop_secs),
            row.start.zip(row.stop),
            rate,
        ) {
            _ if row.whole_clip => None,
            (Some(secs), _, _) => Some(secs),
            (None, Some((start, stop)), Some(rate)) => {
                Some((start as f64 / rate, stop as f64 / rate))
            }
            (None, Some(_), None) => {
                *read.absent.entry(row.clip.clone()).or_default() += 1;
                continue;
            }
            (None, None, _) => None,
        };
        let in_frames = row.start_secs.zip(row.stop_secs).is_none();
        let before = rate
            .filter(|_| in_frames)
            .map_or(0.0, |rate| context.before(&row.clip, rate));
        if let Some(extent) = extent {
            let stretch = read.stretch(Place::File, &row.class, extent);
            let stretch = stretch.map_err(|found| {
                let expected = format!("labels[{index}]: a stop after a start of at least 0");
                ParseError::new(Place::File, expected, found)
            })?;
            if stretch.is_none() {
                continue;
            }
        }
        read.annotations.push(Annotation {
            clip: row.clip,
            class: row.class,
            extent: extent.map(|(start, stop)| (start - before, stop - before)),
            person: row.person,
            score: row.score,
            state: row.state.unwrap_or(SampleState::Accepted),
            annotator: row.annotator,
        });
    }
    Ok(read)
}

/// Writes annotations as morec's own JSON, with times in seconds and, where the frame rate is known, in frames.
///
/// # Errors
/// A label covers a whole clip of unknown length.
pub fn write(annotations: &[Annotation], lengths: &ClipLengths) -> Result<String, String> {
    let row = |a: &Annotation| -> Result<JsonRow, String> {
        let (start_secs, stop_secs) = secs(a, lengths)?;
        let framed = frames(
            &Annotation {
                extent: Some((start_secs, stop_secs)),
                ..a.clone()
            },
            lengths,
        );
        Ok(JsonRow {
            clip: a.clip.clone(),
            class: a.class.clone(),
            start_secs: Some(start_secs),
            stop_secs: Some(stop_secs),
            start: framed.map(|f| f.0),
            stop: framed.map(|f| f.1),
            whole_clip: a.extent.is_none(),
            person: a.person.clone(),
            score: a.score,
            state: Some(a.state),
            annotator: a.annotator.clone(),
        })
    };
    let file = File {
        labels: annotations.iter().map(row).collect::<Result<_, _>>()?,
    };
    serde_json::to_string_pretty(&file)
        .map(|text| text + "\n")
        .map_err(|error| error.to_string())
}
