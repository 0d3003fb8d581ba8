//! Broadcasts of every kind, and what becomes of them.

use proptest::prelude::*;

use super::decoder::{HEADER, WITH_POSITIONS, WITHOUT_POSITIONS, values_of};
use super::sender::angles;
use super::*;
use morec::formats::{Limits, bvh};
use morec::kinematics::WorldPose;
use morec::live::{Frame, PerformerId, SourceEvent};
use morec::math::{Axis, Quat, Vec3};
use morec::roles::{Role, RoleMap};
use morec::synth::{Person, Script};

/// A frame with these numbers.
fn raw(avatar: u32, number: u32, flags: [u8; 2], values: &[f32]) -> Vec<u8> {
    let mut bytes = AxisSender::new(avatar, "Char00", true)
        .frame(&WorldPose::default(), &RoleMap::default())
        .to_vec();
    bytes.truncate(HEADER);
    bytes[6..8].copy_from_slice(&(values.len() as u16).to_le_bytes());
    bytes[8..10].copy_from_slice(&flags);
    bytes[46..50].copy_from_slice(&number.to_le_bytes());
    values
        .iter()
        .for_each(|v| bytes.extend_from_slice(&v.to_le_bytes()));
    bytes
}

fn bone(name: &str) -> usize {
    AXIS_BONES
        .iter()
        .position(|bone| bone.name == name)
        .unwrap()
}

/// Angles only, with some bones turned: `[y, x, z]` in degrees.
fn turned(bones: &[(&str, [f32; 3])]) -> Vec<f32> {
    let mut values = vec![0.0; WITHOUT_POSITIONS];
    values[1] = 92.0;
    for (name, turn) in bones {
        values[3 + 3 * bone(name)..][..3].copy_from_slice(turn);
    }
    values
}

/// Whatever comes out of a receiver now.
fn drain(receiver: &mut AxisReceiver) -> (Vec<Frame>, Vec<PerformerId>, Vec<PerformerId>) {
    let (mut frames, mut rigs, mut gone) = (vec![], vec![], vec![]);
    let mut frame = Frame::default();
    while let Some(next) = receiver.next(&mut frame) {
        match next {
            SourceEvent::Frame => frames.push(frame.clone()),
            SourceEvent::Rig(actor, _) => rigs.push(actor),
            SourceEvent::Gone(actor) => gone.push(actor),
            SourceEvent::Quiet | SourceEvent::Ended => unreachable!(),
        }
    }
    (frames, rigs, gone)
}

fn posed(values: &[f32], flags: [u8; 2]) -> Frame {
    let mut receiver = AxisReceiver::new(&AxisOptions::default());
    receiver.bytes(100.0, &raw(0, 1, flags, values));
    let (frames, rigs, _) = drain(&mut receiver);
    assert_eq!(
        (frames.len(), rigs.len(), receiver.take_error()),
        (1, 1, None)
    );
    frames.into_iter().next().unwrap()
}

