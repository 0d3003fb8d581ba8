//! Joints of a skeleton that play pivots.

use mocap::clip::{Clip, Skeleton};
use mocap::kinematics::WorldPose;
use mocap::roles::{Role, RoleMap};

use super::{Pivot, PivotPose, PivotSet};

/// Why nothing can be said of the poses of a skeleton.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NoPivots {
    /// No joint plays the root pivot.
    #[error("no joint for the root pivot {pivot}: expected one of the joints [{}]{}", .joints.join(", "), role_hint(.role))]
    Root {
        /// The root pivot's name.
        pivot: String,
        /// Joint names that would have played it.
        joints: Vec<String>,
        /// The role that would have.
        role: Option<Role>,
    },
    /// The clip is one of points.
    #[error(
        "the method svrdm needs joint rotations, but the input has positions only: use the method templates"
    )]
    Rotations,
}

fn role_hint(role: &Option<Role>) -> String {
    role.map_or_else(String::new, |role| format!(" or the role {role}"))
}

/// For each pivot of a set, the joint of a skeleton that plays it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PivotMap {
    joints: Vec<Option<usize>>,
    parents: Vec<usize>,
    missing: Vec<String>,
}

impl PivotMap {
    /// [`resolve`](Self::resolve) on the skeleton of a clip.
    ///
    /// # Errors
    /// As there, or the clip is one of points, which have no rotations.
    pub fn of_clip(set: &PivotSet, clip: &Clip, roles: &RoleMap) -> Result<Self, NoPivots> {
        if !clip.has_rotations() {
            return Err(NoPivots::Rotations);
        }
        Self::resolve(set, &clip.skeleton, roles)
    }

    /// Finds the pivots of `set` on `skeleton`: by joint name, and by role where no joint has one of the names or
    /// the joint of that name plays another role (`LeftShoulder` is a collar here and an upper arm there). A joint
    /// plays one pivot at most. O(pivots · joints).
    ///
    /// # Errors
    /// Nothing plays the root. Other pivots may be [`missing`](PivotMap::missing).
    pub fn resolve(set: &PivotSet, skeleton: &Skeleton, roles: &RoleMap) -> Result<Self, NoPivots> {
        let mut joints: Vec<Option<usize>> = Vec::with_capacity(set.len());
        for pivot in set.pivots() {
            let joint =
                player(pivot, skeleton, roles).filter(|&joint| !joints.contains(&Some(joint)));
            joints.push(joint);
        }
        let root = &set.pivots()[0];
        if joints[0].is_none() {
            let (pivot, joints) = (root.name.clone(), root.joints.clone());
            return Err(NoPivots::Root {
                pivot,
                joints,
                role: root.role,
            });
        }
        let unplayed = set
            .pivots()
            .iter()
            .zip(&joints)
            .filter(|(_, joint)| joint.is_none());
        let missing = unplayed.map(|(pivot, _)| pivot.name.clone()).collect();
        Ok(Self {
            parents: (0..set.len()).map(|p| set.parent(p)).collect(),
            joints,
            missing,
        })
    }

    /// The joint that plays pivot `index`.
    #[inline]
    pub fn joint(&self, index: usize) -> Option<usize> {
        self.joints[index]
    }

    /// Names of the pivots that nothing plays. In poses they turn with their parents: their part of a row is the
    /// identity, and what lies below them is taken relative to the next pivot above.
    pub fn missing(&self) -> &[String] {
        &self.missing
    }

    /// The pivots of a posed skeleton. O(pivots), takes no memory.
    pub fn pose(&self, pose: &WorldPose) -> PivotPose {
        let mut pivots = PivotPose::default();
        for (index, joint) in self.joints.iter().enumerate() {
            let rotation = match joint {
                Some(joint) => Some(pose.rotations[*joint]),
                None => pivots.get(self.parents[index]).copied(),
            };
            if let Some(rotation) = rotation {
                pivots.set(index, rotation);
            }
        }
        pivots
    }
}

fn player(pivot: &Pivot, skeleton: &Skeleton, roles: &RoleMap) -> Option<usize> {
    let by_role = pivot.role.and_then(|role| roles.joint(role));
    let other_role = |joint| {
        Role::ALL
            .into_iter()
            .any(|r| Some(r) != pivot.role && roles.joint(r) == Some(joint))
    };
    match named(pivot, skeleton) {
        Some(joint) if by_role.is_some() && other_role(joint) => by_role,
        Some(joint) => Some(joint),
        None => by_role,
    }
}

/// The joint of one of the pivot's names: spelt so, or so but for namespace and case.
fn named(pivot: &Pivot, skeleton: &Skeleton) -> Option<usize> {
    let bare = |name: &str| {
        name.rsplit(':')
            .next()
            .unwrap_or(name)
            .trim()
            .to_lowercase()
    };
    let exact = pivot.joints.iter().find_map(|name| skeleton.find(name));
    exact.or_else(|| {
        let mut names = pivot.joints.iter().map(|name| bare(name));
        names.find_map(|name| {
            skeleton
                .joints()
                .iter()
                .position(|joint| bare(&joint.name) == name)
        })
    })
}
