//! Streams that do not go on as they should.

use super::*;

#[test]
fn times_that_are_no_seconds_are_reported() {
    let poses = performance(0, 60.0);
    let at = |time: fn(f64) -> f64| -> Vec<Timed> {
        poses
            .iter()
            .map(|(secs, pose)| (time(*secs), *pose))
            .collect()
    };
    let label = "time is not in seconds";
    for (time, said) in [
        ((|t| t * 1e3) as fn(f64) -> f64, "milliseconds"),
        (|t| t * 1e6, "microseconds"),
        (|t| t * 60.0, "frame numbers"),
        (|t| t * 1e-3, "0.017 ms apart"),
    ] {
        let diagnoser = punctual(&at(time));
        assert_eq!(labels(&diagnoser), [label], "{said}");
        let text = worst(&diagnoser);
        assert!(text.contains(said), "{text}");
    }
    assert_eq!(found(&at(|_| 1.0)), ["times do not increase"]);
    // It is said within two seconds.
    assert_eq!(found(&at(|t| t * 1e3)[..60]), [label]);
}

#[test]
fn bodies_that_do_not_move_and_nobody_are_reported() {
    let poses = performance(0, 60.0);
    let still: Vec<Timed> = poses.iter().map(|(secs, _)| (*secs, poses[0].1)).collect();
    assert_eq!(found(&still), ["nothing moves"]);
    assert_eq!(found(&still[..120]), ["nothing moves"]);
    let empty: Vec<Timed> = poses
        .iter()
        .map(|(secs, _)| (*secs, KeyPose::default()))
        .collect();
    assert_eq!(found(&empty), ["nobody there"]);
    assert_eq!(
        found(&moved(&poses, |_, _| Vec3::zeros())),
        ["nobody there"]
    );
}

#[test]
fn floors_that_move_and_hips_that_do_not_are_reported() {
    for number in 0..4 {
        let glide = |(secs, pose): &Timed| {
            moved(&[(*secs, *pose)], |_, p| {
                p + Vec3::new(1.4 * secs, 0.0, 0.3 * secs)
            })[0]
        };
        let poses: Vec<Timed> = performance(number, 60.0).iter().map(glide).collect();
        assert_eq!(found(&poses), ["moving floor"], "person {number}");
        let seat = |(secs, pose): &Timed| {
            let hips = pose.get(Role::Hips).unwrap();
            moved(&[(*secs, *pose)], |_, p| p - hips)[0]
        };
        let poses: Vec<Timed> = performance(number, 60.0).iter().map(seat).collect();
        assert_eq!(found(&poses), ["hips do not move"], "person {number}");
    }
}

#[test]
fn joints_that_are_missing_or_flicker_are_reported() {
    let poses = performance(0, 60.0);
    let without = |gone: &dyn Fn(usize, Role) -> bool| -> Vec<Timed> {
        let mut poses = poses.clone();
        for (at, (_, pose)) in poses.iter_mut().enumerate() {
            for role in Role::ALL.into_iter().filter(|role| gone(at, *role)) {
                pose.set(role, Vec3::repeat(f64::NAN));
            }
        }
        poses
    };
    let hand = Role::LeftHand;
    assert_eq!(found(&without(&|_, role| role == hand)), ["joints missing"]);
    assert_eq!(
        found(&without(&|at, role| role == hand && at % 3 > 0)),
        ["joints come and go"]
    );
    let legs = |role: Role| role.name().contains("thigh");
    let arms = |role: Role| role.name().ends_with("_arm");
    // The shoulders say which way the body faces where the hip joints are not seen.
    assert_eq!(found(&without(&|_, role| legs(role))), ["joints missing"]);
    assert_eq!(
        found(&without(&|_, role| legs(role) || arms(role))),
        ["no hip joints or shoulders", "joints missing"]
    );
    // At a desk: a note, in words that fit, and the size by the arms in whatever unit.
    for unit in [1.0, 1000.0] {
        let lower = |role: Role| {
            ["thigh", "shin", "foot", "hips", "torso"]
                .iter()
                .any(|part| role.name().contains(part))
        };
        let desk = moved(&without(&|_, role| lower(role)), |_, place| place * unit);
        let mut diagnoser = Diagnoser::whole();
        desk.iter()
            .for_each(|(secs, pose)| diagnoser.push(*secs, *secs, pose));
        let diagnosis = diagnoser.diagnosis();
        let said: Vec<String> = diagnosis.findings().iter().map(|f| f.to_string()).collect();
        assert_eq!(said.len(), 1, "{said:?}");
        assert!(
            said[0].starts_with("the stream has neither hips nor legs"),
            "{said:?}"
        );
        assert!(!said[0].contains("missing:"), "{said:?}");
        assert_eq!(diagnosis.metres_per_unit * unit, 1.0);
        assert!(
            (0.35..0.8).contains(&diagnosis.arm_m.unwrap()),
            "{diagnosis}"
        );
        assert!(diagnosis.to_string().starts_with("half a body, arms"));
        // And its vertical by the head.
        let lying = moved(&desk, |_, p| Vec3::new(p.x, -p.z, p.y));
        assert!(
            found(&lying).contains(&"Y is not up"),
            "{:?}",
            found(&lying)
        );
    }
    // Skeletons without these are common, and nothing is lost.
    let spare = |role: Role| role.name().contains("shoulder") || role == Role::Torso;
    assert_eq!(found(&without(&|_, role| spare(role))), [""; 0]);
}

#[test]
fn frames_that_are_few_lost_repeated_or_uneven_are_reported() {
    let poses = performance(0, 60.0);
    let few: Vec<Timed> = poses.iter().step_by(8).copied().collect();
    assert_eq!(found(&few), ["few frames"]);
    let mut rng = Rng::new(2);
    let lost: Vec<Timed> = poses.iter().filter(|_| !rng.chance(0.2)).copied().collect();
    assert_eq!(found(&lost), ["frames lost"]);
    let held: Vec<Timed> = (0..poses.len())
        .map(|i| (poses[i].0, poses[i & !1].1))
        .collect();
    assert_eq!(found(&held), ["frames repeated"]);
    // Every packet comes twice, as through two network cards.
    let doubled: Vec<Timed> = (poses.iter())
        .flat_map(|&(secs, pose)| [(secs, pose), (secs + 1e-4, pose)])
        .collect();
    assert_eq!(found(&doubled), ["frames repeated"]);
    let mut diagnoser = Diagnoser::live();
    for (at, (secs, pose)) in poses.iter().enumerate() {
        // Three at once, a tenth of a second apart.
        diagnoser.push(*secs, (at / 6) as f64 * 0.1, pose);
    }
    assert_eq!(labels(&diagnoser), ["uneven arrival"]);
}