#[test]
fn known_poses_are_where_they_must_be() {
    let at = |frame: &Frame, name: &str| frame.pose.positions[bone(name)];
    let along = |frame: &Frame, from: &str, to: &str| (at(frame, to) - at(frame, from)).normalize();
    let near = |a: Vec3, b: Vec3| assert!((a - b).norm() < 1e-6, "{a} for {b}");
    // A T-pose: up is +Y, the left side +X, toes and gaze +Z.
    let t = posed(&turned(&[]), [0, 0]);
    near(at(&t, "Hips"), Vec3::new(0.0, 0.92, 0.0));
    near(along(&t, "LeftArm", "LeftHand"), Vec3::x());
    near(along(&t, "RightArm", "RightHand"), -Vec3::x());
    near(along(&t, "LeftUpLeg", "LeftFoot"), -Vec3::y());
    assert!(at(&t, "Head").y > 1.5 && at(&t, "LeftHandThumb1").z > at(&t, "LeftHandPinky1").z);
    // The left arm raised, the right hanging down, the left forearm to the front.
    let up = posed(
        &turned(&[
            ("LeftArm", [0.0, 0.0, 90.0]),
            ("RightArm", [0.0, 0.0, 90.0]),
        ]),
        [0, 0],
    );
    near(along(&up, "LeftArm", "LeftHand"), Vec3::y());
    near(along(&up, "RightArm", "RightHand"), -Vec3::y());
    let front = posed(&turned(&[("LeftForeArm", [-90.0, 0.0, 0.0])]), [0, 0]);
    near(along(&front, "LeftForeArm", "LeftHand"), Vec3::z());
    // A kick forwards, and a turn to the left: +Z becomes +X.
    let kick = posed(&turned(&[("RightUpLeg", [0.0, -90.0, 0.0])]), [0, 0]);
    near(along(&kick, "RightUpLeg", "RightFoot"), Vec3::z());
    let left = posed(
        &turned(&[
            ("Hips", [90.0, 0.0, 0.0]),
            ("RightUpLeg", [0.0, -90.0, 0.0]),
        ]),
        [0, 0],
    );
    near(along(&left, "RightUpLeg", "RightFoot"), Vec3::x());
    // Y before X before Z.
    let all = posed(&turned(&[("LeftArm", [90.0, 90.0, 0.0])]), [0, 0]);
    near(along(&all, "LeftArm", "LeftHand"), -Vec3::z());
}

/// The same numbers through a BVH file, for which there are other readers.
#[test]
fn poses_are_those_of_a_bvh_file_with_the_same_numbers() {
    fn joint(b: usize, depth: usize, text: &mut String) {
        let AXIS {
            name,
            offset_cm: [x, y, z],
            ..
        } = AXIS_BONES[b];
        let kind = if b == 0 { "ROOT" } else { "JOINT" };
        let at = format!("{:1$}", "", depth);
        *text += &format!("{at}{kind} {name}\n{at}{{\n{at}OFFSET {x} {y} {z}\n");
        *text += &format!(
            "{at}CHANNELS 6 Xposition Yposition Zposition Yrotation Xrotation Zrotation\n"
        );
        (0..AXIS_BONE_COUNT)
            .filter(|c| AXIS_BONES[*c].parent == Some(b))
            .for_each(|c| joint(c, depth + 1, text));
        *text += &format!("{at}}}\n");
    }
    use super::AxisBone as AXIS;
    let mut text = "HIERARCHY\n".to_owned();
    joint(0, 0, &mut text);
    let mut frames = vec![];
    for n in 0..4 {
        let mut values = vec![0f32; WITH_POSITIONS];
        for (b, bone) in AXIS_BONES.iter().enumerate() {
            for k in 0..3 {
                values[6 * b + k] = bone.offset_cm[k] as f32;
                values[6 * b + 3 + k] = ((n * 7919 + b * 131 + k * 37) % 241) as f32 - 120.0;
            }
        }
        frames.push(values);
    }
    text += &format!("MOTION\nFrames: {}\nFrame Time: 0.01\n", frames.len());
    for values in &frames {
        text += &values
            .iter()
            .map(f32::to_string)
            .collect::<Vec<_>>()
            .join(" ");
        text += "\n";
    }
    let read = bvh::read(
        text.as_bytes(),
        "axis",
        &bvh::BvhOptions::default(),
        &Limits::default(),
    )
    .unwrap();
    let clip = &read.clips[0];
    for (n, values) in frames.iter().enumerate() {
        let expected = WorldPose::of(clip, n);
        let reference = [[9.0; 6].as_slice(), values.as_slice()].concat();
        for found in [posed(values, [1, 0]), posed(&reference, [1, 1])] {
            for (b, bone) in AXIS_BONES.iter().enumerate() {
                let joint = clip.skeleton.find(bone.name).unwrap();
                let off = (found.pose.positions[b] - expected.positions[joint] / 100.0).norm();
                assert!(off < 1e-6, "{} of frame {n}: {off} m off", bone.name);
                let off = found.pose.rotations[b].angle_to(&expected.rotations[joint]);
                assert!(off < 1e-6, "{} of frame {n}: {off} rad off", bone.name);
            }
        }
    }
}

