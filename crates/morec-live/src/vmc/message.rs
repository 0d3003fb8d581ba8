//! Messages of VMC, in right-handed axes.

use crate::osc::{Arg, Message};
use morec::humanoid::{bone_of_name, mirrored};
use morec::math::{Quat, Vec3, rotation_of_xyzw};

/// A message that concerns recognition.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum VmcMessage {
    /// `/VMC/Ext/OK`: whether there is a performer to be seen.
    State {
        /// Loaded, and tracking is not known to be lost.
        good: bool,
    },
    /// `/VMC/Ext/T`: the sender's clock, seconds.
    Time(f64),
    /// `/VMC/Ext/Root/Pos`: where the performer's own frame is in the world.
    Root(Vec3, Quat),
    /// `/VMC/Ext/Bone/Pos`: a bone in its parent's frame.
    Bone(usize, Vec3, Quat),
    /// Something else: cameras, faces, buttons, unknown bones.
    Other,
}

/// Parses a message; `None` if it is one of the known but its arguments are too few, of the wrong kinds or not
/// finite. Surplus arguments are ignored, as the specification (V3.1) has it.
pub fn understand(message: &Message) -> Option<VmcMessage> {
    let mut args = message.args();
    match message.address {
        "/VMC/Ext/Bone/Pos" => {
            let name = args.next()?;
            let (position, rotation) = pose(&mut args)?;
            let Arg::Text(name) = name else { return None };
            Some(bone_of_name(name).map_or(VmcMessage::Other, |bone| {
                VmcMessage::Bone(bone, position, rotation)
            }))
        }
        "/VMC/Ext/Root/Pos" => {
            args.next()?;
            let (position, rotation) = pose(&mut args)?;
            Some(VmcMessage::Root(position, rotation))
        }
        "/VMC/Ext/T" => {
            let time_secs = args.next()?.number()?;
            time_secs.is_finite().then_some(VmcMessage::Time(time_secs))
        }
        "/VMC/Ext/OK" => {
            let loaded = args.next()?.number()?;
            // Calibration and mode say nothing about the pose; the fourth, since V2.7, whether tracking is good.
            let tracking = args.nth(2).and_then(|arg| arg.number()).unwrap_or(1.0);
            Some(VmcMessage::State {
                good: loaded != 0.0 && tracking != 0.0,
            })
        }
        _ => Some(VmcMessage::Other),
    }
}

/// Position and rotation, `x y z  x y z w`, in Unity's axes.
fn pose<'a>(args: &mut impl Iterator<Item = Arg<'a>>) -> Option<(Vec3, Quat)> {
    let mut values = [0.0; 7];
    for value in &mut values {
        *value = args.next()?.number()?;
    }
    let [x, y, z, qx, qy, qz, qw] = values;
    Some((
        position_from_unity(Vec3::new(x, y, z))?,
        rotation_from_unity([qx, qy, qz, qw])?,
    ))
}

/// From Unity's left-handed axes (Y up, Z forward) to right-handed ones: Z turns round. The way back is the same.
pub fn position_from_unity(p: Vec3) -> Option<Vec3> {
    let turned = Vec3::new(p.x, p.y, -p.z);
    // Farther than a planet's size is no position, and squares must stay finite.
    turned.iter().all(|c| c.abs() < 1e9).then_some(turned)
}

/// A rotation `x y z w` from Unity's axes: the axis' Z turns round, and so does the sense of turning.
pub fn rotation_from_unity([x, y, z, w]: [f64; 4]) -> Option<Quat> {
    rotation_of_xyzw([x, y, -z, -w])
}

/// A rotation to Unity's axes, `x y z w`.
pub fn rotation_to_unity(q: &Quat) -> [f64; 4] {
    [q.i, q.j, -q.k, -q.w]
}

/// The bone, position and rotation that a mirror shows, left and right exchanged.
pub fn seen_in_mirror(bone: usize, position: Vec3, rotation: Quat) -> (usize, Vec3, Quat) {
    let (position, rotation) = mirror(position, rotation);
    (mirrored(bone), position, rotation)
}

/// Reflected at the plane of Y and Z.
pub fn mirror(position: Vec3, rotation: Quat) -> (Vec3, Quat) {
    let mut reflected = rotation;
    let q = reflected.as_mut_unchecked();
    (q.j, q.k) = (-rotation.j, -rotation.k);
    (Vec3::new(-position.x, position.y, position.z), reflected)
}

