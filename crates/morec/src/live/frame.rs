//! Values that a live source delivers: a skeleton, and frames posed in the world.

use crate::clip::{Joint, Skeleton};
use crate::features::{BoneSet, KeyPose};
use crate::kinematics::WorldPose;
use crate::math::{Quat, Vec3};
use crate::roles::{Role, RoleMap};

/// Number of a source's performer, from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub struct PerformerId(pub u16);

impl PerformerId {
    /// Its place in a list of performers.
    pub fn index(self) -> usize {
        usize::from(self.0)
    }
}

/// A source's skeleton, and which of its joints plays which part. Frames that follow are poses of it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Rig {
    /// The joints, parents first.
    pub skeleton: Skeleton,
    /// Joint of each role.
    pub roles: RoleMap,
}

impl Rig {
    /// For sources that know the joints by their roles: joint `i` plays `Role::ALL[i]`, nothing hangs together.
    pub fn of_roles() -> Self {
        let joint = |role: Role| Joint {
            name: role.name().to_owned(),
            parent: None,
            offset: Vec3::zeros(),
            tip: None,
        };
        let skeleton = Skeleton::new(Role::ALL.map(joint).to_vec()).unwrap_or_default();
        let mut roles = RoleMap::default();
        for role in Role::ALL {
            roles.set(role, Some(role.index()));
        }
        Self { skeleton, roles }
    }

    /// The bones that this skeleton shows in `pose`: both ends are known and lie apart.
    pub fn bones(&self, pose: &KeyPose) -> BoneSet {
        BoneSet::of_pose(pose)
    }
}

/// One performer's pose at one instant, as it travels from a source to recognition; reused from frame to frame.
///
/// Right-handed, Y up, one unit of length throughout. Rotations travel along for methods that look at them; the
/// template recogniser looks at [`key_pose`](Frame::key_pose) only.
#[derive(Debug, Clone, Default)]
pub struct Frame {
    /// When it was, on the source's clock, seconds.
    pub time_secs: f64,
    /// When its last part arrived: [`wall_now_secs`](super::wall_now_secs) then.
    pub wall_secs: f64,
    /// The performer it shows.
    pub actor: PerformerId,
    /// Joints of the rig that was announced last, one position each. A joint that is unknown at this instant has a
    /// position that is not a number. Rotations are empty if the source knows positions only.
    pub pose: WorldPose,
}

impl Frame {
    /// Positions of the role joints, which templates compare.
    pub fn key_pose(&self, rig: &Rig) -> KeyPose {
        let mut key = KeyPose::default();
        for (role, joint) in rig.roles.played() {
            if let Some(position) = self.pose.positions.get(joint) {
                key.set(role, *position);
            }
        }
        key
    }

    /// Takes the poses of a source that knows roles: joints as in [`Rig::of_roles`], positions only.
    pub fn set_key_pose(&mut self, pose: &KeyPose) {
        let unknown = Vec3::repeat(f64::NAN);
        self.pose.rotations.clear();
        self.pose.positions.clear();
        self.pose
            .positions
            .extend(Role::ALL.map(|role| pose.get(role).unwrap_or(unknown)));
    }

    /// Makes room for `joints` joints, all unknown and unturned.
    pub fn clear(&mut self, joints: usize) {
        self.pose.positions.clear();
        self.pose.positions.resize(joints, Vec3::repeat(f64::NAN));
        self.pose.rotations.clear();
        self.pose.rotations.resize(joints, Quat::identity());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_pose_comes_through_a_frame_unchanged() {
        let mut pose = KeyPose::default();
        pose.set(Role::Hips, Vec3::new(1.0, 2.0, 3.0));
        pose.set(Role::LeftHand, Vec3::new(0.5, 0.0, -1.0));
        let mut frame = Frame::default();
        frame.clear(3);
        frame.set_key_pose(&pose);
        assert_eq!(frame.key_pose(&Rig::of_roles()), pose);
    }
}
