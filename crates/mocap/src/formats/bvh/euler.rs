//! Converts rotations to the angles of `Zrotation Yrotation Xrotation`, continuous over time.

use std::f64::consts::{PI, TAU};

use super::arctangent::atan2_all;
use crate::math::{Quat, portable};

/// Angles `[z, y, x]` in radians of some joints, frame after frame, with `Rz·Ry·Rx` the joint's rotation.
///
/// There are two solutions for each rotation, `(z, y, x)` and `(z + π, π - y, x + π)`, and every angle may be turned
/// fully round (Shoemake, *Euler Angle Conversion*, Graphics Gems IV, 1994): of all such those nearest to the last frame's
/// are taken. In gimbal lock, where only a sum or difference of z and x is given, x stays where it was.
#[derive(Debug)]
pub(super) struct RunningZyx {
    angles: Vec<[f64; 3]>,
    /// Three points for each joint, whose angles are those of the first solution.
    ys: Vec<f64>,
    xs: Vec<f64>,
    of_points: Vec<f64>,
}

impl RunningZyx {
    /// Angles of `joints` joints, all 0 before the first frame.
    pub fn new(joints: usize) -> Self {
        Self {
            angles: vec![[0.0; 3]; joints],
            ys: vec![0.0; 3 * joints],
            xs: vec![0.0; 3 * joints],
            of_points: vec![0.0; 3 * joints],
        }
    }

    /// The angles of the next frame, a joint's each; `rotations` are as many.
    pub fn next<'q>(&mut self, rotations: impl Iterator<Item = &'q Quat> + Clone) -> &[[f64; 3]] {
        let points = self.ys.chunks_exact_mut(3).zip(self.xs.chunks_exact_mut(3));
        for (rotation, (ys, xs)) in rotations.clone().zip(points) {
            set_points(rotation, ys, xs);
        }
        atan2_all(&self.ys, &self.xs, &mut self.of_points);
        let solutions = self.of_points.chunks_exact(3).zip(self.xs.chunks_exact(3));
        for ((rotation, (solution, xs)), last) in rotations.zip(solutions).zip(&mut self.angles) {
            let first = [solution[0], solution[1], solution[2]];
            *last = match xs[1] < LOCK {
                true => locked(rotation, first[1], *last),
                false => nearer(first, *last),
            };
        }
        &self.angles
    }
}

/// A cosine of y below this is gimbal lock.
const LOCK: f64 = 1e-8;

/// The points at the angles z, y and x of one solution: entries of the rotation's matrix.
#[inline(always)]
fn set_points(rotation: &Quat, ys: &mut [f64], xs: &mut [f64]) {
    let [x, y, z, w] = [rotation.i, rotation.j, rotation.k, rotation.w];
    (xs[0], ys[0]) = (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z));
    (xs[1], ys[1]) = (
        (xs[0] * xs[0] + ys[0] * ys[0]).sqrt(),
        -2.0 * (x * z - w * y),
    );
    (xs[2], ys[2]) = (1.0 - 2.0 * (x * x + y * y), 2.0 * (y * z + w * x));
}

/// With sin y = ±1 the middle column of the matrix is (-sin(z ∓ x), cos(z ∓ x), 0).
fn locked(rotation: &Quat, pitch: f64, last: [f64; 3]) -> [f64; 3] {
    let [x, y, z, w] = [rotation.i, rotation.j, rotation.k, rotation.w];
    let middle = [2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z)];
    let difference = portable::atan2(-middle[0], middle[1]);
    let roll = last[2];
    nearest([difference + pitch.signum() * roll, pitch, roll], last)
}

/// The solution that is nearer to the last angles.
#[inline(always)]
fn nearer([yaw, pitch, roll]: [f64; 3], last: [f64; 3]) -> [f64; 3] {
    let first = nearest([yaw, pitch, roll], last);
    // Yaw and roll of the other solution lie half a turn from these: it is not nearer.
    if distance(&first, &last) < 0.5 * PI * PI {
        return first;
    }
    let second = nearest([yaw + PI, PI - pitch, roll + PI], last);
    match distance(&second, &last) < distance(&first, &last) {
        true => second,
        false => first,
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

    fn zyx_near(rotation: &Quat, last: [f64; 3]) -> [f64; 3] {
        let mut running = RunningZyx::new(1);
        running.angles[0] = last;
        running.next([*rotation].iter())[0]
    }

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
