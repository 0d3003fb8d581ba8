//! The layout of a table, from its header, and the reading of its rows and frames.

use crate::formats::points::Point;
use crate::formats::timing::Stamps;

/// A row: its line and its cells.
pub(super) type TableLine<'a> = (u64, Vec<&'a str>);

/// The column of z of a point that lies in a plane, where z is 0.
pub(super) const IN_PLANE: usize = usize::MAX;

/// Layout of a table, from its header.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct ColumnLayout {
    /// Points and the columns of x, y and z.
    pub(super) points: Vec<(String, [usize; 3])>,
    /// The column of times, and seconds in its unit.
    pub(super) time: Option<(usize, Option<f64>)>,
    /// The column of frame numbers.
    pub(super) frame: Option<usize>,
    pub(super) rate_hz: Option<f64>,
    pub(super) metres_per_unit: Option<f64>,
    /// Rows before the first frame.
    pub(super) header_rows: usize,
    /// The row behind the last frame, if others follow.
    pub(super) stop_row: Option<usize>,
    /// Omissions and guesses.
    pub(super) notes: Vec<String>,
}

/// Frames: points, when each was, and the layout they were read by.
pub(super) type TableFrames = (Vec<Point>, Stamps, ColumnLayout);
