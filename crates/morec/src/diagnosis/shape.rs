//! Measures of the body: its proportions, its vertical, and whether left and right agree with the direction in which limbs bend.

use crate::features::KeyPose;
use crate::math::Vec3;
use crate::roles::{ARMS, LEGS, Role};

use super::figures::SideEvidence;

/// A leg counts as straight if hip and ankle are this share of its length apart.
const STRAIGHT: f64 = 0.93;
/// The feet of somebody who stands are no farther apart than this share of a leg.
const TOGETHER: f64 = 0.5;
/// Cosine of the most by which trunk and legs of a standing body differ: 20°.
const IN_LINE: f64 = 0.94;

/// A mean that old values fade from.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Mean {
    sum: f64,
    count: f64,
}

impl Mean {
    fn add(&mut self, value: f64) {
        self.sum += value;
        self.count += 1.0;
    }

    pub(super) fn add_known(&mut self, value: Option<f64>) {
        if let Some(value) = value {
            self.add(value);
        }
    }

    pub(super) fn fade(&mut self, factor: f64) {
        self.sum *= factor;
        self.count *= factor;
    }

    pub(super) fn get(&self) -> Option<f64> {
        (self.count > 0.0).then(|| self.sum / self.count)
    }
}

/// Lengths, directions and bends of one body.
#[derive(Debug, Clone, Default)]
pub(super) struct BodyShape {
    pub(super) leg: Mean,
    pub(super) arm: Mean,
    pub(super) trunk: Mean,
    pub(super) neck: Mean,
    knees: Mean,
    elbows: Mean,
    hands: Mean,
    trunk_up: Vec3,
    trunk_count: f64,
    head_up: Vec3,
    head_count: f64,
    body_up: Vec3,
    body_count: f64,
}

/// A leg's joints.
struct Leg {
    hip: Vec3,
    knee: Vec3,
    ankle: Vec3,
}

impl Leg {
    fn of(pose: &KeyPose, [hip, knee, ankle]: [Role; 3]) -> Option<Self> {
        Some(Self {
            hip: pose.get(hip)?,
            knee: pose.get(knee)?,
            ankle: pose.get(ankle)?,
        })
    }

    fn length(&self) -> f64 {
        (self.knee - self.hip).norm() + (self.ankle - self.knee).norm()
    }

    /// Offset of the knee from the line between hip and ankle.
    fn bend(&self) -> Vec3 {
        let line = self.ankle - self.hip;
        let along = (self.knee - self.hip).dot(&line) / line.norm_squared().max(1e-12);
        self.knee - self.hip - line * along
    }
}

impl BodyShape {
    pub(super) fn push(&mut self, pose: &KeyPose) {
        let legs = LEGS.map(|roles| Leg::of(pose, roles));
        for leg in legs.iter().flatten() {
            self.leg.add(leg.length());
        }
        for arm in ARMS.iter().filter_map(|roles| Leg::of(pose, *roles)) {
            self.arm.add(arm.length());
        }
        self.head(pose);
        let hips = middle(pose, Role::LeftThigh, Role::RightThigh).or_else(|| pose.get(Role::Hips));
        let top = pose
            .get(Role::Neck)
            .or_else(|| middle(pose, Role::LeftArm, Role::RightArm))
            .or_else(|| pose.get(Role::Head));
        let trunk = hips.zip(top).map(|(hips, top)| top - hips);
        if let Some(trunk) = trunk.filter(|trunk| trunk.norm() > 1e-9) {
            self.trunk.add(trunk.norm());
            self.trunk_up += trunk.normalize();
            self.trunk_count += 1.0;
            self.stand(&legs, &trunk.normalize());
            self.sides(pose, &legs, &trunk);
        }
        if let (Some(neck), Some(head)) = (pose.get(Role::Neck), pose.get(Role::Head)) {
            self.neck.add((head - neck).norm());
        }
    }

    /// The way from the shoulders to the head.
    fn head(&mut self, pose: &KeyPose) {
        let shoulders = middle(pose, Role::LeftArm, Role::RightArm);
        let line = || (pose.get(Role::Head)? - shoulders?).try_normalize(1e-9);
        if let Some(line) = line() {
            self.head_up += line;
            self.head_count += 1.0;
        }
    }

    /// The line of a body that stands straight, whatever way the world is turned.
    fn stand(&mut self, legs: &[Option<Leg>; 2], trunk: &Vec3) {
        let [Some(left), Some(right)] = legs else {
            return;
        };
        let straight = |leg: &Leg| (leg.hip - leg.ankle).norm() > STRAIGHT * leg.length();
        let line = (left.hip + right.hip) - (left.ankle + right.ankle);
        // Who walks fast or runs leans, and has the feet apart.
        let apart = (left.ankle - right.ankle).norm() > TOGETHER * left.length();
        if !straight(left) || !straight(right) || apart || line.norm() < 1e-9 {
            return;
        }
        let line = line.normalize();
        if line.dot(trunk) > IN_LINE {
            self.body_up += (line + trunk).normalize();
            self.body_count += 1.0;
        }
    }

    /// Offsets of joints towards the front, if the hip that is called left is the left one.
    fn sides(&mut self, pose: &KeyPose, legs: &[Option<Leg>; 2], trunk: &Vec3) {
        let pair = (pose.get(Role::LeftThigh), pose.get(Role::RightThigh));
        let (Some(left), Some(right)) = pair else {
            return;
        };
        let front = (left - right).cross(trunk);
        if front.norm() < 1e-12 {
            return;
        }
        let (front, length) = (front.normalize(), trunk.norm());
        for leg in legs.iter().flatten() {
            self.knees.add(leg.bend().dot(&front) / length);
        }
        for arm in ARMS.iter().filter_map(|roles| Leg::of(pose, *roles)) {
            self.elbows.add(arm.bend().dot(&front) / length);
            self.hands.add((arm.ankle - arm.hip).dot(&front) / length);
        }
    }

    pub(super) fn fade(&mut self, factor: f64) {
        for mean in [
            &mut self.leg,
            &mut self.arm,
            &mut self.trunk,
            &mut self.neck,
            &mut self.knees,
            &mut self.elbows,
            &mut self.hands,
        ] {
            mean.fade(factor);
        }
        self.trunk_up *= factor;
        self.trunk_count *= factor;
        self.head_up *= factor;
        self.head_count *= factor;
        self.body_up *= factor;
        self.body_count *= factor;
    }

    /// The mean way up of the trunk, a vector whose length says how much it stays so.
    pub(super) fn trunk_up(&self) -> Option<Vec3> {
        (self.trunk_count > 4.0).then(|| self.trunk_up / self.trunk_count)
    }

    /// The same of the head over the shoulders.
    pub(super) fn head_up(&self) -> Option<Vec3> {
        (self.head_count > 4.0).then(|| self.head_up / self.head_count)
    }

    /// The same of a body that stands straight.
    pub(super) fn body_up(&self) -> Option<Vec3> {
        (self.body_count > 8.0).then(|| self.body_up / self.body_count)
    }

    /// Evidence for and against the sides.
    pub(super) fn evidence(&self) -> SideEvidence {
        SideEvidence {
            knees: self.knees.get(),
            elbows: self.elbows.get(),
            hands: self.hands.get(),
        }
    }
}

fn middle(pose: &KeyPose, a: Role, b: Role) -> Option<Vec3> {
    Some(0.5 * (pose.get(a)? + pose.get(b)?))
}