#[test]
fn what_is_sent_with_positions_arrives_where_it_was_whatever_the_skeleton() {
    let take = Script::new(7, Person::draw(7, 1))
        .rest(0.3)
        .play("push")
        .play("walk")
        .film("axis", 60.0)
        .unwrap();
    let roles = RoleMap::find(&take.clip.skeleton);
    let mut sender = AxisSender::new(3, "somebody with a name that is too long to be sent", true);
    let mut receiver = AxisReceiver::new(&AxisOptions::default());
    for n in 0..take.clip.frames {
        let pose = WorldPose::of(&take.clip, n);
        receiver.bytes(n as f64 / 60.0, sender.frame(&pose, &roles));
        let frame = drain(&mut receiver).0.pop().unwrap();
        for (b, bone) in AXIS_BONES.iter().enumerate() {
            let Some(joint) = bone.role.and_then(|role| roles.joint(role)) else {
                continue;
            };
            let off = (frame.pose.positions[b] - pose.positions[joint]).norm();
            assert!(off < 1e-4, "{} of frame {n}: {off} m off", bone.name);
            assert!(
                frame.pose.rotations[b].angle_to(&pose.rotations[joint]) < 1e-4,
                "{}",
                bone.name
            );
        }
    }
    assert_eq!(receiver.counts().packets, take.clip.frames as u64);
}

#[test]
fn frames_without_positions_are_of_the_skeleton_that_was_given() {
    let own = AxisSkeleton::default();
    let longer = own.skeleton.joints().iter().cloned();
    let longer = longer
        .map(|joint| morec::clip::Joint {
            offset: joint.offset * 1.5,
            ..joint
        })
        .collect();
    let skeleton = morec::clip::Skeleton::new(longer).unwrap();
    let options = AxisOptions {
        skeleton: AxisSkeleton::of_clip(&skeleton, &own.roles).unwrap(),
        actors: 1,
    };
    let mut receiver = AxisReceiver::new(&options);
    receiver.bytes(0.0, &raw(0, 0, [0, 0], &turned(&[])));
    let frame = drain(&mut receiver).0.pop().unwrap();
    let length =
        (frame.pose.positions[bone("LeftForeArm")] - frame.pose.positions[bone("LeftArm")]).norm();
    assert!((length - 0.45).abs() < 1e-9, "{length}");
}

/// A frame's avatar, number and values.
type Decoded = (u32, u32, Vec<f32>);

/// Frames' numbers, and errors, decoded from `bytes` in these pieces.
fn decoded(bytes: &[u8], cuts: &[usize]) -> (Vec<Decoded>, Vec<AxisError>) {
    let mut decoder = AxisDecoder::new();
    let (mut frames, mut errors) = (vec![], vec![]);
    let mut out = |found: Result<AxisFrame<'_>, AxisError>| match found {
        Ok(frame) => frames.push((frame.avatar, frame.number, frame.values.to_vec())),
        Err(error) => errors.push(error),
    };
    let mut at = 0;
    for cut in cuts
        .iter()
        .map(|cut| cut % (bytes.len() + 1))
        .chain([bytes.len()])
    {
        if cut > at {
            decoder.push(&bytes[at..cut], &mut out);
            at = cut;
        }
    }
    decoder.finish(&mut out);
    (frames, errors)
}

