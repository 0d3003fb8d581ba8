//! A living room: gestures by people who otherwise stand, shift their weight, walk about and sit down.

use super::actor::Actor;
use super::actor::Perform;
use super::film::film;
use super::motion::{MotionKind, SyntheticMotion};
use super::person::Person;
use super::{SyntheticTake, everyday, unknown};
use crate::TimeSpan;
use crate::labels::Mark;
use crate::rng::Rng;

/// Motions between gestures, in turn.
const IDLE: [(&str, Perform); 6] = [
    ("stand_still", stand_still),
    ("shift_weight", unknown::shift_weight),
    ("walk", everyday::walk),
    ("stand", everyday::stand),
    ("sit_down", everyday::sit_down),
    ("turn_round", everyday::turn_round),
];

/// Seconds of idling before each gesture, at least.
const IDLE_SECS: f64 = 4.0;

/// A take before a camera at home.
#[derive(Debug, Clone, PartialEq)]
pub struct LivingRoom {
    /// The clip and its gestures.
    pub take: SyntheticTake,
    /// Motions that were performed between them.
    pub idle: Vec<Mark<&'static str>>,
}

/// Every class of `classes` (names of [`MotionKind::Gesture`] motions) `repetitions` times by person `number`, in random
/// order, with at least four seconds of idling before each. The person does not return to one pose.
/// The same arguments give the same take on every platform.
pub fn living_room(
    seed: u64,
    number: usize,
    classes: &[&str],
    repetitions: usize,
    rate_hz: f64,
) -> LivingRoom {
    let person = Person::draw(seed, number);
    let mut rng = Rng::for_part(seed, 0x1119 + number as u64);
    let gestures = classes
        .iter()
        .filter_map(|name| SyntheticMotion::named(name));
    let gestures: Vec<SyntheticMotion> = gestures
        .filter(|m| m.kind() == MotionKind::Gesture)
        .collect();
    let mut plan: Vec<SyntheticMotion> = (0..repetitions).flat_map(|_| gestures.clone()).collect();
    rng.shuffle(&mut plan);
    let first_idle = rng.below(IDLE.len());
    let mut actor = Actor::new(&person, rng);
    let (mut labels, mut idle) = (Vec::new(), Vec::new());
    let mut next_idle = (0..IDLE.len()).cycle().skip(first_idle);
    for motion in plan {
        let until = actor.now_secs + IDLE_SECS;
        while actor.now_secs < until {
            let (class, perform) = IDLE[next_idle.next().unwrap_or(0)];
            let start_secs = actor.now_secs;
            actor.vary();
            perform(&mut actor);
            idle.push(Mark::new(class, TimeSpan::new(start_secs, actor.now_secs)));
            let pause = actor.rng.range(0.2, 0.9);
            actor.wait(pause);
        }
        let span = motion.perform(&mut actor);
        labels.push(Mark::new(motion.name(), span));
    }
    actor.wait(1.0);
    let clip = film(actor, &format!("living_room_{}", person.name), rate_hz);
    let person = person.name;
    LivingRoom {
        take: SyntheticTake {
            clip,
            labels,
            person,
        },
        idle,
    }
}

fn stand_still(a: &mut Actor) {
    let secs = a.rng.range(2.0, 5.0);
    a.wait(secs);
}
