//! Worlds and bodies that are not as they should be.

use super::*;

#[test]
fn turned_worlds_are_told_with_what_to_send() {
    // What is sent, and what must be sent instead: the sentence says it, and it is right.
    type Case = (
        &'static str,
        fn(Vec3) -> Vec3,
        &'static str,
        fn(Vec3) -> Vec3,
    );
    let cases: [Case; 8] = [
        (
            "upside down",
            |p| Vec3::new(p.x, -p.y, -p.z),
            "[x, -y, -z]",
            |p| Vec3::new(p.x, -p.y, -p.z),
        ),
        (
            "upside down",
            |p| Vec3::new(p.x, -p.y, p.z),
            "[x, -y, z]",
            |p| Vec3::new(p.x, -p.y, p.z),
        ),
        (
            "Y is not up",
            |p| Vec3::new(p.x, -p.z, p.y),
            "[x, z, -y]",
            |p| Vec3::new(p.x, p.z, -p.y),
        ),
        (
            "Y is not up",
            |p| Vec3::new(p.x, p.z, p.y),
            "[x, z, y]",
            |p| Vec3::new(p.x, p.z, p.y),
        ),
        (
            "Y is not up",
            |p| Vec3::new(p.x, p.z, -p.y),
            "[x, -z, y]",
            |p| Vec3::new(p.x, -p.z, p.y),
        ),
        (
            "Y is not up",
            |p| Vec3::new(p.y, -p.x, p.z),
            "[-y, x, z]",
            |p| Vec3::new(-p.y, p.x, p.z),
        ),
        (
            "Y is not up",
            |p| Vec3::new(-p.y, p.x, p.z),
            "[y, -x, z]",
            |p| Vec3::new(p.y, -p.x, p.z),
        ),
        (
            "Y is not up",
            |p| Vec3::new(p.y, p.x, p.z),
            "[y, x, z]",
            |p| Vec3::new(p.y, p.x, p.z),
        ),
    ];
    let poses = performance(1, 60.0);
    for (label, spoil, send, mend) in cases {
        let spoiled = moved(&poses, |_, p| spoil(p));
        assert_eq!(found(&spoiled), [label], "{send}");
        let text = worst(&punctual(&spoiled));
        assert!(text.contains(&format!("send {send}")), "{text}");
        assert_eq!(found(&moved(&spoiled, |_, p| mend(p))), [""; 0], "{send}");
    }
}

#[test]
fn exchanged_sides_and_the_wrong_hand_are_reported() {
    for number in 0..6 {
        let poses = performance(number, 60.0);
        assert_eq!(
            found(&moved(&poses, |_, p| Vec3::new(-p.x, p.y, p.z))),
            ["left and right exchanged"]
        );
        let named = |(secs, pose): &Timed| {
            let mut new = KeyPose::default();
            for role in Role::ALL {
                new.set(
                    other_side(role),
                    pose.get(role).unwrap_or(Vec3::repeat(f64::NAN)),
                );
            }
            (*secs, new)
        };
        let poses: Vec<Timed> = poses.iter().map(named).collect();
        assert_eq!(found(&poses), ["left and right exchanged"]);
    }
}

#[test]
fn tilted_worlds_are_told_by_how_much() {
    let poses = performance(2, 60.0);
    for (axis, degrees) in [
        (Axis::X, 18f64),
        (Axis::Z, 18.0),
        (Axis::X, -20.0),
        (Axis::Z, -30.0),
    ] {
        let turn = axis.rotation(degrees.to_radians());
        let tilted = moved(&poses, |_, p| turn * p);
        assert_eq!(found(&tilted), ["tilted"], "{degrees}°");
        let mut diagnoser = Diagnoser::whole();
        tilted
            .iter()
            .for_each(|(secs, pose)| diagnoser.push(*secs, *secs, pose));
        let tilt = diagnoser.diagnosis().tilt_rad.unwrap().to_degrees();
        assert!((tilt - degrees.abs()).abs() < 6.0, "{tilt} for {degrees}");
    }
}

#[test]
fn noise_is_measured_and_reported() {
    for rate_hz in [30.0, 60.0, 120.0] {
        for (sigma_m, expected) in [(0.002, ""), (0.01, "noisy"), (0.02, "noisy")] {
            let mut rng = Rng::new(5);
            let mut normal = || sigma_m * rng.normal();
            let poses = moved(&performance(0, rate_hz), |_, p| {
                p + Vec3::new(normal(), normal(), normal())
            });
            assert_eq!(
                found(&poses).join(""),
                expected,
                "{sigma_m} m at {rate_hz} Hz"
            );
            let mut diagnoser = Diagnoser::whole();
            poses
                .iter()
                .for_each(|(secs, pose)| diagnoser.push(*secs, *secs, pose));
            let noise_m = diagnoser.diagnosis().noise_m.unwrap();
            assert!(
                (0.7..1.4).contains(&(noise_m / sigma_m)),
                "{noise_m} for {sigma_m} at {rate_hz} Hz"
            );
        }
    }
}

#[test]
fn spikes_are_reported() {
    for rate_hz in [30.0, 120.0] {
        let mut rng = Rng::new(9);
        let mut poses = performance(3, rate_hz);
        for (_, pose) in &mut poses {
            if rng.chance(0.03) {
                let role = Role::ALL[rng.below(Role::COUNT)];
                if let Some(place) = pose.get(role) {
                    pose.set(role, place + Vec3::new(0.0, 0.7, 0.7));
                }
            }
        }
        assert_eq!(found(&poses), ["spikes"], "{rate_hz} Hz");
    }
}
