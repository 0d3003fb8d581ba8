//! BORIS' tabular events: lines about the observation, then a row for each start, stop or moment of a behaviour. Its aggregated events are
//! a plain table ([`csv`](super::csv)).

use morec::formats::{ParseError, Place, Warning};

use super::annotation::{Annotation, LabelContext, ReadLabels};
use crate::labels::SampleState;

/// A row with its line.
type Record = (u64, Vec<String>);

/// True if records are such a file's.
pub(super) fn is_tabular(records: &[Record]) -> bool {
    header(records).is_some()
}

fn header(records: &[Record]) -> Option<usize> {
    let has = |record: &Vec<String>, name: &str| record.iter().any(|cell| cell.trim() == name);
    records.iter().position(|(_, record)| {
        has(record, "Time")
            && has(record, "Behavior")
            && (has(record, "Status") || has(record, "Behavior type"))
    })
}

/// Behaviours from their start to their stop; moments, and what never stops, are left out with a warning.
pub(super) fn read(records: &[Record], context: &LabelContext) -> Result<ReadLabels, ParseError> {
    let mut read = ReadLabels::default();
    let Some(at) = header(records) else {
        return Ok(read);
    };
    let (line, names) = &records[at];
    let find = |known: &[&str]| names.iter().position(|name| known.contains(&name.trim()));
    let (Some(time), Some(behavior), Some(status)) = (
        find(&["Time"]),
        find(&["Behavior"]),
        find(&["Status", "Behavior type"]),
    ) else {
        let expected = "the columns Time, Behavior and Status of BORIS";
        return Err(ParseError::new(
            Place::Line(*line),
            expected,
            names.join(","),
        ));
    };
    let (subject, media) = (
        find(&["Subject"]),
        find(&["Media file path", "Media file name"]),
    );
    let id_column = find(&["Observation id"]);
    let above = records[..at]
        .iter()
        .find(|(_, r)| r[0].trim() == "Observation id");
    let above = above.and_then(|(_, record)| record.get(1));
    let mut open: Vec<(&str, &str, f64, u64)> = Vec::new();
    for (line, record) in &records[at + 1..] {
        let cell = |column: usize| record.get(column).map_or("", |cell| cell.trim());
        let secs = cell(time)
            .replacen(',', ".", 1)
            .parse::<f64>()
            .map_err(|_| {
                ParseError::new(Place::Line(*line), "seconds", format!("`{}`", cell(time)))
            })?;
        let (class, who) = (cell(behavior), subject.map_or("", cell));
        let is_it = |(known, whose, ..): &(&str, &str, f64, u64)| (*known, *whose) == (class, who);
        match cell(status).to_ascii_uppercase().as_str() {
            "START" => open.push((class, who, secs, *line)),
            "STOP" => {
                let Some(begun) = open.iter().position(is_it) else {
                    let text = format!("`{class}` stops but has no start; left out");
                    read.warnings.push(Warning::new(Place::Line(*line), text));
                    continue;
                };
                let (_, _, start, _) = open.remove(begun);
                let id = id_column.map(cell).or(above.map(|id| id.trim()));
                let file = media.map(cell).filter(|file| !file.is_empty());
                let known = id.filter(|id| context.knows(id));
                let Some(clip) = context.clip.or(known).or(file).or(id) else {
                    let expected = "the observation or media file that names the clip";
                    return Err(ParseError::new(Place::Line(*line), expected, "none"));
                };
                let extent = read.stretch(Place::Line(*line), class, (start, secs));
                let extent = extent.map_err(|found| {
                    ParseError::new(Place::Line(*line), "a stop after its start", found)
                })?;
                if extent.is_some() {
                    read.annotations.push(Annotation {
                        clip: clip.to_owned(),
                        class: class.to_owned(),
                        extent,
                        person: Some(who).filter(|who| !who.is_empty()).map(str::to_owned),
                        score: None,
                        state: SampleState::Accepted,
                        annotator: None,
                    });
                }
            }
            _ => {
                let _ = read.stretch(Place::Line(*line), class, (secs, secs));
            }
        }
    }
    for (class, _, start, line) in open {
        let text = format!("`{class}` starts at {start} s but has no stop; left out");
        read.warnings.push(Warning::new(Place::Line(line), text));
    }
    Ok(read)
}
