//! Stretches of a live stream that were marked.

use morec::TimeSpan;
use morec::live::PerformerId;
use morec_db::ClipId;
use morec_db::labels::SampleState;

use crate::jobs::teach::Meaning;
use crate::store::Snapshot;

/// Stretches that share less than this do not contradict each other, seconds.
const TOUCHING_SECS: f64 = 0.1;

/// A marked stretch, on the clock of the stream.
#[derive(Debug, Clone, PartialEq)]
pub struct LiveMark {
    pub actor: PerformerId,
    pub span: TimeSpan,
    pub meaning: Meaning,
    /// The clip it became, once it is in the database.
    pub clip: Option<ClipId>,
    /// True once a snapshot has shown that clip.
    seen: bool,
}

impl LiveMark {
    pub fn new(actor: PerformerId, span: TimeSpan, meaning: Meaning) -> Self {
        Self {
            actor,
            span,
            meaning,
            clip: None,
            seen: false,
        }
    }

    /// True if it shares more than its ends with a stretch of a performer.
    pub fn meets(&self, actor: PerformerId, stretch: TimeSpan) -> bool {
        self.actor == actor && meet(self.span, stretch)
    }

    /// Follows the database; false once the mark was taken back there.
    pub fn follow(&mut self, snapshot: &Snapshot) -> bool {
        let Some(clip) = self.clip else { return true };
        let there = match &self.meaning {
            Meaning::Background => snapshot.clip(clip).is_some_and(|c| c.is_background()),
            Meaning::Class(_) => {
                let mut samples = snapshot.samples_of(clip).iter();
                samples.any(|s| s.state == SampleState::Accepted)
            }
        };
        // What is kept may come with a later snapshot than this.
        let gone = self.seen && !there;
        self.seen |= there;
        !gone
    }
}

/// The class of an accepted label of `clip` that shares more than its ends with a stretch of it.
pub fn labelled_there(snapshot: &Snapshot, clip: ClipId, stretch: TimeSpan) -> Option<&str> {
    let mut samples = snapshot.samples_of(clip).iter();
    let met = samples.find(|s| s.state == SampleState::Accepted && meet(s.span(), stretch))?;
    Some(&met.class)
}

fn meet(a: TimeSpan, b: TimeSpan) -> bool {
    a.overlap_secs(b) > TOUCHING_SECS
}
