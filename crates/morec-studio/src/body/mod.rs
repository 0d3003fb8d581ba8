//! A performer as limbs: which joints a limb joins, how thick it is, which side it belongs to.

mod aligned;
pub mod camera;
mod clip_motion;
pub mod companion;
pub mod mesh;
pub mod strip;

use morec::clip::Clip;
use morec::features::{ALL_BONES, BoneSet, Hand, Profile};
use morec::kinematics::WorldPose;
use morec::math::Vec3;
use morec::roles::{BODY_LINES, Role, RoleMap};

pub use aligned::Aligned;
pub use camera::Camera;
pub use clip_motion::{ClipMotion, extent};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BodySide {
    Left,
    Right,
    Middle,
}

/// A limb from one joint to another.
#[derive(Debug, Clone, PartialEq)]
pub struct LimbShape {
    pub from: usize,
    pub to: usize,
    /// Radii at both ends, in heights of the body.
    pub radii: [f64; 2],
    pub side: BodySide,
}

/// Limbs and proportions of a performer.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Body {
    pub limbs: Vec<LimbShape>,
    /// The joint of the head, which is drawn as a ball in front of it.
    pub head: Option<(usize, Option<usize>)>,
    pub hips: Option<usize>,
    pub hip_joints: Option<(usize, usize)>,
    /// From the lowest joint to the highest, metres.
    pub height: f64,
    /// Hands without a body.
    pub is_hand: bool,
}

impl Body {
    /// The body of a clip, measured in frame `frame`.
    pub fn of(clip: &Clip, roles: &RoleMap, frame: usize) -> Self {
        if clip.frames == 0 {
            return Self::default();
        }
        let pose = WorldPose::of(clip, frame);
        let parents: Vec<Option<usize>> = clip.skeleton.joints().iter().map(|j| j.parent).collect();
        Self::new(&parents, roles, &pose)
    }

    /// The body of a skeleton with these `parents` of its joints, measured in `pose`.
    pub fn new(parents: &[Option<usize>], roles: &RoleMap, pose: &WorldPose) -> Self {
        let height = height(&pose.positions, roles.profile());
        let flat = parents.iter().all(Option::is_none);
        let mut limbs = Vec::new();
        let mut add = |from: usize, to: usize| {
            let kind = LimbPart::of(from, to, parents, roles);
            limbs.push(LimbShape {
                from,
                to,
                radii: kind.radii(),
                side: side(from, to, parents, roles),
            });
        };
        if flat {
            let chest = roles.joint(Role::Torso);
            let bones = BODY_LINES.into_iter().map(|line| match (line, chest) {
                // The trunk goes by the chest if there is one.
                ((Role::Hips, Role::Neck), Some(_)) => (Role::Torso, Role::Neck),
                _ => line,
            });
            let is_known = |role: Role| roles.joint(role).is_some();
            let hands = Hand::BOTH.into_iter().flat_map(|hand| hand.lines(is_known));
            let custom = BoneSet::CUSTOM.indices().map(|bone| ALL_BONES[bone]);
            let custom = custom.map(|bone| (bone.from, bone.to));
            for (from, to) in bones.chain(hands).chain(custom) {
                if let (Some(from), Some(to)) = (roles.joint(from), roles.joint(to)) {
                    add(from, to);
                }
            }
        } else {
            for (joint, parent) in parents.iter().enumerate() {
                if let Some(parent) = *parent {
                    add(parent, joint);
                }
            }
        }
        let of = |role| roles.joint(role);
        Self {
            limbs,
            head: of(Role::Head).map(|head| (head, of(Role::Neck))),
            hips: of(Role::Hips)
                .or_else(|| wrist(roles))
                .or((!parents.is_empty()).then_some(0)),
            is_hand: is_hand(roles),
            hip_joints: of(Role::LeftThigh).zip(of(Role::RightThigh)),
            height,
        }
    }

    /// Position of the hips in `pose`.
    pub fn centre(&self, pose: &WorldPose) -> Option<Vec3> {
        let at = pose.positions.get(self.hips?)?;
        at.iter().all(|v| v.is_finite()).then_some(*at)
    }

    /// Heading of the performer in `pose`: an angle about the vertical in radians, 0 is +Z.
    pub fn heading(&self, pose: &WorldPose) -> Option<f64> {
        let (left, right) = self.hip_joints?;
        let across = pose.positions.get(left)? - pose.positions.get(right)?;
        // Left is at +X of somebody who faces +Z.
        let heading = (-across.z).atan2(across.x);
        heading.is_finite().then_some(heading)
    }
}

fn is_hand(roles: &RoleMap) -> bool {
    matches!(roles.profile(), Profile::Hand | Profile::Hands)
}

/// The wrist, or else the palm, of a hand without a body.
fn wrist(roles: &RoleMap) -> Option<usize> {
    let points = Hand::BOTH.map(Hand::points);
    let mut places = points.iter().flat_map(|hand| [hand.wrist, hand.palm]);
    places
        .find_map(|role| roles.joint(role))
        .filter(|_| is_hand(roles))
}

