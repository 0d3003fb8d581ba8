//! Senders of every kind, and what becomes of what they send.

use proptest::prelude::*;

use super::*;
use crate::osc::{Arg, begin_bundle, write_element, write_message};
use morec::features::{Hand, KeyPose};
use morec::kinematics::WorldPose;
use morec::live::{Frame, PerformerId, Rig, SourceEvent};
use morec::math::{Axis, Quat, Vec3};
use morec::roles::{Role, RoleMap};

/// A person made of the humanoid's own joints, role by role, with an arm that swings.
fn swinging(secs: f64) -> WorldPose {
    let mut pose = WorldPose::default();
    let mut at = [(Vec3::zeros(), Quat::identity()); HUMANOID_BONES];
    for (b, bone) in HUMANOID.iter().enumerate() {
        let local = match bone.role {
            Some(Role::LeftArm) => Axis::Z.rotation(1.2) * Axis::X.rotation((3.0 * secs).sin()),
            Some(Role::RightArm) => Axis::Z.rotation(-1.3),
            Some(Role::Hips) => Axis::Y.rotation(0.3 * secs),
            _ => Axis::X.rotation(0.05),
        };
        at[b] = match bone.parent {
            Some(p) => (at[p].0 + at[p].1 * bone.offset(), at[p].1 * local),
            None => (bone.offset(), local),
        };
    }
    for role in Role::BODY {
        let bone = HUMANOID.iter().position(|b| b.role == Some(role)).unwrap();
        pose.positions.push(at[bone].0);
        pose.rotations.push(at[bone].1);
    }
    pose
}

/// Joint `i` plays `Role::BODY[i]`.
fn roles() -> RoleMap {
    let mut roles = RoleMap::default();
    for (joint, role) in Role::BODY.into_iter().enumerate() {
        roles.set(role, Some(joint));
    }
    roles
}

/// A receiver with all that came out of it.
struct Heard {
    receiver: VmcReceiver<u8>,
    rigs: Vec<(PerformerId, Rig)>,
    frames: Vec<(PerformerId, f64, KeyPose)>,
    gone: Vec<PerformerId>,
}

impl Heard {
    fn new(options: &VmcOptions) -> Self {
        Self {
            receiver: VmcReceiver::new(options),
            rigs: vec![],
            frames: vec![],
            gone: vec![],
        }
    }

    fn packet(&mut self, peer: u8, now_secs: f64, bytes: &[u8]) {
        self.receiver.packet(peer, now_secs, bytes);
        self.drain();
    }

    fn tick(&mut self, now_secs: f64) {
        self.receiver.tick(now_secs);
        self.drain();
    }

    fn drain(&mut self) {
        let mut frame = Frame::default();
        while let Some(next) = self.receiver.next(&mut frame) {
            match next {
                SourceEvent::Frame => {
                    let rig = self
                        .rigs
                        .iter()
                        .rev()
                        .find(|(actor, _)| *actor == frame.actor)
                        .unwrap();
                    self.frames
                        .push((frame.actor, frame.time_secs, frame.key_pose(&rig.1)));
                }
                SourceEvent::Rig(actor, rig) => self.rigs.push((actor, (*rig).clone())),
                SourceEvent::Gone(actor) => self.gone.push(actor),
                SourceEvent::Quiet | SourceEvent::Ended => unreachable!(),
            }
        }
    }

    /// Plays `secs` of the swinging person at `rate_hz`, packet by packet, dropping those `lose` names.
    fn play(
        &mut self,
        sender: &mut VmcSender,
        from_secs: f64,
        secs: f64,
        rate_hz: f64,
        lose: impl Fn(usize) -> bool,
    ) {
        let mut nth = 0;
        for i in 0..(secs * rate_hz) as usize {
            let time_secs = from_secs + i as f64 / rate_hz;
            for packet in sender.frame(time_secs, &swinging(time_secs), &roles()) {
                nth += 1;
                if !lose(nth) {
                    self.packet(1, 100.0 + time_secs, packet);
                }
            }
            self.tick(100.0 + time_secs + 0.6 / rate_hz);
        }
    }
}

fn far(a: &KeyPose, b: &WorldPose) -> f64 {
    Role::BODY
        .iter()
        .map(|r| (a.get(*r).unwrap() - b.positions[r.index()]).norm())
        .fold(0.0, f64::max)
}

