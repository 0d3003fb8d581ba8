//! Input limits and results that all readers share.

use crate::clip::Clip;
use crate::parse_error::Warning;

/// Limits of what a file may declare.
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

/// Result of reading a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Loaded {
    /// One clip for each character in the file, in file order.
    pub clips: Vec<Clip>,
    /// Repairs and doubts.
    pub warnings: Vec<Warning>,
}
