//! Diagnosis of a stream of poses before recognition: the body's size, whether it stands
//! upright, how noisy it is, how evenly frames come, and what is wrong, in sentences that say what to do.
//!
//! [`Diagnoser`] takes the key poses that live recognition takes, one by one and in fixed memory; [`diagnose_clip`] looks
//! at a whole clip. Both give a [`Diagnosis`]: figures, and [`Finding`]s judged by them.
//!
//! Nothing here changes what is recognised.

mod figures;
mod finding;
mod hands;
mod histogram;
mod judge;
mod noise;
mod role_set;
mod shape;
mod stillness;
mod timing;
mod words;

pub use figures::{Diagnosis, SideEvidence};
pub use finding::{Finding, Severity};
pub use judge::Findings;
pub use role_set::RoleSet;

use crate::clip::{Clip, Span};
use crate::features::{Hand, KeyPose, Profile, for_each_pose};
use crate::math::{Axis, Quat, Vec3};
use crate::roles::{Role, RoleMap, proportions};

use hands::HandsWatch;
use noise::NoiseEstimate;
use shape::BodyShape;
use stillness::Stillness;
use timing::Timing;

/// A live stream's past counts half as much after this.
const HALF_LIFE_SECS: f64 = 5.0;
/// Frames after which the past is made to count less.
const FADE_EVERY: u64 = 16;
/// Bodies are looked at so often at most.
const LOOK_SECS: f64 = 0.02;
/// In streams faster than that, noise is looked at in this many frames in a row out of this many.
const NOISE_ROW: u64 = 8;
const NOISE_EVERY: u64 = 24;
/// No frame makes the past fade by more than this, whatever its time says.
const MOST_FADE_SECS: f64 = 0.1;
/// A leg of a grown person; what children and giants have lies within [`LEGS_M`].
const LEG_M: f64 = 0.85;
const LEGS_M: std::ops::Range<f64> = 0.35..1.4;
/// A hand from the wrist to the tip of its middle finger.
const HANDS_M: std::ops::Range<f64> = 0.1..0.3;
/// Less of the frames is never.
const SELDOM: f64 = 0.01;
/// A trunk, from the hips to the neck, over a leg.
const TRUNK_OF_LEG: f64 = 0.6;
/// Units of length in use: metres, centimetres, millimetres, inches, feet, decimetres.
const UNITS_M: [f64; 6] = [1.0, 0.01, 0.001, 0.0254, 0.3048, 0.1];

/// Looks at one performer's stream, frame by frame, in fixed memory.
///
/// ```
/// use morec::diagnosis::Diagnoser;
/// use morec::features::KeyPose;
///
/// let mut diagnoser = Diagnoser::live();
/// for frame in 0..60 {
///     // Nothing but empty frames, 30 a second.
///     let secs = f64::from(frame) / 30.0;
///     diagnoser.push(secs, secs, &KeyPose::default());
/// }
/// let diagnosis = diagnoser.diagnosis();
/// let worst = diagnosis.findings().worst().copied().unwrap();
/// assert_eq!(worst.label(), "nobody there");
/// ```
#[derive(Debug, Clone)]
pub struct Diagnoser {
    /// True if the past fades.
    fades: bool,
    to_fade_secs: f64,
    timing: Timing,
    seen: [f64; Role::COUNT],
    looked: f64,
    empty: f64,
    has_body: bool,
    looked_secs: f64,
    last: KeyPose,
    shape: BodyShape,
    hands: HandsWatch,
    noise: NoiseEstimate,
    stillness: Stillness,
    turns: Option<bool>,
}

impl Diagnoser {
    /// For a live stream: the past fades, half of it in five seconds.
    pub fn live() -> Self {
        Self::new(true)
    }

    /// For a whole recording: everything counts alike.
    pub fn whole() -> Self {
        Self::new(false)
    }

    fn new(fades: bool) -> Self {
        Self {
            fades,
            to_fade_secs: 0.0,
            timing: Timing::new(),
            seen: [0.0; Role::COUNT],
            looked: 0.0,
            empty: 0.0,
            has_body: false,
            looked_secs: f64::NEG_INFINITY,
            last: KeyPose::default(),
            shape: BodyShape::default(),
            hands: HandsWatch::default(),
            noise: NoiseEstimate::new(),
            stillness: Stillness::new(),
            turns: None,
        }
    }

