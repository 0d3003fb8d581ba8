//! Projects of BORIS (`.boris`, format 7.0 and later): one JSON object with an ethogram, subjects and observations. A state is two events, its
//! start and its stop, of the same subject, behaviour and modifiers.

use std::collections::{BTreeMap, BTreeSet};

use morec::formats::{ParseError, Place, Warning};
use serde_json::{Map, Value, json};

use super::annotation::{Annotation, ClipLengths, LabelContext, ReadLabels, json_error, secs};

/// Begins the modifier of a state during which another of the same subject and behaviour goes on: BORIS would take the start of the
/// second for the stop of the first.
const OVERLAP: &str = "overlap ";
/// What BORIS writes where no subject is in focus.
const NO_SUBJECT: &str = "No focal subject";

/// Reads the state events of a project, each from its start to its stop; an observation is a clip. Point events, and states
/// without a stop, are left out with a warning.
///
/// # Errors
/// The file is not a project of BORIS.
pub fn read(bytes: &[u8], context: &LabelContext) -> Result<ReadLabels, ParseError> {
    let expected = "a project of BORIS: {behaviors_conf, observations}";
    let project: Value =
        serde_json::from_slice(bytes).map_err(|error| json_error(&error, expected))?;
    let Some(observations) = project["observations"].as_object() else {
        return Err(ParseError::new(Place::File, expected, "no observations"));
    };
    let behaviours = project["behaviors_conf"].as_object();
    let points: BTreeSet<&str> = (behaviours.into_iter().flat_map(Map::values))
        .filter(|b| {
            b["type"]
                .as_str()
                .is_some_and(|kind| kind.to_lowercase().starts_with("point"))
        })
        .filter_map(|b| b["code"].as_str())
        .collect();
    let mut read = ReadLabels::default();
    let mut modified = 0;
    for (id, observation) in observations {
        let clip = clip_of(id, observation, context);
        let mut open: BTreeMap<[&str; 3], f64> = BTreeMap::new();
        for event in sorted_events(id, observation)? {
            let ProjectEvent {
                secs,
                subject,
                code,
                modifiers,
            } = event;
            modified += usize::from(!modifiers.is_empty() && !modifiers.starts_with(OVERLAP));
            let key = [subject, code, modifiers];
            let start = match open.remove(&key) {
                _ if points.contains(code) => secs,
                Some(start) => start,
                None => {
                    open.insert(key, secs);
                    continue;
                }
            };
            let extent = read.stretch(Place::File, code, (start, secs));
            let error =
                |found| ParseError::new(Place::File, format!("{id}: times from 0 on"), found);
            let Some(extent) = extent.map_err(error)? else {
                continue;
            };
            let person = (!subject.is_empty() && subject != NO_SUBJECT).then(|| subject.to_owned());
            read.annotations.push(Annotation {
                person,
                ..Annotation::accepted(clip, code, extent)
            });
        }
        for ([_, code, _], start) in open {
            let text = format!("{id}: `{code}` starts at {start} s but has no stop; left out");
            read.warnings.push(Warning::new(Place::File, text));
        }
    }
    if modified > 0 {
        let text = format!("{modified} events have modifiers, which are not read");
        read.warnings.push(Warning::new(Place::File, text));
    }
    Ok(read)
}

/// One event of an observation.
struct ProjectEvent<'p> {
    secs: f64,
    subject: &'p str,
    code: &'p str,
    modifiers: &'p str,
}

/// The events of an observation by time.
fn sorted_events<'p>(
    id: &str,
    observation: &'p Value,
) -> Result<Vec<ProjectEvent<'p>>, ParseError> {
    let mut events = Vec::new();
    for (number, event) in observation["events"]
        .as_array()
        .into_iter()
        .flatten()
        .enumerate()
    {
        let (Some(secs), Some(code)) = (event[0].as_f64(), event[2].as_str()) else {
            let expected = format!("{id}: event {number}: [seconds, subject, behaviour, …]");
            return Err(ParseError::new(Place::File, expected, event.to_string()));
        };
        let text = |place: usize| event[place].as_str().unwrap_or("");
        events.push(ProjectEvent {
            secs,
            subject: text(1),
            code,
            modifiers: text(3),
        });
    }
    events.sort_by(|a, b| a.secs.total_cmp(&b.secs));
    Ok(events)
}

