//! Converts between the caller's coordinates and morec's (right-handed, Y up).

use std::f64::consts::FRAC_PI_2;

use morec::math::{Axis, Quat, Vec3};

use crate::status::CallError;

/// Handedness of the coordinate axes.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MorecHandedness {
    /// Unset; the call fails.
    Unknown = 0,
    /// As in OpenGL, glTF, Maya, Blender, Godot, OpenXR, BVH files.
    Right = 1,
    /// As in Unity, Unreal, VMC.
    Left = 2,
}

/// The axis that points up.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MorecUpAxis {
    /// As in Unity, Godot, glTF, Maya.
    Y = 0,
    /// As in Unreal, Blender.
    Z = 1,
}

/// From a caller's coordinates to right-handed ones with Y up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Convention {
    /// Left-handed coordinates become right-handed by turning this axis round.
    mirror: Option<Axis>,
    /// From the caller's up to Y.
    turn: Option<Quat>,
}

impl Convention {
    pub(crate) fn new(handedness: i32, up: i32) -> Result<Self, CallError> {
        let z_up = if up == MorecUpAxis::Y as i32 {
            false
        } else if up == MorecUpAxis::Z as i32 {
            true
        } else {
            return Err(CallError::invalid(format!(
                "up_axis is {up}, expected a MorecUpAxis"
            )));
        };
        // A level axis; which of the two is the same but for the heading.
        let mirror = if handedness == MorecHandedness::Right as i32 {
            None
        } else if handedness == MorecHandedness::Left as i32 {
            Some(if z_up { Axis::Y } else { Axis::Z })
        } else {
            let text = "expected MOREC_HANDEDNESS_RIGHT or MOREC_HANDEDNESS_LEFT";
            return Err(CallError::invalid(format!(
                "handedness is {handedness}, {text}"
            )));
        };
        Ok(Self {
            mirror,
            turn: z_up.then(|| Axis::X.rotation(-FRAC_PI_2)),
        })
    }

    /// A position in a parent's frame; in the world's, if the joint is a root.
    pub(crate) fn position(&self, mut p: Vec3, in_world: bool) -> Vec3 {
        if let Some(axis) = self.mirror {
            p[axis.index()] = -p[axis.index()];
        }
        match self.turn.filter(|_| in_world) {
            Some(turn) => turn * p,
            None => p,
        }
    }

    /// A rotation from a joint's frame into its parent's; into the world, if the joint is a root.
    pub(crate) fn rotation(&self, mut q: Quat, in_world: bool) -> Quat {
        if let Some(axis) = self.mirror {
            // A mirrored rotation turns about the mirrored axis the other way round.
            let mut inner = q.into_inner();
            for other in Axis::ALL.into_iter().filter(|other| *other != axis) {
                inner.coords[other.index()] = -inner.coords[other.index()];
            }
            q = Quat::new_unchecked(inner);
        }
        match self.turn.filter(|_| in_world) {
            Some(turn) => turn * q,
            None => q,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A pose seen in two conventions is one pose, whichever way its joints hang together.
    #[test]
    fn mirrored_rotations_move_mirrored_points() {
        let q = Quat::from_euler_angles(0.3, -1.1, 0.7);
        let p = Vec3::new(0.2, -0.5, 1.3);
        for (handedness, up) in [(1, 0), (1, 1), (2, 0), (2, 1)] {
            let to = Convention::new(handedness, up).unwrap();
            let turned_then_told = to.position(q * p, false);
            let told_then_turned = to.rotation(q, false) * to.position(p, false);
            assert!((turned_then_told - told_then_turned).norm() < 1e-12);
            let in_world = to.rotation(q, true) * to.position(p, false);
            assert!((to.position(q * p, true) - in_world).norm() < 1e-12);
        }
    }

    #[test]
    fn unitys_and_unreals_axes_become_ours() {
        // Unity: right, up, forward.
        let unity = Convention::new(2, 0).unwrap();
        let seen = |c: &Convention, x, y, z| c.position(Vec3::new(x, y, z), true);
        let (right, up, forward) = (
            seen(&unity, 1.0, 0.0, 0.0),
            seen(&unity, 0.0, 1.0, 0.0),
            seen(&unity, 0.0, 0.0, 1.0),
        );
        assert_eq!(up, Vec3::y());
        assert_eq!(
            right.cross(&up),
            -forward,
            "right, up, backward are a right hand"
        );
        // Unreal: forward, right, up.
        let unreal = Convention::new(2, 1).unwrap();
        let (forward, right, up) = (
            seen(&unreal, 1.0, 0.0, 0.0),
            seen(&unreal, 0.0, 1.0, 0.0),
            seen(&unreal, 0.0, 0.0, 1.0),
        );
        assert!((up - Vec3::y()).norm() < 1e-12);
        assert!((right.cross(&up) + forward).norm() < 1e-12);
    }

    #[test]
    fn handedness_must_be_said() {
        assert!(Convention::new(0, 0).is_err());
        assert!(Convention::new(3, 0).is_err());
        assert!(Convention::new(1, 2).is_err());
    }
}