    /// Looks at the rotations of a frame's joints, which a source of positions leaves out or leaves unturned. O(joints)
    /// until one has turned.
    pub fn see_turns(&mut self, rotations: &[Quat]) {
        if self.turns != Some(true) {
            self.turns = Some(rotations.iter().any(|q| *q != Quat::identity()));
        }
    }

    /// Frames taken so far.
    pub fn frames(&self) -> u64 {
        self.timing.frames
    }

    /// Takes the pose at `time_secs` on the stream's clock, which arrived at `arrived_secs` on any clock. O(roles), no
    /// allocation, never fails.
    pub fn push(&mut self, time_secs: f64, arrived_secs: f64, pose: &KeyPose) {
        let repeated = *pose == self.last && self.looked > 0.0;
        if repeated && self.timing.is_copy(time_secs) {
            self.timing.copy();
            return;
        }
        let Some(interval) = self.timing.push(time_secs, arrived_secs) else {
            return;
        };
        if repeated && !is_empty(pose) {
            self.timing.repeat();
        } else {
            self.last = *pose;
        }
        let fast = self
            .timing
            .usual_secs
            .is_some_and(|usual| usual < LOOK_SECS);
        let row = !fast || self.timing.frames % NOISE_EVERY < NOISE_ROW;
        if row && !repeated && self.has_body {
            self.noise.push(interval, pose, self.metres_per_unit().0);
        }
        if !fast || (time_secs - self.looked_secs).abs() >= LOOK_SECS {
            self.looked_secs = time_secs;
            self.look(time_secs, pose, repeated);
        }
        self.to_fade_secs += interval.min(MOST_FADE_SECS);
        if self.fades && self.timing.frames.is_multiple_of(FADE_EVERY) {
            self.fade();
        }
    }

    /// Measurements that need not be taken in every frame of a fast stream.
    fn look(&mut self, time_secs: f64, pose: &KeyPose, repeated: bool) {
        self.looked += 1.0;
        for role in pose.roles() {
            self.seen[role.index()] += 1.0;
        }
        self.hands.push(time_secs, pose);
        self.has_body = !is_empty(pose);
        if !self.has_body {
            self.empty += 1.0;
            return;
        }
        if !repeated {
            self.shape.push(pose);
        }
        let (unit, _) = self.metres_per_unit();
        self.stillness
            .push(time_secs, pose, unit, self.noise.lately_m());
    }

    fn fade(&mut self) {
        let factor = 0.5f64.powf(std::mem::take(&mut self.to_fade_secs) / HALF_LIFE_SECS);
        self.timing.fade(factor);
        self.seen.iter_mut().for_each(|seen| *seen *= factor);
        self.looked *= factor;
        self.empty *= factor;
        self.shape.fade(factor);
        self.hands.fade(factor);
        self.noise.fade(factor);
        self.stillness.fade(factor);
    }

    /// Metres in the stream's unit, and whether it is a common one.
    fn metres_per_unit(&self) -> (f64, bool) {
        let trunk = || self.shape.trunk.get().map(|trunk| trunk / TRUNK_OF_LEG);
        let arm = || {
            self.shape
                .arm
                .get()
                .map(|arm| arm / proportions::ARM_TO_LEG)
        };
        let leg = self.shape.leg.get().or_else(trunk).or_else(arm);
        let hand = self.hands.length.get();
        let leg = leg.map(|leg| (leg, LEG_M, LEGS_M));
        let known = leg.or_else(|| hand.map(|hand| (hand, proportions::HAND, HANDS_M)));
        let Some((length, usual, range)) = known.filter(|(length, ..)| *length > 1e-9) else {
            return (1.0, true);
        };
        let mut units = UNITS_M.into_iter();
        match units.find(|unit| range.contains(&(length * unit))) {
            Some(unit) => (unit, true),
            None => (usual / length, false),
        }
    }

