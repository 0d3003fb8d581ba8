//! The available motions, by name.

use super::actor::{Actor, Perform};
use super::{everyday, gestures, unknown};
use crate::TimeSpan;

/// Purpose of a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MotionKind {
    /// A class of the demo.
    Gesture,
    /// Motions between gestures.
    Unknown,
    /// Motions of the everyday library.
    Everyday,
}

/// A motion that a synthetic person can perform.
#[derive(Debug, Clone, Copy)]
pub struct SyntheticMotion {
    name: &'static str,
    kind: MotionKind,
    perform: Perform,
}

const GESTURES: [(&str, Perform); 8] = [
    ("wave", gestures::wave),
    ("raise_hands", gestures::raise_hands),
    ("point_side", gestures::point_side),
    ("clap", gestures::clap),
    ("push", gestures::push),
    ("circle", gestures::circle),
    ("bow", gestures::bow),
    ("kick", gestures::kick),
];

const UNKNOWN: [(&str, Perform); 10] = [
    ("scratch_head", unknown::scratch_head),
    ("look_around", unknown::look_around),
    ("shift_weight", unknown::shift_weight),
    ("stretch", unknown::stretch),
    ("step_aside", unknown::step_aside),
    ("phone", unknown::phone),
    ("cross_arms", unknown::cross_arms),
    ("wipe", unknown::wipe),
    ("hands_on_hips", unknown::hands_on_hips),
    ("look_at_watch", unknown::look_at_watch),
];

/// All motions: gestures, unknown ones, everyday ones.
pub fn all() -> impl Iterator<Item = SyntheticMotion> {
    let everyday = everyday::CONTENTS;
    let of = |kind| {
        move |(name, perform)| SyntheticMotion {
            name,
            kind,
            perform,
        }
    };
    (GESTURES.into_iter().map(of(MotionKind::Gesture)))
        .chain(UNKNOWN.into_iter().map(of(MotionKind::Unknown)))
        .chain(everyday.into_iter().map(of(MotionKind::Everyday)))
}

/// Gestures, motions of no class, or everyday motions.
pub fn of_kind(kind: MotionKind) -> impl Iterator<Item = SyntheticMotion> {
    all().filter(move |m| m.kind == kind)
}

impl SyntheticMotion {
    /// The motion that scripts call `name`; `None` if there is none.
    pub fn named(name: &str) -> Option<SyntheticMotion> {
        all().find(|m| m.name == name)
    }

    /// Name of the motion; for a gesture, its class.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// Purpose of the motion.
    pub fn kind(&self) -> MotionKind {
        self.kind
    }

    /// Performs it in a way never seen before and returns when it can be seen: from leaving rest to return.
    ///
    /// The first and last hundredths of a reach move nothing that an annotator would see: with a minimum-jerk
    /// course, a tenth of its time covers a hundredth of its way.
    pub(super) fn perform(&self, actor: &mut Actor) -> TimeSpan {
        actor.vary();
        let start_secs = actor.now_secs;
        (self.perform)(actor);
        let unseen = 0.06f64.min(0.1 * (actor.now_secs - start_secs));
        TimeSpan::new(start_secs + unseen, actor.now_secs - unseen)
    }
}
