//! Measures of the body over a clip, in the units and axes of its file.

use crate::clip::Clip;
use crate::kinematics::WorldPose;
use crate::math::Vec3;
use crate::pose::{Hand, KeyPose};
use crate::roles::{ARMS, LEGS, Role, RoleMap};
use crate::signed_axis::SignedAxis;

/// Frames looked at, evenly spread: bodies do not change within a clip.
const FRAMES: usize = 200;

/// Lengths and directions of the body in the poses of a clip, in the file's units and axes.
pub(super) struct BodyMeasures {
    /// From the lower end to the upper end of the body, frame by frame.
    pub(super) feet_to_head: Vec<Vec3>,
    /// The same, with the highest part that is known where head and neck are not: it says which way is up.
    pub(super) upwards: Vec<Vec3>,
    /// From the middle of the shoulders to the head, in the same frames: the way up of a body whose legs are not seen.
    pub(super) head_over_shoulders: Vec<Vec3>,
    /// Positions of the joints that play roles, in the same frames.
    pub(super) poses: Vec<Vec<Vec3>>,
    /// Thigh and shin together.
    pub(super) leg: Option<f64>,
    /// Upper arm and forearm together.
    pub(super) arm: Option<f64>,
    /// From the left shoulder to the right.
    pub(super) shoulders: Option<f64>,
    /// From the middle of the hip joints to that of the shoulders.
    pub(super) trunk: Option<f64>,
    /// From the wrist to the tip of the middle finger.
    pub(super) hand: Option<f64>,
    /// Leg, hips to neck, neck to head: the height of someone who stands straight, up to the head's joint.
    pub(super) chain: Option<f64>,
}

impl BodyMeasures {
    pub(super) fn measure(clip: &Clip, map: &RoleMap) -> Self {
        let mut pose = WorldPose::default();
        let step = clip.frames.div_ceil(FRAMES).max(1);
        // The first frame is left out if there are others: it may be a rest pose of another size.
        let frames = || (usize::from(clip.frames > 1)..clip.frames).step_by(step);
        let (mut feet_to_head, mut upwards) = (Vec::new(), Vec::new());
        let (mut legs, mut chains) = (Vec::new(), Vec::new());
        let (mut arms, mut trunks) = (Vec::new(), Vec::new());
        let (mut shoulders, mut head_over_shoulders) = (Vec::new(), Vec::new());
        let (mut poses, mut hands) = (Vec::new(), Vec::new());
        for frame in frames() {
            pose.set(clip, frame);
            let key = KeyPose::of(&pose, map);
            hands.extend(Hand::BOTH.iter().filter_map(|hand| hand.length(&key)));
            let joints = Role::ALL.iter().filter_map(|&role| map.joint(role));
            poses.push(joints.map(|joint| pose.positions[joint]).collect());
            let head = extent(clip, map, &pose, &[Role::Head, Role::Neck]);
            feet_to_head.extend(head);
            upwards.extend(head.or_else(|| extent(clip, map, &pose, &[Role::Torso, Role::Hips])));
            let leg = mean(LEGS.map(|limb| limb_length(map, &pose, limb)));
            arms.extend(mean(ARMS.map(|limb| limb_length(map, &pose, limb))));
            shoulders.extend(distance(map, &pose, Role::LeftArm, Role::RightArm));
            head_over_shoulders.extend(shoulders_to_head(map, &pose));
            trunks.extend(hips_to_shoulders(map, &pose));
            legs.extend(leg);
            chains.extend(leg.and_then(|leg| Some(leg + trunk_length(map, &pose)?)));
        }
        Self {
            feet_to_head,
            upwards,
            head_over_shoulders,
            poses,
            leg: median(legs),
            arm: median(arms),
            shoulders: median(shoulders),
            trunk: median(trunks),
            chain: median(chains),
            hand: median(hands),
        }
    }

    /// From the feet to the top of the head where the body stands straightest.
    pub(super) fn height(&self, up: SignedAxis) -> Option<f64> {
        let mut heights: Vec<f64> = self
            .feet_to_head
            .iter()
            .map(|v| v.dot(&up.unit()))
            .collect();
        heights.sort_by(f64::total_cmp);
        let tall = heights
            .get(heights.len() * 9 / 10)
            .or(heights.last())
            .copied();
        // Someone who never stands up is measured along the limbs.
        match (tall, self.chain) {
            (Some(tall), Some(chain)) => Some(tall.max(chain)),
            (tall, chain) => tall.or(chain),
        }
    }
}

/// From the mean of the feet (or the lowest ends of the legs that are known) to the first of `tops` that is known.
fn extent(clip: &Clip, map: &RoleMap, pose: &WorldPose, tops: &[Role]) -> Option<Vec3> {
    let any = |roles: &[Role]| roles.iter().find_map(|&role| map.joint(role));
    let head = any(tops)?;
    let feet = [
        any(&[Role::LeftFoot, Role::LeftShin, Role::LeftThigh]),
        any(&[Role::RightFoot, Role::RightShin, Role::RightThigh]),
    ];
    let feet: Vec<Vec3> = feet
        .into_iter()
        .flatten()
        .map(|foot| pose.positions[foot])
        .collect();
    let count = feet.len();
    (count > 0).then(|| pose.tip(clip, head) - feet.iter().sum::<Vec3>() / count as f64)
}

fn distance(map: &RoleMap, pose: &WorldPose, a: Role, b: Role) -> Option<f64> {
    Some((pose.positions[map.joint(a)?] - pose.positions[map.joint(b)?]).norm())
}

fn limb_length(map: &RoleMap, pose: &WorldPose, [upper, lower, end]: [Role; 3]) -> Option<f64> {
    Some(distance(map, pose, upper, lower)? + distance(map, pose, lower, end)?)
}

fn middle(map: &RoleMap, pose: &WorldPose, a: Role, b: Role) -> Option<Vec3> {
    Some((pose.positions[map.joint(a)?] + pose.positions[map.joint(b)?]) / 2.0)
}

fn hips_to_shoulders(map: &RoleMap, pose: &WorldPose) -> Option<f64> {
    let hips = middle(map, pose, Role::LeftThigh, Role::RightThigh)?;
    Some((middle(map, pose, Role::LeftArm, Role::RightArm)? - hips).norm())
}

fn shoulders_to_head(map: &RoleMap, pose: &WorldPose) -> Option<Vec3> {
    let shoulders = middle(map, pose, Role::LeftArm, Role::RightArm)?;
    Some(pose.positions[map.joint(Role::Head)?] - shoulders)
}

fn trunk_length(map: &RoleMap, pose: &WorldPose) -> Option<f64> {
    Some(
        distance(map, pose, Role::Hips, Role::Neck)? + distance(map, pose, Role::Neck, Role::Head)?,
    )
}

fn mean(values: [Option<f64>; 2]) -> Option<f64> {
    match values {
        [Some(a), Some(b)] => Some((a + b) / 2.0),
        [a, b] => a.or(b),
    }
}

pub(super) fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}