fn height(positions: &[Vec3], profile: Profile) -> f64 {
    if matches!(profile, Profile::Hand | Profile::Hands) {
        return HAND_M;
    }
    let heights = || positions.iter().map(|p| p.y).filter(|y| y.is_finite());
    let span = heights().fold(f64::MIN, f64::max) - heights().fold(f64::MAX, f64::min);
    if span.is_finite() && span > 0.3 {
        span
    } else {
        1.7
    }
}

/// Hands are drawn in this size, whatever their pose: from the wrist to the fingertips, metres.
const HAND_M: f64 = 0.19;

/// Part of the body that a limb is.
#[derive(Debug, Clone, Copy, PartialEq)]
enum LimbPart {
    Trunk,
    Pelvis,
    Neck,
    Clavicle,
    UpperArm,
    Forearm,
    Hand,
    Thigh,
    Shin,
    Foot,
    Small,
    /// Of a hand that is drawn alone.
    Finger,
}

impl LimbPart {
    fn of(from: usize, to: usize, parents: &[Option<usize>], roles: &RoleMap) -> Self {
        use Role::*;
        let is =
            |joint: usize, wanted: &[Role]| wanted.iter().any(|r| roles.joint(*r) == Some(joint));
        if matches!(roles.profile(), Profile::Hand | Profile::Hands) {
            return LimbPart::Finger;
        }
        if is(to, &[LeftThigh, RightThigh]) {
            return LimbPart::Pelvis;
        }
        if is(to, &[LeftArm, RightArm, LeftShoulder, RightShoulder]) {
            return LimbPart::Clavicle;
        }
        if is(to, &[Head]) || is(from, &[Neck]) {
            return LimbPart::Neck;
        }
        // The nearest joint above that plays a role says which limb this is a part of.
        let mut at = Some(from);
        while let Some(joint) = at {
            let kinds: [(&[Role], LimbPart); 9] = [
                (&[LeftThigh, RightThigh], LimbPart::Thigh),
                (&[LeftShin, RightShin], LimbPart::Shin),
                (&[LeftFoot, RightFoot], LimbPart::Foot),
                (&[LeftArm, RightArm], LimbPart::UpperArm),
                (&[LeftForearm, RightForearm], LimbPart::Forearm),
                (&[LeftHand, RightHand], LimbPart::Hand),
                (&[LeftShoulder, RightShoulder], LimbPart::Clavicle),
                (&[Head], LimbPart::Small),
                (&[Hips, Torso], LimbPart::Trunk),
            ];
            if let Some((_, kind)) = kinds.iter().find(|(wanted, _)| is(joint, wanted)) {
                // Fingers and toes beyond the first joint are thin.
                let end = matches!(kind, LimbPart::Hand | LimbPart::Foot);
                return if end && joint != from {
                    LimbPart::Small
                } else {
                    *kind
                };
            }
            at = parents.get(joint).copied().flatten();
        }
        LimbPart::Small
    }

    /// In heights of the body.
    fn radii(self) -> [f64; 2] {
        match self {
            LimbPart::Trunk => [0.062, 0.066],
            LimbPart::Pelvis => [0.052, 0.046],
            LimbPart::Neck => [0.030, 0.026],
            LimbPart::Clavicle => [0.040, 0.032],
            LimbPart::UpperArm => [0.029, 0.023],
            LimbPart::Forearm => [0.023, 0.016],
            LimbPart::Hand => [0.017, 0.012],
            LimbPart::Thigh => [0.045, 0.032],
            LimbPart::Shin => [0.031, 0.021],
            LimbPart::Foot => [0.023, 0.016],
            LimbPart::Small => [0.008, 0.006],
            LimbPart::Finger => [0.04, 0.035],
        }
    }
}

fn side(from: usize, to: usize, parents: &[Option<usize>], roles: &RoleMap) -> BodySide {
    use Role::*;
    const LEFT: [Role; 8] = [
        LeftThigh,
        LeftShin,
        LeftFoot,
        LeftShoulder,
        LeftArm,
        LeftForearm,
        LeftHand,
        LeftArm,
    ];
    const RIGHT: [Role; 8] = [
        RightThigh,
        RightShin,
        RightFoot,
        RightShoulder,
        RightArm,
        RightForearm,
        RightHand,
        RightArm,
    ];
    let played = roles.played().filter(|(_, joint)| *joint == to);
    match played.filter_map(|(role, _)| Hand::of(role)).next() {
        Some(Hand::Left) => return BodySide::Left,
        Some(Hand::Right) => return BodySide::Right,
        None => {}
    }
    let mut at = Some(to);
    let mut first = true;
    while let Some(joint) = at {
        if LEFT.iter().any(|r| roles.joint(*r) == Some(joint)) {
            return BodySide::Left;
        }
        if RIGHT.iter().any(|r| roles.joint(*r) == Some(joint)) {
            return BodySide::Right;
        }
        at = match first {
            true => Some(from),
            false => parents.get(joint).copied().flatten(),
        };
        first = false;
    }
    BodySide::Middle
}
