//! From joint positions to bone directions as the performer sees them.

use crate::math::{Vec3, slerp_direction};
use crate::roles::Role;

use super::KeyPose;
use super::bones::{ALL_BONES, BONES, BoneSet};

/// One frame's bone directions in the heading frame and where the root stands.
///
/// The heading frame turns about the vertical with the hips: lateral axis from the right to the left hip joint
/// without its vertical part, up is +Y, forward is lateral × up. Coordinates are (lateral, up, forward).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Observation {
    /// Unit vectors, `heading_from_world` applied; zero for bones outside the set.
    pub directions: [Vec3; BONES],
    /// World position of the hips, in the source's length unit.
    pub root: Vec3,
    /// Heading about +Y from +Z, continuous over time (it does not jump at ±π).
    pub yaw_rad: f64,
    /// Length of a leg in the source's unit: the mean over the stream so far.
    pub leg_length: f64,
}

impl Observation {
    /// Between `a` and `b`; directions along great circles, the rest on a line.
    pub fn between(a: &Self, b: &Self, t: f64, bones: BoneSet) -> Self {
        if t <= 0.0 {
            return *a;
        }
        if t >= 1.0 {
            return *b;
        }
        let mut directions = [Vec3::zeros(); BONES];
        for bone in bones.indices() {
            directions[bone] = slerp_direction(&a.directions[bone], &b.directions[bone], t);
        }
        Self {
            directions,
            root: a.root.lerp(&b.root, t),
            yaw_rad: a.yaw_rad + (b.yaw_rad - a.yaw_rad) * t,
            leg_length: a.leg_length + (b.leg_length - a.leg_length) * t,
        }
    }
}

/// Turns poses into observations; remembers what a missing joint did last.
#[derive(Debug, Clone)]
pub struct Observer {
    bones: BoneSet,
    last: Option<Observation>,
    leg_sum: f64,
    leg_count: f64,
}

impl Observer {
    /// For the bones an index uses.
    pub fn new(bones: BoneSet) -> Self {
        Self {
            bones,
            last: None,
            leg_sum: 0.0,
            leg_count: 0.0,
        }
    }

    /// Forgets the stream so far.
    pub fn reset(&mut self) {
        *self = Self::new(self.bones);
    }

    /// Length of a leg in the source's unit, the mean over the stream so far.
    pub fn leg_length(&self) -> Option<f64> {
        (self.leg_count > 0.0).then(|| self.leg_sum / self.leg_count)
    }

    /// The observation of one pose. A bone or heading that `pose` does not show keeps its last direction;
    /// `None` until the hip joints have been seen once.
    pub fn observe(&mut self, pose: &KeyPose) -> Option<Observation> {
        let yaw_rad = self.yaw(pose)?;
        let (sin, cos) = yaw_rad.sin_cos();
        let mut directions = self
            .last
            .map_or([Vec3::zeros(); BONES], |last| last.directions);
        for index in self.bones.indices() {
            let bone = &ALL_BONES[index];
            if let (Some(from), Some(to)) = (pose.get(bone.from), pose.get(bone.to)) {
                let along = to - from;
                let length = along.norm();
                if length > 1e-9 {
                    directions[index] = heading_from_world(sin, cos, &(along / length));
                }
            }
        }
        let root = self.root(pose)?;
        self.measure_leg(pose);
        let leg_length = if self.leg_count > 0.0 {
            self.leg_sum / self.leg_count
        } else {
            1.0
        };
        let observation = Observation {
            directions,
            root,
            yaw_rad,
            leg_length,
        };
        self.last = Some(observation);
        Some(observation)
    }

    fn yaw(&self, pose: &KeyPose) -> Option<f64> {
        let last = self.last.map(|o| o.yaw_rad);
        let lateral = match (pose.get(Role::LeftThigh), pose.get(Role::RightThigh)) {
            (Some(left), Some(right)) => left - right,
            _ => return last,
        };
        // Hips seen straight from the side of the vertical have no heading.
        if lateral.x.hypot(lateral.z) < 1e-9 {
            return last;
        }
        let yaw = (-lateral.z).atan2(lateral.x);
        Some(match last {
            Some(previous) => {
                let turn = yaw - previous;
                previous + turn - std::f64::consts::TAU * (turn / std::f64::consts::TAU).round()
            }
            None => yaw,
        })
    }

