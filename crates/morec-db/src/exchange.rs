//! Labels in other programs' forms, read and written.
//!
//! What all of them come down to is an [`Annotation`]. Times are seconds from the clip's beginning; forms that count in
//! less (milliseconds in ELAN) come back to whole frames of the clip ([`snap`]). Forms that know one recording a file (ELAN, Audacity) need to be
//! told the clip, unless morec wrote them.
//!
//! | form | times | keeps |
//! |---|---|---|
//! | TSV ([`morec::labels`]) | frames, or seconds where they lie on no frame | clip, class, person, whole clips, state |
//! | CSV | seconds and frames | all but who set it |
//! | JSON | seconds and frames | all but who set it |
//! | ELAN | milliseconds, so frames of up to 500 Hz | clip, class, person; state by tier |
//! | Audacity | seconds | class; the clip by the file's name ([`file_name`]) |
//! | BABEL | seconds | clip, class, whole clips, state (a key of ours) |
//! | Label Studio | seconds | clip, class, score; accepted ones as annotations, others as predictions |

mod audacity;
mod babel;
mod csv;
mod eaf;
mod file_names;
mod json;
mod label_studio;
#[cfg(test)]
mod tests;
mod tsv;

pub use file_names::{clip_of_file_name, file_name, file_names};

use std::collections::BTreeMap;

use morec::formats::{ParseError, Place, Warning};
use morec::labels::ClipLength;

use crate::labels::SampleState;

/// A labelled stretch as files tell of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Annotation {
    /// The clip's name.
    pub clip: String,
    /// What it shows.
    pub class: String,
    /// Start and stop in seconds; `None` for the whole clip.
    pub extent: Option<(f64, f64)>,
    /// Who is seen.
    pub person: Option<String>,
    /// How sure a program was.
    pub score: Option<f64>,
    /// What is thought of it.
    pub state: SampleState,
}

/// A form of labels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[allow(missing_docs)] // The names say it.
pub enum LabelFormat {
    Tsv,
    Csv,
    Json,
    Eaf,
    Audacity,
    Babel,
    LabelStudio,
}

impl LabelFormat {
    /// All of them.
    pub const ALL: [LabelFormat; 7] = [
        LabelFormat::Tsv,
        LabelFormat::Csv,
        LabelFormat::Json,
        LabelFormat::Eaf,
        LabelFormat::Audacity,
        LabelFormat::Babel,
        LabelFormat::LabelStudio,
    ];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            LabelFormat::Tsv => "tsv",
            LabelFormat::Csv => "csv",
            LabelFormat::Json => "json",
            LabelFormat::Eaf => "eaf",
            LabelFormat::Audacity => "audacity",
            LabelFormat::Babel => "babel",
            LabelFormat::LabelStudio => "label-studio",
        }
    }

    /// The form that a file's ending says; text files are Audacity's, JSON is told apart by its content.
    pub fn of_file(name: &str, bytes: &[u8]) -> Option<Self> {
        match name.rsplit_once('.')?.1.to_ascii_lowercase().as_str() {
            "tsv" => Some(LabelFormat::Tsv),
            "csv" => Some(LabelFormat::Csv),
            "eaf" => Some(LabelFormat::Eaf),
            "txt" => Some(LabelFormat::Audacity),
            "json" => Some(json::which(bytes)),
            _ => None,
        }
    }

    /// Whether a label of this state is read again in the same state.
    pub fn keeps(self, state: SampleState) -> bool {
        match self {
            LabelFormat::Audacity => state == SampleState::Accepted,
            _ => true,
        }
    }

    /// Whether a file of this form tells of one clip only.
    pub fn is_of_one_clip(self) -> bool {
        matches!(self, LabelFormat::Eaf | LabelFormat::Audacity)
    }
}

/// Annotations and what was doubtful about them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ReadLabels {
    /// In file order.
    pub annotations: Vec<Annotation>,
    /// What was left out or looks wrong.
    pub warnings: Vec<Warning>,
    /// Clips that are not known and whose frames can therefore not be told in seconds, with how many labels each had.
    pub absent: BTreeMap<String, usize>,
}

/// Lengths of the clips by name: frames need a rate.
pub type ClipLengths = BTreeMap<String, ClipLength>;

