#![no_main]
//! Any bytes in any pieces: no panic, the pieces make no difference to what is decoded, every pose is finite.

use libfuzzer_sys::fuzz_target;
use morec_live::axis::{AxisDecoder, AxisOptions, AxisReceiver};
use morec::live::{Frame, MAX_PERFORMERS, SourceEvent};

fn decoded<'a>(pieces: impl Iterator<Item = &'a [u8]>) -> Vec<String> {
    let (mut decoder, mut found) = (AxisDecoder::new(), vec![]);
    pieces.for_each(|piece| decoder.push(piece, &mut |frame| found.push(format!("{frame:?}"))));
    decoder.finish(&mut |frame| found.push(format!("{frame:?}")));
    found
}

fuzz_target!(|input: (u16, u8, &[u8])| {
    let (piece, wait, bytes) = input;
    let piece = usize::from(piece).max(1);
    assert_eq!(
        decoded(bytes.chunks(piece)),
        decoded(std::iter::once(bytes))
    );
    let mut receiver = AxisReceiver::new(&AxisOptions {
        actors: 2,
        ..AxisOptions::default()
    });
    let (mut now_secs, mut frame) = (0.0, Frame::default());
    let mut last_secs = [f64::NEG_INFINITY; MAX_PERFORMERS];
    for bytes in bytes.chunks(piece) {
        now_secs += f64::from(wait) / 500.0;
        receiver.bytes(now_secs, bytes);
        receiver.tick(now_secs);
        while let Some(next) = receiver.next(&mut frame) {
            if !matches!(next, SourceEvent::Frame) {
                last_secs.fill(f64::NEG_INFINITY);
                continue;
            }
            let last = &mut last_secs[frame.actor.index()];
            assert!(frame.time_secs > *last);
            *last = frame.time_secs;
            assert!(frame.pose.positions.iter().flatten().all(|c| c.is_finite()));
        }
    }
    receiver.lost();
});
