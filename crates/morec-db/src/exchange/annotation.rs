//! Annotations, which all forms of labels are read as, and helpers that their readers share.

use std::collections::BTreeMap;

use morec::formats::{ParseError, Place, Warning};
use morec::labels::ClipLength;

use crate::labels::{DbSample, SampleState};

/// A labelled stretch as files tell of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Annotation {
    /// The clip's name.
    pub clip: String,
    /// Its class.
    pub class: String,
    /// Start and stop in seconds; `None` for the whole clip.
    pub extent: Option<(f64, f64)>,
    /// Person in it.
    pub person: Option<String>,
    /// Confidence of the program that proposed it.
    pub score: Option<f64>,
    /// Its state.
    pub state: SampleState,
}

impl From<DbSample> for Annotation {
    fn from(sample: DbSample) -> Self {
        Self {
            extent: (!sample.whole_clip).then_some((sample.start_secs, sample.stop_secs)),
            clip: sample.clip_name,
            class: sample.class,
            person: sample.subject,
            score: sample.score,
            state: sample.state,
        }
    }
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

    /// The ending of its files, by which [`of_file`](Self::of_file) knows it.
    pub fn ending(self) -> &'static str {
        match self {
            LabelFormat::Tsv => "tsv",
            LabelFormat::Csv => "csv",
            LabelFormat::Json | LabelFormat::Babel | LabelFormat::LabelStudio => "json",
            LabelFormat::Eaf => "eaf",
            LabelFormat::Audacity => "txt",
        }
    }

    /// True if a label of this state is read again in the same state.
    pub fn keeps(self, state: SampleState) -> bool {
        match self {
            LabelFormat::Audacity => state == SampleState::Accepted,
            _ => true,
        }
    }

    /// True if a file of this form tells of one clip only.
    pub fn is_of_one_clip(self) -> bool {
        matches!(self, LabelFormat::Eaf | LabelFormat::Audacity)
    }
}

/// Annotations and what was doubtful about them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ReadLabels {
    /// In file order.
    pub annotations: Vec<Annotation>,
    /// Omissions and doubts.
    pub warnings: Vec<Warning>,
    /// Clips that are not known and whose frames can therefore not be given in seconds, with how many labels each had.
    pub absent: BTreeMap<String, usize>,
}

/// Lengths of the clips by name: frames need a rate.
pub type ClipLengths = BTreeMap<String, ClipLength>;

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
pub(super) fn secs(annotation: &Annotation, lengths: &ClipLengths) -> Result<(f64, f64), String> {
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
pub(super) fn frames(annotation: &Annotation, lengths: &ClipLengths) -> Option<(u64, u64)> {
    let rate_hz = lengths.get(&annotation.clip)?.rate_hz;
    let (start, stop) = annotation.extent?;
    let frame = |secs: f64| {
        let frame = (secs * rate_hz).round();
        (frame / rate_hz == secs).then_some(frame as u64)
    };
    Some((frame(start)?, frame(stop)?))
}

pub(super) fn text(bytes: &[u8]) -> Result<&str, ParseError> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    std::str::from_utf8(bytes).map_err(|error| {
        ParseError::new(
            Place::Byte(error.valid_up_to() as u64),
            "text in UTF-8",
            "another byte",
        )
    })
}

/// State in a cell of the column `state`. An empty cell is a proposal, so that earlier judgements stay.
pub(super) fn state(cell: &str, line: u64) -> Result<SampleState, ParseError> {
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
pub(super) fn checked(start: f64, stop: f64) -> Result<(f64, f64), String> {
    if start.is_finite() && stop.is_finite() && start >= 0.0 && stop > start {
        Ok((start, stop))
    } else {
        Err(format!("{start} to {stop} s"))
    }
}

/// A position of `serde_json` in a file.
pub(super) fn json_error(error: &serde_json::Error, expected: &str) -> ParseError {
    ParseError::new(
        Place::Column(error.line() as u64, error.column() as u64),
        expected,
        error.to_string(),
    )
}

/// The length of a clip, whose file ending may stand behind its name.
pub(super) fn length_of(clip: &str, lengths: &ClipLengths) -> Option<ClipLength> {
    let stem = || {
        clip.rsplit_once('.')
            .and_then(|(stem, _)| lengths.get(stem))
    };
    lengths.get(clip).or_else(stem).copied()
}
