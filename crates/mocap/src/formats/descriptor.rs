//! The description of a format (names, extensions, reader), and the input of a reader. A new format is added by its descriptor.

use std::io;

use super::bvh::PositionChannels;
use super::head::Head;
use super::{Limits, Loaded, ParseError, Place};
use crate::math::Axis;

/// All that is known of a format: what it is called, how it is recognised, its reader.
pub(super) struct FormatDescriptor {
    /// See [`Format::name`](super::Format::name).
    pub(super) name: &'static str,
    /// See [`Format::title`](super::Format::title).
    pub(super) title: &'static str,
    /// See [`Format::noun`](super::Format::noun).
    pub(super) noun: &'static str,
    /// Endings of files, in lower case.
    pub(super) endings: &'static [&'static str],
    /// True of content that shows it.
    pub(super) looks_so: fn(&Head) -> bool,
    /// The up axis, if the specification states it and that lengths are metres.
    pub(super) up: Option<Axis>,
    /// Reads what is in a file.
    pub(super) read: fn(&FormatInput<'_>) -> Result<Loaded, ParseError>,
}

/// Gives the bytes of a file that lies beside the one that is read, by its relative address.
pub type Beside<'a> = &'a dyn Fn(&str) -> io::Result<Vec<u8>>;

/// A file to be read.
#[derive(Clone, Copy)]
pub struct FormatInput<'a> {
    /// Its content, neither packed nor in UTF-16.
    pub bytes: &'a [u8],
    /// Name for its clip.
    pub name: &'a str,
    /// Replaces the rate of frames, and that at which keys in seconds are sampled.
    pub rate_hz: Option<f64>,
    /// Meaning of BVH position channels below the root; decided from the data if not given.
    pub positions: Option<PositionChannels>,
    /// True if points in two dimensions are read, all in one plane, in place of refusing them: those of a custom skeleton.
    pub planar: bool,
    /// The files beside it.
    pub beside: Beside<'a>,
    /// Limits of what it may declare.
    pub limits: &'a Limits,
}

impl<'a> FormatInput<'a> {
    /// A file that refers to no other file.
    pub(super) fn alone(
        bytes: &'a [u8],
        name: &'a str,
        rate_hz: Option<f64>,
        limits: &'a Limits,
    ) -> Self {
        Self {
            bytes,
            name,
            rate_hz,
            positions: None,
            planar: false,
            beside: &|_| Err(io::ErrorKind::NotFound.into()),
            limits,
        }
    }

    /// Its clips at the rate that replaces theirs.
    pub(super) fn at_rate(&self, mut loaded: Loaded) -> Loaded {
        for clip in &mut loaded.clips {
            clip.rate_hz = self.rate_hz.unwrap_or(clip.rate_hz);
        }
        loaded
    }

    /// The error of a file that is read with another one only.
    pub(super) fn lacks(other: &str) -> ParseError {
        ParseError::new(Place::File, other, "this file alone")
    }
}
