//! Acclaim's pair of formats: a skeleton (ASF) that serves many motions (AMC).
//!
//! Sources: M. Schafer, "Acclaim Skeleton File Definition V1.10" (1995), and Oxford Metrics' "Acclaim Format:
//! ASF line details". What they leave open is decided as the CMU and HDM05 libraries need it:
//!
//! - A bone's rotation `M` is given about its own axes `C`, so that `parent_from_joint = C·M·C⁻¹`.
//! - A list of rotations is applied in the order in which it is written, about fixed axes: `rx ry rz` is
//!   `Rz·Ry·Rx`. This holds for the root's `order`, for `dof` and for `axis`.
//! - An Acclaim bone becomes the joint at its near end, which is the far end of its parent bone. A bone without
//!   children gives its joint a [`tip`](crate::clip::Joint::tip).
//! - Lengths stay in the file's own unit; [`Asf::metres_per_unit`] says what the header declares.

mod amc;
mod asf;
mod motion;
mod skeleton;
mod text;

use super::descriptor::{FormatDescriptor, FormatInput};
use super::head::Head;
use super::{Loaded, ParseError};
use crate::clip::Clip;
pub use amc::{AmcOptions, DEFAULT_RATE_HZ, read_amc};
pub use asf::read_asf;
pub use skeleton::{AmcChannel, Asf, AsfBone, Root};

pub(super) const ASF: FormatDescriptor = FormatDescriptor {
    name: "asf",
    title: "ASF (skeleton only)",
    noun: "an ASF skeleton",
    endings: &["asf"],
    looks_so: is_asf,
    up: None,
    read: read_skeleton,
};

fn is_asf(head: &Head) -> bool {
    let first = head.lines().next().unwrap_or_default().to_ascii_lowercase();
    let opens = [
        b":version".as_slice(),
        b":name",
        b":units",
        b":documentation",
        b":root",
        b":bonedata",
    ];
    opens.iter().any(|keyword| first.starts_with(keyword))
}

pub(super) const AMC: FormatDescriptor = FormatDescriptor {
    name: "amc",
    title: "AMC",
    noun: "an AMC motion",
    endings: &["amc"],
    looks_so: is_amc,
    up: None,
    read: |_| Err(FormatInput::lacks("the ASF skeleton beside it")),
};

/// A header of its own, or a number alone on a line and then a name and a number.
fn is_amc(head: &Head) -> bool {
    let opens = |line: &[u8]| {
        let line = line.to_ascii_lowercase();
        [b":fully-specified".as_slice(), b":degrees", b":radians"]
            .iter()
            .any(|word| line.starts_with(word))
    };
    let mut lines = head.lines();
    let Some(first) = lines.next() else {
        return false;
    };
    if opens(first) {
        return true;
    }
    let mut row = lines
        .next()
        .unwrap_or_default()
        .split(u8::is_ascii_whitespace);
    let named = row
        .next()
        .is_some_and(|name| name.first().is_some_and(u8::is_ascii_alphabetic));
    first.iter().all(u8::is_ascii_digit)
        && named
        && row
            .next()
            .is_some_and(|value| fast_float2::parse::<f64, _>(value).is_ok())
}

/// A clip of a skeleton alone: without frames.
fn read_skeleton(file: &FormatInput<'_>) -> Result<Loaded, ParseError> {
    let (asf, warnings) = read_asf(file.bytes, file.limits)?;
    let clip = Clip {
        name: file.name.to_owned(),
        skeleton: asf.skeleton(),
        rate_hz: DEFAULT_RATE_HZ,
        rotations: Vec::new(),
        tracks: Vec::new(),
        frames: 0,
        repaired: Vec::new(),
        points: None,
    };
    Ok(Loaded {
        clips: vec![clip],
        warnings,
    })
}

#[cfg(test)]
mod tests;
