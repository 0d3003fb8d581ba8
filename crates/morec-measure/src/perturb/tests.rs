use super::*;
use morec::features::KeyPose;
use morec::math::Vec3;
use morec::roles::Role;

fn still(frames: usize) -> Vec<(f64, KeyPose)> {
    let mut pose = KeyPose::default();
    pose.set(Role::LeftThigh, Vec3::new(0.1, 0.85, 0.0));
    pose.set(Role::LeftShin, Vec3::new(0.1, 0.45, 0.0));
    pose.set(Role::LeftFoot, Vec3::new(0.1, 0.0, 0.0));
    pose.set(Role::RightHand, Vec3::new(-0.5, 1.0, 0.2));
    (0..frames).map(|f| (f as f64 / 100.0, pose)).collect()
}

/// Deviation of the hand's x over time, about its mean.
fn deviation(poses: &[(f64, KeyPose)]) -> f64 {
    let x: Vec<f64> = poses
        .iter()
        .map(|(_, p)| p.get(Role::RightHand).unwrap().x)
        .collect();
    let mean = x.iter().sum::<f64>() / x.len() as f64;
    (x.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / x.len() as f64).sqrt()
}

#[test]
fn noise_has_the_size_that_was_asked_for() {
    let white = perturb(still(4000), &[Perturbation::White(0.02)], 1);
    assert!((deviation(&white.poses) - 0.02).abs() < 0.002);
    let slow = perturb(still(20_000), &[Perturbation::Slow(0.02)], 1);
    assert!((deviation(&slow.poses) - 0.02).abs() < 0.004);
    let constant = perturb(still(100), &[Perturbation::Constant(0.02)], 1);
    assert!(deviation(&constant.poses) < 1e-12);
    assert_ne!(constant.poses[0].1, still(1)[0].1);
}

#[test]
fn slow_noise_moves_little_from_frame_to_frame() {
    let slow = perturb(still(2000), &[Perturbation::Slow(0.02)], 1).poses;
    let x = |i: usize| {
        let (_, pose) = &slow[i];
        pose.get(Role::RightHand).unwrap().x
    };
    assert!((1..2000).all(|i| (x(i) - x(i - 1)).abs() < 0.004));
}

#[test]
fn tilt_keeps_distances() {
    let tilted = perturb(still(1), &[Perturbation::Tilt(10.0)], 3).poses[0].1;
    let place = |role| tilted.get(role).unwrap();
    let shin = place(Role::LeftShin) - place(Role::LeftFoot);
    assert!((shin.norm() - 0.45).abs() < 1e-9);
    let up = shin.normalize().y;
    assert!((up - 10f64.to_radians().cos()).abs() < 1e-9);
}

#[test]
fn the_clock_follows_lost_frames_and_another_pace() {
    let slower = perturb(still(101), &[Perturbation::Duration(2.0)], 1);
    assert!((slower.secs_in_copy(0.5) - 1.0).abs() < 1e-9);
    let fewer = perturb(still(1001), &[Perturbation::Drop(0.3)], 1);
    let share = fewer.poses.len() as f64 / 1001.0;
    assert!((share - 0.7).abs() < 0.05);
    assert!((fewer.secs_in_copy(10.0) - 10.0 * share).abs() < 0.02);
    let step = fewer.poses[500].0 - fewer.poses[499].0;
    assert!(
        (step - 0.01).abs() < 1e-9,
        "lost frames leave no gap behind"
    );
}

#[test]
fn a_mirror_twice_is_no_mirror() {
    let twice = perturb(still(1), &[Perturbation::Mirror; 2], 1);
    assert_eq!(twice.poses, still(1));
    let once = still(1)[0].1.mirrored();
    assert_eq!(once.get(Role::LeftHand), Some(Vec3::new(0.5, 1.0, 0.2)));
    assert_eq!(once.get(Role::RightHand), None);
}

#[test]
fn another_rate_interpolates() {
    let mut poses = still(2);
    poses[1].1.set(Role::RightHand, Vec3::new(0.5, 1.0, 0.2));
    let copy = perturb(poses, &[Perturbation::Rate(200.0)], 1).poses;
    assert_eq!(copy.len(), 3);
    assert!((copy[1].1.get(Role::RightHand).unwrap().x).abs() < 1e-9);
}

#[test]
fn names_are_read_as_they_are_written() {
    for text in [
        "white:0.01",
        "slow:0.02",
        "const:0.02",
        "tilt:7",
        "speed:0.7",
        "drop:0.3",
        "repeat:0.1",
        "spikes:0.02",
        "mirror",
        "cam:1",
        "rate:30",
    ] {
        assert_eq!(text.parse::<Perturbation>().unwrap().to_string(), text);
    }
    for text in [
        "", "white", "white:x", "drop:1.5", "speed:0", "noise:1", "white:-1",
    ] {
        assert!(text.parse::<Perturbation>().is_err(), "{text}");
    }
}

#[test]
fn an_empty_sequence_stays_empty() {
    for text in [
        "white:0.01",
        "slow:0.02",
        "drop:0.3",
        "cam:1",
        "rate:30",
        "mirror",
    ] {
        let copy = perturb(vec![], &[text.parse().unwrap()], 1);
        assert!(copy.poses.is_empty());
        assert_eq!(copy.secs_in_copy(1.0), 1.0);
    }
}
