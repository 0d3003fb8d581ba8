//! Synthetic bodies put through each fault give exactly that finding, and none without; real clips give none.

mod bodies;
mod hands;
mod streams;

use super::*;
use crate::import::{ImportOptions, normalize};
use crate::synth::{DatabaseSpec, Person, Rng, Script, database};

type Timed = (f64, KeyPose);

/// A person who waves, bows and walks: key poses with their times.
fn performance(number: usize, rate_hz: f64) -> Vec<Timed> {
    let script = Script::new(40 + number as u64, Person::draw(31, number))
        .rest(1.2)
        .play("wave")
        .rest(0.6)
        .play("walk")
        .rest(0.5)
        .play("bow")
        .rest(0.8);
    let take = script.film("performance", rate_hz).unwrap();
    let imported = normalize(take.clip, &ImportOptions::default()).unwrap();
    let mut poses = Vec::new();
    let rest = &imported.report.rest_frames;
    for_each_pose(&imported.clip, &imported.roles, rest, |secs, pose| {
        poses.push((secs, *pose))
    });
    poses
}

/// Findings in `poses` as a live stream that arrives as it was performed, and as a recording.
fn found(poses: &[Timed]) -> Vec<&'static str> {
    let mut diagnoser = Diagnoser::live();
    for (at, (secs, pose)) in poses.iter().enumerate() {
        diagnoser.push(*secs, at as f64 / 60.0, pose);
    }
    labels(&diagnoser)
}

/// What a live stream whose poses arrive at their times is told.
fn punctual(poses: &[Timed]) -> Diagnoser {
    let mut diagnoser = Diagnoser::live();
    poses
        .iter()
        .for_each(|(secs, pose)| diagnoser.push(*secs, *secs, pose));
    diagnoser
}

fn worst(diagnoser: &Diagnoser) -> String {
    let diagnosis = diagnoser.diagnosis();
    diagnosis.findings().worst().unwrap().to_string()
}

fn labels(diagnoser: &Diagnoser) -> Vec<&'static str> {
    diagnoser
        .diagnosis()
        .findings()
        .iter()
        .map(Finding::label)
        .collect()
}

/// Each pose with every joint at another place.
fn moved(poses: &[Timed], mut to: impl FnMut(Role, Vec3) -> Vec3) -> Vec<Timed> {
    let one = |(secs, pose): &Timed| {
        let mut new = KeyPose::default();
        for role in Role::ALL {
            if let Some(place) = pose.get(role) {
                new.set(role, to(role, place));
            }
        }
        (*secs, new)
    };
    poses.iter().map(one).collect()
}

fn other_side(role: Role) -> Role {
    let name = role.name();
    let other = match name.split_once('_') {
        Some(("left", part)) => format!("right_{part}"),
        Some(("right", part)) => format!("left_{part}"),
        _ => name.to_owned(),
    };
    Role::from_name(&other).unwrap()
}

#[test]
fn clean_streams_of_any_person_and_rate_give_no_finding() {
    for number in 0..6 {
        for rate_hz in [30.0, 60.0, 120.0] {
            let poses = performance(number, rate_hz);
            assert_eq!(found(&poses), [""; 0], "person {number} at {rate_hz} Hz");
            // Turned about the vertical, far away, in centimetres.
            let turn = Axis::Y.rotation(2.0);
            let away = moved(&poses, |_, p| {
                (turn * p + Vec3::new(1e4, 0.0, -3e3)) * 100.0
            });
            assert_eq!(found(&away), [""; 0], "person {number} far away");
        }
    }
}

#[test]
fn at_every_moment_of_a_clean_stream_nothing_is_found() {
    for number in 0..4 {
        let mut diagnoser = Diagnoser::live();
        for (secs, pose) in performance(number, 60.0) {
            diagnoser.push(secs, secs, &pose);
            assert_eq!(labels(&diagnoser), [""; 0], "person {number} at {secs} s");
        }
    }
}

