//! Samples as values.

use crate::ClipId;

/// A sample's number in its database.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize, serde::Deserialize,
)]
pub struct SampleId(pub i64);

/// A sample as it is kept.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct DbSample {
    /// Its number.
    pub id: SampleId,
    /// Its clip.
    #[serde(rename = "clip_id")]
    pub clip: ClipId,
    /// Its clip's name.
    #[serde(rename = "clip")]
    pub clip_name: String,
    /// Who is seen in the clip.
    pub subject: Option<String>,
    /// What it shows.
    pub class: String,
    /// Where it starts, seconds from the clip's beginning.
    pub start_secs: f64,
    /// Where it stops.
    pub stop_secs: f64,
    /// True if the clip as a whole was labelled, still ends and all.
    pub whole_clip: bool,
    /// What is thought of it.
    pub state: SampleState,
    /// How sure a program was of it.
    pub score: Option<f64>,
    /// Who said so.
    pub set_by: String,
    /// When, seconds since 1970.
    pub set_secs: i64,
    /// Frames a second of its clip.
    pub rate_hz: f64,
}

impl DbSample {
    /// Its frames in the clip's file, rounded to whole ones.
    pub fn frames(&self) -> std::ops::Range<usize> {
        let frame = |secs: f64| (secs * self.rate_hz).round().max(0.0) as usize;
        frame(self.start_secs)..frame(self.stop_secs)
    }
}

/// A sample to add.
#[derive(Debug, Clone, PartialEq)]
pub struct NewSample {
    /// Its clip.
    pub clip: ClipId,
    /// What it shows.
    pub class: String,
    /// Where it starts, seconds.
    pub start_secs: f64,
    /// Where it stops.
    pub stop_secs: f64,
    /// True if the clip as a whole is meant.
    pub whole_clip: bool,
    /// What is thought of it.
    pub state: SampleState,
    /// How sure a program is of it.
    pub score: Option<f64>,
}

/// What became of samples that were added.
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
}

/// Which samples; all conditions must hold.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SampleFilter {
    /// In this clip.
    pub clip: Option<ClipId>,
    /// Of this class.
    pub class: Option<String>,
    /// In this state.
    pub state: Option<SampleState>,
}

/// Who says what `morec group` proposes: that stretches are alike, under a name of its own making.
pub const GROUPED_BY: &str = "group";

/// What is thought of a sample.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize, serde::Deserialize,
)]
#[serde(rename_all = "lowercase")]
pub enum SampleState {
    /// It shows its class.
    Accepted,
    /// It may show its class; nobody has looked yet.
    Proposed,
    /// It does not show its class.
    Rejected,
}

impl SampleState {
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
        [Self::Accepted, Self::Proposed, Self::Rejected]
            .into_iter()
            .find(|s| s.name() == name)
    }
}
