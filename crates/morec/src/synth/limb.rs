//! Two-bone inverse kinematics: positions of elbow and knee from hand and foot.

use nalgebra::{Matrix3, Rotation3};

use super::smooth::{soft_max, soft_min};
use crate::math::{Quat, Vec3};

/// Directions of a limb's two bones and the axis of the hinge between them; unit vectors in one frame.
#[derive(Debug, Clone, Copy)]
pub struct Bend {
    /// Of the upper bone.
    pub upper: Vec3,
    /// Of the lower bone.
    pub lower: Vec3,
    /// The hinge, about which the lower bone turns from the straight limb.
    pub hinge: Vec3,
}

/// Bends a limb of bone lengths `lengths` so that it ends at `target` from its root, the middle joint on the
/// side of `pole`. Targets out of reach are approached softly: a limb never snaps straight.
pub fn reach(lengths: [f64; 2], target: Vec3, pole: Vec3) -> Bend {
    let [a, b] = lengths;
    let whole = a + b;
    let distance = target.norm().max(1e-9);
    let along = target / distance;
    let side = perpendicular(&pole, &along);
    let d = soft_max(
        soft_min(distance, 0.992 * whole, 0.015 * whole),
        0.22 * whole,
        0.04 * whole,
    );
    let cos = ((a * a + d * d - b * b) / (2.0 * a * d)).clamp(-1.0, 1.0);
    let upper = along * cos + side * (1.0 - cos * cos).sqrt();
    let lower = (along * d - upper * a) / b;
    Bend {
        upper,
        lower: lower / lower.norm(),
        hinge: side.cross(&along),
    }
}

/// The unit vector nearest to `v` at right angles to `along`; some such vector when there is no nearest.
pub fn perpendicular(v: &Vec3, along: &Vec3) -> Vec3 {
    let rest = v - along * along.dot(v);
    let length = rest.norm();
    if length > 1e-9 {
        return rest / length;
    }
    let other = if along.x.abs() < 0.7 {
        Vec3::x()
    } else {
        Vec3::y()
    };
    perpendicular(&other, along)
}

/// The rotation that takes the right-angled unit vectors `bone` and `hinge` to `new_bone` and `new_hinge`.
pub fn carry(bone: &Vec3, hinge: &Vec3, new_bone: &Vec3, new_hinge: &Vec3) -> Quat {
    let from = Matrix3::from_columns(&[*bone, *hinge, bone.cross(hinge)]);
    let to = Matrix3::from_columns(&[*new_bone, *new_hinge, new_bone.cross(new_hinge)]);
    Quat::from_rotation_matrix(&Rotation3::from_matrix_unchecked(to * from.transpose()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vector() -> impl Strategy<Value = Vec3> {
        (-1.0f64..1.0, -1.0f64..1.0, -1.0f64..1.0).prop_map(|(x, y, z)| Vec3::new(x, y, z))
    }

    proptest! {
        #[test]
        fn a_target_in_easy_reach_is_met(toward in vector(), distance in 0.25f64..0.5, pole in vector()) {
            prop_assume!(toward.norm() > 0.1 && pole.norm() > 0.1);
            let target = toward.normalize() * distance;
            let bend = reach([0.3, 0.26], target, pole);
            let end = bend.upper * 0.3 + bend.lower * 0.26;
            // The soft limits may hold it back by a fraction of their width.
            prop_assert!((end - target).norm() < 0.012, "{} off", (end - target).norm());
            prop_assert!(bend.upper.cross(&bend.lower).dot(&bend.hinge) > 0.0);
            let side = perpendicular(&pole, &(target / target.norm()));
            prop_assert!(bend.upper.dot(&side) > 0.0 && bend.lower.dot(&side) < 0.0);
        }

        #[test]
        fn carrying_takes_both_vectors_along(target in vector(), pole in vector()) {
            prop_assume!(target.norm() > 0.1 && pole.cross(&target).norm() > 0.05);
            let bend = reach([0.3, 0.26], target, pole);
            let turn = carry(&Vec3::x(), &Vec3::z(), &bend.upper, &bend.hinge);
            prop_assert!((turn * Vec3::x() - bend.upper).norm() < 1e-9);
            prop_assert!((turn * Vec3::z() - bend.hinge).norm() < 1e-9);
        }
    }
}