const WAYS: [Bundling; 4] = [
    Bundling::Whole,
    Bundling::Bytes(1500),
    Bundling::Bytes(300),
    Bundling::Single,
];

#[test]
fn any_bundling_at_any_rate_gives_the_poses_that_were_sent() {
    for bundling in WAYS {
        for (rate_hz, every_bone) in [(15.0, false), (60.0, true), (200.0, false)] {
            let mut heard = Heard::new(&VmcOptions::default());
            heard.play(
                &mut VmcSender::new(bundling, every_bone),
                5.0,
                2.0,
                rate_hz,
                |_| false,
            );
            let what = format!("{bundling:?} at {rate_hz} Hz");
            assert_eq!(heard.rigs.len(), 1, "{what}");
            assert!(
                heard.frames.len() as f64 > 1.6 * rate_hz,
                "{what}: {}",
                heard.frames.len()
            );
            let counts = heard.receiver.counts();
            assert_eq!(
                (counts.malformed, counts.late, counts.not_motion),
                (0, 0, 0),
                "{what}"
            );
            let (_, first_secs, _) = heard.frames[0];
            for (i, (_, time_secs, pose)) in heard.frames.iter().enumerate() {
                let expected_secs = first_secs + i as f64 / rate_hz;
                assert!(
                    (time_secs - expected_secs).abs() < 1e-3,
                    "{what}: {time_secs} for {expected_secs}"
                );
                // The receiver's clock begins with the first packet, the performance at 5 s.
                let off = far(pose, &swinging(5.0 + expected_secs));
                assert!(off < 0.02, "{what}: {off} m off at {time_secs}");
            }
        }
    }
}

#[test]
fn lost_packets_cost_frames_and_never_the_stream() {
    for bundling in WAYS {
        let mut heard = Heard::new(&VmcOptions::default());
        heard.play(
            &mut VmcSender::new(bundling, false),
            0.0,
            4.0,
            60.0,
            |nth| nth % 17 == 3,
        );
        assert_eq!(heard.rigs.len(), 1, "{bundling:?}");
        assert!(
            heard.frames.len() > 180,
            "{bundling:?}: {}",
            heard.frames.len()
        );
        assert!(heard.frames.windows(2).all(|w| w[1].1 > w[0].1));
        let off = heard
            .frames
            .iter()
            .map(|(_, t, pose)| far(pose, &swinging(*t)))
            .fold(0.0, f64::max);
        assert!(off < 0.1, "{bundling:?}: {off}");
    }
}

#[test]
fn packets_that_were_overtaken_are_left_and_counted() {
    let mut heard = Heard::new(&VmcOptions::default());
    let mut sender = VmcSender::new(Bundling::Whole, false);
    let mut held = None;
    for i in 0..240 {
        let secs = f64::from(i) / 60.0;
        let packet = sender.frame(secs, &swinging(secs), &roles())[0].clone();
        if i % 10 == 5 {
            held = Some(packet);
            continue;
        }
        heard.packet(1, secs, &packet);
        if let Some(late) = held.take() {
            heard.packet(1, secs, &late);
        }
    }
    assert_eq!(heard.receiver.counts().late, 24);
    assert!(heard.frames.windows(2).all(|w| w[1].1 - w[0].1 > 0.01));
}

/// One message with seven numbers.
fn bone(out: &mut Vec<u8>, name: &str, position: [f32; 3], rotation: [f32; 4]) {
    let numbers = position.into_iter().chain(rotation).map(Arg::Float);
    let args: Vec<Arg> = [Arg::Text(name)].into_iter().chain(numbers).collect();
    write_message(out, "/VMC/Ext/Bone/Pos", &args);
}

/// A T-pose of all bones without positions, as senders that only know rotations have it, the left arm turned.
fn rotations_only(arm: [f32; 4]) -> Vec<u8> {
    let mut packet = vec![];
    begin_bundle(&mut packet);
    for b in &HUMANOID[..20] {
        let rotation = if b.name == "LeftUpperArm" {
            arm
        } else {
            [0.0, 0.0, 0.0, 1.0]
        };
        write_element(&mut packet, |out| bone(out, b.name, [0.0; 3], rotation));
    }
    packet
}

