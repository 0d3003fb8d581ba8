//! Motion-capture files: reading, writing, and telling them apart.
//!
//! Readers take bytes, never paths. What can be saved is loaded with a [`Warning`] that names the place; what
//! cannot is refused with a [`ParseError`] that says where, what was expected and what was found.

pub mod acclaim;
mod builder;
pub mod bvh;
pub mod c3d;
mod cells;
pub mod container;
#[cfg(feature = "fbx")]
pub mod fbx;
pub mod gltf;
pub mod jsonl;
mod keys;
pub mod landmarks;
#[cfg(test)]
mod mangle;
pub mod mclip;
pub mod mocopi;
pub mod mvnx;
pub mod ntu;
pub(crate) mod points;
pub mod probe;
mod scene;
pub mod smpl;
pub mod table;
mod timing;
pub mod trc;

use std::fmt;

use crate::clip::Clip;

/// Where in a file something was noticed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Place {
    /// The file as a whole.
    File,
    /// A line of a text file, from 1.
    Line(u64),
    /// A line and a column (in bytes) of a text file, both from 1.
    Column(u64, u64),
    /// A byte of a binary file, from 0.
    Byte(u64),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Place::File => f.write_str("file"),
            Place::Line(line) => write!(f, "line {line}"),
            Place::Column(line, column) => write!(f, "line {line}, column {column}"),
            Place::Byte(byte) => write!(f, "byte {byte}"),
        }
    }
}

/// A file that could not be read, and why.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{at}: expected {expected}, found {found}")]
pub struct ParseError {
    /// Where reading stopped.
    pub at: Place,
    /// What would have been right.
    pub expected: String,
    /// What stood there instead.
    pub found: String,
}

impl ParseError {
    /// An error at `at`.
    pub fn new(at: Place, expected: impl Into<String>, found: impl Into<String>) -> Self {
        Self {
            at,
            expected: expected.into(),
            found: found.into(),
        }
    }
}

/// Something that was repaired or looks wrong, in a file that was read all the same.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct Warning {
    /// Where it was noticed.
    pub at: Place,
    /// What it is and what was done about it, in a sentence.
    pub text: String,
}

impl Warning {
    /// A warning at `at`.
    pub fn new(at: Place, text: impl Into<String>) -> Self {
        Self {
            at,
            text: text.into(),
        }
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.at, self.text)
    }
}

/// What a file declares is believed only up to here.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// Joints in one file.
    pub joints: usize,
    /// Joints from a root to a leaf.
    pub depth: usize,
    /// Bytes in one line.
    pub line_bytes: usize,
    /// Frames in one clip.
    pub frames: usize,
}

impl Default for Limits {
    fn default() -> Self {
        // The largest files seen in the wild have 173 joints and some ten thousand frames; a day at 120 Hz has
        // ten million.
        Self {
            joints: 4096,
            depth: 256,
            line_bytes: 1 << 20,
            frames: 20_000_000,
        }
    }
}

/// What reading a file gave.
#[derive(Debug, Clone, PartialEq)]
pub struct Loaded {
    /// One clip for each character in the file, in file order.
    pub clips: Vec<Clip>,
    /// What was repaired or looks wrong.
    pub warnings: Vec<Warning>,
}

/// Reads the formats of whole scenes and suits: [MVNX](mvnx), [glTF](gltf), FBX (feature `fbx`), [SMPL](smpl) and
/// [mocopi], and of points that need nothing but the file ([NTU](ntu), [landmarks]). `rate_hz` replaces the rate where the file holds frames; keys in seconds keep theirs. `None` for
/// other formats.
pub fn read_scene(
    format: probe::Format,
    bytes: &[u8],
    name: &str,
    rate_hz: Option<f64>,
    beside: gltf::Beside<'_>,
    limits: &Limits,
) -> Option<Result<Loaded, ParseError>> {
    use probe::Format;
    let loaded = match format {
        Format::Mvnx => mvnx::read(bytes, name, limits),
        Format::Smpl => smpl::read(bytes, name, limits),
        Format::Mocopi => mocopi::read(bytes, name, limits),
        Format::Gltf => gltf::read(bytes, name, beside, limits),
        Format::NtuSkeleton => ntu::read(bytes, name, rate_hz, limits),
        Format::Landmarks => landmarks::read(bytes, name, rate_hz, limits),
        Format::Fbx => read_fbx(bytes, name, limits),
        _ => return None,
    };
    let timed = matches!(format, Format::Gltf | Format::Fbx);
    Some(loaded.map(|mut loaded| {
        match rate_hz {
            Some(_) if timed => {
                let text = "its keys stand at times, not frames; the rate given is not used";
                loaded.warnings.push(Warning::new(Place::File, text));
            }
            Some(rate_hz) => loaded.clips.iter_mut().for_each(|c| c.rate_hz = rate_hz),
            None => {}
        }
        loaded
    }))
}

#[cfg(feature = "fbx")]
fn read_fbx(bytes: &[u8], name: &str, limits: &Limits) -> Result<Loaded, ParseError> {
    fbx::read(bytes, name, limits)
}

#[cfg(not(feature = "fbx"))]
fn read_fbx(_: &[u8], _: &str, _: &Limits) -> Result<Loaded, ParseError> {
    Err(ParseError::new(
        Place::File,
        "a format that this build reads",
        "FBX, which needs the feature `fbx`",
    ))
}
