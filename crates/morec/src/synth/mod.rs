//! Synthetic people performing scripted motions: a stand-in for a motion-capture studio.
//!
//! For the demo, the documentation, tests and benchmarks, and as background: [`everyday`] motion from which a
//! first index learns motion of no class. Nothing here imitates a particular recording, and no figure
//! measured on it says anything about accuracy on real people.
//!
//! How it is made, from the outside in: a [`Script`] or [`database`] lets an actor perform named motions; a
//! motion schedules smooth movements of hands, feet, hips, trunk and head on a timeline; for each frame, inverse
//! kinematics turns these into joint rotations; sway and sensor noise are added on the way. All arithmetic is
//! fixed by IEEE 754 (no platform sine), so a seed gives the same clip everywhere, to the bit.

mod actor;
mod body;
mod database;
mod everyday;
mod film;
mod gait;
mod gestures;
mod idle_gestures;
mod limb;
mod living_room;
mod motion;
mod person;
mod script;
mod smooth;
#[cfg(test)]
mod tests;
mod timeline;
mod unknown;

pub use crate::rng::Rng;
pub use database::{DatabaseSpec, database};
pub use everyday::{everyday, everyday_gestures};
pub use living_room::{LivingRoom, living_room};
pub use motion::{MotionKind, SyntheticMotion, all as motions, of_kind as motions_of};
pub use person::Person;
pub use script::{Script, UnknownMotion};
pub use timeline::LimbSide;

use crate::clip::Clip;
use crate::labels::{Mark, Sample};

/// A clip with what was performed in it.
#[derive(Debug, Clone, PartialEq)]
pub struct SyntheticTake {
    /// The motion, metres and Y up.
    pub clip: Clip,
    /// Performed motions, each from leaving rest to its return, in order, without overlap.
    pub labels: Vec<Mark<&'static str>>,
    /// Name of the person.
    pub person: String,
}

impl SyntheticTake {
    /// Its labels as samples to train from, of the person who performs.
    pub fn samples(&self) -> impl Iterator<Item = Sample> {
        self.labels.iter().map(|label| Sample {
            clip: self.clip.name.clone(),
            class: label.class.to_owned(),
            span: label.span,
            whole_clip: false,
            person: Some(self.person.clone()),
            line: 0,
        })
    }
}
