//! Tables separated by commas (RFC 4180), or by semicolons or tabs as spreadsheets write them: `file,label,start_s,end_s,start_frame,end_frame,score,actor,source`.

use morec::formats::{ParseError, Place, Warning};

use super::annotation::{Annotation, ClipLengths, LabelContext, ReadLabels, frames, secs};
use super::boris;
use crate::labels::SampleState;

const HEADER: &str =
    "file,label,start_s,end_s,start_frame,end_frame,whole_clip,score,actor,source,state";

/// Reads a table with a header row. Columns are found by their names, in any order; the separator is found from the first lines.
///
/// # Errors
/// A required column is missing, or a cell is not what its column requires.
pub fn read(bytes: &[u8], context: &LabelContext) -> Result<ReadLabels, ParseError> {
    let text = super::annotation::text(bytes)?;
    let separator = separator(text);
    let mut records = records(text, separator)?;
    if boris::is_tabular(&records) {
        return boris::read(&records, context);
    }
    // A name may begin with the sign of a comment.
    let header = records
        .iter()
        .find(|(_, record)| !record[0].starts_with('#'));
    let width = header.map_or(0, |(_, record)| record.len());
    records.retain(|(_, record)| {
        let first = &record[0];
        !(first.starts_with("# ") || first.starts_with('#') && record.len() < width)
    });
    let mut records = records.into_iter();
    let (line, header) = records.next().ok_or_else(|| {
        ParseError::new(
            Place::File,
            "a header line with column names",
            "an empty file",
        )
    })?;
    let columns = Columns::of(line, &header)?;
    let mut read = ReadLabels::default();
    for (line, record) in records {
        let row = CsvRow {
            line,
            record: &record,
            has_comma: separator != ',',
        };
        if let Some(annotation) = columns.annotation(&row, context, &mut read)? {
            read.annotations.push(annotation);
        }
    }
    Ok(read)
}

/// The columns of a table, by their names.
struct Columns {
    file: usize,
    label: usize,
    secs: Option<(usize, usize)>,
    frames: Option<(usize, usize)>,
    whole: Option<usize>,
    score: Option<usize>,
    person: Option<usize>,
    state: Option<usize>,
    annotator: Option<usize>,
}

impl Columns {
    fn of(line: u64, header: &[String]) -> Result<Self, ParseError> {
        let find = |names: &[&str]| {
            let named = |name: &&str| {
                header
                    .iter()
                    .position(|h| h.trim().eq_ignore_ascii_case(name))
            };
            names.iter().find_map(named)
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
        let framed = find(&["start_frame", "start"]).zip(find(&["end_frame", "stop"]));
        Ok(Self {
            // The last ones are those of BORIS' aggregated events.
            file: need(&["file", "clip", "filename", "file_name", "observation id"])?,
            label: need(&["label", "class", "behavior", "behaviour"])?,
            secs: find(&[
                "start_s",
                "start_secs",
                "start (s)",
                "start_sec",
                "start_seconds",
            ])
            .zip(find(&[
                "end_s",
                "stop_secs",
                "stop (s)",
                "end (s)",
                "stop_s",
                "end_secs",
                "end_sec",
                "stop_sec",
                "stop_seconds",
                "end_seconds",
            ])),
            frames: framed,
            whole: find(&["whole_clip"]),
            score: find(&["score"]),
            person: find(&["actor", "person", "subject"]),
            state: find(&["state"]),
            annotator: find(&["annotator"]),
        })
    }

    /// The label of a row; `None` if it is left out, which `read` then says.
    fn annotation(
        &self,
        row: &CsvRow<'_>,
        context: &LabelContext,
        read: &mut ReadLabels,
    ) -> Result<Option<Annotation>, ParseError> {
        let (clip, class) = (row.cell(self.file), row.cell(self.label));
        let filled = |pair: &(usize, usize)| !row.cell(pair.0).is_empty();
        let mut before = 0.0;
        let extent = if self.whole.is_some_and(|column| row.cell(column) == "1") {
            None
        } else if let Some((start, stop)) = self.secs.filter(filled) {
            Some((row.number(start)?, row.number(stop)?))
        } else if let Some((start, stop)) = self.frames.filter(filled) {
            let Some(rate_hz) = context.rate_of(clip) else {
                *read.absent.entry(clip.to_owned()).or_default() += 1;
                return Ok(None);
            };
            before = context.before(clip, rate_hz);
            Some((row.number(start)? / rate_hz, row.number(stop)? / rate_hz))
        } else {
            None
        };
        if let Some(extent) = extent {
            let stretch = read.stretch(Place::Line(row.line), class, extent);
            let stretch = stretch.map_err(|found| {
                let expected = "a stop after a start of at least 0";
                ParseError::new(Place::Line(row.line), expected, found)
            })?;
            if stretch.is_none() {
                return Ok(None);
            }
        }
        let state = self.state.map_or(Ok(SampleState::Accepted), |column| {
            super::annotation::state(row.cell(column), row.line)
        })?;
        if class.is_empty() {
            let text = "a row without a label; left out";
            read.warnings
                .push(Warning::new(Place::Line(row.line), text));
            return Ok(None);
        }
        let cell = |column: Option<usize>| column.map_or("", |column| row.cell(column));
        let name = |column| Some(cell(column).to_owned()).filter(|name| !name.is_empty());
        Ok(Some(Annotation {
            clip: clip.to_owned(),
            class: class.to_owned(),
            extent: extent.map(|(start, stop)| (start - before, stop - before)),
            person: name(self.person),
            annotator: name(self.annotator),
            score: cell(self.score)
                .parse()
                .ok()
                .filter(|score: &f64| score.is_finite()),
            state,
        }))
    }
}

/// A record below the header.
struct CsvRow<'a> {
    line: u64,
    record: &'a [String],
    /// True if numbers may have a comma for a point.
    has_comma: bool,
}