#[test]
fn takes_of_the_synthetic_database_give_no_finding() {
    for take in database(
        3,
        &DatabaseSpec {
            people: 4,
            ..DatabaseSpec::default()
        },
    ) {
        let imported = normalize(take.clip, &ImportOptions::default()).unwrap();
        let rest = &imported.report.rest_frames;
        let diagnosis = diagnose_clip(&imported.clip, &imported.roles, rest);
        assert!(
            diagnosis.findings().is_empty(),
            "{}: {diagnosis:?}",
            imported.clip.name
        );
    }
}

#[test]
fn figures_are_those_of_the_body() {
    let person = Person {
        height_m: 1.72,
        ..Person::average()
    };
    let take = Script::new(3, person)
        .rest(1.0)
        .play("wave")
        .rest(1.0)
        .film("figures", 60.0)
        .unwrap();
    let imported = normalize(take.clip, &ImportOptions::default()).unwrap();
    let known = diagnose_clip(&imported.clip, &imported.roles, &(0..0));
    assert!(
        (known.leg_m.unwrap() - 0.491 * 1.72).abs() < 0.01,
        "{known:?}"
    );
    assert!((known.rate_hz.unwrap() - 60.0).abs() < 0.1);
    assert!(known.tilt_rad.unwrap() < 0.1 && known.stands);
    assert!(known.lost_share == 0.0 && known.jitter_secs.unwrap() < 1e-6);
    assert!(known.to_string().contains("upright"), "{known}");
}

#[test]
fn odd_sizes_are_told_and_common_units_are_known() {
    let poses = performance(0, 60.0);
    for scale in [100.0, 1000.0, 1.0 / 0.0254, 1.0 / 0.3048] {
        assert_eq!(found(&moved(&poses, |_, p| p * scale)), [""; 0], "{scale}");
    }
    assert_eq!(found(&moved(&poses, |_, p| p * 1e-4)), ["odd size"]);
}

#[test]
fn a_stream_that_is_mended_is_found_well_again() {
    let poses = performance(0, 60.0);
    let mut diagnoser = Diagnoser::live();
    let upside_down = moved(&poses[..240], |_, p| Vec3::new(p.x, -p.y, -p.z));
    upside_down
        .iter()
        .for_each(|(secs, pose)| diagnoser.push(*secs, *secs, pose));
    assert_eq!(labels(&diagnoser), ["upside down"]);
    for lap in 0..4 {
        for (secs, pose) in &poses {
            let secs = 4.5 + secs + f64::from(lap) * (poses.len() as f64 / 60.0);
            diagnoser.push(secs, secs, pose);
        }
    }
    assert_eq!(labels(&diagnoser), [""; 0]);
}

#[test]
fn whatever_is_pushed_nothing_panics_and_json_tells_all() {
    let mut rng = Rng::new(77);
    for _ in 0..300 {
        let mut diagnoser = if rng.chance(0.5) {
            Diagnoser::live()
        } else {
            Diagnoser::whole()
        };
        let size = 10f64.powf(rng.range(-30.0, 30.0));
        let step = 10f64.powf(rng.range(-9.0, 9.0));
        let mut secs = 0.0;
        for _ in 0..rng.below(200) {
            let mut pose = KeyPose::default();
            for role in Role::ALL {
                if rng.chance(0.8) {
                    let mut coordinate = || {
                        if rng.chance(0.02) {
                            f64::INFINITY
                        } else {
                            size * rng.normal()
                        }
                    };
                    pose.set(role, Vec3::new(coordinate(), coordinate(), coordinate()));
                }
            }
            secs += if rng.chance(0.05) {
                f64::NAN
            } else {
                step * rng.range(-0.2, 1.0)
            };
            diagnoser.push(secs, step * rng.range(0.0, 9.0), &pose);
            if secs.is_nan() {
                secs = 0.0;
            }
        }
        let diagnosis = diagnoser.diagnosis();
        let json = serde_json::to_value(diagnosis.findings()).unwrap();
        let list = json.as_array().unwrap();
        assert_eq!(list.len(), diagnosis.findings().len());
        for entry in list {
            for key in ["kind", "severity", "text"] {
                assert!(
                    entry[key].as_str().is_some_and(|text| !text.is_empty()),
                    "{entry}"
                );
            }
        }
        serde_json::to_string(&diagnosis).unwrap();
        let _ = diagnosis.to_string();
    }
}
