#![no_main]
//! Any bytes read as an index: no panic, and what opens is written and read again the same and can recognise.
//!
//! A wrong checksum is put right first: chance would never find the right one, and what lies behind it would
//! never be tried.

use libfuzzer_sys::fuzz_target;
use morec::features::{BoneSet, KeyPose};
use morec::index::{IndexError, MotionIndex};
use morec::live::Recognizer;

fuzz_target!(|bytes: &[u8]| {
    let index = match MotionIndex::from_bytes(bytes) {
        Err(IndexError::Checksum { expected, found }) => {
            let Some(right) = with_checksum(bytes, expected, found) else {
                return;
            };
            MotionIndex::from_bytes(&right)
        }
        other => other,
    };
    let Ok(index) = index else { return };
    let written = index.to_bytes().expect("what was read can be written");
    assert_eq!(MotionIndex::from_bytes(&written).as_ref(), Ok(&index));
    let Ok(mut recognizer) = Recognizer::new(&index.model, BoneSet::BODY) else {
        return;
    };
    for n in 0..30 {
        recognizer.push(f64::from(n) / 30.0, &KeyPose::default());
    }
    recognizer.finish();
});

/// `bytes` with another number for the checksum in the manifest, and the header's length as it then is.
fn with_checksum(bytes: &[u8], old: u32, new: u32) -> Option<Vec<u8>> {
    let text = |sum: u32| format!("\\\"checksum\\\":{sum}").into_bytes();
    let (from, to) = (text(old), text(new));
    let at = bytes.windows(from.len()).position(|w| w == from)?;
    let header = u64::from_le_bytes(bytes.get(..8)?.try_into().ok()?);
    let mut right = bytes.to_vec();
    right.splice(at..at + from.len(), to.iter().copied());
    right[..8].copy_from_slice(
        &(header + to.len() as u64)
            .checked_sub(from.len() as u64)?
            .to_le_bytes(),
    );
    Some(right)
}
