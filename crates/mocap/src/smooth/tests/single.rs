//! Clips made to a purpose.

use std::f64::consts::PI;

use super::one_joint;
use crate::clip::{Clip, Joint, JointTrack, Skeleton};
use crate::math::{Axis, Quat, Vec3};
use crate::progress::Progress;
use crate::smooth::{ChannelKind, SmoothError, SmoothParams, compress};

fn still(_: f64) -> Quat {
    Quat::identity()
}

/// Degrees of the curves of a one-joint clip's position.
fn degrees(clip: &Clip) -> Vec<u8> {
    let compressed = compress(clip, &SmoothParams::default(), &()).unwrap();
    let curve = compressed.curve(0, ChannelKind::Position).unwrap();
    compressed
        .beziers(curve)
        .map(|bezier| bezier.degree)
        .collect()
}

#[test]
fn polynomials_are_one_curve_of_their_degree() {
    let of = |x: fn(f64) -> f64| {
        degrees(&one_joint(100.0, 201, still, |t| {
            Vec3::new(x(t), 1.0, -x(t))
        }))
    };
    assert!(of(|_| 0.7).is_empty());
    assert_eq!(of(|t| 3.0 * t - 1.0), [1]);
    assert_eq!(of(|t| t * t - 2.0 * t), [2]);
    assert_eq!(of(|t| t * (t - 1.0) * (t - 2.0)), [3]);
}

#[test]
fn splits_fall_where_the_motion_breaks() {
    // A corner at 0.5 s: no cubic turns it, two lines do.
    let clip = one_joint(100.0, 101, still, |t| {
        Vec3::new((t - 0.5).abs() * 4.0, 0.0, 0.0)
    });
    let compressed = compress(&clip, &SmoothParams::default(), &()).unwrap();
    let curve = compressed.curve(0, ChannelKind::Position).unwrap();
    let keys: Vec<f64> = compressed
        .beziers(curve)
        .map(|bezier| bezier.span.start_secs)
        .collect();
    assert_eq!(keys, [0.0, 0.5]);
}

#[test]
fn noise_below_the_threshold_is_smoothed_away() {
    let noisy = |t: f64| Axis::Y.rotation(t + 0.002 * (t * 1e4).sin());
    let clip = one_joint(120.0, 241, noisy, |_| Vec3::zeros());
    let compressed = compress(&clip, &SmoothParams::default(), &()).unwrap();
    assert!(compressed.keyframes() < 10, "{}", compressed.keyframes());
    assert!(compressed.compression_ratio() > 20.0);
}

/// Whole turns, and turns of 180° from one frame to the next, have no side to be on.
#[test]
fn turning_without_end_and_flips_are_kept() {
    let spinning = one_joint(60.0, 301, |t| Axis::Y.rotation(5.0 * t), |_| Vec3::zeros());
    let flipping = one_joint(
        60.0,
        50,
        |t| Axis::X.rotation((t * 60.0).round() * (PI - 1e-4)),
        |_| Vec3::zeros(),
    );
    for clip in [spinning, flipping] {
        let compressed = compress(&clip, &SmoothParams::database(), &()).unwrap();
        let again = compressed.sample(clip.rate_hz).unwrap();
        for (a, b) in clip.rotations.iter().zip(&again.rotations) {
            assert!(a.angle_to(b) <= 0.5f64.to_radians() + 1e-9);
        }
    }
}

#[test]
fn what_stands_still_costs_next_to_nothing() {
    let joint = |j: usize| Joint {
        name: format!("J{j}"),
        parent: j.checked_sub(1),
        offset: Vec3::new(0.0, 0.1, 0.0),
        tip: None,
    };
    let (joints, frames) = (31, 10_000);
    let clip = Clip {
        name: "still".into(),
        skeleton: Skeleton::new((0..joints).map(joint).collect()).unwrap(),
        rate_hz: 120.0,
        rotations: vec![Axis::Z.rotation(0.3); joints * frames],
        tracks: vec![JointTrack {
            joint: 0,
            positions: vec![Vec3::new(1.0, 2.0, 3.0); frames],
        }],
        frames,
        repaired: Vec::new(),
        points: None,
    };
    let compressed = compress(&clip, &SmoothParams::database(), &()).unwrap();
    assert_eq!(compressed.keyframes(), joints + 1);
    let bytes = compressed.to_bytes().len();
    assert!(
        bytes < 900,
        "{bytes} bytes, a skeleton of some 500 among them"
    );
}

