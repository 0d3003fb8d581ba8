use super::*;
use crate::clip::Skeleton;
use crate::features::{Hand, KeyPose, for_each_pose};
use crate::formats::{Limits, bvh};
use crate::import::{ImportOptions, Take, normalize};
use crate::kinematics::{WorldPose, for_each_world_pose};
use crate::math::Vec3;
use crate::roles::Role;
use crate::synth::{Person, Script};
use mocap::testing::clip_of_hands;

fn performance() -> Take {
    let script = Script::new(6, Person::draw(6, 1))
        .rest(0.4)
        .play("wave")
        .play("walk");
    normalize(
        script.film("made", 60.0).unwrap().clip,
        &ImportOptions::default(),
    )
    .unwrap()
}

/// The recording written as BVH and read again.
fn written(recording: &Recording) -> Take {
    let clip = recording.to_clip("take").unwrap();
    let mut bytes = Vec::new();
    bvh::write(&clip, &mut bytes).unwrap();
    let read = bvh::read(&bytes, "take", &Default::default(), &Limits::default()).unwrap();
    let options = ImportOptions {
        mapping: recording.mapping(&clip),
        ..ImportOptions::default()
    };
    normalize(read.clips.into_iter().next().unwrap(), &options).unwrap()
}

fn poses(imported: &Take) -> Vec<KeyPose> {
    let mut poses = Vec::new();
    for_each_pose(&imported.clip, &imported.roles, &(0..0), |_, pose| {
        poses.push(*pose)
    });
    poses
}

fn farthest(a: &[KeyPose], b: &[KeyPose]) -> f64 {
    let of = |(a, b): (&KeyPose, &KeyPose)| {
        let both = Role::ALL
            .into_iter()
            .filter_map(|r| Some((a.get(r)? - b.get(r)?).norm()));
        both.fold(0.0, f64::max)
    };
    a.iter().zip(b).map(of).fold(0.0, f64::max)
}

#[test]
fn a_posed_skeleton_comes_back_from_a_file_as_it_was() {
    let made = performance();
    let rig = Arc::new(Rig {
        skeleton: made.clip.skeleton.clone(),
        roles: made.roles.clone(),
    });
    let (mut recording, mut frame) = (Recording::new(&rig), Frame::default());
    for_each_world_pose(&made.clip, &(0..0), |secs, world: &WorldPose| {
        (frame.time_secs, frame.pose) = (100.0 + secs, world.clone());
        recording.push(&frame);
        // Late ones are left out.
        recording.push(&frame);
    });
    let clip = recording.to_clip("take").unwrap();
    assert_eq!((clip.rate_hz, clip.frames), (60.0, made.clip.frames));
    assert_eq!(clip.tracks.len(), 1, "bones keep their length");
    let read = written(&recording);
    assert_eq!(read.roles, made.roles);
    assert!(farthest(&poses(&read), &poses(&made)) < 1e-5);
}

#[test]
fn places_of_roles_become_a_body_whatever_comes_and_goes() {
    let made = performance();
    let mut recording = Recording::new(&Arc::new(Rig::of_roles()));
    let mut frame = Frame::default();
    let seen = poses(&made);
    for (at, pose) in seen.iter().enumerate() {
        // Three frames of ten are missing, the torso always, a hand at times.
        if at % 10 >= 3 || at + 1 == seen.len() {
            let mut pose = *pose;
            pose.set(Role::Torso, Vec3::repeat(f64::NAN));
            if at % 4 == 0 {
                pose.set(Role::LeftHand, Vec3::repeat(f64::NAN));
            }
            frame.time_secs = at as f64 / 60.0;
            frame.set_key_pose(&pose);
            recording.push(&frame);
        }
    }
    let read = written(&recording);
    let missing: Vec<Role> = read.roles.missing().collect();
    assert_eq!(missing, [Role::Torso]);
    // It begins with the first frame that came.
    let seen = &seen[3..];
    assert_eq!((read.clip.rate_hz, read.clip.frames), (60.0, seen.len()));
    // Straight lines over a twentieth of a second.
    assert!(farthest(&poses(&read), seen) < 0.05);
    // Where all was seen nothing is changed.
    let (seventh, read) = (&seen[24..25], &poses(&read)[24..25]);
    assert!(farthest(read, seventh) < 1e-5);
}

#[test]
fn a_hand_with_a_skeleton_of_its_own_is_a_hand_again() {
    let hand = clip_of_hands(&[Hand::Left], |_, number| number.to_string());
    let made = normalize(hand, &ImportOptions::default()).unwrap();
    let mut joints = made.clip.skeleton.joints().to_vec();
    joints.iter_mut().skip(1).for_each(|j| j.parent = Some(0));
    let rig = Arc::new(Rig {
        skeleton: Skeleton::new(joints).unwrap(),
        roles: made.roles.clone(),
    });
    assert_ne!(rig.roles.profile(), Profile::Body);
    let (mut recording, mut frame) = (Recording::new(&rig), Frame::default());
    for_each_world_pose(&made.clip, &(0..0), |secs, world: &WorldPose| {
        (frame.time_secs, frame.pose) = (secs, world.clone());
        recording.push(&frame);
    });
    let read = written(&recording);
    assert_eq!(read.roles, made.roles);
    assert!(farthest(&poses(&read), &poses(&made)) < 1e-5);
}

#[test]
fn what_is_no_clip_says_why() {
    let mut recording = Recording::new(&Arc::new(Rig::of_roles()));
    assert_eq!(
        recording.to_clip("x"),
        Err(RecordingError::TooShort { frames: 0 })
    );
    let mut frame = Frame::default();
    frame.set_key_pose(&KeyPose::default());
    for secs in [0.0, 0.1, 0.2] {
        frame.time_secs = secs;
        recording.push(&frame);
    }
    assert_eq!(
        recording.to_clip("x"),
        Err(RecordingError::Nobody { frames: 3 })
    );
    frame.time_secs = 1e9;
    recording.push(&frame);
    assert!(matches!(
        recording.to_clip("x"),
        Err(RecordingError::TooLong { .. })
    ));
    let other = Arc::new(Rig::default());
    assert!(!recording.set_rig(&other) && recording.set_rig(&Arc::new(Rig::of_roles())));
}
