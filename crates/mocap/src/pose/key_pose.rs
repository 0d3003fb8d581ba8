//! Key poses: the positions of the role joints in one frame, all that recognition uses of it.

use crate::kinematics::WorldPose;
use crate::math::Vec3;
use crate::roles::{Role, RoleMap};

/// World positions of the role joints at one instant, Y up, in any one length unit.
///
/// This is what every source comes down to: files by forward kinematics, trackers that send positions directly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KeyPose {
    positions: [Vec3; Role::COUNT],
    present: u128,
}

impl Default for KeyPose {
    fn default() -> Self {
        Self {
            positions: [Vec3::zeros(); Role::COUNT],
            present: 0,
        }
    }
}

impl KeyPose {
    /// The role joints of a posed skeleton.
    pub fn of(pose: &WorldPose, roles: &RoleMap) -> Self {
        let mut key = Self::default();
        key.update(pose, roles.played());
        key
    }

    /// Puts the roles of `played` where their joints are in `pose`; the others stay.
    pub fn update(&mut self, pose: &WorldPose, played: impl IntoIterator<Item = (Role, usize)>) {
        for (role, joint) in played {
            self.set(role, pose.positions[joint]);
        }
    }

    /// Position of `role`, if the source knows it.
    pub fn get(&self, role: Role) -> Option<Vec3> {
        (self.present >> role.index() & 1 == 1).then(|| self.positions[role.index()])
    }

    /// The roles whose positions are known, in the order of their numbers.
    pub fn roles(&self) -> impl Iterator<Item = Role> + use<> {
        let mut left = self.present;
        std::iter::from_fn(move || {
            let role = Role::ALL.get(left.trailing_zeros() as usize)?;
            left &= left - 1;
            Some(*role)
        })
    }

    /// The pose as a mirror shows it: left and right exchanged, X reversed.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let mut image = Self::default();
        for role in self.roles() {
            let place = self.positions[role.index()];
            image.set(role.opposite(), Vec3::new(-place.x, place.y, place.z));
        }
        image
    }

    /// Puts `role` at `position`; a position that is not finite counts as unknown.
    pub fn set(&mut self, role: Role, position: Vec3) {
        if position.iter().all(|c| c.is_finite()) {
            self.positions[role.index()] = position;
            self.present |= 1 << role.index();
        } else {
            self.present &= !(1 << role.index());
        }
    }
}
