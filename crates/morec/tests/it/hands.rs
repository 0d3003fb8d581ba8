//! Hands that are made here: signs that are held, gestures, another performer, the other hand.

use morec::TimeSpan;
use morec::clip::{Clip, Points};
use morec::features::Hand;
use morec::import::Take;
use morec::index::{Model, MotionIndex, Provenance};
use morec::labels::Sample;
use morec::live::recognize_clip;
use morec::math::{Axis, Quat, Vec3};
use morec::roles::Role;
use morec::train::{LabelSet, TrainClip, TrainOptions, train_clips};

const RATE_HZ: f64 = 60.0;

/// How a hand is at one instant.
#[derive(Clone, Copy)]
struct Pose {
    /// Bend of each finger's joints, radians.
    bend: [f64; 5],
    /// Where the palm is, lengths of a hand; its turning about the vertical.
    place: Vec3,
    yaw_rad: f64,
}

const AT_EASE: Pose = Pose {
    bend: [0.35; 5],
    place: Vec3::new(0.0, 1.5, 0.0),
    yaw_rad: 0.0,
};

/// A performer's hand, as a tracker without names of sides films it.
struct Filming {
    hand: Hand,
    length_m: f64,
    tracks: Vec<Vec<Vec3>>,
    labels: Vec<(&'static str, f64, f64)>,
    frame: usize,
}

/// The points that are filmed: no wrist, as of a Leap.
fn filmed(hand: Hand) -> Vec<(Role, String)> {
    let points = hand.points();
    let all = std::iter::once(points.palm).chain(points.fingers.into_iter().flatten());
    let bare = |role: Role| {
        role.name()
            .trim_start_matches("left_")
            .trim_start_matches("right_")
    };
    all.map(|role| (role, bare(role).to_owned())).collect()
}

impl Filming {
    fn new(hand: Hand, length_m: f64) -> Self {
        Self {
            hand,
            length_m,
            tracks: vec![Vec::new(); 21],
            labels: Vec::new(),
            frame: 0,
        }
    }

    fn shoot(&mut self, pose: Pose) {
        let sway = (self.frame as f64 * 0.07).sin() * 0.01;
        let side = match self.hand {
            Hand::Right => 1.0,
            Hand::Left => -1.0,
        };
        let turn: Quat = Axis::Y.rotation(pose.yaw_rad);
        let mut points = vec![Vec3::new(0.0, 0.0, 0.3)];
        for (finger, bend) in pose.bend.iter().enumerate() {
            let mut at = Vec3::new((2.5 - finger as f64) * 0.11, 0.0, 0.5);
            if finger == 0 {
                at.z = 0.2;
            }
            for joint in 0..4 {
                points.push(at);
                let turned = (bend + sway) * (joint + 1) as f64;
                at += Vec3::new(0.0, -turned.sin(), turned.cos()) * 0.14;
            }
        }
        for (track, point) in self.tracks.iter_mut().zip(points) {
            let mut at = turn * point + pose.place + Vec3::repeat(sway);
            at.x *= side;
            track.push(at * self.length_m);
        }
        self.frame += 1;
    }

    fn play(mut self, secs: f64, pose: impl Fn(f64) -> Pose) -> Self {
        let frames = (secs * RATE_HZ) as usize;
        (0..frames).for_each(|f| self.shoot(pose(f as f64 / frames as f64)));
        self
    }

    fn rest(self, secs: f64) -> Self {
        self.play(secs, |_| AT_EASE)
    }

    /// A sign or a gesture, from the hand at ease and back.
    fn show(mut self, class: &'static str, secs: f64) -> Self {
        let start = self.frame as f64 / RATE_HZ;
        self = self.play(secs, |t| {
            // Out within a sixth of the time, and back.
            let out = (6.0 * t).min(6.0 * (1.0 - t)).min(1.0);
            let swing = (std::f64::consts::PI * t).sin();
            let bend = |to: [f64; 5]| std::array::from_fn(|f| 0.35 + (to[f] - 0.35) * out);
            let there = |x: f64, z: f64| AT_EASE.place + Vec3::new(x, 0.0, z) * swing;
            match class {
                "point" => Pose {
                    bend: bend([0.8, 0.0, 0.8, 0.8, 0.8]),
                    ..AT_EASE
                },
                "peace" => Pose {
                    bend: bend([0.8, 0.0, 0.0, 0.8, 0.8]),
                    ..AT_EASE
                },
                "grab" => Pose {
                    bend: std::array::from_fn(|_| 0.35 + 0.5 * swing),
                    ..AT_EASE
                },
                "push" => Pose {
                    place: there(0.0, 1.5),
                    ..AT_EASE
                },
                "swipe" => Pose {
                    place: there(1.5, 0.0),
                    ..AT_EASE
                },
                _ => AT_EASE,
            }
        });
        self.labels
            .push((class, start, self.frame as f64 / RATE_HZ));
        self
    }

