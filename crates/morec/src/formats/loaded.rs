//! What every reader of a format takes and gives.

use crate::clip::Clip;
use crate::parse_error::Warning;

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
