//! Rotations for clips of points: fits a skeleton of constant bone lengths to the positions of the joints.
//!
//! Bones get the median of their measured lengths. In each frame every joint in turn, from the hips outwards, is turned by the rotation
//! that brings all joints behind it nearest to where they were measured, in least squares (Kabsch 1976); rounds of this
//! go on until they gain nothing: coordinate descent, whose sum of squares never grows. It begins with the pose of
//! the frame before. Positions say nothing of how a straight limb is turned about itself: that stays as it was, next to its
//! parent. Residuals say how far the skeleton is from the points.

use nalgebra::Matrix3;

use crate::clip::{Clip, Joint};
use crate::import::Take;
use crate::kinematics::WorldPose;
use crate::math::{Quat, Vec3};
use crate::roles::{Role, RoleMap};

/// A skeleton fitted to points, and how well it fits.
#[derive(Debug, Clone, PartialEq)]
pub struct SkeletonFit {
    /// A clip of one skeleton in the take's frames, metres, Y up; a joint for each role that the take knows.
    pub clip: Clip,
    /// The joint of each role.
    pub roles: RoleMap,
    /// Root of the mean squared distance between joints and points, metres.
    pub rms_metres: f64,
    /// The role that is farthest from its points, and its root mean square, metres.
    pub worst: (Role, f64),
}

/// Why nothing can be fitted.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FitError {
    /// The clip has rotations of its own.
    #[error("its joints have rotations already")]
    HasRotations,
    /// Too little of a body is known.
    #[error(
        "no skeleton can be fitted, because none of its points is known to be the {0}: name the point with roles"
    )]
    Missing(Role),
    /// No frame shows the body.
    #[error("no frame contains the hips")]
    Unseen,
}

/// A joint of the skeleton: its role, its name, the roles it may hang on (the first that is known), and where its bone points
/// in a T-pose.
struct FittedBone(Role, &'static str, &'static [Role], [f64; 3]);

/// The skeleton, parents first. Faces +Z, left at +X.
const BONES: [FittedBone; Role::BODY_COUNT] = {
    use Role::*;
    [
        FittedBone(Hips, "Hips", &[], [0.0, 0.0, 0.0]),
        FittedBone(LeftThigh, "LeftUpLeg", &[Hips], [1.0, 0.0, 0.0]),
        FittedBone(LeftShin, "LeftLeg", &[LeftThigh], [0.0, -1.0, 0.0]),
        FittedBone(LeftFoot, "LeftFoot", &[LeftShin], [0.0, -1.0, 0.0]),
        FittedBone(RightThigh, "RightUpLeg", &[Hips], [-1.0, 0.0, 0.0]),
        FittedBone(RightShin, "RightLeg", &[RightThigh], [0.0, -1.0, 0.0]),
        FittedBone(RightFoot, "RightFoot", &[RightShin], [0.0, -1.0, 0.0]),
        FittedBone(Torso, "Spine", &[Hips], [0.0, 1.0, 0.0]),
        FittedBone(Neck, "Neck", &[Torso, Hips], [0.0, 1.0, 0.0]),
        FittedBone(Head, "Head", &[Neck, Torso, Hips], [0.0, 1.0, 0.0]),
        FittedBone(
            LeftShoulder,
            "LeftShoulder",
            &[Torso, Hips],
            [0.0, 1.0, 0.0],
        ),
        FittedBone(
            LeftArm,
            "LeftArm",
            &[LeftShoulder, Torso, Hips],
            [1.0, 0.0, 0.0],
        ),
        FittedBone(LeftForearm, "LeftForeArm", &[LeftArm], [1.0, 0.0, 0.0]),
        FittedBone(LeftHand, "LeftHand", &[LeftForearm], [1.0, 0.0, 0.0]),
        FittedBone(
            RightShoulder,
            "RightShoulder",
            &[Torso, Hips],
            [0.0, 1.0, 0.0],
        ),
        FittedBone(
            RightArm,
            "RightArm",
            &[RightShoulder, Torso, Hips],
            [-1.0, 0.0, 0.0],
        ),
        FittedBone(RightForearm, "RightForeArm", &[RightArm], [-1.0, 0.0, 0.0]),
        FittedBone(RightHand, "RightHand", &[RightForearm], [-1.0, 0.0, 0.0]),
    ]
};

