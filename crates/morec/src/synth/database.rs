//! Streams of several people performing gestures, with unknown motion and rest in between.

use super::SyntheticTake;
use super::actor::Actor;
use super::film::film;
use super::motion::{self, MotionKind, SyntheticMotion};
use super::person::Person;
use super::timeline::LimbSide;
use crate::labels::Mark;
use crate::rng::Rng;

/// Contents of a synthetic [`database`].
#[derive(Debug, Clone, PartialEq)]
pub struct DatabaseSpec {
    /// Number of people.
    pub people: usize,
    /// Streams of each person.
    pub streams: usize,
    /// Number of times that each class occurs in a stream.
    pub repetitions: usize,
    /// The classes, names of [`MotionKind::Gesture`] motions.
    pub classes: Vec<&'static str>,
    /// Unknown motions in a stream, for each gesture in it.
    pub unknown_share: f64,
    /// Left-handed people mirror the one-handed gestures; otherwise everybody uses the right hand.
    pub left_handed: bool,
    /// Frames a second.
    pub rate_hz: f64,
}

impl Default for DatabaseSpec {
    /// Five people, one stream each, every class three times: some 10 minutes at 60 Hz.
    fn default() -> Self {
        Self {
            people: 5,
            streams: 1,
            repetitions: 3,
            classes: motion::of_kind(MotionKind::Gesture)
                .map(|m| m.name())
                .collect(),
            unknown_share: 0.6,
            left_handed: false,
            rate_hz: 60.0,
        }
    }
}

/// One take for each stream of each person, named `<person>_<stream from 1>`. Classes that are not the name of a
/// gesture are passed over. The same seed and spec give the same takes on every platform.
pub fn database(seed: u64, spec: &DatabaseSpec) -> Vec<SyntheticTake> {
    let mut takes = Vec::with_capacity(spec.people * spec.streams);
    for number in 0..spec.people {
        let mut person = Person::draw(seed, number);
        if !spec.left_handed {
            person.hand = LimbSide::Right;
        }
        for stream in 0..spec.streams {
            let rng = Rng::for_part(seed, 0x5712 + (number * 1000 + stream) as u64);
            let name = format!("{}_{}", person.name, stream + 1);
            takes.push(take(&person, rng, &name, spec));
        }
    }
    takes
}

fn take(person: &Person, mut rng: Rng, name: &str, spec: &DatabaseSpec) -> SyntheticTake {
    let plan = plan(&mut rng, spec);
    let mut actor = Actor::new(person, rng);
    actor.wait(1.0);
    let mut labels = Vec::new();
    for motion in plan {
        let span = motion.perform(&mut actor);
        if motion.kind() == MotionKind::Gesture {
            labels.push(Mark::new(motion.name(), span));
        }
        let pause = actor.rng.range(0.5, 1.6);
        actor.wait(pause);
    }
    actor.wait(0.5);
    SyntheticTake {
        clip: film(actor, name, spec.rate_hz),
        labels,
        person: person.name.clone(),
    }
}

/// The gestures and the unknown motions of one stream in random order.
fn plan(rng: &mut Rng, spec: &DatabaseSpec) -> Vec<SyntheticMotion> {
    let gestures: Vec<SyntheticMotion> = spec
        .classes
        .iter()
        .filter_map(|name| SyntheticMotion::named(name).filter(|m| m.kind() == MotionKind::Gesture))
        .collect();
    let unknown: Vec<SyntheticMotion> = motion::of_kind(MotionKind::Unknown).collect();
    let mut plan: Vec<SyntheticMotion> = Vec::new();
    for _ in 0..spec.repetitions {
        plan.extend(&gestures);
    }
    let extra = (plan.len() as f64 * spec.unknown_share).round() as usize;
    plan.extend((0..extra).map(|_| unknown[rng.below(unknown.len())]));
    rng.shuffle(&mut plan);
    plan
}
