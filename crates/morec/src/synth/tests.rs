//! Properties of every motion, for any synthetic person.

use std::collections::BTreeMap;

use super::*;
use crate::kinematics::WorldPose;
use crate::math::Vec3;

/// Every motion there is by somebody, `people` times over.
fn every_motion(people: usize, rate_hz: f64) -> Vec<SyntheticTake> {
    let film = |n: usize, m: SyntheticMotion| {
        let person = Person::draw(11, n);
        let script = Script::new(n as u64, person)
            .rest(0.3)
            .play(m.name())
            .rest(0.5)
            .play(m.name())
            .rest(0.3);
        script
            .film(m.name(), rate_hz)
            .expect("a motion of its own list")
    };
    (0..people)
        .flat_map(|n| motions().map(move |m| film(n, m)))
        .collect()
}

/// FNV-1a over the bits of all rotations and positions.
fn hash<'a>(clips: impl Iterator<Item = &'a Clip>) -> u64 {
    let mut hash = 0xcbf2_9ce4_8422_2325u64;
    for clip in clips {
        let rotations = clip.rotations.iter().flat_map(|q| q.coords.iter().copied());
        let positions = clip
            .tracks
            .iter()
            .flat_map(|t| t.positions.iter())
            .flat_map(|p| p.iter().copied());
        for value in rotations.chain(positions) {
            hash = (hash ^ value.to_bits()).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
    hash
}

fn joint(clip: &Clip, name: &str) -> usize {
    clip.skeleton
        .find(name)
        .expect("a joint of the synthetic skeleton")
}

#[test]
fn a_seed_gives_the_same_clips_on_every_platform() {
    let spec = DatabaseSpec {
        people: 2,
        repetitions: 1,
        rate_hz: 30.0,
        ..DatabaseSpec::default()
    };
    let takes = |seed| database(seed, &spec);
    assert_eq!(takes(1), takes(1));
    assert_ne!(
        hash(takes(1).iter().map(|t| &t.clip)),
        hash(takes(2).iter().map(|t| &t.clip))
    );
    // Changes when a motion is changed on purpose; never from one machine to the next.
    assert_eq!(hash(takes(1).iter().map(|t| &t.clip)), DATABASE_1);
}

const DATABASE_1: u64 = 9_666_035_036_872_803_270;

#[test]
fn joints_turn_no_faster_than_bodies_can() {
    for rate_hz in [30.0, 120.0] {
        for take in every_motion(3, rate_hz) {
            let clip = &take.clip;
            let n = clip.skeleton.len();
            for (at, q) in clip.rotations.iter().enumerate().skip(n) {
                let speed = q.angle_to(&clip.rotations[at - n]) * rate_hz;
                let (frame, name) = (at / n, &clip.skeleton.joints()[at % n].name);
                assert!(
                    speed < 25.0,
                    "{}: {name} turns at {speed:.1} rad/s in frame {frame}",
                    clip.name
                );
            }
        }
    }
}

#[test]
fn without_noise_every_curve_is_smooth() {
    let rate_hz = 480.0;
    for m in motions() {
        let person = Person::draw(3, 1).noiseless();
        let take = Script::new(9, person)
            .rest(0.2)
            .play(m.name())
            .film(m.name(), rate_hz)
            .expect("known");
        let clip = &take.clip;
        let hands = [joint(clip, "LeftHand"), joint(clip, "RightHand"), 0];
        let poses: Vec<WorldPose> = (0..clip.frames).map(|f| WorldPose::of(clip, f)).collect();
        for (f, three) in poses.windows(3).enumerate() {
            for j in hands {
                let [p, q, r] = [0, 1, 2].map(|k| three[k].positions[j]);
                let acceleration = (p - q * 2.0 + r).norm() * rate_hz * rate_hz;
                // Noise of a thousandth of a radian would give 300 m/s² here, a step of velocity thousands.
                assert!(
                    acceleration < 160.0,
                    "{}: joint {j}, frame {f}: {acceleration:.0} m/s²",
                    clip.name
                );
            }
        }
    }
}

#[test]
fn noise_is_there_unless_it_is_turned_off() {
    let still = |person: Person| {
        let clip = Script::new(1, person)
            .rest(1.0)
            .film("rest", 60.0)
            .expect("no motion to miss")
            .clip;
        clip.rotations
            .chunks(clip.skeleton.len())
            .all(|row| row == clip.frame_rotations(0))
    };
    assert!(!still(Person::draw(1, 0)));
    assert!(still(Person::draw(1, 0).noiseless()));
}

#[test]
fn bones_keep_their_lengths_and_feet_keep_to_the_ground() {
    for take in every_motion(2, 30.0) {
        let clip = &take.clip;
        let bone = |name: &str| clip.skeleton.joints()[joint(clip, name)].offset.norm();
        let pairs = [
            ("LeftArm", "LeftForeArm"),
            ("LeftForeArm", "LeftHand"),
            ("RightUpLeg", "RightLeg"),
        ];
        for f in 0..clip.frames {
            let pose = WorldPose::of(clip, f);
            let at = |name: &str| pose.positions[joint(clip, name)];
            for (a, b) in pairs {
                assert!(((at(b) - at(a)).norm() - bone(b)).abs() < 1e-9);
            }
            let lowest = at("LeftToeBase").y.min(at("RightToeBase").y);
            let jumps =
                ["jump", "run", "jog_on_the_spot", "football"].contains(&clip.name.as_str());
            assert!(
                lowest > -0.04,
                "{}: a foot is {lowest:.3} m under the ground, frame {f}",
                clip.name
            );
            assert!(
                lowest < 0.07 || jumps,
                "{}: both feet {lowest:.3} m up in frame {f}",
                clip.name
            );
        }
    }
}

#[test]
fn a_planted_foot_stays_where_it_is() {
    // While standing and gesticulating, no ankle moves by more than noise and sway let it.
    for name in ["talk", "wave", "bow", "circle", "phone"] {
        let script = Script::new(4, Person::draw(8, 2))
            .rest(0.3)
            .play(name)
            .rest(0.3);
        let clip = script.film(name, 60.0).expect("known").clip;
        for foot in ["LeftFoot", "RightFoot"] {
            let j = joint(&clip, foot);
            let first = WorldPose::of(&clip, 0).positions[j];
            for f in 0..clip.frames {
                let moved = (WorldPose::of(&clip, f).positions[j] - first).norm();
                assert!(
                    moved < 0.05,
                    "{name}: {foot} slid {moved:.3} m by frame {f}"
                );
            }
        }
    }
}

#[test]
fn knees_and_elbows_bend_their_own_way() {
    for take in every_motion(2, 30.0) {
        let clip = &take.clip;
        for f in 0..clip.frames {
            let pose = WorldPose::of(clip, f);
            let bends = [("LeftLeg", Vec3::x(), 1.0), ("RightLeg", Vec3::x(), 1.0)];
            let elbows = [
                ("LeftForeArm", Vec3::y(), -1.0),
                ("RightForeArm", Vec3::y(), 1.0),
            ];
            for (name, hinge, sign) in bends.into_iter().chain(elbows) {
                let local = clip.frame_rotations(f)[joint(clip, name)];
                let bend = local.scaled_axis().dot(&hinge) * sign;
                assert!(
                    bend > -0.03,
                    "{}: {name} is bent by {bend:.2} rad in frame {f}",
                    clip.name
                );
            }
            assert!(pose.positions[joint(clip, "Head")].y > 0.3);
        }
    }
}

#[test]
fn walkers_walk_ahead() {
    for name in ["walk", "run"] {
        let script = Script::new(5, Person::draw(2, 3)).rest(0.2).play(name);
        let clip = script.film(name, 60.0).expect("known").clip;
        let hips: Vec<Vec3> = (0..clip.frames)
            .map(|f| WorldPose::of(&clip, f).positions[0])
            .collect();
        let ahead: f64 = (1..clip.frames)
            .map(|f| {
                (hips[f] - hips[f - 1]).dot(&(WorldPose::of(&clip, f).rotations[0] * Vec3::z()))
            })
            .sum();
        let way: f64 = hips.windows(2).map(|w| (w[1] - w[0]).norm()).sum();
        assert!(
            ahead > 2.0 && ahead > 0.85 * way,
            "{name}: {ahead:.2} m ahead of {way:.2} m"
        );
    }
}

#[test]
fn labels_are_in_range_in_order_and_each_class_comes_as_often_as_asked() {
    let spec = DatabaseSpec {
        people: 3,
        streams: 2,
        repetitions: 2,
        rate_hz: 30.0,
        ..Default::default()
    };
    let takes = database(4, &spec);
    assert_eq!(takes.len(), 6);
    for take in &takes {
        let spans: Vec<_> = take
            .labels
            .iter()
            .map(|l| l.span.frames(spec.rate_hz))
            .collect();
        assert!(
            spans
                .iter()
                .all(|s| s.start < s.end && s.end <= take.clip.frames)
        );
        assert!(spans.windows(2).all(|w| w[0].end <= w[1].start));
        for class in &spec.classes {
            assert_eq!(
                take.labels.iter().filter(|l| l.class == *class).count(),
                2,
                "{class}"
            );
        }
    }
    let everything: f64 = takes.iter().map(|t| t.clip.duration_secs()).sum();
    let labelled: f64 = takes
        .iter()
        .flat_map(|t| &t.labels)
        .map(|l| l.span.duration_secs())
        .sum();
    assert!(
        (0.2..0.7).contains(&(labelled / everything)),
        "labelled share {}",
        labelled / everything
    );
}

#[test]
fn the_frame_rate_changes_the_sampling_only() {
    let script = Script::new(2, Person::draw(1, 4).noiseless())
        .rest(0.5)
        .play("wave")
        .rest(0.5);
    let [slow, fast] = [30.0, 120.0].map(|rate| script.film("wave", rate).expect("known"));
    assert_eq!(slow.labels, fast.labels);
    for f in 0..slow.clip.frames {
        let (a, b) = (
            slow.clip.frame_rotations(f),
            fast.clip.frame_rotations(4 * f),
        );
        assert!(
            a.iter().zip(b).all(|(a, b)| a.angle_to(b) < 1e-6),
            "frame {f}"
        );
    }
}

#[test]
fn a_script_names_what_it_does_not_know() {
    let script = Script::new(1, Person::average()).rest(1.0).play("moonwalk");
    let error = script.film("x", 30.0).expect_err("no such motion");
    assert_eq!((error.line, error.found.as_str()), (2, "moonwalk"));
    assert!(error.to_string().contains("expected one of wave, "));
}

#[test]
fn scripts_keep_their_times() {
    let script = Script::new(1, Person::draw(1, 0))
        .rest_until(2.0)
        .play("bow")
        .rest_until(8.0)
        .play("walk");
    let take = script.film("times", 60.0).expect("known");
    let starts: Vec<f64> = take.labels.iter().map(|l| l.span.start_secs).collect();
    assert!(
        (starts[0] - 2.0).abs() < 0.1 && (starts[1] - 8.0).abs() < 0.1,
        "{starts:?}"
    );
    let kept = take.keep(MotionKind::Gesture);
    assert_eq!(
        kept.labels.iter().map(|l| l.class).collect::<Vec<_>>(),
        ["bow"]
    );
}

#[test]
fn everyday_motion_goes_everywhere_but_shows_no_class() {
    let clips = everyday(1);
    let secs: f64 = clips.iter().map(Clip::duration_secs).sum();
    assert!((300.0..1500.0).contains(&secs), "{secs:.0} s");
    for class in motions_of(MotionKind::Gesture) {
        assert!(
            clips.iter().all(|c| !c.name.contains(class.name())),
            "{}",
            class.name()
        );
    }
    for (side, sign) in [("Left", 1.0), ("Right", -1.0)] {
        let share = occupied_directions(&clips, side, sign);
        println!(
            "{side} upper arm: {:.0} % of the reachable directions visited",
            100.0 * share
        );
        assert!(share > 0.85, "{side}: {share:.2}");
    }
}

/// Share of the 15-degree cells of directions that an upper arm can take in which it is seen at least once. Cells
/// that reach far behind or across the body do not count.
fn occupied_directions(clips: &[Clip], side: &str, sign: f64) -> f64 {
    let mut whole = BTreeMap::new();
    let cell = |v: &Vec3| {
        let polar = (v.y.clamp(-1.0, 1.0).acos().to_degrees() / 15.0) as i32;
        let turns = (v.x.atan2(v.z).to_degrees() + 180.0) / 15.0;
        (polar, (turns * v.xz().norm()) as i32)
    };
    let reachable = |v: &Vec3| v.x > -0.3 && v.z > -0.3;
    for k in 0..40_000 {
        // A spiral of evenly spread directions.
        let y = 1.0 - 2.0 * (k as f64 + 0.5) / 40_000.0;
        let (sin, cos) = (k as f64 * 2.399_963).sin_cos();
        let v = Vec3::new(cos * (1.0 - y * y).sqrt(), y, sin * (1.0 - y * y).sqrt());
        *whole.entry(cell(&v)).or_insert(true) &= reachable(&v);
    }
    let mut cells: BTreeMap<_, _> = whole
        .into_iter()
        .filter(|c| c.1)
        .map(|c| (c.0, false))
        .collect();
    for clip in clips {
        let (chest, arm, elbow) = (
            joint(clip, "Chest"),
            joint(clip, &format!("{side}Arm")),
            joint(clip, &format!("{side}ForeArm")),
        );
        for f in (0..clip.frames).step_by(3) {
            let pose = WorldPose::of(clip, f);
            let v = pose.rotations[chest].inverse()
                * (pose.positions[elbow] - pose.positions[arm]).normalize();
            if let Some(seen) = cells.get_mut(&cell(&Vec3::new(v.x * sign, v.y, v.z))) {
                *seen = true;
            }
        }
    }
    cells.values().filter(|seen| **seen).count() as f64 / cells.len() as f64
}