/// Rounds in a frame at most; most need three.
const ROUNDS: usize = 30;
/// A round that lowers the sum of squares by less than this share is the last.
const GAIN: f64 = 1e-3;
/// Weight of a joint's present rotation, as a share of the weight of what hangs on it: it decides only what the points
/// leave open.
const HOLD: f64 = 1e-3;

/// Lays a skeleton into the points of `take`. O(frames × joints²), some hundred frames a millisecond.
///
/// # Errors
/// The clip has rotations, or its hips or hip joints are not known or never seen.
pub fn fit_skeleton(take: &Take) -> Result<SkeletonFit, FitError> {
    if take.clip.has_rotations() {
        return Err(FitError::HasRotations);
    }
    for role in [Role::Hips, Role::LeftThigh, Role::RightThigh] {
        if take.roles.joint(role).is_none() {
            return Err(FitError::Missing(role));
        }
    }
    let mut fit = SkeletonSolver::new(take);
    let frames: Vec<MeasuredJoints> = (0..take.clip.frames)
        .map(|frame| fit.targets(frame))
        .collect();
    fit.measure(&frames);
    if fit.offsets.is_empty() {
        return Err(FitError::Unseen);
    }
    Ok(fit.run(&frames))
}

/// Measured positions of the joints in a frame; `None` where they were not.
type MeasuredJoints = Vec<Option<Vec3>>;

struct SkeletonSolver<'a> {
    take: &'a Take,
    /// Those of [`BONES`] that are there, parents first, and the parent of each among these.
    bones: Vec<usize>,
    parents: Vec<Option<usize>>,
    offsets: Vec<Vec3>,
    /// For each joint those behind it, itself left out.
    behind: Vec<Vec<usize>>,
}

impl<'a> SkeletonSolver<'a> {
    fn new(take: &'a Take) -> Self {
        let mut bones: Vec<usize> = (0..BONES.len())
            .filter(|&b| take.roles.joint(BONES[b].0).is_some())
            .collect();
        let has = |bones: &[usize], role: Role| bones.iter().position(|&b| BONES[b].0 == role);
        // A bone whose parent is unknown hangs on nothing and is left out.
        let mut at = 0;
        while at < bones.len() {
            let parents = BONES[bones[at]].2;
            let hangs =
                parents.is_empty() || parents.iter().any(|&p| has(&bones[..at], p).is_some());
            if hangs {
                at += 1;
            } else {
                bones.remove(at);
            }
        }
        let parent = |&b: &usize| BONES[b].2.iter().find_map(|&p| has(&bones, p));
        let parents: Vec<Option<usize>> = bones.iter().map(parent).collect();
        let mut behind = vec![Vec::new(); bones.len()];
        for joint in 0..bones.len() {
            let mut above = parents[joint];
            while let Some(ancestor) = above {
                behind[ancestor].push(joint);
                above = parents[ancestor];
            }
        }
        Self {
            take,
            bones,
            parents,
            offsets: Vec::new(),
            behind,
        }
    }

    fn targets(&self, frame: usize) -> MeasuredJoints {
        let clip = &self.take.clip;
        let pose = WorldPose::of(clip, frame);
        let target = |&bone: &usize| {
            let joint = self.take.roles.joint(BONES[bone].0)?;
            (!clip.is_gap_at(joint, frame)).then(|| pose.positions[joint])
        };
        self.bones.iter().map(target).collect()
    }

    /// FittedBone lengths and the shapes of pelvis and chest, as medians over the frames.
    fn measure(&mut self, frames: &[MeasuredJoints]) {
        let seen = frames.iter().any(|targets| targets[0].is_some());
        if !seen {
            return;
        }
        for joint in 0..self.bones.len() {
            let offset = match self.parents[joint] {
                None => Vec3::zeros(),
                Some(parent) => self.offset(joint, parent, frames),
            };
            self.offsets.push(offset);
        }
    }