#[test]
fn what_is_no_frame_is_said_with_its_place_and_the_next_frame_is_found() {
    let good = raw(1, 5, [0, 0], &turned(&[]));
    let mut few = raw(1, 6, [1, 0], &[0.0; 354]);
    few[6..8].copy_from_slice(&180u16.to_le_bytes());
    let mut nan = raw(1, 7, [0, 0], &turned(&[]));
    nan[HEADER + 40..HEADER + 44].copy_from_slice(&f32::NAN.to_le_bytes());
    let bytes = [
        b"hello",
        &good[..],
        &few,
        &good,
        &nan,
        &good,
        &good[..700],
        &good,
        &good[..9],
    ]
    .concat();
    let (frames, errors) = decoded(&bytes, &[]);
    assert_eq!(
        frames.iter().filter(|f| **f == (1, 5, turned(&[]))).count(),
        3,
        "{}",
        frames.len()
    );
    let said: Vec<String> = errors.iter().map(AxisError::to_string).collect();
    let places = [
        5,
        5 + good.len(),
        5 + 2 * good.len() + few.len() + HEADER + 40,
    ];
    assert_eq!(
        said[0],
        "byte 0: expected a frame (FF DD …), found 5 other bytes"
    );
    assert_eq!(
        said[1],
        format!(
            "byte {}: expected 354 to 2048 numbers in a frame, found 180",
            places[1]
        )
    );
    assert!(
        said[2].starts_with(&format!("byte {}: expected a frame", places[1])),
        "{}",
        said[2]
    );
    assert_eq!(
        said[3],
        format!(
            "byte {}: expected a position or an angle, found NaN",
            places[2]
        )
    );
}

proptest! {
    /// Whatever comes, in whatever pieces: no panic, and the pieces make no difference.
    #[test]
    fn pieces_make_no_difference(
        parts in prop::collection::vec((0u8..4, prop::collection::vec(any::<u8>(), 0..200)), 0..8),
        mut cuts in prop::collection::vec(0usize..20_000, 0..40),
    ) {
        let good = raw(2, 9, [0, 0], &turned(&[("Head", [1.0, 2.0, 3.0])]));
        let mut bytes = vec![];
        for (kind, rubbish) in parts {
            match kind {
                0 => bytes.extend_from_slice(&rubbish),
                1 => bytes.extend_from_slice(&good[..rubbish.len() * 3]),
                2 => {
                    let mut spoilt = good.clone();
                    rubbish.chunks_exact(2).for_each(|r| spoilt[usize::from(r[0]) % HEADER] = r[1]);
                    bytes.extend_from_slice(&spoilt);
                }
                _ => bytes.extend_from_slice(&good),
            }
        }
        cuts.iter_mut().for_each(|cut| *cut %= bytes.len() + 1);
        cuts.sort_unstable();
        let whole = decoded(&bytes, &[]);
        prop_assert_eq!(decoded(&bytes, &cuts), whole);
        // And through the receiver.
        let mut receiver = AxisReceiver::new(&AxisOptions::default());
        receiver.bytes(0.0, &bytes);
        receiver.lost();
        for frame in drain(&mut receiver).0 {
            prop_assert!(frame.pose.positions.iter().all(|p| p.iter().all(|v| v.is_finite())));
        }
    }

    #[test]
    fn rubbish_without_the_first_byte_of_a_frame_costs_no_frame(
        between in prop::collection::vec(prop::collection::vec(0u8..0xFF, 0..300), 1..6),
    ) {
        let good = raw(2, 9, [0, 0], &turned(&[]));
        let bytes = between.iter().flat_map(|rubbish| [rubbish.as_slice(), &good].concat()).collect::<Vec<u8>>();
        let (frames, errors) = decoded(&bytes, &[]);
        prop_assert_eq!(frames.len(), between.len());
        let skipped: u64 = errors.iter().map(|e| match e { AxisError::Rubbish { skipped, .. } => *skipped, _ => 0 }).sum();
        prop_assert_eq!(skipped as usize, between.iter().map(Vec::len).sum::<usize>());
    }

    #[test]
    fn angles_give_the_rotation(y in -3.2f64..3.2, x in -3.2f64..3.2, z in -3.2f64..3.2, lock in 0u8..4) {
        let quarter = std::f64::consts::FRAC_PI_2;
        let x = match lock { 0 => quarter, 1 => -quarter, _ => x };
        let of = |[y, x, z]: [f64; 3]| -> Quat { Axis::Y.rotation(y) * Axis::X.rotation(x) * Axis::Z.rotation(z) };
        let rotation = of([y, x, z]);
        prop_assert!(of(angles(&rotation)).angle_to(&rotation) < 1e-6);
    }
}

