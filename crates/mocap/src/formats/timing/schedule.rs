//! A constant rate, and the source frames from which each of its frames is made.

/// A fixed rate, and where its frames lie among those of the file.
pub(in crate::formats) struct Schedule {
    pub(in crate::formats) rate_hz: f64,
    /// For each frame what it is made of; `None` if frames stay as they are.
    pub(in crate::formats) places: Option<Vec<BetweenFrames>>,
}

/// A frame between two of a file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::formats) struct BetweenFrames {
    pub(in crate::formats) before: usize,
    pub(in crate::formats) after: usize,
    /// How far it lies from the one before to the one after, 0 to 1.
    pub(in crate::formats) t: f64,
    /// False if the two are too far apart to know what is between them.
    pub(in crate::formats) known: bool,
}

impl BetweenFrames {
    pub(super) fn at(frame: usize) -> Self {
        Self {
            before: frame,
            after: frame,
            t: 0.0,
            known: true,
        }
    }
}
