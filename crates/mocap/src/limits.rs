//! Limits of what a file may declare, which all readers share.

use crate::parse_error::ParseError;

/// Memory for what is unpacked of an archive and made of it, however small it is,
const FREE_BYTES: usize = 64 << 20;
/// and this much for each of its bytes: text of motion has 3 to 10, and becomes once or twice as much.
const BYTES_A_BYTE: usize = 32;

/// Memory for all that is unpacked of a packed file of this many bytes and made of it, bytes: 64 MiB and 32 times as many. What
/// it holds packed once more has no more of its own.
pub fn memory_of_packed(bytes: usize) -> usize {
    bytes
        .saturating_mul(BYTES_A_BYTE)
        .saturating_add(FREE_BYTES)
}

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
    /// [that of archives](memory_of_packed) at most.
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
