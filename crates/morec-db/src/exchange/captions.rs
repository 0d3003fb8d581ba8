//! Descriptions of clips in sentences, beside the clips: tables, BABEL, texts of HumanML3D, the index of CMU.

use std::collections::BTreeMap;

use morec::TimeSpan;
use morec::formats::{ParseError, Place};
use morec::labels::names_of_clip;
use serde_json::{Map, Value};

use super::annotation::{json_error, text};
use super::babel;
use super::csv::{records, separator};

/// Signs of a text of HumanML3D: sentence, words with their parts of speech, start, stop.
const PARTS_OF_HUMANML3D: usize = 4;

/// A sentence about a clip, or about a stretch of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Caption {
    /// The clip's name, as the file has it.
    pub clip: String,
    /// What happens.
    pub text: String,
    /// When, seconds; `None`: the whole clip.
    pub span: Option<TimeSpan>,
}

/// Reads captions; the name of the file says the form, and the clip of a text of HumanML3D.
///
/// - `.json`: BABEL, whole sequences and stretches.
/// - `.tsv`, `.csv`: a table with columns `clip` (or `file`, `motion`) and `caption` (or `text`, `description`), and `start_secs` and
///   `stop_secs` for stretches.
/// - Any other text: lines of HumanML3D (`sentence#words#start#stop`), or of a name and a description, as the index of CMU.
///
/// # Errors
/// The place where something else was expected.
pub fn read_captions(file_name: &str, bytes: &[u8]) -> Result<Vec<Caption>, ParseError> {
    let (stem, ending) = file_name.rsplit_once('.').unwrap_or((file_name, ""));
    match ending.to_ascii_lowercase().as_str() {
        "json" => of_babel(bytes),
        "tsv" | "csv" => of_table(text(bytes)?),
        _ => of_lines(stem, text(bytes)?),
    }
}

/// Adds to captions of HumanML3D those of the sequences that its clips are parts of, by its `index.csv`
/// (`source_path,start_frame,end_frame,new_name`, twenty frames a second).
///
/// # Errors
/// The place where something else was expected.
pub fn add_sources(captions: &mut Vec<Caption>, index: &[u8]) -> Result<(), ParseError> {
    const RATE_HZ: f64 = 20.0;
    let mut rows = records(text(index)?, ',')?.into_iter();
    let expected = ["source_path", "start_frame", "end_frame", "new_name"];
    let (line, header) = rows.next().unwrap_or_default();
    let places = expected.map(|name| header.iter().position(|cell| cell.trim() == name));
    let [Some(source), Some(start), Some(stop), Some(new)] = places else {
        let (expected, found) = (expected.join(","), header.join(","));
        return Err(ParseError::new(Place::Line(line), expected, found));
    };
    let mut sources = BTreeMap::new();
    for (line, row) in rows {
        let cell = |column: usize| row.get(column).map_or("", |cell| cell.trim());
        let secs = |column: usize| {
            let frame = cell(column).parse::<f64>().map(|frame| frame / RATE_HZ);
            frame.map_err(|_| ParseError::new(Place::Line(line), "a frame", cell(column)))
        };
        let whole = TimeSpan::new(secs(start)?, secs(stop)?);
        let stem = |path: &str| names_of_clip(path).last().map(str::to_owned);
        sources.extend(stem(cell(new)).zip(stem(cell(source)).zip(Some(whole))));
    }
    let of_source = |caption: &Caption| {
        let (clip, whole) = sources.get(&caption.clip)?.clone();
        let begin = whole.start_secs;
        let part = |span: TimeSpan| TimeSpan::new(begin + span.start_secs, begin + span.stop_secs);
        Some(Caption {
            clip,
            text: caption.text.clone(),
            span: Some(caption.span.map_or(whole, part)),
        })
    };
    let added: Vec<Caption> = captions.iter().filter_map(of_source).collect();
    captions.extend(added);
    Ok(())
}

