//! Makes a connected skeleton of recorded positions and rotations.

use crate::clip::{Clip, Joint, JointTrack, Skeleton};
use crate::features::Hand;
use crate::math::{Quat, Vec3, same_hemisphere, slerp};
use crate::roles::Role;

use crate::live::{Frame, Rig};

/// A joint whose place in its parent's frame strays by less than this does not move there, in the stream's unit.
const FIXED: f64 = 1e-4;
/// Joints of a clip: which of the stream's they are, and how they hang together.
pub(super) struct RecordedJoints {
    /// The stream's joint, for each of the clip's.
    from: Vec<usize>,
    joints: Vec<Joint>,
    turned: bool,
}

impl RecordedJoints {
    /// The joints that `frames` of `rig` show; `None` if they show none.
    pub(super) fn of(rig: &Rig, frames: &[Frame]) -> Option<Self> {
        let skeleton = &rig.skeleton;
        let seen = |joint: usize| {
            frames
                .iter()
                .any(|frame| is_place(&frame.pose.positions[joint]))
        };
        let any = (0..skeleton.len()).any(seen);
        let flat = skeleton.len() > 1 && skeleton.joints().iter().all(|j| j.parent.is_none());
        let turned = frames
            .iter()
            .all(|frame| frame.pose.rotations.len() == skeleton.len());
        let mut tree = if flat {
            Self::of_roles(rig, &seen)
        } else {
            Self {
                from: (0..skeleton.len()).collect(),
                joints: skeleton.joints().to_vec(),
                turned,
            }
        };
        // Places alone say nothing about how a joint is turned.
        tree.turned = turned && !flat;
        (any && !tree.joints.is_empty()).then_some(tree)
    }

    /// A body of the roles that were seen.
    fn of_roles(rig: &Rig, seen: &dyn Fn(usize) -> bool) -> Self {
        let played = |role: Role| rig.roles.joint(role).filter(|joint| seen(*joint));
        let mut at = [None; Role::COUNT];
        let (mut from, mut joints) = (Vec::new(), Vec::<Joint>::new());
        let points = Role::ALL.into_iter().filter(|role| !role.is_of_body());
        let points = points.map(|role| (role, role.name()));
        for (role, name) in NAMES.into_iter().chain(points) {
            let Some(joint) = played(role) else { continue };
            let above = std::iter::successors(above(role), |role| above(*role));
            let parent = above.filter_map(|role| at[role.index()]).next();
            at[role.index()] = Some(joints.len());
            from.push(joint);
            joints.push(Joint {
                name: name.to_owned(),
                // Whatever nothing hangs on hangs on the first.
                parent: parent.or((!joints.is_empty()).then_some(0)),
                offset: Vec3::zeros(),
                tip: None,
            });
        }
        Self {
            from,
            joints,
            turned: false,
        }
    }

    /// `count` frames at `rate_hz` of what was recorded.
    pub(super) fn clip(self, frames: &[Frame], name: &str, rate_hz: f64, count: usize) -> Clip {
        let n = self.joints.len();
        let places: Vec<Option<Vec<Vec3>>> = (0..n)
            .map(|j| places(frames, self.from[j], rate_hz, count))
            .collect();
        let world: Vec<Vec<Quat>> = (0..n)
            .map(|j| match self.turned {
                true => rotations(frames, self.from[j], rate_hz, count),
                false => vec![Quat::identity(); count],
            })
            .collect();
        let (mut joints, mut tracks) = (self.joints, Vec::new());
        for j in 0..n {
            let Some(own) = &places[j] else { continue };
            let parent = joints[j].parent;
            let local = |f: usize| match parent.map(|p| (places[p].as_deref(), &world[p])) {
                Some((Some(above), turned)) => turned[f].inverse() * (own[f] - above[f]),
                // Its parent was never seen: there is no place to take it from.
                Some((None, _)) => joints[j].offset,
                None => own[f],
            };
            let positions: Vec<Vec3> = (0..count).map(local).collect();
            let mean = positions.iter().sum::<Vec3>() / count as f64;
            joints[j].offset = if parent.is_some() {
                mean
            } else {
                Vec3::zeros()
            };
            if parent.is_none() || positions.iter().any(|p| (p - mean).norm() > FIXED) {
                tracks.push(JointTrack {
                    joint: j,
                    positions,
                });
            }
        }
        Clip {
            name: name.to_owned(),
            rotations: locals(&joints, &world, count),
            skeleton: Skeleton::new(joints).unwrap_or_default(),
            rate_hz,
            tracks,
            frames: count,
            repaired: Vec::new(),
            points: None,
        }
    }
}

/// `parent_from_joint`, frame by frame, from `world_from_joint` of each joint.
fn locals(joints: &[Joint], world: &[Vec<Quat>], count: usize) -> Vec<Quat> {
    let n = joints.len();
    let mut locals = vec![Quat::identity(); count * n];
    for (j, joint) in joints.iter().enumerate() {
        let mut last = Quat::identity();
        for f in 0..count {
            let above = joint.parent.map_or(Quat::identity(), |p| world[p][f]);
            last = same_hemisphere(&last, above.inverse() * world[j][f]);
            locals[f * n + j] = last;
        }
    }
    locals
}