#[cfg(test)]
mod tests {
    use super::*;
    use morec::math::Axis;
    use proptest::prelude::*;

    /// Unity, facing +Z, has its left at −X. Its left arm reaches out to the left in a T-pose; turned by +90° about
    /// Y (clockwise from above, in left-handed axes) it reaches forward.
    #[test]
    fn a_left_arm_stretched_forward_stays_a_left_arm_stretched_forward() {
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let turn = rotation_from_unity([0.0, half, 0.0, half]).unwrap();
        let arm = position_from_unity(Vec3::new(-0.3, 0.0, 0.0)).unwrap();
        let forward = position_from_unity(Vec3::new(0.0, 0.0, 1.0)).unwrap();
        let (up, left) = (
            Vec3::y(),
            position_from_unity(Vec3::new(-1.0, 0.0, 0.0)).unwrap(),
        );
        assert!((turn * arm - forward * 0.3).norm() < 1e-12);
        // In right-handed axes left is up × forward: so left has stayed left.
        assert!((up.cross(&forward) - left).norm() < 1e-12);
    }

    #[test]
    fn a_right_arm_raised_sideways_goes_up() {
        // Unity: +90° about Z takes +X to +Y.
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let turn = rotation_from_unity([0.0, 0.0, half, half]).unwrap();
        let arm = position_from_unity(Vec3::new(0.3, 0.0, 0.0)).unwrap();
        assert!((turn * arm - Vec3::new(0.0, 0.3, 0.0)).norm() < 1e-12);
    }

    #[test]
    fn a_nod_forward_goes_forward() {
        // Unity: a turn about +X takes +Y to +Z: the head's top goes forward.
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let turn = rotation_from_unity([half, 0.0, 0.0, half]).unwrap();
        let forward = position_from_unity(Vec3::z()).unwrap();
        assert!((turn * Vec3::y() - forward).norm() < 1e-12);
    }

    fn quat() -> impl Strategy<Value = [f64; 4]> {
        [-1.0f64..1.0, -1.0f64..1.0, -1.0f64..1.0, 0.1f64..1.0]
    }

    fn vector() -> impl Strategy<Value = Vec3> {
        [-2.0f64..2.0, -2.0f64..2.0, -2.0f64..2.0].prop_map(Vec3::from)
    }

    /// Unity's rotation of a vector, by the formula, in its own axes: `v + 2 w (u × v) + 2 u × (u × v)` holds for
    /// quaternions whatever the handedness is called.
    fn turned([x, y, z, w]: [f64; 4], v: Vec3) -> Vec3 {
        let u = Vec3::new(x, y, z);
        v + u.cross(&v) * (2.0 * w) + u.cross(&u.cross(&v)) * 2.0
    }

    proptest! {
        #[test]
        fn turning_and_converting_can_be_exchanged(q in quat(), v in vector()) {
            let norm = q.iter().map(|c| c * c).sum::<f64>().sqrt();
            let unit = q.map(|c| c / norm);
            let there = position_from_unity(turned(unit, v)).unwrap();
            let here = rotation_from_unity(q).unwrap() * position_from_unity(v).unwrap();
            prop_assert!((there - here).norm() < 1e-9);
            let back = rotation_from_unity(rotation_to_unity(&rotation_from_unity(q).unwrap())).unwrap();
            prop_assert!(back.angle_to(&rotation_from_unity(q).unwrap()) < 1e-6);
        }

        #[test]
        fn turning_and_mirroring_can_be_exchanged(q in quat(), v in vector()) {
            let q = rotation_from_unity(q).unwrap();
            let (mirrored_v, mirrored_q) = mirror(v, q);
            prop_assert!((mirror(q * v, q).0 - mirrored_q * mirrored_v).norm() < 1e-9);
        }
    }

    #[test]
    fn nonsense_is_no_pose() {
        assert!(rotation_from_unity([0.0; 4]).is_none());
        assert!(rotation_from_unity([f64::NAN, 0.0, 0.0, 1.0]).is_none());
        assert!(position_from_unity(Vec3::new(f64::INFINITY, 0.0, 0.0)).is_none());
        let quarter = Axis::Y.rotation(1.0);
        assert!(
            rotation_from_unity(rotation_to_unity(&quarter).map(|c| c * 3.0))
                .unwrap()
                .angle_to(&quarter)
                < 1e-9
        );
    }
}
