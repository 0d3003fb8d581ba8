//! Whole clips through curves and back; single steps are tested beside their code.

mod properties;
mod single;
mod stored;

use proptest::prelude::*;

use crate::clip::{Clip, Joint, JointTrack, Skeleton};
use crate::math::{Quat, Vec3, same_hemisphere};

/// A clip of one joint, its rotation and position given by functions of time.
pub(crate) fn one_joint(
    rate_hz: f64,
    frames: usize,
    rotation: impl Fn(f64) -> Quat,
    position: impl Fn(f64) -> Vec3,
) -> Clip {
    let times = (0..frames).map(|f| f as f64 / rate_hz);
    let mut rotations: Vec<Quat> = Vec::new();
    for q in times.clone().map(rotation) {
        rotations.push(rotations.last().map_or(q, |last| same_hemisphere(last, q)));
    }
    let root = Joint {
        name: "Hips".into(),
        parent: None,
        offset: Vec3::zeros(),
        tip: None,
    };
    Clip {
        name: "one".into(),
        skeleton: Skeleton::new(vec![root]).unwrap(),
        rate_hz,
        rotations,
        tracks: vec![JointTrack {
            joint: 0,
            positions: times.map(position).collect(),
        }],
        frames,
        repaired: Vec::new(),
        points: None,
    }
}

fn vec3(size: f64) -> impl Strategy<Value = Vec3> {
    [-size..size, -size..size, -size..size].prop_map(Vec3::from)
}

/// A channel's motion: a random walk of this much a frame, with now and then a jump.
fn walk(frames: usize) -> impl Strategy<Value = Vec<Vec3>> {
    let pace = prop_oneof![Just(0.0), Just(0.003), Just(0.05), Just(0.8)];
    (
        pace,
        prop::collection::vec((vec3(1.0), prop::bool::weighted(0.03)), frames),
    )
        .prop_map(|(pace, steps)| {
            let (mut at, mut speed) = (Vec3::zeros(), Vec3::zeros());
            let next = |(step, jump): (Vec3, bool)| {
                speed = speed * 0.8 + step * pace;
                at += if jump { step * 3.0 } else { speed };
                at
            };
            steps.into_iter().map(next).collect()
        })
}

/// Clips of every shape: trees of joints, any number of frames, still, smooth, noisy, jumping.
fn clips() -> impl Strategy<Value = Clip> {
    (1usize..5, prop_oneof![0usize..4, 4usize..60]).prop_flat_map(|(joints, frames)| {
        let offsets = prop::collection::vec(
            (vec3(0.5), any::<prop::sample::Index>(), any::<bool>()),
            joints,
        );
        let turns = prop::collection::vec(walk(frames), joints);
        let moves = prop::collection::vec(prop::option::of(walk(frames)), joints);
        let rate = prop_oneof![Just(30.0), Just(120.0), 10.0f64..200.0];
        (offsets, turns, moves, rate).prop_map(move |(offsets, turns, moves, rate_hz)| {
            let joint =
                |(j, (offset, parent, root)): (usize, (Vec3, prop::sample::Index, bool))| {
                    let parent = (j > 0 && !root).then(|| parent.index(j.max(1)));
                    let tip = root.then(|| offset * 0.3);
                    Joint {
                        name: format!("Joint {j}"),
                        parent,
                        offset,
                        tip,
                    }
                };
            let skeleton =
                Skeleton::new(offsets.into_iter().enumerate().map(joint).collect()).unwrap();
            let mut rotations: Vec<Quat> = Vec::new();
            for frame in 0..frames {
                for turn in &turns {
                    let q = Quat::from_scaled_axis(turn[frame]);
                    let last = rotations
                        .len()
                        .checked_sub(joints)
                        .map_or(q, |i| rotations[i]);
                    rotations.push(same_hemisphere(&last, q));
                }
            }
            let track = |(joint, moves): (usize, Option<Vec<Vec3>>)| {
                Some(JointTrack {
                    joint,
                    positions: moves?,
                })
            };
            let tracks = moves.into_iter().enumerate().filter_map(track).collect();
            let repaired = if frames > 5 {
                vec![1..2, 3..5]
            } else {
                Vec::new()
            };
            Clip {
                name: "made".into(),
                skeleton,
                rate_hz,
                rotations,
                tracks,
                frames,
                repaired,
                points: None,
            }
        })
    })
}
