//! One performer's stream of points: arrays of positions in, events out.

use std::sync::Arc;

use morec::features::{BoneSet, KeyPose};
use morec::import::SignedAxis;
use morec::index::MotionIndex;
use morec::live::{Event, EventOptions, Frame, Performer, PerformerId, Rig};
use morec::math::{Quat, Vec3};
use morec::roles::Role;
use morec::roles::points::{PointJoint, places_of};
use serde::Deserialize;

/// Events that one frame settles at most, with room to spare.
const ROOM: usize = 96;

/// Options of a stream.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PointOptions {
    /// The axis that points up: `y`, `-y` (landmarks of pictures), `z`.
    pub up: String,
    /// Report what seems to be under way, too.
    pub early: bool,
    /// Make each repetition of an activity an event of its own, of the phase `repetition`.
    pub each_repetition: bool,
    /// A motion of the same class that ends less than this after the one before it is not reported, seconds.
    pub refractory_secs: f64,
}

impl Default for PointOptions {
    fn default() -> Self {
        Self {
            up: "y".to_owned(),
            early: true,
            each_repetition: false,
            refractory_secs: 0.0,
        }
    }
}

/// A recogniser of the poses that named points make. After the first frame, [`push`](Self::push) allocates nothing, but where
/// parts that were announced do not come, or come late ([`ShownBones`](morec::live::ShownBones)).
#[derive(Debug)]
pub struct PointStream {
    performer: Performer,
    latency_secs: f64,
    places: Vec<(Role, PointJoint)>,
    /// Takes coordinates of the stream to Y up; `None` if they are.
    turn: Option<Quat>,
    values: Vec<f64>,
    key: KeyPose,
    frame: Frame,
    events: Vec<Event>,
}

impl PointStream {
    /// A stream of points of these names: a published set (MediaPipe, COCO, Kinect, marker sets), usual joint names, or
    /// names of roles.
    ///
    /// # Errors
    /// A sentence: no part of a body among the points, no bone of the index among them, an index that needs rotations, or an option
    /// out of bounds.
    pub fn new(
        index: &MotionIndex,
        points: &[&str],
        options: &PointOptions,
    ) -> Result<Self, String> {
        let up = options.up.parse::<SignedAxis>();
        let up = up.map_err(|error| format!("up: {error}"))?;
        if !(0.0..=60.0).contains(&options.refractory_secs) {
            let found = options.refractory_secs;
            return Err(format!("refractory_secs: expected 0 to 60, found {found}"));
        }
        if index.model.needs_rotations() {
            return Err(format!(
                "an index of the method {} looks at joint rotations, which a stream of positions does not have",
                index.model.method()
            ));
        }
        let places = places_of(points);
        if places.is_empty() {
            return Err(
                "points: no known set of points, and no names of parts of the body".to_owned(),
            );
        }
        let mut rig = Rig::of_roles();
        for role in Role::ALL {
            if !places.iter().any(|(known, _)| *known == role) {
                rig.roles.set(role, None);
            }
        }
        let announced = BoneSet::of_roles(&rig.roles);
        let events = EventOptions {
            early: options.early,
            each_repetition: options.each_repetition,
            refractory_secs: options.refractory_secs,
        };
        let mut performer = Performer::new(&index.model, PerformerId(0), &events);
        performer.set_rig(&Arc::new(rig), &mut |_| {});
        let made = performer.announce(announced);
        made.map_err(|error| error.to_string())?;
        Ok(Self {
            latency_secs: performer.latency_secs().unwrap_or_default(),
            performer,
            places,
            turn: (up != SignedAxis::Y).then(|| up.to_y()),
            values: vec![f64::NAN; 3 * points.len()],
            key: KeyPose::default(),
            frame: Frame::default(),
            events: Vec::with_capacity(ROOM),
        })
    }

    /// Where the positions of the next frame go: x, y, z of each point, NaN where it is not seen.
    pub fn values(&mut self) -> &mut [f64] {
        &mut self.values
    }

    /// Takes the frame that [`values`](Self::values) hold, seen at `time_secs` and arrived at `wall_secs`; the events that it
    /// settled.
    pub fn push(&mut self, time_secs: f64, wall_secs: f64) -> &[Event] {
        let values = &self.values;
        for (role, place) in &self.places {
            let point = |at: usize| Vec3::from_column_slice(&values[3 * at..3 * at + 3]);
            let at = place.at(point).unwrap_or_else(|| Vec3::repeat(f64::NAN));
            self.key.set(*role, self.turn.map_or(at, |turn| turn * at));
        }
        self.frame.time_secs = time_secs;
        self.frame.wall_secs = wall_secs;
        self.frame.set_key_pose(&self.key);
        self.events.clear();
        let events = &mut self.events;
        self.performer
            .push(&self.frame, &mut |event| events.push(event));
        &self.events
    }

    /// Ends the stream: the events that its last moments hold. The next frame begins a new one.
    pub fn finish(&mut self) -> &[Event] {
        self.events.clear();
        let events = &mut self.events;
        self.performer.finish(&mut |event| events.push(event));
        &self.events
    }

    /// Seconds from the end of a motion to its report at the earliest.
    pub fn latency_secs(&self) -> f64 {
        self.latency_secs
    }

    /// What is wrong with the stream of the last seconds, a sentence each that says what to do, the gravest first.
    pub fn diagnosis(&self) -> Vec<String> {
        let known = self.performer.diagnosis().map(|known| known.findings());
        let findings = known.iter().flat_map(|findings| findings.iter());
        let is_other = self.performer.shows_another();
        let problem = self.performer.problem().filter(|_| is_other);
        let problem = problem.iter().map(ToString::to_string);
        problem.chain(findings.map(ToString::to_string)).collect()
    }
}
