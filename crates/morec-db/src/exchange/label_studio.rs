//! Label Studio tasks: what people set in `annotations`, what a program proposes in `predictions`.

use morec::formats::{ParseError, Place, Warning};
use serde_json::{Value, json};

use super::annotation::{Annotation, ClipLengths, LabelContext, ReadLabels, json_error, secs};
use crate::labels::SampleState;

/// Reads Label Studio tasks: annotations as accepted labels, predictions as proposed ones.
///
/// # Errors
/// The JSON is invalid, or a task does not name its clip.
pub fn read(bytes: &[u8], context: &LabelContext) -> Result<ReadLabels, ParseError> {
    let expected = "Label Studio tasks: [{data, annotations, predictions}]";
    let file: Value =
        serde_json::from_slice(bytes).map_err(|error| json_error(&error, expected))?;
    let tasks = match &file {
        Value::Array(tasks) => tasks.as_slice(),
        one => std::slice::from_ref(one),
    };
    let mut read = ReadLabels::default();
    let mut unread: Option<ParseError> = None;
    for (index, task) in tasks.iter().enumerate() {
        let error = |expected: &str, found: String| {
            ParseError::new(Place::File, format!("task {index}: {expected}"), found)
        };
        let clip = clip_of(task, context)
            .ok_or_else(|| error("data with the clip's name", task["data"].to_string()))?;
        let results = results_of(task, &mut read);
        for (result, state) in results {
            let value = if result["value"].is_null() {
                &result
            } else {
                &result["value"]
            };
            let classes = classes_of(value);
            if classes.is_empty() {
                continue;
            }
            let stretches = match stretches_of(value, context.rate_of(&clip)) {
                Ok(stretches) => stretches,
                Err(found) => {
                    let why = error(
                        "`start` and `end` in seconds from the clip's beginning",
                        found,
                    );
                    let text = format!("{}, found {}; left out", why.expected, why.found);
                    read.warnings.push(Warning::new(Place::File, text));
                    unread.get_or_insert(why);
                    continue;
                }
            };
            for extent in stretches {
                let extent = read
                    .stretch(Place::File, &classes[0], extent)
                    .map_err(|found| error("a stop after a start of at least 0", found))?;
                let Some(extent) = extent else { continue };
                read.annotations
                    .extend(classes.iter().map(|class| Annotation {
                        clip: clip.clone(),
                        class: class.clone(),
                        extent: Some(extent),
                        person: None,
                        score: result["score"].as_f64(),
                        state,
                        annotator: None,
                    }));
            }
        }
    }
    match unread {
        Some(error) if read.annotations.is_empty() => Err(error),
        _ => Ok(read),
    }
}

/// The results of a task: of annotations that were not cancelled, else of predictions; or the lists of the short form (JSON-MIN).
fn results_of(task: &Value, read: &mut ReadLabels) -> Vec<(Value, SampleState)> {
    let set = |key: &str| task[key].as_array().into_iter().flatten();
    let is_cancelled = |set: &&Value| set["was_cancelled"].as_bool() == Some(true);
    let cancelled = set("annotations").filter(is_cancelled).count();
    if cancelled > 0 {
        let text =
            format!("{cancelled} annotations were skipped by their annotator and are left out");
        read.warnings.push(Warning::new(Place::File, text));
    }
    if task["annotations"].is_null() && task["predictions"].is_null() {
        let fields = task
            .as_object()
            .into_iter()
            .flat_map(|fields| fields.values());
        let lists = fields.filter_map(Value::as_array).flatten();
        let results = lists.filter(|result| !classes_of(result).is_empty());
        return results
            .map(|result| (result.clone(), SampleState::Accepted))
            .collect();
    }
    let of_set = |set: &Value, state| {
        let results = set["result"].as_array().into_iter().flatten();
        results
            .map(move |result| (result.clone(), state))
            .collect::<Vec<_>>()
    };
    if set("annotations").next().is_some() {
        let judged = set("annotations").filter(|set| !is_cancelled(set));
        return judged
            .flat_map(|set| of_set(set, SampleState::Accepted))
            .collect();
    }
    set("predictions")
        .flat_map(|set| of_set(set, state_of(set)))
        .collect()
}

