//! Annotations, the common form of all label formats, and helpers that their readers share. Readers must not access the database;
//! [`resolve`](super::resolve) turns annotations into samples.

use std::collections::BTreeMap;

use morec::formats::{ParseError, Place, Warning};
use morec::labels::{ClipLength, names_of_clip};

use crate::labels::{DbSample, SampleState};

/// End of the names of BIDS files.
pub const BIDS_SUFFIX: &str = "_events";

/// A labelled stretch as files tell of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Annotation {
    /// The clip's name.
    pub clip: String,
    /// Name of the class.
    pub class: String,
    /// Start and stop in seconds; `None` for the whole clip.
    pub extent: Option<(f64, f64)>,
    /// Who performs, if the file says.
    pub person: Option<String>,
    /// Confidence of the program that proposed it.
    pub score: Option<f64>,
    /// Accepted, proposed or rejected.
    pub state: SampleState,
    /// Who labelled it, if the file says.
    pub annotator: Option<String>,
}

impl Annotation {
    /// An accepted stretch of a clip without a person.
    pub(super) fn accepted(clip: &str, class: &str, extent: (f64, f64)) -> Self {
        Self {
            clip: clip.to_owned(),
            class: class.to_owned(),
            extent: Some(extent),
            person: None,
            score: None,
            state: SampleState::Accepted,
            annotator: None,
        }
    }

    /// A sample as a form says it: once for each annotator, where the form has annotators.
    pub fn of_sample(sample: DbSample, form: LabelFormat) -> Vec<Self> {
        let annotators = match form.has_annotators() {
            true => sample.annotators.clone(),
            false => Vec::new(),
        };
        let plain = Self::from(sample);
        if annotators.is_empty() {
            return vec![plain];
        }
        let of = |annotator| Self {
            annotator: Some(annotator),
            ..plain.clone()
        };
        annotators.into_iter().map(of).collect()
    }
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
            annotator: None,
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
    Boris,
    Bids,
}

impl LabelFormat {
    /// All of them.
    pub const ALL: [LabelFormat; 9] = [
        LabelFormat::Tsv,
        LabelFormat::Csv,
        LabelFormat::Json,
        LabelFormat::Eaf,
        LabelFormat::Audacity,
        LabelFormat::Babel,
        LabelFormat::LabelStudio,
        LabelFormat::Boris,
        LabelFormat::Bids,
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
            LabelFormat::Boris => "boris",
            LabelFormat::Bids => "bids",
        }
    }

    /// The ending of its files, by which [`of_file`](Self::of_file) knows it.
    pub fn ending(self) -> &'static str {
        match self {
            LabelFormat::Tsv | LabelFormat::Bids => "tsv",
            LabelFormat::Csv => "csv",
            LabelFormat::Json | LabelFormat::Babel | LabelFormat::LabelStudio => "json",
            LabelFormat::Eaf => "eaf",
            LabelFormat::Audacity => "txt",
            LabelFormat::Boris => "boris",
        }
    }

    /// The name of a file of one clip, whose name as a file's is given.
    pub fn file_of_clip(self, name: &str) -> String {
        let suffix = match self {
            LabelFormat::Bids => BIDS_SUFFIX,
            _ => "",
        };
        format!("{name}{suffix}.{}", self.ending())
    }

    /// True if a label of this state is read again in the same state.
    pub fn keeps(self, state: SampleState) -> bool {
        match self {
            LabelFormat::Audacity | LabelFormat::Boris | LabelFormat::Bids => {
                state == SampleState::Accepted
            }
            _ => true,
        }
    }

    /// True if a label can have an annotator.
    pub fn has_annotators(self) -> bool {
        matches!(self, Self::Tsv | Self::Csv | Self::Json | Self::Bids)
    }

    /// True if a file of this form holds labels of one clip only.
    pub fn is_of_one_clip(self) -> bool {
        matches!(self, Self::Eaf | Self::Audacity | Self::Bids)
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

pub(crate) fn text(bytes: &[u8]) -> Result<&str, ParseError> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    std::str::from_utf8(bytes).map_err(|error| {
        ParseError::new(
            Place::Byte(error.valid_up_to() as u64),
            "text in UTF-8",
            "another byte",
        )
    })
}

/// Text in UTF-16 with a mark of its order; `None` of other text.
pub(super) fn of_utf16(bytes: &[u8]) -> Option<String> {
    let (mark, rest) = bytes.split_at_checked(2)?;
    let word = match mark {
        [0xFF, 0xFE] => |pair: &[u8]| u16::from_le_bytes([pair[0], pair[1]]),
        [0xFE, 0xFF] => |pair: &[u8]| u16::from_be_bytes([pair[0], pair[1]]),
        _ => return None,
    };
    let words: Vec<u16> = rest.chunks_exact(2).map(word).collect();
    Some(String::from_utf16_lossy(&words))
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

/// What is said of a file's labels beside the file.
#[derive(Debug, Clone, Copy, Default)]
pub struct LabelContext<'a> {
    /// The clip that a file of one clip refers to.
    pub clip: Option<&'a str>,
    /// Lengths of the clips: frames need their rates.
    pub lengths: Option<&'a ClipLengths>,
    /// Frames a second of what was labelled, where it is not the clip: a video.
    pub label_rate_hz: Option<f64>,
    /// Tiers that are read, of forms that have some; all if empty.
    pub tiers: &'a [String],
    /// The number of the first frame of clips whose frames labels do not count from 0.
    pub first_frames: Option<&'a BTreeMap<String, usize>>,
}

impl LabelContext<'_> {
    /// Frames a second in which labels of this clip count.
    pub(super) fn rate_of(&self, clip: &str) -> Option<f64> {
        let of_clip = || Some(length_of(clip, self.lengths?)?.rate_hz);
        self.label_rate_hz.or_else(of_clip)
    }

    /// Seconds at which frame 0 of labels lies before the clip's beginning.
    pub(super) fn before(&self, clip: &str, rate_hz: f64) -> f64 {
        let first = names_of_clip(clip).find_map(|name| self.first_frames?.get(name));
        first.map_or(0.0, |first| *first as f64 / rate_hz)
    }

    pub(super) fn knows(&self, clip: &str) -> bool {
        self.lengths
            .is_some_and(|lengths| length_of(clip, lengths).is_some())
    }
}

impl ReadLabels {
    /// The extent if it has a length. A moment is left out with a warning, so that the rest of the file is read.
    ///
    /// # Errors
    /// Times that cannot be any.
    pub(super) fn stretch(
        &mut self,
        at: Place,
        class: &str,
        (start, stop): (f64, f64),
    ) -> Result<Option<(f64, f64)>, String> {
        if start == stop && start >= 0.0 && start.is_finite() {
            let text =
                format!("`{class}` is a point in time, at {start} s, without a duration; left out");
            self.warnings.push(Warning::new(at, text));
            return Ok(None);
        }
        checked(start, stop).map(Some)
    }
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
    names_of_clip(clip)
        .find_map(|name| lengths.get(name))
        .copied()
}