const AHEAD: [f32; 4] = [
    0.0,
    std::f32::consts::FRAC_1_SQRT_2,
    0.0,
    std::f32::consts::FRAC_1_SQRT_2,
];

#[test]
fn senders_without_positions_get_a_standard_skeleton_and_left_stays_left() {
    let mut heard = Heard::new(&VmcOptions::default());
    for i in 0..60 {
        heard.packet(1, f64::from(i) / 60.0, &rotations_only(AHEAD));
    }
    let (_, _, pose) = heard.frames.last().unwrap();
    let at = |role| pose.get(role).unwrap();
    let (left, up) = (
        at(Role::LeftThigh) - at(Role::RightThigh),
        at(Role::Neck) - at(Role::Hips),
    );
    let forward = left.cross(&up).normalize();
    let arm = (at(Role::LeftForearm) - at(Role::LeftArm)).normalize();
    assert!(
        (arm - forward).norm() < 1e-6,
        "left × up is forward, and so is the arm: {arm}"
    );
    let other = (at(Role::RightForearm) - at(Role::RightArm)).normalize();
    assert!((other + left.normalize()).norm() < 1e-6);
    assert!((at(Role::LeftShin) - at(Role::LeftThigh)).norm() > 0.3);
}

#[test]
fn a_mirrored_sender_is_turned_back() {
    let mut heard = Heard::new(&VmcOptions {
        mirrored: true,
        ..Default::default()
    });
    for i in 0..60 {
        heard.packet(1, f64::from(i) / 60.0, &rotations_only(AHEAD));
    }
    let (_, _, pose) = heard.frames.last().unwrap();
    let at = |role| pose.get(role).unwrap();
    let forward = (at(Role::LeftThigh) - at(Role::RightThigh))
        .cross(&(at(Role::Neck) - at(Role::Hips)))
        .normalize();
    let right = (at(Role::RightForearm) - at(Role::RightArm)).normalize();
    assert!(
        (right - forward).norm() < 1e-6,
        "now the right arm reaches forward"
    );
    assert!(
        (at(Role::LeftForearm) - at(Role::LeftArm))
            .normalize()
            .dot(&forward)
            .abs()
            < 1e-6
    );
}

#[test]
fn a_t_pose_and_a_sender_that_says_so_are_no_motion() {
    let mut heard = Heard::new(&VmcOptions::default());
    for i in 0..60 {
        heard.packet(
            1,
            f64::from(i) / 60.0,
            &rotations_only([0.0, 0.0, 0.0, 1.0]),
        );
    }
    assert!(heard.frames.is_empty() && heard.receiver.counts().not_motion > 30);
    let mut state = vec![];
    write_message(
        &mut state,
        "/VMC/Ext/OK",
        &[Arg::Int(1), Arg::Int(3), Arg::Int(0), Arg::Int(0)],
    );
    heard.packet(1, 1.0, &state);
    for i in 60..90 {
        heard.packet(1, f64::from(i) / 60.0, &rotations_only(AHEAD));
    }
    assert!(heard.frames.is_empty());
    state.clear();
    write_message(&mut state, "/VMC/Ext/OK", &[Arg::Int(1)]);
    heard.packet(1, 1.5, &state);
    heard.packet(1, 1.51, &rotations_only(AHEAD));
    assert_eq!(heard.frames.len(), 1);
}

#[test]
fn a_bone_that_is_lost_takes_what_hangs_on_it_along_and_comes_back() {
    let mut heard = Heard::new(&VmcOptions::default());
    let mut sender = VmcSender::new(Bundling::Whole, false);
    heard.play(&mut sender, 0.0, 1.0, 60.0, |_| false);
    let mut armless = roles();
    armless.set(Role::LeftForearm, None);
    for i in 0..60 {
        let secs = 1.0 + f64::from(i) / 60.0;
        let packet = sender.frame(secs, &swinging(secs), &armless)[0].clone();
        heard.packet(1, 100.0 + secs, &packet);
        heard.tick(100.0 + secs + 0.01);
    }
    let (_, _, pose) = heard.frames.last().unwrap();
    assert!(pose.get(Role::LeftHand).is_none() && pose.get(Role::RightHand).is_some());
    heard.play(&mut sender, 2.0, 0.5, 60.0, |_| false);
    assert!(heard.frames.last().unwrap().2.get(Role::LeftHand).is_some());
    assert_eq!(heard.rigs.len(), 1, "the skeleton was the same all along");
}