/// The clip of an observation: its name or one of its media files, if that is a known clip, else its name.
fn clip_of<'p>(id: &'p str, observation: &'p Value, context: &LabelContext<'p>) -> &'p str {
    let files = observation["file"]
        .as_object()
        .into_iter()
        .flat_map(Map::values);
    let media = files
        .flat_map(|files| files.as_array().into_iter().flatten())
        .filter_map(Value::as_str);
    let known = std::iter::once(id)
        .chain(media)
        .find(|name| context.knows(name));
    context.clip.or(known).unwrap_or(id)
}

/// Writes a project with an observation for each clip, a state event for each class and a subject for each person.
pub fn write(annotations: &[Annotation], lengths: &ClipLengths) -> Result<String, String> {
    let numbered = |names: BTreeSet<&str>, of: fn(&str) -> Value| -> Map<String, Value> {
        (names.into_iter().enumerate())
            .map(|(k, name)| (k.to_string(), of(name)))
            .collect()
    };
    let classes = annotations.iter().map(|a| a.class.as_str()).collect();
    let people = annotations
        .iter()
        .filter_map(|a| a.person.as_deref())
        .collect();
    let mut events: BTreeMap<&str, Vec<(f64, Value)>> = BTreeMap::new();
    let mut ends: BTreeMap<[&str; 3], Vec<f64>> = BTreeMap::new();
    let mut spans = Vec::new();
    for a in annotations {
        spans.push((secs(a, lengths)?, a));
    }
    spans.sort_by(|(a, _), (b, _)| a.0.total_cmp(&b.0));
    for ((start, stop), a) in spans {
        let who = a.person.as_deref().unwrap_or("");
        let lanes = ends.entry([&a.clip, who, &a.class]).or_default();
        let free = lanes.iter().position(|end| *end <= start);
        let lane = free.unwrap_or(lanes.len());
        lanes.resize(lanes.len().max(lane + 1), stop);
        lanes[lane] = stop;
        let modifier = match lane {
            0 => String::new(),
            more => format!("{OVERLAP}{more}"),
        };
        let row = |secs: f64| (secs, json!([secs, who, a.class, modifier, ""]));
        events
            .entry(&a.clip)
            .or_default()
            .extend([row(start), row(stop)]);
    }
    let mut observations = Map::new();
    for (clip, mut events) in events {
        events.sort_by(|a, b| a.0.total_cmp(&b.0));
        let events: Vec<Value> = events.into_iter().map(|(_, row)| row).collect();
        let observation = json!({
            "type": "LIVE", "date": "1970-01-01T00:00:00", "description": "", "time offset": 0.0,
            "file": {}, "independent_variables": {}, "observation time interval": [0, 0],
            "start_from_current_time": false, "start_from_current_epoch_time": false, "scan_sampling_time": 0,
            "events": events,
        });
        observations.insert(clip.to_owned(), observation);
    }
    let project = json!({
        "time_format": "hh:mm:ss", "project_date": "", "project_name": "morec", "project_description": "",
        "project_format_version": "7.0",
        "subjects_conf": numbered(people, |name| json!({ "key": "", "name": name, "description": "" })),
        "behaviors_conf": numbered(classes, |code| json!({
            "type": "State event", "key": "", "code": code, "description": "", "color": "", "category": "",
            "modifiers": {}, "excluded": "", "coding map": "",
        })),
        "observations": observations,
        "behavioral_categories": [], "independent_variables": {}, "coding_map": {}, "behaviors_coding_map": [],
        "converters": {},
    });
    let text = serde_json::to_string_pretty(&project).map_err(|error| error.to_string())?;
    Ok(text + "\n")
}
