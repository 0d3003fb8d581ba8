//! Samples as values: their clip, class, extent, state and author.

use crate::ClipId;
use morec::TimeSpan;

/// A sample's number in its database.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize, serde::Deserialize,
)]
pub struct SampleId(pub i64);

/// Number of proposals that were judged, and of those that are left.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[allow(missing_docs)] // The names say it.
pub struct JudgedCounts {
    pub accepted: usize,
    pub rejected: usize,
    pub left: usize,
}

/// A sample as it is kept.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct DbSample {
    /// Number of the sample.
    pub id: SampleId,
    /// Number of the clip.
    #[serde(rename = "clip_id")]
    pub clip: ClipId,
    /// Its clip's name.
    #[serde(rename = "clip")]
    pub clip_name: String,
    /// Person in the clip.
    pub subject: Option<String>,
    /// Name of the class.
    pub class: String,
    /// Start, seconds from the beginning of the clip.
    pub start_secs: f64,
    /// Stop, seconds.
    pub stop_secs: f64,
    /// True if the clip as a whole was labelled, still ends and all.
    pub whole_clip: bool,
    /// Accepted, proposed or rejected.
    pub state: SampleState,
    /// Confidence of the program that proposed it.
    pub score: Option<f64>,
    /// Who labelled it so, by name; empty if nobody is named.
    pub annotators: Vec<String>,
    /// Author of the last change.
    pub set_by: String,
    /// Time of the change, seconds since 1970.
    pub set_secs: i64,
    /// Frames a second of its clip.
    pub rate_hz: f64,
}

impl DbSample {
    /// Its time, seconds from the clip's beginning.
    pub fn span(&self) -> TimeSpan {
        TimeSpan::new(self.start_secs, self.stop_secs)
    }

    /// Its frames in the clip's file, rounded to whole ones.
    pub fn frames(&self) -> std::ops::Range<usize> {
        self.span().frames(self.rate_hz)
    }
}

/// A sample to add.
#[derive(Debug, Clone, PartialEq)]
pub struct NewSample {
    /// Number of the clip.
    pub clip: ClipId,
    /// Name of the class.
    pub class: String,
    /// Start, seconds.
    pub start_secs: f64,
    /// Stop, seconds.
    pub stop_secs: f64,
    /// True if the clip as a whole is meant.
    pub whole_clip: bool,
    /// Accepted, proposed or rejected.
    pub state: SampleState,
    /// Confidence of the program that proposes it.
    pub score: Option<f64>,
}

impl NewSample {
    /// An accepted sample of part of a clip, without a score.
    pub fn accepted(clip: ClipId, class: &str, span: TimeSpan) -> Self {
        Self {
            clip,
            class: class.to_owned(),
            start_secs: span.start_secs,
            stop_secs: span.stop_secs,
            whole_clip: false,
            state: SampleState::Accepted,
            score: None,
        }
    }
}

impl From<&DbSample> for NewSample {
    fn from(sample: &DbSample) -> Self {
        Self {
            clip: sample.clip,
            class: sample.class.clone(),
            start_secs: sample.start_secs,
            stop_secs: sample.stop_secs,
            whole_clip: sample.whole_clip,
            state: sample.state,
            score: sample.score,
        }
    }
}

/// Counts of added samples, by outcome.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
pub struct Added {
    /// They are new.
    pub added: usize,
    /// They were there and are judged anew.
    pub changed: usize,
    /// They were there just so; or a proposal of what had been judged.
    pub unchanged: usize,
    /// Samples that start or stop elsewhere now.
    pub moved: usize,
    /// Samples that have another class now.
    pub renamed: usize,
    /// Samples that were removed, as no label says them.
    pub gone: usize,
    /// Proposals of other classes for the same stretch that are rejected now.
    pub rejected: usize,
    /// Proposals of groups for the same stretch that are there no more.
    pub withdrawn: usize,
    /// Clips of which it is known now who is in them.
    pub people: usize,
    /// Labels of an annotator who had not said the same before.
    pub annotated: usize,
}

/// Conditions on samples; all must hold.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SampleFilter {
    /// Samples in this clip only.
    pub clip: Option<ClipId>,
    /// Samples of the class with this name only.
    pub class: Option<String>,
    /// Samples in this state only.
    pub state: Option<SampleState>,
    /// Samples by this annotator only.
    pub annotator: Option<String>,
}

/// Author of the proposals of `morec group`, which say that stretches are alike, under a generated name.
pub const GROUPED_BY: &str = "group";

/// State of a sample.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize, serde::Deserialize,
)]
#[serde(rename_all = "lowercase")]
pub enum SampleState {
    /// It shows its class.
    Accepted,
    /// Proposed by a program and not judged yet.
    Proposed,
    /// It does not show its class.
    Rejected,
}

impl SampleState {
    /// All of them.
    pub const ALL: [SampleState; 3] = [Self::Accepted, Self::Proposed, Self::Rejected];

    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            SampleState::Accepted => "accepted",
            SampleState::Proposed => "proposed",
            SampleState::Rejected => "rejected",
        }
    }

    /// The state of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|s| s.name() == name)
    }
}