#[test]
fn avatars_are_followed_apart_leave_and_come_back() {
    let mut receiver = AxisReceiver::new(&AxisOptions {
        actors: 2,
        ..Default::default()
    });
    let values = turned(&[]);
    let send = |receiver: &mut AxisReceiver, avatar, number, secs: f64| {
        receiver.bytes(secs, &raw(avatar, number, [0, 0], &values));
        receiver.tick(secs);
        drain(receiver)
    };
    assert_eq!(send(&mut receiver, 7, 1, 0.00).1, [PerformerId(0)]);
    assert_eq!(send(&mut receiver, 4, 1, 0.01).1, [PerformerId(1)]);
    assert_eq!(send(&mut receiver, 9, 1, 0.01).0.len(), 0);
    assert_eq!(receiver.counts().refused, 1);
    // Late, twice, begun anew.
    assert_eq!(send(&mut receiver, 7, 3, 0.03).0.len(), 1);
    assert_eq!(send(&mut receiver, 7, 2, 0.04).0.len(), 0);
    assert_eq!(receiver.counts().late, 1);
    for n in 0..200 {
        send(&mut receiver, 7, 4 + n, 0.05 + f64::from(n) / 100.0);
    }
    assert_eq!(send(&mut receiver, 7, 0, 2.1).0.len(), 1);
    // The other has been silent: the third takes its place.
    assert_eq!(send(&mut receiver, 9, 1, 2.2).1, [PerformerId(1)]);
    receiver.lost();
    assert_eq!(drain(&mut receiver).2, [PerformerId(0), PerformerId(1)]);
    let (frames, rigs, _) = send(&mut receiver, 9, 1, 5.0);
    assert_eq!((frames.len(), rigs.len()), (1, 0));
    assert!((frames[0].time_secs - 5.0).abs() < 1e-9 && frames[0].actor == PerformerId(1));
    let counts = receiver.counts();
    assert_eq!(
        (counts.malformed, counts.interruptions),
        (0, 2),
        "{counts:?}"
    );
}

/// One machine that sends ever new avatars has no more places than are left by another.
#[test]
fn a_machine_leaves_room_for_others_whatever_it_sends() {
    let mut receiver = AxisReceiver::new(&AxisOptions {
        actors: 4,
        ..Default::default()
    });
    let values = turned(&[]);
    let mut own = std::collections::BTreeSet::new();
    for n in 0..120 {
        let secs = f64::from(n) / 60.0;
        for avatar in 0..8 {
            let number = n * 8 + avatar;
            receiver.bytes_from(1, secs, &raw(avatar, number, [0, 0], &values));
        }
        receiver.tick(secs);
        drain(&mut receiver);
        // The other comes after half a second, with an avatar of a number that is there.
        if n >= 30 {
            receiver.bytes_from(2, secs, &raw(0, n, [0, 0], &values));
            let (frames, ..) = drain(&mut receiver);
            assert_eq!(frames.len(), 1, "frame {n}");
            own.insert(frames[0].actor.0);
        }
    }
    assert_eq!(own.len(), 1, "it keeps its place: {own:?}");
    assert!(receiver.counts().refused > 0);
}

#[test]
fn sizes_are_the_broadcasts() {
    let sizes =
        [(false, false), (false, true), (true, false), (true, true)].map(|(p, r)| values_of(p, r));
    assert_eq!(sizes, [180, 186, 354, 360]);
    assert!(AXIS_BONES[bone("Neck")].role == Some(Role::Neck) && AXIS_BONES.len() == 59);
}
