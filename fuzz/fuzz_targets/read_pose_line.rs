#![no_main]
//! Any text as a line of JSON from a live sender: no panic, no infinite position, a reason for every refusal.

use libfuzzer_sys::fuzz_target;
use morec_live::PoseLine;

fuzz_target!(|text: &str| {
    match PoseLine::of_line(text) {
        Ok(pose) => {
            assert!(pose.known() != 0);
            assert!(pose.time_secs.is_none_or(f64::is_finite));
            let values = pose.positions.iter().flatten();
            assert!(values.into_iter().all(|value| !value.is_infinite()));
            assert!(
                pose.rotations
                    .iter()
                    .all(|q| (q.coords.norm() - 1.0).abs() < 1e-6)
            );
        }
        Err(said) => assert!(!said.is_empty()),
    }
});
