//! From packets to frames, no memory is taken from the system.

// What tests share lies outside of test functions, where the lint looks for it.
#![allow(clippy::unwrap_used)]

use assert_no_alloc::{AllocDisabler, assert_no_alloc, reset_violation_count, violation_count};
use morec::live::{Frame, SourceEvent};
use morec::synth::{LimbSide, Person, Script};
use morec_live::vmc::{Bundling, VmcOptions, VmcReceiver, VmcSender};

#[global_allocator]
static ALLOCATOR: AllocDisabler = AllocDisabler;

/// Number of times that `job` asks for memory or gives it back.
fn allocations(job: impl FnOnce()) -> u32 {
    reset_violation_count();
    assert_no_alloc(job);
    violation_count()
}

#[test]
fn packets_take_no_memory() {
    let counted = allocations(|| drop(std::hint::black_box(vec![1])));
    assert!(counted > 0, "the counter must count");
    let person = Person {
        hand: LimbSide::Right,
        ..Person::draw(89, 1)
    };
    let take = Script::new(89, person)
        .rest(0.5)
        .play("push")
        .film("packets", 60.0)
        .unwrap();
    let roles = morec::roles::RoleMap::find(&take.clip.skeleton);
    let mut sender = VmcSender::new(Bundling::Bytes(700), true);
    let packets: Vec<(f64, Vec<u8>)> = (0..take.clip.frames)
        .flat_map(|frame| {
            let (secs, pose) = (
                frame as f64 / 60.0,
                morec::kinematics::WorldPose::of(&take.clip, frame),
            );
            sender
                .frame(secs, &pose, &roles)
                .iter()
                .map(|p| (secs, p.clone()))
                .collect::<Vec<_>>()
        })
        .collect();
    let mut receiver = VmcReceiver::new(&VmcOptions::default());
    let (mut frame, mut frames) = (Frame::default(), 0);
    let mut play = |packets: &[(f64, Vec<u8>)]| {
        for (secs, packet) in packets {
            receiver.packet(1u8, *secs, packet);
            receiver.tick(*secs);
            while let Some(next) = receiver.next(&mut frame) {
                frames += usize::from(matches!(next, SourceEvent::Frame));
            }
        }
    };
    let (before, after) = packets.split_at(packets.len() / 2);
    play(before);
    assert_eq!(allocations(|| play(after)), 0);
    assert!(frames > 50, "{frames} frames");
}
