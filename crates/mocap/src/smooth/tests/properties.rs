use proptest::prelude::*;

use super::clips;
use crate::clip::Clip;
use crate::math::{Quat, Vec3};
use crate::smooth::{Bezier, CompressedClip, Errors, SmoothParams, compress};

/// Position of a joint in the world, by walking up its chain.
fn in_world(clip: &Clip, frame: usize, joint: usize) -> Vec3 {
    let (mut point, mut at) = (Vec3::zeros(), joint);
    loop {
        point += clip.local_position(frame, at);
        match clip.skeleton.joints()[at].parent {
            Some(parent) => {
                point = clip.frame_rotations(frame)[parent] * point;
                at = parent;
            }
            None => return point,
        }
    }
}

/// Errors the obvious way: every joint at every frame, one by one.
fn brute_force(a: &Clip, b: &Clip, metres_per_unit: f64) -> Errors {
    let (mut angles, mut positions, mut world) = (vec![], vec![], vec![]);
    for frame in 0..a.frames {
        for j in 0..a.skeleton.len() {
            angles.push(a.frame_rotations(frame)[j].angle_to(&b.frame_rotations(frame)[j]));
            world.push((in_world(a, frame, j) - in_world(b, frame, j)).norm() * metres_per_unit);
            if a.track(j).is_some() {
                let off = a.local_position(frame, j) - b.local_position(frame, j);
                positions.push(off.norm() * metres_per_unit);
            }
        }
    }
    let most = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len().max(1) as f64;
    Errors {
        max_angle_rad: most(&angles),
        mean_angle_rad: mean(&angles),
        max_position_metres: most(&positions),
        mean_position_metres: mean(&positions),
        max_joint_position_metres: most(&world),
        mean_joint_position_metres: mean(&world),
    }
}

fn params() -> impl Strategy<Value = SmoothParams> {
    let bound = prop::option::of(prop_oneof![Just(0.005), 1e-3f64..0.5]);
    (
        1e-4f64..0.2,
        1e-4f64..0.5,
        bound,
        prop_oneof![Just(1.0), Just(0.01)],
    )
        .prop_map(
            |(angle_rad, position_metres, joint_position_metres, metres_per_unit)| SmoothParams {
                angle_rad,
                position_metres,
                joint_position_metres,
                metres_per_unit,
            },
        )
}

/// Rounding of the comparison itself.
const EXACT: f64 = 1e-9;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn every_sample_is_within_the_thresholds(clip in clips(), params in params()) {
        let compressed = compress(&clip, &params, &()).unwrap();
        let again = compressed.sample(clip.rate_hz).unwrap();
        prop_assert_eq!(again.frames, clip.frames);
        let found = brute_force(&clip, &again, params.metres_per_unit);
        prop_assert!(found.max_angle_rad <= params.angle_rad + EXACT, "{:?}", found);
        prop_assert!(found.max_position_metres <= params.position_metres + EXACT, "{:?}", found);
        if let Some(bound) = params.joint_position_metres {
            prop_assert!(found.max_joint_position_metres <= bound + EXACT, "{:?}", found);
        }
    }

    #[test]
    fn errors_are_those_that_brute_force_finds(clip in clips(), params in params()) {
        let compressed = compress(&clip, &params, &()).unwrap();
        let again = compressed.sample(clip.rate_hz).unwrap();
        let (stated, found) = (compressed.errors(), brute_force(&clip, &again, params.metres_per_unit));
        for (stated, found) in stated.as_array().into_iter().zip(found.as_array()) {
            prop_assert!((stated - found).abs() < EXACT, "{} {}", stated, found);
        }
        prop_assert_eq!(compressed.measure(&clip), Some(*stated));
    }

    #[test]
    fn what_is_stored_comes_back_to_the_bit(clip in clips(), params in params()) {
        let compressed = compress(&clip, &params, &()).unwrap();
        let bytes = compressed.to_bytes();
        let again = CompressedClip::from_bytes(&bytes).unwrap();
        prop_assert_eq!(&again, &compressed);
        prop_assert_eq!(again.to_bytes(), bytes);
    }

    /// At any rate, a frame is the curves' value at its time, and signs do not jump.
    #[test]
    fn any_rate_samples_the_same_curves(clip in clips(), rate in 5.0f64..300.0) {
        let compressed = compress(&clip, &SmoothParams::default(), &()).unwrap();
        let sampled = compressed.sample(rate).unwrap();
        prop_assert_eq!(sampled.frames, clip.resampled(rate).unwrap().frames);
        prop_assert_eq!(&sampled.repaired, &clip.resampled(rate).unwrap().repaired);
        for frame in 0..sampled.frames {
            let time_secs = frame as f64 / rate;
            for (j, q) in sampled.frame_rotations(frame).iter().enumerate() {
                let at: Quat = compressed.rotation_at(j, time_secs).unwrap();
                // Rates and times meet frames only nearly, and jumps are steep.
                prop_assert!(q.angle_to(&at) < 1e-3, "{}", q.angle_to(&at));
                prop_assert!((q.coords.norm() - 1.0).abs() < 1e-12);
                prop_assert!(frame == 0 || q.coords.dot(&sampled.frame_rotations(frame - 1)[j].coords) >= 0.0);
                let position = compressed.position_at(j, time_secs).unwrap();
                prop_assert!((sampled.local_position(frame, j) - position).norm() < 1e-3);
            }
        }
    }

    /// Curves follow one another without a gap, from the first frame to the last.
    #[test]
    fn curves_are_joined(clip in clips()) {
        let compressed = compress(&clip, &SmoothParams::database(), &()).unwrap();
        for curve in compressed.curves() {
            let beziers: Vec<_> = compressed.beziers(curve).collect();
            prop_assert_eq!(beziers.len() + 1, curve.keyframes());
            let joined = |w: &[Bezier]| w[0].span.stop_secs == w[1].span.start_secs && w[0].points[3] == w[1].points[0];
            prop_assert!(beziers.windows(2).all(joined));
            if let (Some(first), Some(last)) = (beziers.first(), beziers.last()) {
                prop_assert_eq!(first.span.start_secs, 0.0);
                prop_assert_eq!(last.span.stop_secs, (clip.frames - 1) as f64 / clip.rate_hz);
            }
        }
    }
}
