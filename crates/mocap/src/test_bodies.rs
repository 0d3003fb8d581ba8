//! Bodies for tests.

// What tests share lies outside of test functions, where the lint looks for it.
#![allow(clippy::unwrap_used)]

use crate::clip::{Clip, Joint, Skeleton};
use crate::formats::{Limits, mclip};
use crate::math::{Axis, Quat, Vec3};
use crate::pose::{Hand, KeyPose};

/// A hand with the palm down whose fingers go along +Z, bent towards the palm by `bend` radians at every joint; `scale` 1 is a metre's.
pub fn flat_hand(hand: Hand, bend: f64, scale: f64) -> KeyPose {
    let side = match hand {
        Hand::Right => 1.0,
        Hand::Left => -1.0,
    };
    let mut pose = KeyPose::default();
    let points = hand.points();
    pose.set(points.wrist, Vec3::zeros());
    pose.set(points.palm, Vec3::new(0.0, 0.0, 0.05) * scale);
    for (number, finger) in points.fingers.iter().enumerate() {
        // Seen from above, fingers ahead, the thumb of a right hand is on the left, which is +X.
        let x = (2.5 - number as f64) * 0.02 * side;
        let mut at = Vec3::new(x, 0.0, if number == 0 { 0.03 } else { 0.09 });
        for (joint, point) in finger.iter().enumerate() {
            pose.set(*point, at * scale);
            let turned = bend * (joint + 1) as f64;
            at += Vec3::new(0.0, -turned.sin(), turned.cos()) * 0.026;
        }
    }
    pose
}

/// The upper half of a person, as a tracker at a desk sends it: the root is the neck, and lengths are millimetres.
pub fn at_a_desk(neck: &str) -> Clip {
    let joints: [(&str, Option<usize>, [f64; 3]); 8] = [
        (neck, None, [0.0, 1250.0, 600.0]),
        ("Head", Some(0), [0.0, 180.0, 20.0]),
        ("LeftShoulder", Some(0), [170.0, -40.0, 0.0]),
        ("LeftElbow", Some(2), [30.0, -250.0, 20.0]),
        ("LeftHand", Some(3), [-20.0, 20.0, 240.0]),
        ("RightShoulder", Some(0), [-170.0, -40.0, 0.0]),
        ("RightElbow", Some(5), [-30.0, -250.0, 20.0]),
        ("RightHand", Some(6), [20.0, 20.0, 240.0]),
    ];
    let joint = |&(name, parent, [x, y, z]): &(&str, Option<usize>, [f64; 3])| Joint {
        name: name.to_owned(),
        parent,
        offset: Vec3::new(x, y, z),
        tip: None,
    };
    let skeleton = Skeleton::new(joints.iter().map(joint).collect()).unwrap();
    let frames = 90;
    let rotations = (0..frames).flat_map(|frame| {
        let mut pose = vec![Quat::identity(); 8];
        pose[5] = Axis::X.rotation(-0.6 * (0.1 * frame as f64).sin().abs());
        pose
    });
    Clip {
        name: "desk".to_owned(),
        rate_hz: 30.0,
        rotations: rotations.collect(),
        tracks: Vec::new(),
        skeleton,
        frames,
        repaired: Vec::new(),
        points: None,
    }
}

/// A clip of the points of `hands` by these names, each hand's in the order of MediaPipe.
pub fn clip_of_hands(hands: &[Hand], name: impl Fn(Hand, usize) -> String) -> Clip {
    let mut joints: Vec<(String, Vec<Vec3>)> = Vec::new();
    for hand in hands {
        let points = hand.points();
        let roles = std::iter::once(points.wrist).chain(points.fingers.into_iter().flatten());
        for (number, role) in roles.enumerate() {
            let place = |frame: usize| {
                let pose = flat_hand(*hand, 0.2 + 0.02 * frame as f64, 1.0);
                pose.get(role).unwrap() + Vec3::x() * 0.2 * hands.len() as f64
            };
            joints.push((name(*hand, number), (0..30).map(place).collect()));
        }
    }
    Clip::of_points("hand".into(), 30.0, joints, Default::default())
}

/// A synthetic person of `morec` who pushes something away, 30 frames a second.
pub fn pushing() -> Clip {
    let bytes = include_bytes!("../testdata/mclip/v1.mclip");
    let loaded = mclip::read(bytes, "push", &Limits::default()).unwrap();
    loaded.clips.into_iter().next().unwrap()
}