#[test]
fn a_bone_that_stays_away_leaves_the_skeleton_and_a_new_one_joins_it() {
    let mut heard = Heard::new(&VmcOptions::default());
    let mut sender = VmcSender::new(Bundling::Whole, false);
    let mut headless = roles();
    headless.set(Role::Head, None);
    for (part, roles) in [roles(), headless, roles()].iter().enumerate() {
        for i in 0..240 {
            let secs = 4.0 * part as f64 + f64::from(i) / 60.0;
            let packet = sender.frame(secs, &swinging(secs), roles)[0].clone();
            heard.packet(1, secs, &packet);
            heard.tick(secs + 0.01);
        }
    }
    let heads: Vec<bool> = heard
        .rigs
        .iter()
        .map(|(_, rig)| rig.roles.joint(Role::Head).is_some())
        .collect();
    assert_eq!(heads, [true, false, true]);
}

#[test]
fn senders_are_told_apart_bounded_and_replaced_when_they_have_gone() {
    let mut heard = Heard::new(&VmcOptions {
        actors: 2,
        ..Default::default()
    });
    for i in 0..60 {
        for peer in [1, 2, 3] {
            heard.packet(peer, f64::from(i) / 60.0, &rotations_only(AHEAD));
        }
    }
    // The third shows a body after a quarter of a second, and is refused from then on.
    assert!((40..60).contains(&heard.receiver.counts().refused));
    assert_eq!(heard.receiver.take_refused(), Some(3));
    let actors = |heard: &Heard| {
        heard
            .frames
            .iter()
            .map(|f| f.0.0)
            .collect::<std::collections::BTreeSet<_>>()
    };
    assert_eq!(actors(&heard).into_iter().collect::<Vec<_>>(), [0, 1]);
    heard.tick(2.5);
    assert_eq!(heard.gone.len(), 2);
    heard.frames.clear();
    for i in 0..60 {
        heard.packet(3, 3.0 + f64::from(i) / 60.0, &rotations_only(AHEAD));
    }
    assert_eq!(
        actors(&heard).into_iter().collect::<Vec<_>>(),
        [0],
        "in the place of one that has gone"
    );
}

proptest! {
    #[test]
    fn no_packet_panics_or_gives_a_pose_of_infinities(
        packets in prop::collection::vec((0u8..4, prop::collection::vec(any::<u8>(), 0..120)), 0..40),
        numbers in prop::collection::vec((0usize..56, any::<[f32; 7]>()), 0..200),
    ) {
        let mut heard = Heard::new(&VmcOptions::default());
        for (i, (name, values)) in numbers.iter().enumerate() {
            let name = HUMANOID.get(*name).map_or("LastBone", |b| b.name);
            let mut packet = vec![];
            let [a, b, c, rotation @ ..] = *values;
            bone(&mut packet, name, [a, b, c], rotation);
            heard.packet(1, i as f64 * 0.01, &packet);
            if let Some((peer, bytes)) = packets.get(i) {
                heard.packet(*peer, i as f64 * 0.01, bytes);
            }
            heard.tick(i as f64 * 0.01 + 0.006);
        }
        for (_, time_secs, pose) in &heard.frames {
            prop_assert!(time_secs.is_finite());
            prop_assert!(Role::ALL.iter().filter_map(|r| pose.get(*r)).all(|p| p.norm().is_finite()));
        }
    }
}

/// A neckless sender: bones of the trunk under their names, the arms and the head.
fn without(names: &[&str]) -> Vec<u8> {
    let mut packet = vec![];
    begin_bundle(&mut packet);
    for b in HUMANOID[..20].iter().filter(|b| !names.contains(&b.name)) {
        let turned = if b.name == "Hips" {
            [0.2, 0.0, 0.0, 0.98]
        } else {
            [0.0, 0.0, 0.0, 1.0]
        };
        write_element(&mut packet, |out| bone(out, b.name, [0.0; 3], turned));
    }
    packet
}

