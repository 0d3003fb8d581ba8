use proptest::prelude::*;

use super::{clips, one_joint};
use crate::formats::{Limits, Place};
use crate::math::{Axis, Vec3};
use crate::smooth::{CompressedClip, SmoothParams, VERSION, compress};

fn small() -> Vec<u8> {
    let clip = one_joint(
        30.0,
        40,
        |t| Axis::Y.rotation(2.0 * t.sin()),
        |t| Vec3::new(t, t * t, 1.0),
    );
    compress(&clip, &SmoothParams::default(), &())
        .unwrap()
        .to_bytes()
}

/// Puts right what the header says of the bytes after it.
fn with_right_header(mut bytes: Vec<u8>) -> Vec<u8> {
    if let Some((header, body)) = bytes.split_at_mut_checked(20) {
        header[8..16].copy_from_slice(&(body.len() as u64).to_le_bytes());
        header[16..].copy_from_slice(&crc32fast::hash(body).to_le_bytes());
    }
    bytes
}

#[test]
fn any_cut_and_any_altered_byte_is_an_error() {
    let bytes = small();
    for length in 0..bytes.len() {
        assert!(
            CompressedClip::from_bytes(&bytes[..length]).is_err(),
            "cut to {length}"
        );
    }
    for at in 0..bytes.len() {
        for change in [1, 0x80, 0xFF] {
            let mut altered = bytes.clone();
            altered[at] ^= change;
            assert!(
                CompressedClip::from_bytes(&altered).is_err(),
                "byte {at} ^ {change}"
            );
        }
    }
    let mut longer = bytes;
    longer.push(0);
    assert!(CompressedClip::from_bytes(&longer).is_err());
}

/// Damage behind a right checksum is somebody's intent: an error or some clip, never a panic.
#[test]
fn altered_bytes_with_a_right_checksum_do_no_harm() {
    let bytes = small();
    let limits = Limits {
        frames: 2000,
        ..Limits::default()
    };
    for at in 20..bytes.len() {
        for change in 1..=255 {
            let mut altered = bytes.clone();
            altered[at] ^= change;
            if let Ok(clip) =
                CompressedClip::from_bytes_within(&with_right_header(altered), &limits)
            {
                clip.sample(clip.source_rate_hz()).unwrap();
            }
        }
        let cut = with_right_header(bytes[..at].to_vec());
        if let Ok(clip) = CompressedClip::from_bytes_within(&cut, &limits) {
            clip.sample(clip.source_rate_hz()).unwrap();
        }
    }
}

proptest! {
    #[test]
    fn any_bytes_behind_a_right_header_do_no_harm(
        clip in clips(),
        from in any::<prop::sample::Index>(),
        noise in prop::collection::vec(any::<u8>(), 1..200),
    ) {
        let mut bytes = compress(&clip, &SmoothParams::database(), &()).unwrap().to_bytes();
        bytes.truncate(20 + from.index(bytes.len() - 20));
        bytes.extend(noise);
        let limits = Limits { frames: 2000, joints: 50, ..Limits::default() };
        if let Ok(clip) = CompressedClip::from_bytes_within(&with_right_header(bytes), &limits) {
            let again = CompressedClip::from_bytes_within(&clip.to_bytes(), &limits);
            prop_assert_eq!(again.as_ref(), Ok(&clip));
            clip.sample(clip.source_rate_hz()).unwrap();
        }
    }
}

#[test]
fn limits_hold() {
    let bytes = small();
    let error = CompressedClip::from_bytes_within(
        &bytes,
        &Limits {
            frames: 39,
            ..Limits::default()
        },
    );
    let error = error.unwrap_err();
    assert!(
        error.expected.contains("39") && error.found == "40",
        "{error}"
    );
    let error = CompressedClip::from_bytes_within(
        &bytes,
        &Limits {
            joints: 0,
            ..Limits::default()
        },
    );
    assert!(error.unwrap_err().expected.contains("joints"));
}

#[test]
fn foreign_and_newer_files_are_named() {
    let error = CompressedClip::from_bytes(b"HIERARCHY\n").unwrap_err();
    assert!(error.expected.contains("MCLIP"), "{error}");
    let mut newer = small();
    newer[6..8].copy_from_slice(&(VERSION + 1).to_le_bytes());
    let error = CompressedClip::from_bytes(&newer).unwrap_err();
    assert_eq!(error.at, Place::Byte(6));
    assert!(error.expected.contains("newer morec"), "{error}");
}