/// Splits at the very end of what is left each time are the worst case of a recursion.
#[test]
fn long_rough_clips_are_neither_too_deep_nor_too_slow() {
    let steps = |t: f64| Vec3::new(2f64.powf((t * 1000.0).floor() % 31.0), 0.0, 0.0);
    let clip = one_joint(1000.0, 30_000, still, steps);
    let compressed = compress(&clip, &SmoothParams::default(), &()).unwrap();
    assert!(compressed.errors().max_position_metres <= 0.005);
}

#[test]
fn outside_the_clip_it_stands_still() {
    let clip = one_joint(
        100.0,
        101,
        |t| Axis::Z.rotation(t),
        |t| Vec3::new(t, t * t, 0.0),
    );
    let compressed = compress(&clip, &SmoothParams::default(), &()).unwrap();
    assert_eq!(
        compressed.rotation_at(0, -3.0),
        compressed.rotation_at(0, 0.0)
    );
    assert_eq!(
        compressed.position_at(0, 9.0),
        compressed.position_at(0, 1.0)
    );
    assert_eq!(compressed.rotation_at(1, 0.0), None);
    assert_eq!(compressed.position_at(1, 0.0), None);
}

#[test]
fn what_cannot_be_compressed_is_refused() {
    let good = one_joint(100.0, 11, still, |_| Vec3::zeros());
    let fails = |clip: &Clip, params: SmoothParams| compress(clip, &params, &()).unwrap_err();
    for params in [
        SmoothParams {
            angle_rad: 0.0,
            ..Default::default()
        },
        SmoothParams {
            position_metres: f64::NAN,
            ..Default::default()
        },
        SmoothParams {
            joint_position_metres: Some(-1.0),
            ..Default::default()
        },
        SmoothParams {
            metres_per_unit: f64::INFINITY,
            ..Default::default()
        },
    ] {
        assert!(matches!(fails(&good, params), SmoothError::Param { .. }));
    }
    let mut bad = good.clone();
    let mut most_with = |y: f64| {
        bad.tracks[0].positions[7].y = y;
        match fails(&bad, SmoothParams::default()) {
            SmoothError::Value {
                joint: 0,
                frame: 7,
                most,
                ..
            } => most,
            error => panic!("{error}"),
        }
    };
    most_with(f64::NAN);
    // The limit that the message names is the limit: beyond it nothing is kept, below it all is.
    let most = most_with(1e200);
    bad.tracks[0].positions[7].y = 1.01 * most;
    assert!(compress(&bad, &SmoothParams::default(), &()).is_err());
    bad.tracks[0].positions[7].y = 0.25 * most;
    assert!(compress(&bad, &SmoothParams::default(), &()).is_ok());
    let mut bad = good.clone();
    bad.rotations.pop();
    assert!(matches!(
        fails(&bad, SmoothParams::default()),
        SmoothError::Clip(_)
    ));
    let bad = Clip {
        rate_hz: 0.0,
        ..good
    };
    assert!(matches!(
        fails(&bad, SmoothParams::default()),
        SmoothError::Clip(_)
    ));
}

#[test]
fn a_listener_can_stop_it() {
    struct Stop;
    impl Progress for Stop {
        fn cancelled(&self) -> bool {
            true
        }
    }
    let clip = one_joint(100.0, 11, still, |_| Vec3::zeros());
    assert_eq!(
        compress(&clip, &SmoothParams::default(), &Stop),
        Err(SmoothError::Cancelled)
    );
}
