//! BIDS events: for each recording a table of `onset`, `duration` and `trial_type`, seconds, called `…_events.tsv`.

use morec::formats::{ParseError, Place, Warning};

use super::annotation::{Annotation, BIDS_SUFFIX, ClipLengths, ReadLabels, secs, text};
use super::csv::records;

/// What stands for nothing.
const NOTHING: &str = "n/a";

/// True of a table whose columns are those of events.
pub fn is_of_bids(bytes: &[u8]) -> bool {
    let first = bytes.split(|byte| *byte == b'\n').next().unwrap_or(bytes);
    let first = String::from_utf8_lossy(first);
    let has = |name: &str| first.split('\t').any(|cell| cell.trim() == name);
    first.starts_with("onset") && has("duration")
}

pub fn read(bytes: &[u8], clip: Option<&str>) -> Result<ReadLabels, ParseError> {
    let clip = clip.ok_or_else(|| {
        let expected = "to be given the clip (events do not name it)";
        ParseError::new(Place::File, expected, "no clip given")
    })?;
    let clip = clip.strip_suffix(BIDS_SUFFIX).unwrap_or(clip);
    let mut records = records(text(bytes)?, '\t')?.into_iter();
    let (line, header) = records.next().unwrap_or_default();
    let find = |name: &str| header.iter().position(|cell| cell.trim() == name);
    let need = |name: &str| {
        find(name).ok_or_else(|| {
            let (expected, found) = (format!("a column `{name}`"), header.join(", "));
            ParseError::new(Place::Line(line), expected, found)
        })
    };
    let (onset, duration, class) = (need("onset")?, need("duration")?, need("trial_type")?);
    let annotator = find("annotator");
    let mut read = ReadLabels::default();
    for (line, record) in records {
        let cell = |column: usize| record.get(column).map_or(NOTHING, |cell| cell.trim());
        let number = |column: usize| {
            let found = cell(column);
            let secs = found.parse::<f64>().ok().filter(|secs| secs.is_finite());
            secs.ok_or_else(|| ParseError::new(Place::Line(line), "seconds", format!("`{found}`")))
        };
        let class = cell(class);
        if class == NOTHING || class.is_empty() {
            let said = "an event without a trial_type; left out";
            read.warnings.push(Warning::new(Place::Line(line), said));
            continue;
        }
        let start = number(onset)?;
        let length = match cell(duration) {
            NOTHING => 0.0,
            _ => number(duration)?,
        };
        if length >= 0.0 && start + length < 0.0 {
            let said = format!("{class} lies before the recording; left out");
            read.warnings.push(Warning::new(Place::Line(line), said));
            continue;
        }
        let extent = (start.max(0.0), start + length);
        let stretch = read.stretch(Place::Line(line), class, extent);
        let stretch = stretch.map_err(|found| {
            ParseError::new(Place::Line(line), "a duration of at least 0", found)
        })?;
        if let Some(extent) = stretch {
            let name = annotator.map(cell).filter(|name| *name != NOTHING);
            read.annotations.push(Annotation {
                annotator: name.map(str::to_owned),
                ..Annotation::accepted(clip, class, extent)
            });
        }
    }
    Ok(read)
}

pub fn write(annotations: &[Annotation], lengths: &ClipLengths) -> Result<String, String> {
    let annotators = annotations.iter().any(|a| a.annotator.is_some());
    let mut rows = Vec::new();
    for a in annotations {
        let (start, stop) = secs(a, lengths)?;
        let who = match annotators {
            true => format!("\t{}", a.annotator.as_deref().unwrap_or(NOTHING)),
            false => String::new(),
        };
        let names = [Some(&a.class), a.annotator.as_ref()];
        let mut names = names.into_iter().flatten();
        if let Some(name) = names.find(|name| {
            name.contains(['\t', '\n', '\r'])
                || name.starts_with('"')
                || name.trim() != *name
                || *name == NOTHING
        }) {
            return Err(format!(
                "{name:?}: events of BIDS cannot hold this name; rename it"
            ));
        }
        rows.push((
            start,
            format!("{start}\t{}\t{}{who}\n", stop - start, a.class),
        ));
    }
    // Events are sorted by their onset.
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    let header = if annotators { "\tannotator" } else { "" };
    let rows = rows.into_iter().map(|(_, row)| row);
    Ok(format!(
        "onset\tduration\ttrial_type{header}\n{}",
        rows.collect::<String>()
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn events_of_a_recording_are_labels_of_its_clip() {
        let table = b"onset\tduration\ttrial_type\tresponse_time\n-0.5\t1.5\twalk\tn/a\n2\t0\tbeep\t1\n3.25\tn/a\tflash\t1\n4\t1\tn/a\t1\n-2\t1\tbefore\t1\n5\t0.5\tjump\t1\n";
        assert!(is_of_bids(table));
        let read = read(table, Some("sub-01_task-walk_events")).unwrap();
        let found: Vec<_> = (read.annotations.iter())
            .map(|a| (a.clip.as_str(), a.class.as_str(), a.extent.unwrap()))
            .collect();
        let clip = "sub-01_task-walk";
        assert_eq!(
            found,
            [(clip, "walk", (0.0, 1.0)), (clip, "jump", (5.0, 5.5))]
        );
        assert_eq!(read.warnings.len(), 4, "{:?}", read.warnings);
    }

    #[test]
    fn mistakes_have_a_line() {
        for (table, said) in [
            (
                "onset\tduration\n1\t2\n",
                "line 1: expected a column `trial_type`",
            ),
            (
                "onset\tduration\ttrial_type\nsoon\t2\tx\n",
                "line 2: expected seconds, found `soon`",
            ),
            ("onset\tduration\ttrial_type\n1\t-2\tx\n", "line 2"),
        ] {
            let error = read(table.as_bytes(), Some("x")).unwrap_err().to_string();
            assert!(error.contains(said), "{error}");
        }
    }
}