#[test]
fn a_sender_without_a_neck_or_a_spine_has_trunk_and_head_all_the_same() {
    let options = VmcOptions {
        skip_t_pose: false,
        ..VmcOptions::default()
    };
    let posed = |packet: &[u8]| {
        let mut heard = Heard::new(&options);
        (0..60).for_each(|i| heard.packet(1, f64::from(i) / 60.0, packet));
        assert_eq!(
            (heard.rigs.len(), heard.receiver.counts().malformed),
            (1, 0)
        );
        let rig = heard.rigs.pop().unwrap().1;
        (heard.frames.pop().unwrap().2, rig)
    };
    let (whole, _) = posed(&without(&[]));
    let lacks = [
        &["Neck"][..],
        &["Neck", "UpperChest"],
        &["Neck", "UpperChest", "Chest", "Spine"],
        &["Spine"],
    ];
    for missing in lacks {
        let (pose, rig) = posed(&without(missing));
        for role in [Role::Neck, Role::Head] {
            let off = (pose.get(role).unwrap() - whole.get(role).unwrap()).norm();
            assert!(off < 1e-9, "without {missing:?}: {role} is {off} m off");
        }
        assert_eq!(
            pose.get(Role::Torso).is_some(),
            missing.len() < 4,
            "without {missing:?}"
        );
        assert!(
            rig.bones(&pose).indices().count() >= 11,
            "without {missing:?}"
        );
        // The neck moves with the trunk.
        let neck = rig.roles.joint(Role::Neck).unwrap();
        assert!(rig.skeleton.joints()[neck].parent.is_some());
    }
    // Nobody can tell where the neck of a headless body is.
    let (pose, _) = posed(&without(&["Neck", "Head"]));
    assert_eq!((pose.get(Role::Neck), pose.get(Role::Head)), (None, None));
}

/// Machines with ports.
#[derive(Debug, Clone, Copy, PartialEq)]
struct At(u8, u32);

impl Peer for At {
    fn same_host(&self, other: &Self) -> bool {
        self.0 == other.0
    }
}

#[test]
fn a_sender_that_opens_a_new_port_for_every_packet_or_frame_is_one_performer() {
    for (bundling, packets_a_port) in [
        (Bundling::Whole, 1),
        (Bundling::Bytes(300), 1),
        (Bundling::Single, 19),
    ] {
        let mut receiver = VmcReceiver::new(&VmcOptions::default());
        let mut sender = VmcSender::new(bundling, false);
        let (mut frame, mut frames, mut sent) = (Frame::default(), 0, 0);
        for i in 0..240 {
            let secs = f64::from(i) / 60.0;
            for packet in sender.frame(secs, &swinging(secs), &roles()) {
                receiver.packet(At(1, sent / packets_a_port), secs, packet);
                sent += 1;
            }
            receiver.tick(secs + 0.01);
            while let Some(next) = receiver.next(&mut frame) {
                assert!(!matches!(next, SourceEvent::Gone(_)));
                if let SourceEvent::Frame = next {
                    assert_eq!(frame.actor, PerformerId(0));
                    frames += 1;
                }
            }
        }
        assert!(frames > 200, "{bundling:?}: {frames}");
        assert_eq!(
            (receiver.counts().refused, receiver.counts().interruptions),
            (0, 0)
        );
    }
}

#[test]
fn two_senders_on_one_machine_are_two_performers_though_they_begin_together() {
    let mut receiver = VmcReceiver::new(&VmcOptions::default());
    let mut senders = [0, 1].map(|_| VmcSender::new(Bundling::Bytes(1500), false));
    let mut rigs: std::collections::BTreeMap<PerformerId, std::sync::Arc<Rig>> = Default::default();
    let (mut frame, mut frames) = (Frame::default(), [0; 2]);
    for i in 0..240 {
        let secs = f64::from(i) / 60.0;
        for (s, sender) in senders.iter_mut().enumerate() {
            // One is half a second ahead of the other.
            let pose = swinging(secs + 0.5 * s as f64);
            for packet in sender.frame(secs, &pose, &roles()) {
                receiver.packet(At(1, 50_000 + s as u32), secs, packet);
            }
            receiver.tick(secs);
            while let Some(next) = receiver.next(&mut frame) {
                match next {
                    SourceEvent::Rig(actor, rig) => _ = rigs.insert(actor, rig),
                    SourceEvent::Frame => {
                        frames[frame.actor.index()] += 1;
                        let key = frame.key_pose(&rigs[&frame.actor]);
                        let off = [0.0, 0.5].map(|ahead| far(&key, &swinging(secs + ahead)));
                        assert!(off[0].min(off[1]) < 0.03, "{off:?} m off at {secs}");
                    }
                    _ => {}
                }
            }
        }
    }
    assert!(frames.iter().all(|n| *n > 180), "{frames:?}");
}

