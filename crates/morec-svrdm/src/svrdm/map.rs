//! The map of confidences over starts and ends of segments (thesis, Fig. 4.3), kept to be looked at.

use super::{Cell, Window};

/// Every segment that was looked at and what it seemed to be: what
/// [`SvrdmEngine::push_with_observer`](super::SvrdmEngine::push_with_observer) calls with. Recording allocates; a live stream
/// without end should not be recorded.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ConfidenceMap {
    cells: Vec<(Window, Cell)>,
}

impl ConfidenceMap {
    /// An empty map.
    pub fn new() -> Self {
        Self::default()
    }

    /// Keeps a segment that is some class; rejected ones are where nothing is kept.
    pub fn record(&mut self, window: Window, cell: Cell) {
        if cell.confidence > 0.0 {
            self.cells.push((window, cell));
        }
    }

    /// Cells that were kept, by end and then from the shortest to the longest.
    pub fn cells(&self) -> &[(Window, Cell)] {
        &self.cells
    }
}
