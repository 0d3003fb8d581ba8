//! Detects a rest pose in the first frame.
//!
//! Converters put a T-pose (or the zero pose) before the motion, for programs that take the first frame as the
//! skeleton's rest. The frame stays in the data; features and segments leave it out.

use super::body::median;
use crate::clip::{Clip, Span};
use crate::kinematics::WorldPose;
use crate::math::Vec3;
use crate::roles::{Role, RoleMap};

/// The jump from a rest pose is at least this many times the usual step from frame to frame.
const JUMP: f64 = 8.0;
/// And at least this, metres a joint: people do not do that in one frame.
const LEAST: f64 = 0.03;
/// Frames whose steps say what is usual.
const LOOKED_AT: usize = 60;

/// A rest pose that a change of rate repeated is this many frames long at most.
const REPEATED: usize = 8;
/// Frames nearer to each other than this, metres a joint, are one frame twice.
const SAME: f64 = 1e-6;

/// The rest pose at the start of a clip in metres and Y-up: `0..1` (more where frames are doubled), or `0..0` if there is
/// none.
///
/// A rest pose is far from the frame behind it, much farther than frames lie apart after it, and symmetric: so a
/// clip that begins in the middle of a motion has none.
pub fn rest_frames(clip: &Clip, map: &RoleMap) -> Span {
    if clip.frames < 3 || clip.skeleton.is_empty() {
        return 0..0;
    }
    let hips = map.joint(Role::Hips).unwrap_or(0);
    let poses: Vec<Vec<Vec3>> = (0..clip.frames.min(LOOKED_AT))
        .map(|f| about_hips(clip, hips, f))
        .collect();
    let steps: Vec<f64> = poses
        .windows(2)
        .map(|pair| apart(&pair[0], &pair[1]))
        .collect();
    let Some(jump) = steps.iter().position(|&step| step > SAME) else {
        return 0..0;
    };
    if jump >= REPEATED {
        return 0..0;
    }
    // Between doubled frames nothing moves, which is no usual step.
    let after: Vec<f64> = steps[jump + 1..]
        .iter()
        .copied()
        .filter(|&step| jump == 0 || step > SAME)
        .collect();
    let usual = median(after.clone()).unwrap_or(0.0);
    // Motion may jerk where it begins; a rest pose is still farther away.
    let most = after.iter().take(3).copied().fold(0.0, f64::max);
    let step = steps[jump];
    let jumps = step > LEAST && step > JUMP * usual && step > most;
    if jumps && (is_zero_pose(clip) || is_symmetric(&poses[0], map)) {
        0..jump + 1
    } else {
        0..0
    }
}

/// Joint positions from the hips.
fn about_hips(clip: &Clip, hips: usize, frame: usize) -> Vec<Vec3> {
    let pose = WorldPose::of(clip, frame);
    pose.positions
        .iter()
        .map(|position| position - pose.positions[hips])
        .collect()
}

/// Mean distance between the joints of two poses.
fn apart(a: &[Vec3], b: &[Vec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).norm()).sum::<f64>() / a.len() as f64
}

/// True if hardly any joint is turned in the first frame.
fn is_zero_pose(clip: &Clip) -> bool {
    if !clip.has_rotations() {
        return false;
    }
    let turned = clip
        .frame_rotations(0)
        .iter()
        .filter(|q| q.angle() > 1f64.to_radians())
        .count();
    turned * 10 <= clip.skeleton.len()
}

/// True if the left limbs mirror the right ones through the body's middle plane.
fn is_symmetric(pose: &[Vec3], map: &RoleMap) -> bool {
    const SIDES: [(Role, Role); 6] = [
        (Role::LeftThigh, Role::RightThigh),
        (Role::LeftShin, Role::RightShin),
        (Role::LeftFoot, Role::RightFoot),
        (Role::LeftArm, Role::RightArm),
        (Role::LeftForearm, Role::RightForearm),
        (Role::LeftHand, Role::RightHand),
    ];
    let pairs: Vec<(Vec3, Vec3)> = SIDES
        .iter()
        .filter_map(|&(left, right)| Some((pose[map.joint(left)?], pose[map.joint(right)?])))
        .collect();
    let across: Vec3 = pairs.iter().map(|(left, right)| left - right).sum();
    let Some(across) = across.try_normalize(1e-9) else {
        return false;
    };
    if pairs.len() < 4 {
        return false;
    }
    let mirrored = |v: &Vec3| v - across * (2.0 * v.dot(&across));
    let error = pairs
        .iter()
        .map(|(left, right)| (mirrored(left) - right).norm())
        .sum::<f64>();
    let size = pairs
        .iter()
        .map(|(left, right)| (left.norm() + right.norm()) / 2.0)
        .sum::<f64>();
    error < 0.1 * size
}