impl CsvRow<'_> {
    fn cell(&self, column: usize) -> &str {
        self.record.get(column).map_or("", |cell| cell.trim())
    }

    fn number(&self, column: usize) -> Result<f64, ParseError> {
        let found = self.cell(column);
        let point = match self.has_comma {
            true => found.replacen(',', ".", 1),
            false => found.to_owned(),
        };
        point
            .parse()
            .map_err(|_| ParseError::new(Place::Line(self.line), "a number", format!("`{found}`")))
    }
}

/// What separates cells: of comma, semicolon and tab the one that the first line that is no comment has most often.
pub(crate) fn separator(text: &str) -> char {
    let mut lines = text.lines().filter(|line| !line.trim().is_empty());
    let first = lines
        .find(|line| !line.starts_with('#'))
        .unwrap_or_default();
    let count = |c: char| first.matches(c).count();
    // Of several that are as often the first.
    [';', '\t', ',']
        .into_iter()
        .max_by_key(|&c| count(c))
        .filter(|&c| count(c) > 0)
        .unwrap_or(',')
}

/// Records with the line each begins at; blank lines are skipped.
pub(crate) fn records(text: &str, separator: char) -> Result<Vec<(u64, Vec<String>)>, ParseError> {
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
            c if c == separator => record.push(std::mem::take(&mut cell)),
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

/// Writes annotations as a table, with times in seconds and, where the frame rate is known, in frames.
///
/// # Errors
/// A label covers a whole clip of unknown length.
pub fn write(annotations: &[Annotation], lengths: &ClipLengths) -> Result<String, String> {
    let annotators = annotations.iter().any(|a| a.annotator.is_some());
    let more = if annotators { ",annotator" } else { "" };
    let mut out = format!("{HEADER}{more}\n");
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
        let annotator = match annotators {
            true => format!(",{}", quoted(a.annotator.as_deref().unwrap_or(""))),
            false => String::new(),
        };
        out.push_str(&format!(
            "{},{},{start},{stop},{framed},{},{score},{},morec,{}{annotator}\n",
            quoted(&a.clip),
            quoted(&a.class),
            u8::from(a.extent.is_none()),
            quoted(a.person.as_deref().unwrap_or("")),
            a.state.name(),
        ));
    }
    Ok(out)
}