fn of_babel(bytes: &[u8]) -> Result<Vec<Caption>, ParseError> {
    let expected = "a BABEL object: sequence number to {feat_p, dur, seq_ann, frame_ann}";
    let file: Map<String, Value> =
        serde_json::from_slice(bytes).map_err(|error| json_error(&error, expected))?;
    let mut captions = Vec::new();
    for (key, sequence) in &file {
        let clip = sequence["feat_p"]
            .as_str()
            .map_or(key.as_str(), babel::stem);
        for label in babel::labels(sequence) {
            let said = [&label["raw_label"], &label["proc_label"]];
            let Some(said) = said.into_iter().find_map(Value::as_str) else {
                continue;
            };
            let times = label["start_t"].as_f64().zip(label["end_t"].as_f64());
            captions.push(Caption {
                clip: clip.to_owned(),
                text: said.to_owned(),
                span: times.map(|(start, stop)| TimeSpan::new(start, stop)),
            });
        }
    }
    Ok(captions)
}

fn of_table(text: &str) -> Result<Vec<Caption>, ParseError> {
    let mut records = records(text, separator(text))?.into_iter();
    let (line, header) = records.next().ok_or_else(|| {
        ParseError::new(
            Place::File,
            "a line with the names of columns",
            "an empty file",
        )
    })?;
    let find = |names: &[&str]| {
        header.iter().position(|cell| {
            let is_called = |name: &&str| cell.trim().eq_ignore_ascii_case(name);
            names.iter().any(is_called)
        })
    };
    let need = |names: &[&str]| {
        find(names).ok_or_else(|| {
            let expected = format!("a column {}", names.join(" or "));
            ParseError::new(Place::Line(line), expected, header.join(", "))
        })
    };
    let clip = need(&["clip", "file", "name", "motion"])?;
    let caption = need(&["caption", "text", "description"])?;
    let times = find(&["start_secs", "start"]).zip(find(&["stop_secs", "stop"]));
    let mut captions = Vec::new();
    for (line, record) in records {
        let cell = |column: usize| record.get(column).map_or("", |cell| cell.trim());
        let secs = |column: usize| -> Result<Option<f64>, ParseError> {
            let number = |found: &str| {
                let secs = found.parse::<f64>().ok().filter(|secs| *secs >= 0.0);
                secs.ok_or_else(|| ParseError::new(Place::Line(line), "seconds", found))
            };
            Some(cell(column))
                .filter(|c| !c.is_empty())
                .map(number)
                .transpose()
        };
        let span = match times {
            Some((start, stop)) => secs(start)?.zip(secs(stop)?),
            None => None,
        };
        captions.push(Caption {
            clip: cell(clip).to_owned(),
            text: cell(caption).to_owned(),
            span: span.map(|(start, stop)| TimeSpan::new(start, stop)),
        });
    }
    Ok(captions)
}

