//! Measures of motion: of the whole body, of the hips, and of the feet on the floor.

use crate::features::KeyPose;
use crate::math::Vec3;
use crate::roles::Role;

/// A joint that moves less than this, metres, does not move.
const STILL_M: f64 = 1e-4;
/// Between two looks at where the feet are.
const LOOK_SECS: f64 = 0.1;
/// Feet that move by less than this against each other move together.
const TOGETHER_MPS: f64 = 0.3;
/// Feet that stand move slower than this.
const STANDS_MPS: f64 = 0.6;

/// Mean and spread of a position over time.
#[derive(Debug, Clone, Copy, Default)]
struct PositionSpread {
    /// The first place: figures are taken from it, so that a place far away loses no digits.
    origin: Vec3,
    count: f64,
    sum: Vec3,
    squares: f64,
}

impl PositionSpread {
    fn add(&mut self, place: Vec3) {
        if self.count <= 0.0 {
            *self = Self {
                origin: place,
                ..Self::default()
            };
        }
        let from = place - self.origin;
        self.count += 1.0;
        self.sum += from;
        self.squares += from.norm_squared();
    }

    fn fade(&mut self, factor: f64) {
        self.count *= factor;
        self.sum *= factor;
        self.squares *= factor;
    }

    fn deviation(&self) -> Option<f64> {
        let mean = (self.count > 4.0).then(|| self.sum / self.count)?;
        Some(
            (self.squares / self.count - mean.norm_squared())
                .max(0.0)
                .sqrt(),
        )
    }
}

/// Positions of the feet.
#[derive(Debug, Clone, Copy)]
struct LastLook {
    secs: f64,
    feet: [Vec3; 2],
}

/// Parts of a stream that move.
#[derive(Debug, Clone)]
pub(super) struct Stillness {
    reference: KeyPose,
    since_secs: f64,
    now_secs: f64,
    longest_secs: f64,
    hips: PositionSpread,
    hands: [PositionSpread; 2],
    look: Option<LastLook>,
    looks: f64,
    standing: f64,
}

impl Stillness {
    pub(super) fn new() -> Self {
        Self {
            reference: KeyPose::default(),
            since_secs: f64::NAN,
            now_secs: f64::NAN,
            longest_secs: 0.0,
            hips: PositionSpread::default(),
            hands: [PositionSpread::default(); 2],
            look: None,
            looks: 0.0,
            standing: 0.0,
        }
    }

    /// Takes the pose at `time_secs`. `noise_m`: how far a joint that stands may seem to move.
    pub(super) fn push(
        &mut self,
        time_secs: f64,
        pose: &KeyPose,
        metres_per_unit: f64,
        noise_m: f64,
    ) {
        self.now_secs = time_secs;
        if self.since_secs.is_nan() || moved(&self.reference, pose, STILL_M / metres_per_unit) {
            self.reference = *pose;
            self.since_secs = time_secs;
        }
        self.longest_secs = self.longest_secs.max(time_secs - self.since_secs);
        let hips = pose.get(Role::Hips);
        if let Some(hips) = hips {
            self.hips.add(hips);
        }
        for (spread, role) in self.hands.iter_mut().zip([Role::LeftHand, Role::RightHand]) {
            if let (Some(hand), Some(hips)) = (pose.get(role), hips) {
                spread.add(hand - hips);
            }
        }
        self.feet(time_secs, pose, metres_per_unit, noise_m);
    }

    fn feet(&mut self, time_secs: f64, pose: &KeyPose, metres_per_unit: f64, noise_m: f64) {
        let (Some(left), Some(right)) = (pose.get(Role::LeftFoot), pose.get(Role::RightFoot))
        else {
            self.look = None;
            return;
        };
        let feet = [left, right];
        let Some(before) = self.look else {
            self.look = Some(LastLook {
                secs: time_secs,
                feet,
            });
            return;
        };
        let passed = time_secs - before.secs;
        if passed < LOOK_SECS {
            return;
        }
        self.look = Some(LastLook {
            secs: time_secs,
            feet,
        });
        if passed > 3.0 * LOOK_SECS {
            return;
        }
        let moved = [0, 1].map(|i| (feet[i] - before.feet[i]) * metres_per_unit);
        let mps = |moved: Vec3| (moved.norm() - 3.0 * noise_m).max(0.0) / passed;
        // Who walks moves the feet one after the other; together they move when all of the body does.
        if mps(moved[0] - moved[1]) < TOGETHER_MPS {
            self.looks += 1.0;
            self.standing += f64::from(u8::from(mps(0.5 * (moved[0] + moved[1])) < STANDS_MPS));
        }
    }

    pub(super) fn fade(&mut self, factor: f64) {
        self.hips.fade(factor);
        self.hands.iter_mut().for_each(|hand| hand.fade(factor));
        self.looks *= factor;
        self.standing *= factor;
    }

    /// Since when nothing has moved, seconds.
    pub(super) fn still_secs(&self) -> f64 {
        (self.now_secs - self.since_secs).max(0.0)
    }

    /// The longest time in which nothing moved, seconds.
    pub(super) fn longest_secs(&self) -> f64 {
        self.longest_secs
    }

    /// Distances of the hips, and of the hand that moves more as seen from them, from their mean, in the stream's
    /// unit.
    pub(super) fn hips_and_hands(&self) -> Option<(f64, f64)> {
        let hands = self.hands.iter().filter_map(PositionSpread::deviation);
        Some((self.hips.deviation()?, hands.reduce(f64::max)?))
    }

    /// Of the looks at which the feet moved together or not at all, the share at which they stood; `None` before there
    /// was a second of them.
    pub(super) fn standing_share(&self) -> Option<f64> {
        (self.looks >= 9.0).then(|| self.standing / self.looks)
    }
}

fn moved(a: &KeyPose, b: &KeyPose, least: f64) -> bool {
    let far = |(a, b): (Vec3, Vec3)| (b - a).norm_squared() > least * least;
    !a.roles().eq(b.roles())
        || a.roles()
            .any(|role| a.get(role).zip(b.get(role)).is_some_and(far))
}