    fn take(self, name: &str) -> (Take, Vec<Sample>) {
        let names = filmed(self.hand).into_iter().map(|(_, name)| name);
        let points = names.zip(self.tracks);
        let clip = Clip::of_points(name.to_owned(), RATE_HZ, points, Points::default());
        let take = Take::new(clip).unwrap();
        let sample = |(class, start_secs, stop_secs): (&str, f64, f64)| Sample {
            clip: name.to_owned(),
            class: class.to_owned(),
            span: TimeSpan::new(start_secs, stop_secs),
            whole_clip: false,
            person: None,
            line: 2,
        };
        (take, self.labels.into_iter().map(sample).collect())
    }
}

const CLASSES: [&str; 5] = ["grab", "peace", "point", "push", "swipe"];

fn secs(class: &str, pace: f64) -> f64 {
    match class {
        "point" | "peace" => 1.8 * pace,
        _ => 0.7 * pace,
    }
}

fn everything(hand: Hand, length_m: f64, pace: f64, order: &[&'static str]) -> Filming {
    order
        .iter()
        .fold(Filming::new(hand, length_m).rest(1.5), |filming, class| {
            filming.show(class, secs(class, pace)).rest(1.5)
        })
}

/// An index of two samples of each class by a right hand.
fn taught() -> MotionIndex {
    let takes = [("a", 1.0), ("b", 1.15)]
        .map(|(name, pace)| everything(Hand::Right, 0.19, pace, &CLASSES).take(name));
    let mut samples = Vec::new();
    let mut clips = Vec::new();
    for (take, of_take) in takes {
        samples.extend(of_take);
        clips.push(TrainClip::from(take));
    }
    let classes: Vec<String> = CLASSES.iter().map(|c| (*c).to_owned()).collect();
    let labelling = LabelSet {
        samples: &samples,
        held_back: &[],
        classes: &classes,
        unlabelled_is_background: true,
    };
    let (model, _) = train_clips(&clips, &labelling, &TrainOptions::default(), &()).unwrap();
    let index = MotionIndex {
        model: model.into(),
        roles: Default::default(),
        provenance: Provenance::default(),
    };
    let read = MotionIndex::from_bytes(&index.to_bytes().unwrap()).unwrap();
    assert_eq!(read, index, "a file holds all of it");
    read
}

fn events(model: &Model, take: &Take) -> Vec<String> {
    let found = recognize_clip(model, &take.clip, &take.roles, &(0..0)).unwrap();
    let mut found: Vec<_> = found.into_iter().collect();
    found.sort_by(|a, b| a.span.start_secs.total_cmp(&b.span.start_secs));
    let name = |class| model.class_name(class).to_owned();
    found.into_iter().map(|d| name(d.class)).collect()
}

#[test]
fn signs_and_gestures_of_a_hand_are_recognised_on_other_hands() {
    let index = taught();
    let order = ["swipe", "point", "push", "grab", "peace", "push", "point"];
    for (hand, length_m, pace) in [
        (Hand::Right, 0.19, 1.05),
        (Hand::Right, 0.16, 0.95),
        (Hand::Left, 0.21, 1.1),
    ] {
        let (take, _) = everything(hand, length_m, pace, &order).take("test");
        assert_eq!(take.report.point_set, Some("points of a hand"));
        assert_eq!(events(&index.model, &take), order, "{hand:?}, {length_m} m");
    }
}

#[test]
fn a_hand_at_ease_raises_nothing_and_one_that_passes_through_a_sign_holds_none() {
    let index = taught();
    let quick = Filming::new(Hand::Right, 0.19)
        .rest(2.0)
        .show("point", 0.4)
        .rest(4.0);
    let found = events(&index.model, &quick.take("quick").0);
    // Fingers that close and open again for a moment may be a grab.
    assert!(found.iter().all(|class| class == "grab"), "{found:?}");
    let idle = Filming::new(Hand::Right, 0.19).rest(12.0).take("idle").0;
    assert!(events(&index.model, &idle).is_empty());
}
