//! One performer's stream with all its options: points or posed skeletons in, events out.

use std::sync::Arc;

use super::{
    Event, EventOptions, Frame, OptionError, Performer, PerformerId, RecognizerCache, Rig,
    StartError, StreamOptions,
};
use crate::diagnosis::{Diagnoser, Diagnosis};
use crate::features::{BoneSet, KeyPose};
use crate::index::MotionIndex;
use crate::math::{Quat, Vec3};
use crate::roles::Role;
use crate::roles::points::{PointJoint, places_of};
use crate::{ParseError, SignedAxis};

/// A recogniser of one performer whose points or skeleton are known from the beginning: the stream of every door of morec.
///
/// ```no_run
/// use std::sync::Arc;
///
/// use morec::MotionIndex;
/// use morec::live::{PerformerStream, Phase, StreamOptions, wall_now_secs};
///
/// # fn next_frame() -> Option<(f64, Vec<f64>)> { None }
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let index = Arc::new(MotionIndex::load("signs.index")?);
/// let points = ["hips", "left_arm", "left_forearm", "left_hand", "right_arm", "right_forearm", "right_hand"];
/// let options = StreamOptions { tentative: true, ..StreamOptions::default() };
/// let mut stream = PerformerStream::of_points(&index, &points, &options)?;
/// while let Some((secs, positions)) = next_frame() {
///     stream.values().copy_from_slice(&positions);
///     for event in stream.push_values(secs, wall_now_secs()) {
///         println!("{} {}", event.phase.name(), index.model.class_name(event.class));
///     }
/// }
/// let last = stream.finish().iter().filter(|event| event.phase == Phase::End);
/// println!("{} more; {:?}", last.count(), stream.findings());
/// # Ok(())
/// # }
/// ```
///
/// After the first frame, pushing allocates no memory, except if announced body parts are missing or appear late
/// ([`ShownBones`](super::ShownBones)).
#[derive(Debug)]
pub struct PerformerStream {
    index: Arc<MotionIndex>,
    recognizers: Arc<RecognizerCache>,
    options: EventOptions,
    rig: Arc<Rig>,
    /// Bones that are looked at before the first frame shows some.
    announced: Option<BoneSet>,
    performer: Performer,
    places: Vec<(Role, PointJoint)>,
    /// x, y, z of each point.
    values: Vec<f64>,
    /// Takes coordinates of the stream to Y up; `None` if they are.
    turn: Option<Quat>,
    key: KeyPose,
    turned: Frame,
}

/// Reasons why a stream cannot be recognised with an index.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StreamError {
    /// An invalid option.
    #[error(transparent)]
    Option(#[from] OptionError),
    /// Roles that do not fit the points or the skeleton.
    #[error("roles: {0}")]
    Roles(ParseError),
    /// Points that identify no body part.
    #[error(
        "points: neither a known set of points nor names of body parts; assign roles to points with `roles`, as in \
         {{\"left_hand\": \"LWrist\", \"hips\": \"LHip+RHip\"}}"
    )]
    NoParts,
    /// The index needs joint rotations, which points do not have.
    #[error(
        "an index of the method {method} needs joint rotations, which a stream of positions does not have"
    )]
    NoRotations {
        /// The method of the index.
        method: &'static str,
    },
    /// The stream has none of the index's bones.
    #[error(transparent)]
    Start(#[from] StartError),
}

impl PerformerStream {
    /// A stream of points with these names: a published set (MediaPipe, COCO, Kinect, marker sets), usual joint names, or names
    /// of roles.
    /// Roles in the options override those inferred from the names.
    ///
    /// # Errors
    /// The points identify no body part, none of the index's bones is among them, the index needs rotations, or an option is
    /// invalid.
    pub fn of_points(
        index: &Arc<MotionIndex>,
        names: &[&str],
        options: &StreamOptions,
    ) -> Result<Self, StreamError> {
        Self::of_places(index, names, places_of(names), options)
    }

    /// A stream of points with these names, from which `places` computes the positions of body parts.
    ///
    /// # Errors
    /// As [`of_points`](Self::of_points).
    pub fn of_places(
        index: &Arc<MotionIndex>,
        names: &[&str],
        mut places: Vec<(Role, PointJoint)>,
        options: &StreamOptions,
    ) -> Result<Self, StreamError> {
        if index.model.needs_rotations() {
            let method = index.model.method();
            return Err(StreamError::NoRotations { method });
        }
        for (role, place) in options.roles.places(names).map_err(StreamError::Roles)? {
            places.retain(|(known, _)| *known != role);
            places.extend(place.map(|place| (role, place)));
        }
        if places.is_empty() {
            return Err(StreamError::NoParts);
        }
        let mut rig = Rig::of_roles();
        let is_played = |role: Role| places.iter().any(|(known, _)| *known == role);
        for role in Role::ALL.into_iter().filter(|role| !is_played(*role)) {
            rig.roles.set(role, None);
        }
        let announced = BoneSet::of_roles(&rig.roles);
        let mut stream = Self::new(index, rig, Some(announced), options)?;
        stream.places = places;
        stream.values = vec![f64::NAN; 3 * names.len()];
        Ok(stream)
    }