/// Reads labels. `clip` is the clip that a file of one clip speaks of.
///
/// # Errors
/// Where and why the file cannot be read; frames of a clip that `lengths` does not know are not an error but counted.
pub fn read(
    form: LabelFormat,
    bytes: &[u8],
    clip: Option<&str>,
    lengths: &ClipLengths,
) -> Result<ReadLabels, ParseError> {
    match form {
        LabelFormat::Tsv => tsv::read(bytes, lengths),
        LabelFormat::Csv => csv::read(bytes, lengths),
        LabelFormat::Json => json::read(bytes, lengths),
        LabelFormat::Eaf => eaf::read(text(bytes)?, clip),
        LabelFormat::Audacity => audacity::read(text(bytes)?, clip),
        LabelFormat::Babel => babel::read(bytes),
        LabelFormat::LabelStudio => label_studio::read(bytes),
    }
}

/// Writes labels. Forms of one clip take the annotations of one clip only.
///
/// # Errors
/// Annotations of several clips in a form of one; a clip whose length is needed and not known.
pub fn write(
    form: LabelFormat,
    annotations: &[Annotation],
    lengths: &ClipLengths,
) -> Result<String, String> {
    if form.is_of_one_clip()
        && annotations
            .windows(2)
            .any(|pair| pair[0].clip != pair[1].clip)
    {
        return Err(format!(
            "{} holds the labels of one clip: write a file for each",
            form.name()
        ));
    }
    match form {
        LabelFormat::Tsv => tsv::write(annotations, lengths),
        LabelFormat::Csv => csv::write(annotations, lengths),
        LabelFormat::Json => json::write(annotations, lengths),
        LabelFormat::Eaf => eaf::write(annotations, lengths),
        LabelFormat::Audacity => audacity::write(annotations, lengths),
        LabelFormat::Babel => babel::write(annotations, lengths),
        LabelFormat::LabelStudio => label_studio::write(annotations, lengths),
    }
}

/// A time that rounding moved off its frame by less than a millisecond, put back.
pub fn snap(secs: f64, rate_hz: f64) -> f64 {
    let frame = (secs * rate_hz).round() / rate_hz;
    if (frame - secs).abs() < 1e-3 {
        frame
    } else {
        secs
    }
}

/// Start and stop as seconds.
fn secs(annotation: &Annotation, lengths: &ClipLengths) -> Result<(f64, f64), String> {
    match annotation.extent {
        Some(extent) => Ok(extent),
        None => Ok((0.0, length(annotation, lengths)?.duration_secs())),
    }
}

fn length(annotation: &Annotation, lengths: &ClipLengths) -> Result<ClipLength, String> {
    lengths
        .get(&annotation.clip)
        .copied()
        .ok_or_else(|| format!("no clip is called {}", annotation.clip))
}

/// Start and stop as frames, if both lie on frames.
fn frames(annotation: &Annotation, lengths: &ClipLengths) -> Option<(u64, u64)> {
    let rate_hz = lengths.get(&annotation.clip)?.rate_hz;
    let (start, stop) = annotation.extent?;
    let frame = |secs: f64| {
        let frame = (secs * rate_hz).round();
        (frame / rate_hz == secs).then_some(frame as u64)
    };
    Some((frame(start)?, frame(stop)?))
}

fn text(bytes: &[u8]) -> Result<&str, ParseError> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    std::str::from_utf8(bytes).map_err(|error| {
        ParseError::new(
            Place::Byte(error.valid_up_to() as u64),
            "text in UTF-8",
            "another byte",
        )
    })
}

/// What a cell of the column `state` says. Nothing is no judgement: what was judged before stays so.
fn state(cell: &str, line: u64) -> Result<SampleState, ParseError> {
    let name = cell.trim().to_ascii_lowercase();
    if name.is_empty() {
        return Ok(SampleState::Proposed);
    }
    SampleState::from_name(&name).ok_or_else(|| {
        ParseError::new(
            Place::Line(line),
            "state `accepted`, `rejected` or `proposed`",
            format!("`{cell}`"),
        )
    })
}

/// A time that can be one.
fn checked(start: f64, stop: f64) -> Result<(f64, f64), String> {
    if start.is_finite() && stop.is_finite() && start >= 0.0 && stop > start {
        Ok((start, stop))
    } else {
        Err(format!("{start} to {stop} s"))
    }
}

/// A position of `serde_json` in a file.
fn json_error(error: &serde_json::Error, expected: &str) -> ParseError {
    ParseError::new(
        Place::Column(error.line() as u64, error.column() as u64),
        expected,
        error.to_string(),
    )
}

/// The length of a clip, whose file ending may stand behind its name.
fn length_of(clip: &str, lengths: &ClipLengths) -> Option<ClipLength> {
    let stem = || {
        clip.rsplit_once('.')
            .and_then(|(stem, _)| lengths.get(stem))
    };
    lengths.get(clip).or_else(stem).copied()
}