    fn offset(&self, joint: usize, parent: usize, frames: &[MeasuredJoints]) -> Vec3 {
        let between = |targets: &MeasuredJoints| Some(targets[joint]? - targets[parent]?);
        let usual = Vec3::from(BONES[self.bones[joint]].3);
        let siblings = self.parents.iter().filter(|p| **p == Some(parent)).count();
        if siblings < 2 {
            let lengths = frames.iter().filter_map(|t| Some(between(t)?.norm()));
            return usual * median(lengths.collect()).unwrap_or(0.0);
        }
        // In axes of the body: to the left, upwards, forwards.
        let mut own: [Vec<f64>; 3] = Default::default();
        for targets in frames {
            let (Some(axes), Some(between)) = (self.axes(targets, parent), between(targets)) else {
                continue;
            };
            let local = axes.transpose() * between;
            own.iter_mut()
                .zip(local.iter())
                .for_each(|(all, value)| all.push(*value));
        }
        let [x, y, z] = own.map(median);
        match (x, y, z) {
            (Some(x), Some(y), Some(z)) => Vec3::new(x, y, z),
            _ => Vec3::zeros(),
        }
    }

    /// Left, up and forward of the part of the body about `joint`: by the hip joints at the hips, by the shoulders above.
    fn axes(&self, targets: &MeasuredJoints, joint: usize) -> Option<Matrix3<f64>> {
        let at = |role: Role| {
            let place = self.bones.iter().position(|&b| BONES[b].0 == role)?;
            targets[place]
        };
        let pair = match BONES[self.bones[joint]].0 {
            Role::Hips => [Role::LeftThigh, Role::RightThigh],
            _ => [Role::LeftArm, Role::RightArm],
        };
        let across = match (at(pair[0]), at(pair[1])) {
            (Some(left), Some(right)) => left - right,
            _ => at(Role::LeftThigh)? - at(Role::RightThigh)?,
        };
        let hips = (at(Role::LeftThigh)? + at(Role::RightThigh)?) / 2.0;
        let top = at(Role::Neck)
            .or_else(|| Some((at(Role::LeftArm)? + at(Role::RightArm)?) / 2.0))
            .or_else(|| at(Role::Torso))
            .or_else(|| at(Role::Head))
            // Of legs alone, the knees say where down is.
            .or_else(|| Some(hips * 2.0 - (at(Role::LeftShin)? + at(Role::RightShin)?) / 2.0))?;
        let left = across.try_normalize(1e-9)?;
        let up = top - hips;
        let up = (up - left * up.dot(&left)).try_normalize(1e-9)?;
        Some(Matrix3::from_columns(&[left, up, left.cross(&up)]))
    }

    fn run(self, frames: &[MeasuredJoints]) -> SkeletonFit {
        let joints = self.bones.len();
        let mut pose = SolvedPose {
            locals: vec![Quat::identity(); joints],
            root: Vec3::zeros(),
            world: WorldPose::default(),
        };
        let mut rotations = Vec::with_capacity(joints * frames.len());
        let mut places = Vec::with_capacity(frames.len());
        let mut squares = vec![(0.0, 0usize); joints];
        for targets in frames {
            self.fit_frame(targets, &mut pose);
            rotations.extend_from_slice(&pose.locals);
            places.push(pose.root);
            for ((sum, count), (target, at)) in squares
                .iter_mut()
                .zip(targets.iter().zip(&pose.world.positions))
            {
                if let Some(target) = target {
                    *sum += (target - at).norm_squared();
                    *count += 1;
                }
            }
        }
        let total: f64 = squares.iter().map(|s| s.0).sum();
        let count: usize = squares.iter().map(|s| s.1).sum();
        let root_mean = |&(sum, count): &(f64, usize)| (sum / count.max(1) as f64).sqrt();
        let worst = (0..joints)
            .max_by(|&a, &b| root_mean(&squares[a]).total_cmp(&root_mean(&squares[b])))
            .unwrap_or(0);
        let skeleton = (0..joints).map(|j| Joint {
            name: BONES[self.bones[j]].1.to_owned(),
            parent: self.parents[j],
            offset: self.offsets[j],
            tip: None,
        });
        let mut roles = RoleMap::default();
        for (joint, &bone) in self.bones.iter().enumerate() {
            roles.set(BONES[bone].0, Some(joint));
        }
        SkeletonFit {
            clip: Clip::of_chain(&self.take.clip, skeleton.collect(), rotations, places),
            roles,
            rms_metres: (total / count.max(1) as f64).sqrt(),
            worst: (BONES[self.bones[worst]].0, root_mean(&squares[worst])),
        }
    }

