//! Comma-separated tables (RFC 4180): `file,label,start_s,end_s,start_frame,end_frame,score,actor,source`.

use morec::formats::{ParseError, Place, Warning};

use super::annotation::{Annotation, ClipLengths, ReadLabels, checked, frames, secs};
use crate::labels::SampleState;

const HEADER: &str =
    "file,label,start_s,end_s,start_frame,end_frame,whole_clip,score,actor,source,state";

pub fn read(bytes: &[u8], lengths: &ClipLengths) -> Result<ReadLabels, ParseError> {
    let mut records = records(super::annotation::text(bytes)?)?.into_iter();
    let (line, header) = records.next().ok_or_else(|| {
        ParseError::new(
            Place::File,
            "a header line with column names",
            "an empty file",
        )
    })?;
    let find = |names: &[&str]| {
        header
            .iter()
            .position(|h| names.iter().any(|n| h.trim().eq_ignore_ascii_case(n)))
    };
    let need = |names: &[&str]| {
        find(names).ok_or_else(|| {
            ParseError::new(
                Place::Line(line),
                format!("a column `{}`", names[0]),
                format!("`{}`", header.join(",")),
            )
        })
    };
    let (file, label) = (need(&["file", "clip"])?, need(&["label", "class"])?);
    let seconds = find(&["start_s", "start_secs"]).zip(find(&["end_s", "stop_secs"]));
    let framed = find(&["start_frame", "start"]).zip(find(&["end_frame", "stop"]));
    let (whole, score, actor) = (
        find(&["whole_clip"]),
        find(&["score"]),
        find(&["actor", "person"]),
    );
    let state = find(&["state"]);
    let mut read = ReadLabels::default();
    for (line, record) in records {
        let cell =
            |column: Option<usize>| column.and_then(|c| record.get(c)).map_or("", |c| c.trim());
        let number = |column: usize| -> Result<f64, ParseError> {
            let found = cell(Some(column));
            found
                .parse()
                .map_err(|_| ParseError::new(Place::Line(line), "a number", format!("`{found}`")))
        };
        let filled = |pair: &(usize, usize)| !cell(Some(pair.0)).is_empty();
        let extent = if cell(whole) == "1" {
            None
        } else if let Some((start, stop)) = seconds.filter(filled) {
            Some((number(start)?, number(stop)?))
        } else if let Some((start, stop)) = framed.filter(filled) {
            let Some(length) = super::annotation::length_of(cell(Some(file)), lengths) else {
                *read.absent.entry(cell(Some(file)).to_owned()).or_default() += 1;
                continue;
            };
            Some((
                number(start)? / length.rate_hz,
                number(stop)? / length.rate_hz,
            ))
        } else {
            None
        };
        if let Some((start, stop)) = extent {
            checked(start, stop).map_err(|found| {
                ParseError::new(
                    Place::Line(line),
                    "a stop after a start of at least 0",
                    found,
                )
            })?;
        }
        let state = state.map_or(Ok(SampleState::Accepted), |column| {
            super::annotation::state(cell(Some(column)), line)
        })?;
        if cell(Some(label)).is_empty() {
            read.warnings.push(Warning::new(
                Place::Line(line),
                "a row without a label; left out",
            ));
            continue;
        }
        read.annotations.push(Annotation {
            clip: cell(Some(file)).to_owned(),
            class: cell(Some(label)).to_owned(),
            extent,
            person: Some(cell(actor))
                .filter(|p| !p.is_empty())
                .map(str::to_owned),
            score: cell(score)
                .parse()
                .ok()
                .filter(|score: &f64| score.is_finite()),
            state,
        });
    }
    Ok(read)
}

/// Records with the line each begins at; blank lines are none.
fn records(text: &str) -> Result<Vec<(u64, Vec<String>)>, ParseError> {
    let (mut records, mut record, mut cell) = (Vec::new(), Vec::new(), String::new());
    let (mut line, mut begun, mut quoted) = (1, 1, false);
    let mut chars = text.chars().peekable();
    while let Some(c) = chars.next() {
        line += u64::from(c == '\n');
        match c {
            '"' if quoted && chars.peek() == Some(&'"') => cell.extend(chars.next()),
            '"' if quoted => quoted = false,
            _ if quoted => cell.push(c),
            '"' if cell.is_empty() => quoted = true,
            ',' => record.push(std::mem::take(&mut cell)),
            '\r' if chars.peek() == Some(&'\n') => {}
            '\n' | '\r' => {
                record.push(std::mem::take(&mut cell));
                records.push((begun, std::mem::take(&mut record)));
                begun = line;
            }
            c => cell.push(c),
        }
    }
    if quoted {
        return Err(ParseError::new(
            Place::Line(begun),
            "a closing quote",
            "the end of the file",
        ));
    }
    if !cell.is_empty() || !record.is_empty() {
        record.push(cell);
        records.push((begun, record));
    }
    records.retain(|(_, record)| record.iter().any(|cell| !cell.trim().is_empty()));
    Ok(records)
}

fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

pub fn write(annotations: &[Annotation], lengths: &ClipLengths) -> Result<String, String> {
    let mut out = format!("{HEADER}\n");
    for a in annotations {
        let (start, stop) = secs(a, lengths)?;
        let framed = frames(
            &Annotation {
                extent: Some((start, stop)),
                ..a.clone()
            },
            lengths,
        );
        let framed = framed.map_or_else(|| ",".to_owned(), |(from, to)| format!("{from},{to}"));
        let score = a.score.map_or_else(String::new, |score| score.to_string());
        out.push_str(&format!(
            "{},{},{start},{stop},{framed},{},{score},{},morec,{}\n",
            quoted(&a.clip),
            quoted(&a.class),
            u8::from(a.extent.is_none()),
            quoted(a.person.as_deref().unwrap_or("")),
            a.state.name(),
        ));
    }
    Ok(out)
}
