//! The skeleton that a set of bones makes, and substitutes for bones that are not sent.

use morec::clip::{Joint, Skeleton};
use morec::humanoid::{
    BoneMask, HUMANOID, HUMANOID_BONES, bone_of_name, parent_among, standard_offset,
};
use morec::live::Rig;
use morec::math::Vec3;
use morec::roles::{Role, RoleMap};

/// A neck for senders that have none: it moves with the bone that the head hangs on, and lies on the way to the head
/// as far along as a neck does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct AssumedNeck {
    /// The bone that it moves with.
    pub(super) parent: usize,
    /// Position along the way to the head, 0 … 1.
    pub(super) share: f64,
}

const HEAD: &str = "Head";
const NECK: &str = "Neck";

/// The head's number, and the neck that must be assumed among the bones of `mask`, if one must.
pub(super) fn assumed_neck(mask: BoneMask) -> Option<(usize, AssumedNeck)> {
    let (head, neck) = (bone_of_name(HEAD)?, bone_of_name(NECK)?);
    let sent = |bone: usize| mask >> bone & 1 == 1;
    if sent(neck) || !sent(head) {
        return None;
    }
    let parent = parent_among(head, mask)?;
    let share =
        standard_offset(neck, Some(parent)).norm() / standard_offset(head, Some(parent)).norm();
    Some((head, AssumedNeck { parent, share }))
}

/// Bones that stand for the trunk if its own bone is not sent.
const TRUNK: [&str; 3] = ["Spine", "Chest", "UpperChest"];

/// Senders without lengths send zeros; a body has none of these.
pub(super) fn local_position(bone: usize, parent: Option<usize>, sent: Vec3) -> Vec3 {
    if parent.is_some() && sent.norm() < 1e-6 {
        standard_offset(bone, parent)
    } else {
        sent
    }
}

pub(super) fn bones_of(mask: BoneMask) -> impl Iterator<Item = usize> {
    (0..HUMANOID_BONES).filter(move |bone| mask >> bone & 1 == 1)
}

/// The place of `bone` among the bones of `mask`.
pub(super) fn place(mask: BoneMask, bone: usize) -> usize {
    (mask & ((1 << bone) - 1)).count_ones() as usize
}

/// The rig of the bones in `mask`, which are at `positions` in their parents' frames.
pub(super) fn rig_of(mask: BoneMask, positions: impl Fn(usize) -> Vec3) -> Rig {
    let mut roles = RoleMap::default();
    let joint = |bone: usize| {
        let parent = parent_among(bone, mask);
        let offset = local_position(bone, parent, positions(bone));
        let parent = parent.map(|parent| place(mask, parent));
        Joint {
            name: HUMANOID[bone].name.to_owned(),
            parent,
            offset,
            tip: None,
        }
    };
    let mut joints: Vec<Joint> = bones_of(mask).map(joint).collect();
    for (place, joint) in joints.iter().enumerate() {
        if let Some(role) = bone_of_name(&joint.name).and_then(|bone| HUMANOID[bone].role) {
            roles.set(role, Some(place));
        }
    }
    if roles.joint(Role::Torso).is_none() {
        let trunk = TRUNK
            .iter()
            .find_map(|name| joints.iter().position(|joint| joint.name == *name));
        roles.set(Role::Torso, trunk);
    }
    if let Some((head, AssumedNeck { parent, share })) = assumed_neck(mask) {
        roles.set(Role::Neck, Some(joints.len()));
        let offset = local_position(head, Some(parent), positions(head)) * share;
        let parent = Some(place(mask, parent));
        joints.push(Joint {
            name: NECK.to_owned(),
            parent,
            offset,
            tip: None,
        });
    }
    // Parents come first in the table, so this cannot fail.
    Rig {
        skeleton: Skeleton::new(joints).unwrap_or_default(),
        roles,
    }
}