    /// Turns `pose`, that of the frame before, into that of `targets`.
    fn fit_frame(&self, targets: &MeasuredJoints, pose: &mut SolvedPose) {
        let mut before = f64::INFINITY;
        for _ in 0..ROUNDS {
            self.shift(targets, pose);
            for joint in 0..self.bones.len() {
                self.turn(joint, targets, pose);
            }
            let now = self.shift(targets, pose);
            if now >= before * (1.0 - GAIN) || now < 1e-12 {
                break;
            }
            before = now;
        }
    }

    /// Moves the whole body to where its joints are nearest to their targets; the sum of squares there.
    fn shift(&self, targets: &MeasuredJoints, pose: &mut SolvedPose) -> f64 {
        pose.set(self);
        let off: Vec<Vec3> = targets
            .iter()
            .zip(&pose.world.positions)
            .filter_map(|(target, at)| Some((*target)? - at))
            .collect();
        if off.is_empty() {
            return 0.0;
        }
        let mean = off.iter().sum::<Vec3>() / off.len() as f64;
        pose.root += mean;
        pose.set(self);
        off.iter().map(|off| (off - mean).norm_squared()).sum()
    }

    /// Turns one joint so that those behind it are nearest to their targets.
    fn turn(&self, joint: usize, targets: &MeasuredJoints, pose: &mut SolvedPose) {
        let centre = pose.world.positions[joint];
        let mut sum = Matrix3::zeros();
        let mut weight = 0.0;
        for &behind in &self.behind[joint] {
            let Some(target) = targets[behind] else {
                continue;
            };
            let (from, to) = (pose.world.positions[behind] - centre, target - centre);
            sum += to * from.transpose();
            weight += from.norm() * to.norm();
        }
        if weight <= 0.0 {
            return;
        }
        // Three directions that would rather stay where they are.
        sum += Matrix3::identity() * (HOLD * weight);
        let Some(turn) = nearest_rotation(&sum) else {
            return;
        };
        let world = turn * pose.world.rotations[joint];
        let parent = self.parents[joint].map_or_else(Quat::identity, |p| pose.world.rotations[p]);
        pose.locals[joint] = Quat::new_normalize((parent.inverse() * world).into_inner());
        pose.set(self);
    }
}

/// A pose of the skeleton.
struct SolvedPose {
    locals: Vec<Quat>,
    root: Vec3,
    world: WorldPose,
}

impl SolvedPose {
    fn set(&mut self, fit: &SkeletonSolver<'_>) {
        self.world.positions.clear();
        self.world.rotations.clear();
        for (joint, local) in self.locals.iter().enumerate() {
            let place = match joint {
                0 => self.root,
                _ => fit.offsets[joint],
            };
            self.world.add(fit.parents[joint], place, *local);
        }
    }
}

/// The rotation `R` for which the trace of `Rᵀ sum` is largest (Kabsch 1976).
fn nearest_rotation(sum: &Matrix3<f64>) -> Option<Quat> {
    let svd = sum.try_svd(true, true, 1e-14, 100)?;
    let (u, v_t) = (svd.u?, svd.v_t?);
    let mut signs = Matrix3::identity();
    if (u * v_t).determinant() < 0.0 {
        // The axis with the least weight is turned back.
        let least = svd.singular_values.imin();
        signs[(least, least)] = -1.0;
    }
    let rotation = nalgebra::Rotation3::from_matrix_unchecked(u * signs * v_t);
    Some(Quat::from_rotation_matrix(&rotation)).filter(|q| q.coords.iter().all(|v| v.is_finite()))
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

#[cfg(test)]
mod tests;