/// The classes of a result: of time series, of audio and video.
fn classes_of(value: &Value) -> Vec<String> {
    const KEYS: [&str; 4] = [
        "timeserieslabels",
        "timelinelabels",
        "labels",
        "videolabels",
    ];
    let lists = KEYS.iter().filter_map(|key| value[*key].as_array());
    let words = lists.flatten().filter_map(Value::as_str);
    words.map(str::to_owned).collect()
}

/// From when to when a result is, in seconds: by its start and end, by ranges of frames, or by the frames at which a region of a video is
/// switched on and off.
///
/// # Errors
/// What was found in place of seconds, or of frames of a known rate.
fn stretches_of(value: &Value, rate_hz: Option<f64>) -> Result<Vec<(f64, f64)>, String> {
    if let (Some(start), Some(end)) = (value["start"].as_f64(), value["end"].as_f64()) {
        return Ok(vec![(start, end)]);
    }
    if let Some(start) = value["start"].as_str() {
        let number = |value: &Value| value.as_str()?.trim().parse::<f64>().ok();
        return match number(&value["start"]).zip(number(&value["end"])) {
            Some(extent) => Ok(vec![extent]),
            None => Err(format!("the date `{start}`")),
        };
    }
    if let Some(ranges) = value["ranges"].as_array() {
        let rate_hz =
            rate_hz.ok_or("frames of a video of unknown rate (give it with --label-rate)")?;
        // Frames count from one, and the last belongs to the label.
        let range = |range: &Value| {
            let (start, end) = (range["start"].as_f64()?, range["end"].as_f64()?);
            Some(((start - 1.0).max(0.0) / rate_hz, end / rate_hz))
        };
        return Ok(ranges.iter().filter_map(range).collect());
    }
    let Some(sequence) = value["sequence"].as_array() else {
        return Err("neither".to_owned());
    };
    let mut stretches = Vec::new();
    let mut open: Option<f64> = None;
    for key in sequence {
        let by_frame = || Some((key["frame"].as_f64()? - 1.0) / rate_hz?);
        let time = key["time"].as_f64().or_else(by_frame);
        let time = time.ok_or("frames of a video of unknown rate (give it with --label-rate)")?;
        match (key["enabled"].as_bool(), open) {
            (Some(false), Some(start)) => {
                stretches.push((start, time));
                open = None;
            }
            (Some(false), None) => {}
            (_, None) => open = Some(time),
            (_, Some(_)) => {}
        }
    }
    if let Some(start) = open {
        let last = sequence.last().and_then(|key| key["time"].as_f64());
        let end = value["duration"].as_f64().or(last).unwrap_or(start);
        stretches.push((start, end));
    }
    Ok(stretches)
}

/// State of a prediction: rejected if its model version is the one that exports write for rejections, else proposed.
fn state_of(prediction: &Value) -> SampleState {
    match prediction["model_version"].as_str() {
        Some(REJECTED) => SampleState::Rejected,
        _ => SampleState::Proposed,
    }
}

const VERSION: &str = concat!("morec ", env!("CARGO_PKG_VERSION"));

/// The model that predictions are of which somebody looked at and rejected.
const REJECTED: &str = "morec: rejected";

/// `data.clip`, or the stem of the first file in `data` (in the task, of the short form), without what uploading puts before its name.
fn clip_of(task: &Value, context: &LabelContext) -> Option<String> {
    if let Some(clip) = task["data"]["clip"].as_str() {
        return Some(clip.to_owned());
    }
    let fields = task["data"].as_object().or_else(|| task.as_object())?;
    let texts = || fields.values().filter_map(Value::as_str);
    let is_file = |text: &&str| {
        text.rsplit('/')
            .next()
            .is_some_and(|name| name.contains('.'))
    };
    let text = texts().find(is_file).or_else(|| texts().next())?;
    let name = text.rsplit(['/', '\\', '=']).next()?;
    let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    if context.knows(stem) {
        return Some(stem.to_owned());
    }
    // Eight hexadecimal digits and a hyphen.
    let is_mark = |mark: &str| mark.len() == 8 && mark.bytes().all(|b| b.is_ascii_hexdigit());
    let uploaded = stem.split_once('-').filter(|(mark, _)| is_mark(mark));
    Some(uploaded.map_or(stem, |(_, rest)| rest).to_owned())
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
