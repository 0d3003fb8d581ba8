//! Clips that are written as BVH are read back the same.

use mocap::clip::{Clip, Joint, JointTrack, Points, Skeleton};
use mocap::formats::Limits;
use mocap::formats::bvh::{self, BvhOptions};
use mocap::kinematics::WorldPose;
use mocap::math::{Axis, Quat, Vec3, same_hemisphere};
use proptest::prelude::*;

fn vec3(size: f64) -> impl Strategy<Value = Vec3> {
    [-size..size, -size..size, -size..size].prop_map(Vec3::from)
}

fn name() -> impl Strategy<Value = String> {
    prop_oneof![4 => "[A-Z][a-z]{1,8}", 1 => "[A-Za-z0-9:#.}_-]{1,4} [a-z/]{1,3}", 1 => "[äé左足]{1,3}"]
}

/// Joints, each below any of those before it, in depth-first order (the writer's) by construction: a parent is taken
/// from the chain above the joint before.
fn skeleton() -> impl Strategy<Value = Skeleton> {
    let joint = (name(), 0usize..4, vec3(50.0), prop::option::of(vec3(9.0)));
    prop::collection::vec(joint, 1..9).prop_map(|parts| {
        let mut joints: Vec<Joint> = Vec::new();
        for (k, (name, up, offset, tip)) in parts.into_iter().enumerate() {
            let mut parent = k.checked_sub(1);
            for _ in 0..up {
                parent = parent.and_then(|p| joints[p].parent).or(parent);
            }
            let name = format!("{name}{k}");
            joints.push(Joint {
                name,
                parent,
                offset,
                tip,
            });
        }
        Skeleton::new(joints).unwrap()
    })
}

fn quat() -> impl Strategy<Value = Quat> {
    let any = [-1.0f64..1.0, -1.0f64..1.0, -1.0f64..1.0, -1.0f64..1.0]
        .prop_map(|[w, x, y, z]| Quat::new_normalize(nalgebra::Quaternion::new(w, x, y, z + 0.01)));
    let locked = (-3.0f64..3.0, -3.0f64..3.0).prop_map(|(z, x)| {
        Axis::Z.rotation(z) * Axis::Y.rotation(std::f64::consts::FRAC_PI_2) * Axis::X.rotation(x)
    });
    prop_oneof![5 => any, 1 => locked]
}

pub fn clip() -> impl Strategy<Value = Clip> {
    let rate = prop_oneof![
        Just(30.0),
        Just(120.0),
        Just(120_000.0 / 1001.0),
        Just(47.3)
    ];
    (skeleton(), 0usize..6, rate).prop_flat_map(|(skeleton, frames, rate_hz)| {
        let joints = skeleton.len();
        let rotations = prop::collection::vec(quat(), frames * joints);
        let tracks = prop::collection::vec(
            prop::option::weighted(0.3, prop::collection::vec(vec3(80.0), frames)),
            joints,
        );
        (Just(skeleton), rotations, tracks).prop_map(move |(skeleton, mut rotations, tracks)| {
            for k in joints..rotations.len() {
                rotations[k] = same_hemisphere(&rotations[k - joints], rotations[k]);
            }
            let track = |(joint, t): (usize, Option<Vec<Vec3>>)| {
                t.map(|positions| JointTrack { joint, positions })
            };
            let tracks = tracks.into_iter().enumerate().filter_map(track).collect();
            Clip {
                name: "c".into(),
                skeleton,
                rate_hz,
                rotations,
                tracks,
                frames,
                repaired: Vec::new(),
                points: None,
            }
        })
    })
}

fn written(clip: &Clip) -> Vec<u8> {
    let mut bytes = Vec::new();
    bvh::write(clip, &mut bytes).unwrap();
    bytes
}

