//! A stretch of a stream.

/// A stretch of a stream in ticks, half-open.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LookExtent {
    /// First tick.
    pub start: i64,
    /// One past the last.
    pub stop: i64,
}

impl LookExtent {
    /// Ticks in it.
    #[allow(clippy::len_without_is_empty)]
    pub fn len(self) -> i64 {
        self.stop - self.start
    }

    /// Ticks in both.
    pub fn shared(self, other: Self) -> i64 {
        (self.stop.min(other.stop) - self.start.max(other.start)).max(0)
    }
}