fn of_lines(file_stem: &str, text: &str) -> Result<Vec<Caption>, ParseError> {
    let mut captions = Vec::new();
    for (number, line) in (1..).zip(text.lines().map(str::trim)) {
        let parts: Vec<&str> = line.split('#').collect();
        if parts.len() == PARTS_OF_HUMANML3D {
            let secs = |found: &str| {
                let number = |_| ParseError::new(Place::Line(number), "seconds", found);
                found.trim().parse::<f64>().map_err(number)
            };
            let (start, stop) = (secs(parts[2])?, secs(parts[3])?);
            // 0 to 0 is the whole clip.
            captions.push(Caption {
                clip: file_stem.to_owned(),
                text: parts[0].to_owned(),
                span: (stop > start).then(|| TimeSpan::new(start, stop)),
            });
            continue;
        }
        // Headings of the index of CMU are about people.
        let named = line.split_once(char::is_whitespace);
        let named = named.filter(|(name, _)| *name != "Subject" && !name.starts_with('#'));
        captions.extend(named.map(|(name, said)| Caption {
            clip: name.to_owned(),
            text: said.trim().to_owned(),
            span: None,
        }));
    }
    Ok(captions)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Clip, text, start and stop.
    type Told = (String, String, Option<(f64, f64)>);

    fn read(name: &str, text: &str) -> Vec<Told> {
        let captions = read_captions(name, text.as_bytes()).unwrap();
        let bounds = |span: TimeSpan| (span.start_secs, span.stop_secs);
        captions
            .into_iter()
            .map(|c| (c.clip, c.text, c.span.map(bounds)))
            .collect()
    }

    fn said(
        clip: &str,
        text: &str,
        span: Option<(f64, f64)>,
    ) -> (String, String, Option<(f64, f64)>) {
        (clip.to_owned(), text.to_owned(), span)
    }

    #[test]
    fn every_form_gives_clip_sentence_and_stretch() {
        let babel = r#"{"7": {"feat_p": "CMU/CMU/01/01_01_poses.npz",
            "seq_ann": {"labels": [{"raw_label": "jumping about"}]},
            "frame_ann": {"labels": [{"raw_label": "turn", "start_t": 1.5, "end_t": 2}]}}}"#;
        let expected = [
            said("01_01", "jumping about", None),
            said("01_01", "turn", Some((1.5, 2.0))),
        ];
        assert_eq!(read("babel.json", babel), expected);
        let table = "clip,caption,start_secs,stop_secs\na,\"waves, left\",,\nb,bows,1,2.5\n";
        let expected = [
            said("a", "waves, left", None),
            said("b", "bows", Some((1.0, 2.5))),
        ];
        assert_eq!(read("captions.csv", table), expected);
        let human = "a man kicks.#a/DET man/NOUN kick/VERB#0.0#0.0\nthen turns#turn/VERB#1.0#2.0\n";
        let expected = [
            said("000021", "a man kicks.", None),
            said("000021", "then turns", Some((1.0, 2.0))),
        ];
        assert_eq!(read("000021.txt", human), expected);
        let cmu = "Subject #1 (climb, swing)\n01_01   playground - forward jumps\n\n01_02\tclimb\n";
        let expected = [
            said("01_01", "playground - forward jumps", None),
            said("01_02", "climb", None),
        ];
        assert_eq!(read("index.txt", cmu), expected);
    }

    #[test]
    fn clips_of_humanml3d_are_parts_of_sequences() {
        let text = b"kicks#kick/VERB#0.0#0.0\nturns#turn/VERB#1.0#2.0\n";
        let mut captions = read_captions("000000.txt", text).unwrap();
        let index = b"source_path,start_frame,end_frame,new_name\n./pose_data/KIT/3/kick_poses.npy,20,120,000000.npy\n";
        add_sources(&mut captions, index).unwrap();
        let of_source: Vec<_> = captions[2..]
            .iter()
            .map(|c| (&c.clip[..], c.span))
            .collect();
        let expected =
            [(1.0, 6.0), (2.0, 3.0)].map(|(a, b)| ("kick_poses", Some(TimeSpan::new(a, b))));
        assert_eq!(of_source, expected);
        let error = add_sources(&mut captions, b"a,b\n")
            .unwrap_err()
            .to_string();
        assert!(
            error.contains("line 1") && error.contains("new_name"),
            "{error}"
        );
    }

    #[test]
    fn mistakes_have_a_place() {
        for (name, text, place) in [
            ("a.csv", "clip,words\na,b\n", "line 1"),
            ("a.csv", "clip,caption,start,stop\na,b,soon,2\n", "line 2"),
            ("a.txt", "ok#x#0#0\na man#x#one#2\n", "line 2"),
            ("a.json", "{\n", "line 2"),
            ("a.tsv", "", "an empty file"),
        ] {
            let error = read_captions(name, text.as_bytes())
                .unwrap_err()
                .to_string();
            assert!(error.contains(place), "{name}: {error}");
        }
    }
}
