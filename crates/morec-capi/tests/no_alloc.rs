//! Real-time contract: after its first frame a recogniser takes frames, and gives events, without taking memory.

// What tests share lies outside of test functions, where the lints look for it.
#![allow(clippy::unwrap_used, clippy::undocumented_unsafe_blocks, dead_code)]

#[path = "it/kit.rs"]
mod kit;
#[path = "../../morec/tests/it/made.rs"]
mod made;

use assert_no_alloc::{AllocDisabler, assert_no_alloc, reset_violation_count, violation_count};
use morec_capi::*;

#[global_allocator]
static ALLOCATOR: AllocDisabler = AllocDisabler;

/// Violations are counted for the whole process: one test, so that nothing else runs beside it.
#[test]
fn pushing_and_polling_take_no_memory() {
    let index = kit::Index::new(&kit::small_index());
    let mut options = kit::options();
    options.flags = MOREC_TENTATIVE;
    let recognizer = kit::Recognizer::new(&index, &options).unwrap();
    let (_, poses) = made::poses(&kit::take(60.0));
    let poses: Vec<(f64, Vec<f64>)> = poses
        .iter()
        .map(|(t, pose)| (*t, kit::positions(pose)))
        .collect();
    let mut events: [MorecEvent; 8] = unsafe { std::mem::zeroed() };
    let mut said = 0;
    let mut play = |lap: f64| {
        for (time_secs, positions) in &poses {
            let (mut count, size) = (0, size_of::<MorecEvent>());
            recognizer.push(&kit::frame(time_secs + 20.0 * lap, positions));
            unsafe {
                morec_recognizer_poll(
                    recognizer.0,
                    events.as_mut_ptr(),
                    size,
                    events.len(),
                    &mut count,
                )
            };
            said += count;
        }
        morec_recognizer_finish(recognizer.0);
    };
    play(0.0);
    reset_violation_count();
    assert_no_alloc(|| play(1.0));
    assert_eq!(violation_count(), 0);
    assert!(
        said > 4,
        "too little happened to prove anything: {said} events"
    );
    assert_no_alloc(|| drop(std::hint::black_box(vec![1])));
    assert!(violation_count() > 0, "the counter must count");
}