/// Arrivals at each place, and the number of frames of each.
fn frames_of(receiver: &mut VmcReceiver<At>, frames: &mut std::collections::BTreeMap<u16, usize>) {
    let mut frame = Frame::default();
    while let Some(next) = receiver.next(&mut frame) {
        if let SourceEvent::Frame = next {
            *frames.entry(frame.actor.0).or_default() += 1;
        }
    }
}

/// One byte, or a bone that is no body, twice a second: neither takes a place nor keeps one.
#[test]
fn rubbish_takes_no_performers_place() {
    let mut stray = vec![];
    bone(&mut stray, "Head", [0.0; 3], [0.0, 0.0, 0.0, 1.0]);
    for rubbish in [&b"x"[..], &stray] {
        for host in [1, 2] {
            let options = VmcOptions {
                actors: 1,
                ..Default::default()
            };
            let mut receiver = VmcReceiver::new(&options);
            let mut sender = VmcSender::new(Bundling::Whole, false);
            let mut frames = std::collections::BTreeMap::new();
            for i in 0..600 {
                let secs = f64::from(i) / 60.0;
                if i % 30 == 0 {
                    receiver.packet(At(host, 9), secs, rubbish);
                }
                // The performer comes after three seconds, and leaves for a while after five.
                let here = (180..300).contains(&i) || i >= 480;
                for packet in sender.frame(secs, &swinging(secs), &roles()) {
                    if here {
                        receiver.packet(At(1, 50_000), secs, packet);
                    }
                }
                receiver.tick(secs + 0.006);
                frames_of(&mut receiver, &mut frames);
            }
            let frames = Vec::from_iter(frames);
            assert!(frames.len() == 1 && frames[0].1 > 170, "{host}: {frames:?}");
        }
    }
}

/// A port that showed a body and goes on with rubbish loses its place to the next who shows one.
#[test]
fn rubbish_keeps_no_place() {
    let options = VmcOptions {
        actors: 1,
        ..Default::default()
    };
    let mut receiver = VmcReceiver::new(&options);
    let mut sender = VmcSender::new(Bundling::Whole, false);
    let mut late = std::collections::BTreeMap::new();
    for i in 0..400 {
        let secs = f64::from(i) / 60.0;
        for packet in sender.frame(secs, &swinging(secs), &roles()) {
            if i < 60 {
                receiver.packet(At(1, 1), secs, packet);
            } else {
                receiver.packet(At(1, 1), secs, b"x");
                receiver.packet(At(2, 1), secs, packet);
            }
        }
        receiver.tick(secs + 0.006);
        let mut frames = std::collections::BTreeMap::new();
        frames_of(&mut receiver, &mut frames);
        if i >= 60 {
            late.extend(frames.into_iter().map(|(actor, count)| (i, (actor, count))));
        }
    }
    assert!(late.len() > 200, "{}", late.len());
    assert!(
        receiver.counts().refused > 0,
        "refused until the place was free"
    );
}

/// With one place, two that begin together on one machine: the first is recognised, the second refused and named.
#[test]
fn of_two_that_begin_together_one_is_recognised_where_there_is_one_place() {
    let options = VmcOptions {
        actors: 1,
        ..Default::default()
    };
    let mut receiver = VmcReceiver::new(&options);
    let mut senders = [0, 1].map(|_| VmcSender::new(Bundling::Bytes(1500), false));
    let mut frames = std::collections::BTreeMap::new();
    let mut refused = std::collections::BTreeSet::new();
    for i in 0..240 {
        let secs = f64::from(i) / 60.0;
        for (s, sender) in senders.iter_mut().enumerate() {
            for packet in sender.frame(secs, &swinging(secs + s as f64), &roles()) {
                receiver.packet(At(1, 50_000 + s as u32), secs, packet);
            }
            receiver.tick(secs);
        }
        frames_of(&mut receiver, &mut frames);
        refused.extend(receiver.take_refused().map(|At(_, port)| port));
    }
    assert!(frames.len() == 1 && frames[&0] > 180, "{frames:?}");
    assert_eq!(refused.len(), 1, "always the same one: {refused:?}");
}