    fn root(&self, pose: &KeyPose) -> Option<Vec3> {
        pose.get(Role::Hips)
            .or_else(|| Some((pose.get(Role::LeftThigh)? + pose.get(Role::RightThigh)?) / 2.0))
            .or(self.last.map(|o| o.root))
    }

    fn measure_leg(&mut self, pose: &KeyPose) {
        let (Some(hip), Some(knee)) = (pose.get(Role::LeftThigh), pose.get(Role::LeftShin)) else {
            return;
        };
        let thigh = (knee - hip).norm();
        // Without a foot the shin counts as long as the thigh: within 5 % in grown people.
        let shin = pose
            .get(Role::LeftFoot)
            .map_or(thigh, |ankle| (ankle - knee).norm());
        if thigh + shin > 1e-9 {
            self.leg_sum += thigh + shin;
            self.leg_count += 1.0;
        }
    }
}

/// Turns a world direction into the heading frame of the yaw with this sine and cosine.
pub fn heading_from_world(sin: f64, cos: f64, v: &Vec3) -> Vec3 {
    Vec3::new(v.x * cos - v.z * sin, v.y, v.x * sin + v.z * cos)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn standing(turned_rad: f64, scale: f64) -> KeyPose {
        let mut pose = KeyPose::default();
        let turn = crate::math::Axis::Y.rotation(turned_rad);
        let mut put =
            |role, x: f64, y: f64, z: f64| pose.set(role, turn * Vec3::new(x, y, z) * scale);
        put(Role::Hips, 0.0, 1.0, 0.0);
        put(Role::LeftThigh, 0.1, 1.0, 0.0);
        put(Role::RightThigh, -0.1, 1.0, 0.0);
        put(Role::LeftShin, 0.1, 0.5, 0.1);
        put(Role::LeftFoot, 0.1, 0.0, 0.0);
        put(Role::Neck, 0.0, 1.5, 0.0);
        put(Role::LeftArm, 0.2, 1.4, 0.0);
        put(Role::LeftForearm, 0.2, 1.4, 0.3);
        pose
    }

    #[test]
    fn heading_and_size_do_not_change_directions() {
        let bones = BoneSet::of_pose(&standing(0.0, 1.0));
        let reference = Observer::new(bones).observe(&standing(0.0, 1.0)).unwrap();
        // The left arm points forward: +Z in the heading frame.
        assert!((reference.directions[6] - Vec3::z()).norm() < 1e-12);
        for step in 0..12 {
            let turned = Observer::new(bones)
                .observe(&standing(f64::from(step), 3.0))
                .unwrap();
            for b in bones.indices() {
                assert!((turned.directions[b] - reference.directions[b]).norm() < 1e-9);
            }
        }
    }

    #[test]
    fn yaw_is_continuous_over_many_turns() {
        let mut observer = Observer::new(BoneSet::ALL);
        let mut last = 0.0;
        for step in 0..200 {
            let yaw = observer
                .observe(&standing(f64::from(step) * 0.2, 1.0))
                .unwrap()
                .yaw_rad;
            assert!(
                (yaw - f64::from(step) * 0.2).abs() < 1e-9,
                "{yaw} after {last}"
            );
            last = yaw;
        }
    }

    #[test]
    fn a_lost_joint_keeps_its_last_direction() {
        let mut observer = Observer::new(BoneSet::ALL);
        let seen = observer.observe(&standing(0.0, 1.0)).unwrap();
        let mut hidden = standing(0.0, 1.0);
        hidden.set(Role::LeftForearm, Vec3::new(f64::NAN, 0.0, 0.0));
        assert_eq!(
            observer.observe(&hidden).unwrap().directions[6],
            seen.directions[6]
        );
    }
}
