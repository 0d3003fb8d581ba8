//! Label Studio tasks: what people set in `annotations`, what a program proposes in `predictions`.

use morec::formats::{ParseError, Place};
use serde_json::{Value, json};

use super::annotation::{Annotation, ClipLengths, ReadLabels, checked, json_error, secs};
use crate::labels::SampleState;

pub fn read(bytes: &[u8]) -> Result<ReadLabels, ParseError> {
    let expected = "Label Studio tasks: [{data, annotations, predictions}]";
    let file: Value =
        serde_json::from_slice(bytes).map_err(|error| json_error(&error, expected))?;
    let tasks = match &file {
        Value::Array(tasks) => tasks.as_slice(),
        one => std::slice::from_ref(one),
    };
    let mut read = ReadLabels::default();
    for (index, task) in tasks.iter().enumerate() {
        let error = |expected: &str, found: String| {
            ParseError::new(Place::File, format!("task {index}: {expected}"), found)
        };
        let clip = clip_of(task)
            .ok_or_else(|| error("data with the clip's name", task["data"].to_string()))?;
        let set = |key: &str| task[key].as_array().into_iter().flatten();
        let judged: Vec<&Value> = set("annotations").collect();
        let accepted = !judged.is_empty();
        let sets = if accepted {
            judged
        } else {
            set("predictions").collect()
        };
        let results = sets.iter().flat_map(|set| {
            let state = match accepted {
                true => SampleState::Accepted,
                false => state_of(set),
            };
            let results = set["result"].as_array().into_iter().flatten();
            results.map(move |result| (result, state))
        });
        for (result, state) in results {
            let value = &result["value"];
            let (Some(start), Some(stop)) = (value["start"].as_f64(), value["end"].as_f64()) else {
                continue;
            };
            let extent = checked(start, stop)
                .map_err(|found| error("a stop after a start of at least 0", found))?;
            for class in value["timeserieslabels"]
                .as_array()
                .into_iter()
                .flatten()
                .filter_map(Value::as_str)
            {
                read.annotations.push(Annotation {
                    clip: clip.clone(),
                    class: class.to_owned(),
                    extent: Some(extent),
                    person: None,
                    score: result["score"].as_f64(),
                    state,
                });
            }
        }
    }
    Ok(read)
}

/// State of a prediction: rejected if its model version says so, else proposed.
fn state_of(prediction: &Value) -> SampleState {
    match prediction["model_version"].as_str() {
        Some(REJECTED) => SampleState::Rejected,
        _ => SampleState::Proposed,
    }
}

const VERSION: &str = concat!("morec ", env!("CARGO_PKG_VERSION"));

/// The model that predictions are of which somebody looked at and rejected.
const REJECTED: &str = "morec: rejected";

/// `data.clip`, or the stem of the first text in `data`.
fn clip_of(task: &Value) -> Option<String> {
    if let Some(clip) = task["data"]["clip"].as_str() {
        return Some(clip.to_owned());
    }
    let text = task["data"].as_object()?.values().find_map(Value::as_str)?;
    let name = text.rsplit('/').next()?;
    Some(
        name.rsplit_once('.')
            .map_or(name, |(stem, _)| stem)
            .to_owned(),
    )
}

/// Accepted labels as annotations, others as predictions; a clip that has both is two tasks, as a task's annotations
/// are said instead of its predictions.
pub fn write(annotations: &[Annotation], lengths: &ClipLengths) -> Result<String, String> {
    let mut tasks: Vec<Value> = Vec::new();
    for (number, a) in annotations.iter().enumerate() {
        let (start, stop) = secs(a, lengths)?;
        let (set, version) = match a.state {
            SampleState::Accepted => ("annotations", VERSION),
            SampleState::Proposed => ("predictions", VERSION),
            SampleState::Rejected => ("predictions", REJECTED),
        };
        let there = |task: &Value| {
            let of_clip = task["data"]["clip"].as_str() == Some(&a.clip);
            of_clip && task[set][0]["model_version"].as_str() == Some(version)
        };
        let place = tasks.iter().position(there).unwrap_or_else(|| {
            tasks.push(
                json!({ "data": { "clip": a.clip }, set: [{ "model_version": version, "result": [] }] }),
            );
            tasks.len() - 1
        });
        let mut result = json!({
            "id": format!("m{number}"), "from_name": "label", "to_name": "ts", "type": "timeserieslabels",
            "value": { "start": start, "end": stop, "instant": false, "timeserieslabels": [a.class] },
        });
        if let Some(score) = a.score {
            result["score"] = score.into();
        }
        if let Some(results) = tasks[place][set][0]["result"].as_array_mut() {
            results.push(result);
        }
    }
    serde_json::to_string_pretty(&tasks)
        .map(|text| text + "\n")
        .map_err(|error| error.to_string())
}
