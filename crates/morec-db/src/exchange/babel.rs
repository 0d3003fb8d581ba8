//! BABEL-like JSON (Punnakkal et al. 2021): by sequence, `seq_ann` for the whole and `frame_ann` for stretches of it.

use morec::formats::{ParseError, Place, Warning};
use serde_json::{Map, Value, json};

use super::annotation::{Annotation, ClipLengths, ReadLabels, json_error, secs};
use crate::labels::SampleState;

/// Reads BABEL's JSON. Labels of whole sequences are left out where they repeat the labels of their parts.
///
/// # Errors
/// The JSON is invalid, or does not have BABEL's structure.
pub fn read(bytes: &[u8]) -> Result<ReadLabels, ParseError> {
    let expected = "a BABEL object: sequence number to {feat_p, dur, seq_ann, frame_ann}";
    let file: Map<String, Value> =
        serde_json::from_slice(bytes).map_err(|error| json_error(&error, expected))?;
    let mut read = ReadLabels::default();
    let mut summed_up = 0;
    for (key, sequence) in &file {
        // Files of ours name the clip in both places, whatever it is called.
        let path = sequence["feat_p"]
            .as_str()
            .filter(|path| *path != key.as_str());
        let clip = path.map_or(key.as_str(), stem);
        // What BABEL says of a whole sequence sums up its stretches. In files of ours clips have both.
        let has_stretches = ["frame_ann", "frame_anns"].iter().any(|set| {
            let set = &sequence[*set];
            let sets = set
                .as_array()
                .map_or(std::slice::from_ref(set), Vec::as_slice);
            sets.iter()
                .any(|set| set["labels"].as_array().is_some_and(|l| !l.is_empty()))
        });
        for (one, several, timed) in [
            ("seq_ann", "seq_anns", false),
            ("frame_ann", "frame_anns", true),
        ] {
            if !timed && has_stretches && path.is_some() {
                let labelled = |set: &str| !sequence[set].is_null();
                summed_up += usize::from(labelled(one) || labelled(several));
                continue;
            }
            let sets = sequence[several]
                .as_array()
                .into_iter()
                .flatten()
                .chain([&sequence[one]]);
            for label in sets.filter_map(|set| set["labels"].as_array()).flatten() {
                read_label(clip, label, timed, &mut read).map_err(|found| {
                    ParseError::new(Place::File, format!("{key}: a label with times"), found)
                })?;
            }
        }
    }
    if summed_up > 0 {
        let text = format!(
            "{summed_up} labels of whole sequences repeat the labels of their parts; left out"
        );
        read.warnings.push(Warning::new(Place::File, text));
    }
    Ok(read)
}

/// All labels of a sequence, those of the whole first.
pub fn labels(sequence: &Value) -> impl Iterator<Item = &Value> {
    let sets = ["seq_ann", "seq_anns", "frame_ann", "frame_anns"].map(|set| &sequence[set]);
    fn of_set(set: &Value) -> &[Value] {
        match set {
            Value::Array(sets) => sets,
            one => std::slice::from_ref(one),
        }
    }
    let labels = sets.into_iter().flat_map(of_set);
    labels.filter_map(|set| set["labels"].as_array()).flatten()
}

/// The file's stem where `feat_p` is a path to poses; a name of ours may hold a slash, too.
pub fn stem(path: &str) -> &str {
    let Some(path) = path.strip_suffix(".npz") else {
        return path;
    };
    let name = path.rsplit(['/', '\\']).next().unwrap_or(path);
    name.strip_suffix("_poses").unwrap_or(name)
}

fn read_label(clip: &str, label: &Value, timed: bool, read: &mut ReadLabels) -> Result<(), String> {
    let extent = match (timed, label["start_t"].as_f64(), label["end_t"].as_f64()) {
        (false, _, _) => None,
        (true, Some(start), Some(stop)) => {
            let class = label["proc_label"].as_str().unwrap_or_default();
            let extent = read.stretch(Place::File, class, (start, stop))?;
            let Some(extent) = extent else { return Ok(()) };
            Some(extent)
        }
        (true, _, _) => return Err(label.to_string()),
    };
    // Not of BABEL: what morec writes of labels that are no accepted ones.
    let state = label["state"].as_str().and_then(SampleState::from_name);
    let categories: Vec<&str> = label["act_cat"]
        .as_array()
        .into_iter()
        .flatten()
        .filter_map(Value::as_str)
        .collect();
    let named = ["proc_label", "raw_label"]
        .into_iter()
        .filter_map(|key| label[key].as_str());
    let classes = if categories.is_empty() {
        named.take(1).collect()
    } else {
        categories
    };
    for class in classes {
        read.annotations.push(Annotation {
            clip: clip.to_owned(),
            class: class.to_owned(),
            extent,
            person: None,
            score: None,
            state: state.unwrap_or(SampleState::Accepted),
            annotator: None,
        });
    }
    Ok(())
}

/// Writes annotations as BABEL's JSON, one sequence for each clip.
///
/// # Errors
/// A label covers a whole clip of unknown length.
pub fn write(annotations: &[Annotation], lengths: &ClipLengths) -> Result<String, String> {
    let mut file: Map<String, Value> = Map::new();
    for a in annotations {
        let sid = file.len();
        let sequence = file.entry(a.clip.clone()).or_insert_with(|| {
            let dur = lengths.get(&a.clip).map(|length| length.duration_secs());
            json!({ "babel_sid": sid, "feat_p": a.clip, "dur": dur,
                    "seq_ann": null, "frame_ann": null })
        });
        let mut label =
            json!({ "raw_label": a.class, "proc_label": a.class, "act_cat": [a.class] });
        if a.state != SampleState::Accepted {
            label["state"] = a.state.name().into();
        }
        let set = match a.extent {
            None => "seq_ann",
            Some(_) => {
                let (start, stop) = secs(a, lengths)?;
                label["start_t"] = start.into();
                label["end_t"] = stop.into();
                "frame_ann"
            }
        };
        if sequence[set].is_null() {
            sequence[set] = json!({ "labels": [] });
        }
        if let Some(labels) = sequence[set]["labels"].as_array_mut() {
            labels.push(label);
        }
    }
    serde_json::to_string_pretty(&file)
        .map(|text| text + "\n")
        .map_err(|error| error.to_string())
}
