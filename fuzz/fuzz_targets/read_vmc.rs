#![no_main]
//! Any datagrams from any senders at any pace: no panic, times that only go forward, no pose of infinities.

use libfuzzer_sys::fuzz_target;
use morec_live::vmc::{VmcOptions, VmcReceiver};
use morec::live::{Frame, MAX_PERFORMERS, SourceEvent};

fuzz_target!(|packets: Vec<(u8, u8, Vec<u8>)>| {
    let mut receiver = VmcReceiver::new(&VmcOptions {
        actors: 3,
        ..VmcOptions::default()
    });
    let (mut now_secs, mut frame) = (0.0, Frame::default());
    let mut last_secs = [f64::NEG_INFINITY; MAX_PERFORMERS];
    for (peer, wait, bytes) in &packets {
        now_secs += f64::from(*wait) / 1000.0;
        receiver.packet(peer % 5, now_secs, bytes);
        receiver.tick(now_secs + 0.001);
        while let Some(next) = receiver.next(&mut frame) {
            if matches!(next, SourceEvent::Gone(_)) || !matches!(next, SourceEvent::Frame) {
                last_secs.fill(f64::NEG_INFINITY);
                continue;
            }
            let last = &mut last_secs[frame.actor.index()];
            assert!(frame.time_secs > *last);
            *last = frame.time_secs;
            assert!(
                frame
                    .pose
                    .positions
                    .iter()
                    .flatten()
                    .all(|c| !c.is_infinite())
            );
        }
    }
});
