#![no_main]
//! Any bytes read as a stored clip: no panic, and what opens is written and read again the same and can be sampled.
//!
//! Length and checksum in the header are put right first: chance would never find them, and what lies behind them
//! would never be tried.

use libfuzzer_sys::fuzz_target;
use morec::formats::Limits;
use morec::smooth::CompressedClip;

const HEADER: usize = 20;

fuzz_target!(|bytes: &[u8]| {
    let _ = CompressedClip::from_bytes(bytes);
    let mut bytes = bytes.to_vec();
    if let Some((header, body)) = bytes.split_at_mut_checked(HEADER) {
        header[8..16].copy_from_slice(&(body.len() as u64).to_le_bytes());
        header[16..].copy_from_slice(&crc32(body).to_le_bytes());
    }
    let limits = Limits {
        frames: 5000,
        joints: 100,
        ..Limits::default()
    };
    let Ok(clip) = CompressedClip::from_bytes_within(&bytes, &limits) else {
        return;
    };
    let written = clip.to_bytes();
    assert_eq!(
        CompressedClip::from_bytes_within(&written, &limits).as_ref(),
        Ok(&clip)
    );
    let sampled = clip
        .sample(clip.source_rate_hz())
        .expect("a rate that was read can be sampled");
    assert_eq!(sampled.frames, clip.source_frames());
    assert!(
        sampled
            .rotations
            .iter()
            .all(|q| (q.coords.norm() - 1.0).abs() < 1e-6)
    );
});

/// CRC-32 bit by bit.
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |sum, &byte| {
        (0..8).fold(sum ^ u32::from(byte), |sum, _| {
            (sum >> 1) ^ (0xEDB8_8320 & (sum & 1).wrapping_neg())
        })
    })
}