/// Roles in an order in which what carries comes first, under the names that joints of BVH files have.
const NAMES: [(Role, &str); Role::BODY_COUNT] = [
    (Role::Hips, "Hips"),
    (Role::Torso, "Spine"),
    (Role::Neck, "Neck"),
    (Role::Head, "Head"),
    (Role::LeftShoulder, "LeftShoulder"),
    (Role::LeftArm, "LeftArm"),
    (Role::LeftForearm, "LeftForeArm"),
    (Role::LeftHand, "LeftHand"),
    (Role::RightShoulder, "RightShoulder"),
    (Role::RightArm, "RightArm"),
    (Role::RightForearm, "RightForeArm"),
    (Role::RightHand, "RightHand"),
    (Role::LeftThigh, "LeftUpLeg"),
    (Role::LeftShin, "LeftLeg"),
    (Role::LeftFoot, "LeftFoot"),
    (Role::RightThigh, "RightUpLeg"),
    (Role::RightShin, "RightLeg"),
    (Role::RightFoot, "RightFoot"),
];

/// The role that carries another.
fn above(role: Role) -> Option<Role> {
    use Role::*;
    for hand in Hand::BOTH.map(Hand::points) {
        if role == hand.palm {
            return Some(hand.wrist);
        }
        let mut fingers = hand.fingers.iter();
        if let Some(finger) = fingers.find(|finger| finger.contains(&role)) {
            let at = finger.iter().position(|point| *point == role)?;
            return Some(at.checked_sub(1).map_or(hand.palm, |at| finger[at]));
        }
    }
    Some(match role {
        Hips => return None,
        Torso | LeftThigh | RightThigh => Hips,
        Neck | LeftShoulder | RightShoulder => Torso,
        Head => Neck,
        LeftArm => LeftShoulder,
        LeftForearm => LeftArm,
        LeftHand => LeftForearm,
        RightArm => RightShoulder,
        RightForearm => RightArm,
        RightHand => RightForearm,
        LeftShin => LeftThigh,
        LeftFoot => LeftShin,
        RightShin => RightThigh,
        RightFoot => RightShin,
        _ => return None,
    })
}

/// The name of a joint of the clip of a stream of roles.
pub(super) fn name_of(role: Role) -> &'static str {
    let body = NAMES.iter().find(|(of, _)| *of == role);
    body.map_or_else(|| role.name(), |(_, name)| name)
}

fn is_place(place: &Vec3) -> bool {
    place.iter().all(|c| c.is_finite())
}

/// Positions of `joint` on the grid; `None` if it was never seen. Before the first and after the last sight it stays
/// there.
fn places(frames: &[Frame], joint: usize, rate_hz: f64, count: usize) -> Option<Vec<Vec3>> {
    let seen = |frame: &&Frame| is_place(&frame.pose.positions[joint]);
    let known: Vec<(f64, Vec3)> = frames
        .iter()
        .filter(seen)
        .map(|frame| {
            (
                frame.time_secs - frames[0].time_secs,
                frame.pose.positions[joint],
            )
        })
        .collect();
    on_grid(&known, rate_hz, count, |a, b, t| a.lerp(b, t))
}

/// Rotations of `joint` on the grid.
fn rotations(frames: &[Frame], joint: usize, rate_hz: f64, count: usize) -> Vec<Quat> {
    let seen = |frame: &&Frame| {
        frame.pose.rotations[joint]
            .coords
            .iter()
            .all(|c| c.is_finite())
    };
    let known: Vec<(f64, Quat)> = frames
        .iter()
        .filter(seen)
        .map(|frame| {
            (
                frame.time_secs - frames[0].time_secs,
                frame.pose.rotations[joint],
            )
        })
        .collect();
    on_grid(&known, rate_hz, count, slerp).unwrap_or_else(|| vec![Quat::identity(); count])
}

fn on_grid<T: Copy>(
    known: &[(f64, T)],
    rate_hz: f64,
    count: usize,
    between: impl Fn(&T, &T, f64) -> T,
) -> Option<Vec<T>> {
    let (first, mut next) = (known.first()?, 0);
    let mut at = |f: usize| {
        let secs = f as f64 / rate_hz;
        while next < known.len() && known[next].0 < secs {
            next += 1;
        }
        match (next.checked_sub(1).map(|i| known[i]), known.get(next)) {
            (Some((a_secs, a)), Some((b_secs, b))) => {
                between(&a, b, (secs - a_secs) / (b_secs - a_secs))
            }
            (Some((_, last)), None) => last,
            (None, Some((_, next))) => *next,
            (None, None) => first.1,
        }
    };
    Some((0..count).map(&mut at).collect())
}