fn read_back(clip: &Clip) -> Clip {
    let mut loaded = bvh::read(
        &written(clip),
        "c",
        &BvhOptions::default(),
        &Limits::default(),
    )
    .unwrap();
    assert_eq!(loaded.clips.len(), 1);
    loaded.clips.remove(0)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn a_clip_comes_back(clip in clip()) {
        let back = read_back(&clip);
        prop_assert_eq!((back.frames, back.skeleton.len()), (clip.frames, clip.skeleton.len()));
        prop_assert!((back.rate_hz / clip.rate_hz - 1.0).abs() < 1e-12);
        for (a, b) in clip.skeleton.joints().iter().zip(back.skeleton.joints()) {
            prop_assert_eq!((&a.name, a.parent), (&b.name, b.parent));
        }
        for (a, b) in clip.rotations.iter().zip(&back.rotations) {
            prop_assert!(a.angle_to(b) < 1e-6);
        }
        for (frame, joint) in (0..clip.frames).flat_map(|f| (0..clip.skeleton.len()).map(move |j| (f, j))) {
            let apart = clip.local_position(frame, joint) - back.local_position(frame, joint);
            prop_assert!(apart.amax() < 1e-6, "frame {} joint {}: {}", frame, joint, apart);
        }
        for frame in 0..clip.frames {
            let (a, b) = (WorldPose::of(&clip, frame), WorldPose::of(&back, frame));
            for j in 0..clip.skeleton.len() {
                prop_assert!((a.tip(&clip, j) - b.tip(&back, j)).amax() < 1e-4);
            }
        }
    }
}

fn one_joint(name: &str) -> Clip {
    let joint = Joint {
        name: name.into(),
        parent: None,
        offset: Vec3::zeros(),
        tip: None,
    };
    let skeleton = Skeleton::new(vec![joint]).unwrap();
    let rotations = vec![Quat::identity(); 2];
    Clip {
        name: "c".into(),
        skeleton,
        rate_hz: 60.0,
        rotations,
        tracks: Vec::new(),
        frames: 2,
        repaired: Vec::new(),
        points: None,
    }
}

#[test]
fn names_survive_or_are_made_to() {
    for name in [
        "mixamorig:Hips",
        "Bip01 L Thigh",
        "TORSO#",
        "#1",
        "//",
        "finger2-1.l",
        "a}b",
        "左足",
        "End",
    ] {
        assert_eq!(read_back(&one_joint(name)).skeleton.joints()[0].name, name);
    }
    for (name, survivor) in [
        (" a\tb\n", "a b"),
        ("a{b", "a(b"),
        ("", "joint0"),
        ("\n", "joint0"),
    ] {
        assert_eq!(
            read_back(&one_joint(name)).skeleton.joints()[0].name,
            survivor
        );
    }
}

#[test]
fn turning_on_does_not_jump() {
    let mut clip = one_joint("Hips");
    clip.frames = 100;
    clip.rotations = (0..100)
        .map(|f| Axis::Y.rotation(0.2 * f64::from(f)))
        .collect();
    let text = String::from_utf8(written(&clip)).unwrap();
    let rows: Vec<Vec<f64>> = text
        .lines()
        .skip_while(|l| !l.starts_with("Frame Time"))
        .skip(1)
        .map(|l| l.split(' ').map(|t| t.parse().unwrap()).collect())
        .collect();
    let largest = rows.windows(2).flat_map(|w| {
        (3..6)
            .map(|c| (w[1][c] - w[0][c]).abs())
            .collect::<Vec<_>>()
    });
    assert!(largest.fold(0.0, f64::max) < 13.0);
}

#[test]
fn a_clip_without_a_rate_is_not_written() {
    for rate_hz in [0.0, f64::NAN, -1.0, f64::INFINITY] {
        let clip = Clip {
            rate_hz,
            ..one_joint("Hips")
        };
        assert!(bvh::write(&clip, &mut Vec::new()).is_err());
    }
}

proptest! {
    #[test]
    fn points_come_back(tracks in prop::collection::vec(prop::collection::vec(vec3(80.0), 5), 1..12), still in any::<bool>()) {
        let mut tracks = tracks;
        if still {
            let first = tracks[0][0];
            tracks[0].fill(first);
        }
        let points = tracks.iter().enumerate().map(|(p, track)| (format!("M{p}"), track.clone()));
        let clip = Clip::of_points("c".into(), 100.0, points, Points::default());
        let back = read_back(&clip);
        prop_assert!(!back.has_rotations());
        prop_assert_eq!(back.skeleton.len(), tracks.len());
        for (track, expected) in back.tracks.iter().zip(&tracks) {
            for (at, expected) in track.positions.iter().zip(expected) {
                prop_assert!((at - expected).amax() < 1e-6, "{} {}", at, expected);
            }
        }
    }
}
