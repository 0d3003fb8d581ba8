//! The descriptor of FBX, present even if its reader is not built.

use super::descriptor::{FormatDescriptor, FormatInput};
use super::{Loaded, ParseError};

pub(super) const FORMAT: FormatDescriptor = FormatDescriptor {
    name: "fbx",
    title: "FBX",
    noun: "an FBX scene",
    endings: &["fbx"],
    looks_so: |h| {
        h.starts("Kaydara FBX Binary") || h.starts("; FBX") || h.starts("FBXHeaderExtension")
    },
    up: None,
    read,
};

#[cfg(feature = "fbx")]
fn read(file: &FormatInput<'_>) -> Result<Loaded, ParseError> {
    Ok(super::fbx::read_stated(file.bytes, file.name, file.rate_hz, file.limits)?.0)
}

#[cfg(not(feature = "fbx"))]
fn read(_: &FormatInput<'_>) -> Result<Loaded, ParseError> {
    Err(ParseError::new(
        super::Place::File,
        "a format that this build reads",
        "FBX, which needs the feature `fbx`",
    ))
}