/// A flood from ever new ports leaves room for a performer.
#[test]
fn a_flood_from_many_ports_leaves_room() {
    let mut receiver = VmcReceiver::new(&VmcOptions::default());
    let mut sender = VmcSender::new(Bundling::Whole, false);
    let mut frames = std::collections::BTreeMap::new();
    for i in 0..240u32 {
        let secs = f64::from(i) / 60.0;
        for port in 0..100 {
            receiver.packet(At(2, 100 * i + port), secs, b"/VMC/Ext/OK");
        }
        for packet in sender.frame(secs, &swinging(secs), &roles()) {
            receiver.packet(At(1, 7), secs, packet);
        }
        receiver.tick(secs + 0.006);
        frames_of(&mut receiver, &mut frames);
    }
    assert!(frames.values().sum::<usize>() > 200, "{frames:?}");
}

#[test]
fn fingers_arrive_where_the_clip_has_them() {
    let (mut pose, mut sent) = (swinging(0.0), roles());
    for (side, hand) in Hand::BOTH.into_iter().enumerate() {
        let points = hand.points();
        let wrist = pose.positions[points.wrist.index()];
        for (finger, roles) in points.fingers.into_iter().enumerate() {
            for (at, role) in roles.into_iter().enumerate() {
                sent.set(role, Some(pose.positions.len()));
                let along = 0.09 + 0.03 * at as f64;
                let across = 0.02 * finger as f64 + 0.001 * side as f64;
                pose.positions.push(wrist + Vec3::new(across, -along, 0.0));
                pose.rotations
                    .push(Axis::Z.rotation(0.2 * at as f64 + 0.1 * finger as f64));
            }
        }
    }
    let mut heard = Heard::new(&VmcOptions::default());
    let mut sender = VmcSender::new(Bundling::Bytes(1500), false);
    for i in 0..30 {
        let secs = f64::from(i) / 30.0;
        for packet in sender.frame(secs, &pose, &sent) {
            heard.receiver.packet(1, secs, packet);
        }
        heard.receiver.tick(secs + 0.02);
    }
    let mut frame = Frame::default();
    let mut rig = None;
    while let Some(next) = heard.receiver.next(&mut frame) {
        match next {
            SourceEvent::Rig(_, new) => rig = Some((*new).clone()),
            SourceEvent::Frame => {}
            other => panic!("{other:?}"),
        }
    }
    let rig = rig.unwrap();
    let roles = rig.roles.with_fingers(&rig.skeleton).into_owned();
    let shown = frame.key_pose(&Rig { roles, ..rig });
    for hand in Hand::BOTH {
        // Three bones a finger: a receiver takes the last one's joint for the tip.
        for [base, second, third, tip] in hand.points().fingers {
            for (role, of) in [(base, base), (second, second), (tip, third)] {
                let there = pose.positions[sent.joint(of).unwrap()];
                let off = (shown.get(role).unwrap() - there).norm();
                assert!(off < 1e-5, "{role:?}: {off} m off");
            }
        }
    }
}

#[test]
fn frames_before_the_skeleton_is_known_are_no_faults() {
    let mut heard = Heard::new(&VmcOptions::default());
    let mut sender = VmcSender::new(Bundling::Bytes(1500), false);
    heard.play(&mut sender, 0.0, 1.0, 60.0, |_| false);
    assert!(heard.frames.len() > 40, "{}", heard.frames.len());
    assert_eq!(heard.receiver.counts().incomplete, 0);
    // A sender that never shows a body is one.
    let mut head = Heard::new(&VmcOptions::default());
    let mut packet = Vec::new();
    let pose = [0.0, 1.6, 0.0, 0.0, 0.0, 0.0, 1.0].map(Arg::Float);
    let args = [&[Arg::Text("Head")][..], &pose].concat();
    write_message(&mut packet, "/VMC/Ext/Bone/Pos", &args);
    for i in 0..60 {
        head.packet(1, f64::from(i) / 60.0, &packet);
    }
    assert!(head.receiver.counts().incomplete > 20);
}
