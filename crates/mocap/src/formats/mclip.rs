//! Reads the stored form of compressed clips: its curves, sampled at the frames of their source.

use super::descriptor::FormatDescriptor;
use super::{Limits, Loaded, ParseError, Place, Warning};
use crate::math::{Quat, Vec3};
use crate::smooth::CompressedClip;

pub(super) const FORMAT: FormatDescriptor = FormatDescriptor {
    name: "mclip",
    title: "MCLIP (curves)",
    noun: "a stored clip",
    endings: &["mclip"],
    looks_so: |h| h.bytes.starts_with(crate::smooth::MAGIC),
    up: None,
    read: |file| Ok(file.at_rate(read(file.bytes, file.name, file.limits)?)),
};

/// Rotations that are made of a file however small it is: an hour of a body that stands still,
const FREE_ROTATIONS: usize = 1 << 24;
/// and this many for each of its bytes. Real motion has ten or so.
const ROTATIONS_A_BYTE: usize = 24;

/// Reads a stored clip and samples it at its source's rate; it is called `name`. Time and memory O(frames × joints).
///
/// # Errors
/// Bytes that are something else, newer, cut short or altered, or that stand for more frames than `limits` allow or
/// so few bytes can be believed to hold.
pub fn read(bytes: &[u8], name: &str, limits: &Limits) -> Result<Loaded, ParseError> {
    let stored = CompressedClip::from_bytes_within(bytes, limits)?;
    let most = FREE_ROTATIONS + bytes.len().saturating_mul(ROTATIONS_A_BYTE);
    let rotations = stored
        .source_frames()
        .saturating_mul(stored.skeleton().len());
    if rotations > most {
        let expected = format!("at most {most} rotations in {} bytes", bytes.len());
        return Err(ParseError::new(
            Place::File,
            expected,
            rotations.to_string(),
        ));
    }
    limits.afford(rotations, size_of::<Quat>() + size_of::<Vec3>())?;
    let clip = stored
        .sample(stored.source_rate_hz())
        .map_err(|error| ParseError::new(Place::File, "a usable rate", error.to_string()))?;
    let mut warnings = Vec::new();
    if clip.frames == 0 {
        warnings.push(Warning::new(Place::File, "the clip has no frames"));
    }
    let clip = crate::clip::Clip {
        name: name.to_owned(),
        ..clip
    };
    Ok(Loaded {
        clips: vec![clip],
        warnings,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::smooth::{SmoothParams, compress};
    use crate::testing::pushing;

    #[test]
    fn a_stored_clip_is_a_clip() {
        let clip = pushing();
        let bytes = compress(&clip, &SmoothParams::default(), &())
            .unwrap()
            .to_bytes();
        let loaded = read(&bytes, "again", &Limits::default()).unwrap();
        let again = &loaded.clips[0];
        assert_eq!(
            (again.name.as_str(), again.frames, again.rate_hz),
            ("again", clip.frames, clip.rate_hz)
        );
        assert_eq!(again.skeleton, clip.skeleton);
        for (a, b) in again.rotations.iter().zip(&clip.rotations) {
            assert!(a.angle_to(b) <= 0.5f64.to_radians() + 1e-9);
        }
    }

    /// A few bytes can say that nothing moves for a day.
    #[test]
    fn small_files_do_not_stand_for_endless_frames() {
        use crate::clip::{Clip, Joint, Skeleton};
        use crate::math::{Quat, Vec3};
        let joint = Joint {
            name: "J".into(),
            parent: None,
            offset: Vec3::zeros(),
            tip: None,
        };
        let (joints, frames) = (1000, 20);
        let clip = Clip {
            name: String::new(),
            skeleton: Skeleton::new(vec![joint; joints]).unwrap(),
            rate_hz: 30.0,
            rotations: vec![Quat::identity(); joints * frames],
            tracks: Vec::new(),
            frames,
            repaired: Vec::new(),
            points: None,
        };
        let mut bytes = compress(&clip, &SmoothParams::default(), &())
            .unwrap()
            .to_bytes();
        // Frames stand behind the empty name; three more bytes make ten million of them.
        bytes.splice(21..22, [0x80, 0xAD, 0xE2, 0x04]);
        let (length, checksum) = (bytes.len() as u64 - 20, crc32fast::hash(&bytes[20..]));
        bytes[8..16].copy_from_slice(&length.to_le_bytes());
        bytes[16..20].copy_from_slice(&checksum.to_le_bytes());
        let error = read(&bytes, "long", &Limits::default()).unwrap_err();
        assert_eq!(error.found, "10000000000", "{error}");
    }
}