    /// Findings so far. O(1), no allocation: some microseconds.
    pub fn diagnosis(&self) -> Diagnosis {
        let rhythm = self.timing.rhythm();
        let (unit, unit_known) = self.metres_per_unit();
        let shares = self.seen.map(|seen| seen / self.looked.max(1e-9));
        let is_seen = |role: Role| shares[role.index()] >= SELDOM;
        let profile = Profile::of_seen(is_seen);
        let body_up = self.shape.body_up();
        // A trunk that is bent now and then still points up on the mean.
        let steady = |up: &Vec3| up.norm() > 0.8;
        let trunk_up = self.shape.trunk_up();
        // Whose hips are not seen has the head above the shoulders.
        let upper_up = || trunk_up.or_else(|| self.shape.head_up()).filter(steady);
        let up = body_up
            .or_else(upper_up)
            .and_then(|up| up.try_normalize(0.1));
        let height = self.height();
        let hips_and_hands = self.stillness.hips_and_hands();
        // A hand that is out of view is lost as a whole: of its points, the frames count in which it is there.
        let share = |role: Role| match Hand::of(role).filter(|_| profile != Profile::Body) {
            Some(hand) => self.seen[role.index()] / self.hands.seen(hand).max(1e-9),
            None => shares[role.index()],
        };
        let with = |keep: &dyn Fn(f64) -> bool| {
            let expected = profile.expected(is_seen);
            let roles = expected.filter(|role| keep(share(*role)));
            if self.empty < 0.9 * self.looked {
                roles.collect()
            } else {
                RoleSet::default()
            }
        };
        Diagnosis {
            turns: self.turns,
            frames: self.timing.frames,
            secs: rhythm.secs,
            rate_hz: rhythm
                .interval_secs
                .map(|interval| 1.0 / interval.max(1e-12)),
            jitter_secs: rhythm.jitter_secs,
            lost_share: rhythm.lost_share,
            repeated_share: rhythm.repeated_share,
            late_share: self.timing.late as f64 / self.timing.frames.max(1) as f64,
            empty_share: self.empty / self.looked.max(1e-9),
            metres_per_unit: unit,
            unit_known,
            height_m: height.map(|height| height * unit),
            leg_m: self.shape.leg.get().map(|leg| leg * unit),
            arm_m: self.shape.arm.get().map(|arm| arm * unit),
            up: up.map(Into::into),
            stands: body_up.is_some(),
            tilt_rad: up.map(|up| up.angle(&Vec3::from(*Axis::Y.unit()))),
            noise_m: self.noise.metres(),
            spike_share: self.noise.spike_share(),
            profile,
            hand_m: self.hands.length.get().map(|hand| hand * unit),
            losses_per_minute: self.hands.losses_per_minute(),
            swaps_per_minute: self.hands.swaps_per_minute(),
            seen: Role::ALL
                .into_iter()
                .filter(|role| is_seen(*role))
                .collect(),
            missing: with(&|share| share < SELDOM),
            flickering: with(&|share| (SELDOM..0.8).contains(&share)),
            sides: self.shape.evidence(),
            still_secs: if self.fades {
                self.stillness.still_secs()
            } else {
                self.stillness.longest_secs()
            },
            hips_m: hips_and_hands.map(|(hips, _)| hips * unit),
            hands_m: hips_and_hands.map(|(_, hands)| hands * unit),
            standing_share: self.stillness.standing_share(),
        }
    }

    /// From the ankles to the head joint along the bones.
    fn height(&self) -> Option<f64> {
        Some(self.shape.leg.get()? + self.shape.trunk.get()? + self.shape.neck.get().unwrap_or(0.0))
    }
}

/// True if a pose shows nothing: no joint, or all of them at one place.
fn is_empty(pose: &KeyPose) -> bool {
    let mut places = pose.roles().filter_map(|role| pose.get(role));
    let Some(first) = places.next() else {
        return true;
    };
    !places.any(|place| (place - first).norm_squared() > 1e-18)
}

/// The same of a whole clip in metres and Y-up, as [`import`](crate::import) makes it; `rest` are frames at its start
/// that show no motion. O(frames · roles).
pub fn diagnose_clip(clip: &Clip, roles: &RoleMap, rest: &Span) -> Diagnosis {
    let mut diagnoser = Diagnoser::whole();
    let first_secs = rest.end as f64 / clip.rate_hz;
    for_each_pose(clip, roles, rest, |time_secs, pose| {
        if time_secs >= first_secs - 1e-9 {
            diagnoser.push(time_secs, time_secs, pose);
        }
    });
    diagnoser.diagnosis()
}

/// Errors among the findings of [`diagnose_clip`], in sentences: what spoils training and recognition, such as exchanged sides. None of a
/// clip without a body. O(frames · roles).
pub fn errors_of_clip(clip: &Clip, roles: &RoleMap, rest: &Span) -> Vec<String> {
    // That no frame shows a body is said of it elsewhere.
    if clip.frames == 0 || roles.missing().count() >= Role::BODY_COUNT {
        return Vec::new();
    }
    let findings = diagnose_clip(clip, roles, rest).findings();
    let said = findings.iter().map(Finding::of_file);
    let errors = said.filter(|(severity, _)| *severity == Severity::Error);
    errors.map(|(_, text)| text).collect()
}

#[cfg(test)]
mod tests;
