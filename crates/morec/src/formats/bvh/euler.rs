//! Rotations to the angles of `Zrotation Yrotation Xrotation`, without jumps.

use std::f64::consts::{PI, TAU};

use crate::math::Quat;

/// Angles `[z, y, x]` in radians with `Rz·Ry·Rx = rotation`, of all such the nearest to `previous`.
///
/// There are two solutions for each rotation, `(z, y, x)` and `(z + π, π - y, x + π)`, and every angle may be turned
/// fully round (Shoemake, *Euler Angle Conversion*, Graphics Gems IV, 1994). In gimbal lock, where only a sum or
/// difference of z and x is given, x stays where it was.
pub(super) fn zyx_near(rotation: &Quat, previous: [f64; 3]) -> [f64; 3] {
    // The entries of its matrix that are asked for.
    let [x, y, z, w] = [rotation.i, rotation.j, rotation.k, rotation.w];
    let first = [
        1.0 - 2.0 * (y * y + z * z),
        2.0 * (x * y + w * z),
        2.0 * (x * z - w * y),
    ];
    let last = [2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)];
    let cos_y = (first[0] * first[0] + first[1] * first[1]).sqrt();
    let pitch = (-first[2]).atan2(cos_y);
    if cos_y < 1e-8 {
        // With sin y = ±1 the middle column is (-sin(z ∓ x), cos(z ∓ x), 0).
        let middle = [2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z)];
        let difference = (-middle[0]).atan2(middle[1]);
        let roll = previous[2];
        return nearest([difference + pitch.signum() * roll, pitch, roll], previous);
    }
    let yaw = first[1].atan2(first[0]);
    let roll = last[0].atan2(last[1]);
    let first = nearest([yaw, pitch, roll], previous);
    // Yaw and roll of the other solution lie half a turn from these: it is not nearer.
    if distance(&first, &previous) < 0.5 * PI * PI {
        return first;
    }
    let second = nearest([yaw + PI, PI - pitch, roll + PI], previous);
    if distance(&second, &previous) < distance(&first, &previous) {
        second
    } else {
        first
    }
}

fn nearest(angles: [f64; 3], previous: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| {
        let turns = (angles[k] - previous[k]) / TAU;
        // Most are there already, and rounding is slow.
        if turns.abs() < 0.5 {
            angles[k]
        } else {
            angles[k] - TAU * turns.round()
        }
    })
}

fn distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Axis;
    use proptest::prelude::*;

    fn compose([z, y, x]: [f64; 3]) -> Quat {
        Axis::Z.rotation(z) * Axis::Y.rotation(y) * Axis::X.rotation(x)
    }

    proptest! {
        #[test]
        fn the_angles_give_the_rotation(z in -7.0f64..7.0, y in -7.0f64..7.0, x in -7.0f64..7.0, previous in -7.0f64..7.0) {
            let rotation = compose([z, y, x]);
            prop_assert!(compose(zyx_near(&rotation, [previous; 3])).angle_to(&rotation) < 1e-7);
        }

        #[test]
        fn near_and_in_gimbal_lock_too(z in -3.0f64..3.0, small in -12i32..0, sign in prop::bool::ANY, x in -3.0f64..3.0) {
            let y = if sign { 1.0 } else { -1.0 } * (PI / 2.0 - 10f64.powi(small));
            let rotation = compose([z, y, x]);
            prop_assert!(compose(zyx_near(&rotation, [0.1, 0.2, 0.3])).angle_to(&rotation) < 1e-7);
        }

        #[test]
        fn small_steps_stay_small_away_from_lock(start in -3.0f64..3.0, y in -1.2f64..1.2) {
            let mut previous = zyx_near(&compose([start, y, start]), [0.0; 3]);
            for step in 1..200 {
                let turn = f64::from(step) * 0.05;
                let angles = zyx_near(&compose([start + turn, y, start - turn]), previous);
                prop_assert!(distance(&angles, &previous).sqrt() < 0.08);
                previous = angles;
            }
        }
    }
}