    /// A stream of a posed skeleton; the options' roles override the rig's, [`MotionIndex::complete_roles`] finds more. With `announced`, bones that do not fit the index are an error now; else they are found at the first frame.
    ///
    /// # Errors
    /// Roles of joints that the skeleton does not have, no bone of the index among those announced, or an option that cannot be.
    pub fn of_rig(
        index: &Arc<MotionIndex>,
        mut rig: Rig,
        announced: Option<BoneSet>,
        options: &StreamOptions,
    ) -> Result<Self, StreamError> {
        let given = options.roles.apply(&rig.skeleton, &mut rig.roles);
        given.map_err(StreamError::Roles)?;
        Self::new(index, rig, announced, options)
    }

    fn new(
        index: &Arc<MotionIndex>,
        rig: Rig,
        announced: Option<BoneSet>,
        options: &StreamOptions,
    ) -> Result<Self, StreamError> {
        let recognizers = RecognizerCache::new(&options.tuned(index.model.clone())?);
        let (recognizers, events) = (Arc::new(recognizers), options.events()?);
        let mut stream = Self {
            index: index.clone(),
            performer: Performer::sharing(&recognizers, PerformerId(0), &events),
            recognizers,
            options: events,
            rig: Arc::new(rig),
            announced,
            places: Vec::new(),
            values: Vec::new(),
            turn: (options.up != SignedAxis::Y).then(|| options.up.to_y()),
            key: KeyPose::default(),
            turned: Frame::default(),
        };
        stream.reset()?;
        Ok(stream)
    }

    /// Resets the stream to its initial state and discards all frames so far.
    ///
    /// # Errors
    /// As when the stream was created.
    pub fn reset(&mut self) -> Result<(), StartError> {
        let mut performer = Performer::sharing(&self.recognizers, PerformerId(0), &self.options);
        performer.set_rig(&self.rig);
        if let Some(bones) = self.announced {
            performer.announce(bones)?;
        }
        self.performer = performer;
        Ok(())
    }

    /// The buffer for the positions of the next frame: x, y, z of each point, NaN for a missing point. Empty for a stream of a
    /// skeleton.
    pub fn values(&mut self) -> &mut [f64] {
        &mut self.values
    }

    /// Processes the frame in [`values`](Self::values), seen at `time_secs` on the stream's clock, which arrived at `wall_secs`
    /// ([`wall_now_secs`](super::wall_now_secs)). Returns the events that it causes, usually none.
    pub fn push_values(&mut self, time_secs: f64, wall_secs: f64) -> &[Event] {
        let values = &self.values;
        for (role, place) in &self.places {
            let point = |at: usize| Vec3::from_column_slice(&values[3 * at..3 * at + 3]);
            let at = place.at(point).unwrap_or_else(|| Vec3::repeat(f64::NAN));
            self.key.set(*role, self.turn.map_or(at, |turn| turn * at));
        }
        self.performer.push_pose(time_secs, wall_secs, &self.key)
    }

    /// Processes a pose of the skeleton and returns the events that it causes, usually none.
    pub fn push(&mut self, frame: &Frame) -> &[Event] {
        let Some(turn) = self.turn else {
            return self.performer.push(frame);
        };
        let turned = &mut self.turned;
        (turned.time_secs, turned.wall_secs) = (frame.time_secs, frame.wall_secs);
        let (to, from) = (&mut turned.pose, &frame.pose);
        to.positions.clear();
        to.positions.extend(from.positions.iter().map(|p| turn * p));
        to.rotations.clear();
        to.rotations.extend(from.rotations.iter().map(|q| turn * q));
        self.performer.push(&self.turned)
    }

    /// Ends the stream and returns its last events. The next frame starts a new stream.
    pub fn finish(&mut self) -> &[Event] {
        self.performer.finish()
    }

    /// The index used for recognition.
    pub fn index(&self) -> &Arc<MotionIndex> {
        &self.index
    }

    /// The skeleton of the stream; for a stream of points, a flat skeleton of its roles.
    pub fn rig(&self) -> &Rig {
        &self.rig
    }

    /// Shortest time from the end of a motion to its report, seconds. `None` for a stream of a skeleton before its first
    /// frame, unless bones were announced.
    pub fn latency_secs(&self) -> Option<f64> {
        self.performer.latency_secs()
    }

    /// Number of motions not reported because of [`StreamOptions::refractory_secs`].
    pub fn suppressed(&self) -> u64 {
        self.performer.suppressed()
    }

    /// Measures and findings of the stream in the last seconds.
    pub fn diagnosis(&self) -> Diagnosis {
        let known = self.performer.diagnosis();
        known.unwrap_or_else(|| Diagnoser::live().diagnosis())
    }

    /// Problems of the stream in the last seconds, one sentence each with its severity and remedy, the most severe first:
    /// [`MotionIndex::findings`].
    pub fn findings(&self) -> Vec<String> {
        self.index.findings(&self.diagnosis())
    }
}
