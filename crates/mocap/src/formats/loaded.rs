//! Input limits and results that all readers share.

use super::container::memory_of_packed;
use crate::clip::Clip;
use crate::parse_error::{ParseError, Warning};

/// Limits of what a file may declare.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// Joints in one file.
    pub joints: usize,
    /// Joints from a root to a leaf.
    pub depth: usize,
    /// Bytes in one line of text.
    pub line_bytes: usize,
    /// Frames in one clip.
    pub frames: usize,
    /// Memory for all that is unpacked of one file and made of it, bytes. A packed file has
    /// [that of archives](super::container::memory_of_packed) at most.
    pub memory: usize,
}

impl Limits {
    /// Refuses what takes more memory than there is: `count` times `each` bytes.
    pub(crate) fn afford(&self, count: usize, each: usize) -> Result<(), ParseError> {
        match count.saturating_mul(each) {
            needed if needed > self.memory => Err(ParseError::of_memory(self.memory, needed)),
            _ => Ok(()),
        }
    }

    /// The same limits for a packed file of this many bytes.
    pub(crate) fn of_packed(&self, bytes: usize) -> Self {
        let memory = self.memory.min(memory_of_packed(bytes));
        Self { memory, ..*self }
    }

    /// The same limits when `used` bytes of the memory are taken.
    ///
    /// # Errors
    /// There are fewer.
    pub(crate) fn without(&self, used: usize) -> Result<Self, ParseError> {
        self.afford(used, 1)?;
        let memory = self.memory - used;
        Ok(Self { memory, ..*self })
    }
}

/// Room for `count` rows.
///
/// # Errors
/// The system has no memory for them.
pub(super) fn room<T>(count: usize) -> Result<Vec<T>, ParseError> {
    let mut rows = Vec::new();
    let bytes = count.saturating_mul(size_of::<T>());
    rows.try_reserve_exact(count)
        .map_err(|_| ParseError::of_memory(0, bytes))?;
    Ok(rows)
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
            memory: usize::MAX,
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
