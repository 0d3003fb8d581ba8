//! Layout of a table from its header, and its rows and frames.

use crate::formats::points::Point;

/// A row: its line and its cells.
pub(super) type TableLine<'a> = (u64, Vec<&'a str>);

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

/// Frames: points, times, and the layout they were read by.
pub(super) type TableFrames = (Vec<Point>, Vec<Option<f64>>, ColumnLayout);

/// Times in their unit to seconds; an unknown unit follows from the usual step.
pub(in crate::formats) fn to_seconds(times: &mut [Option<f64>], secs: Option<f64>) {
    let known: Vec<f64> = times.iter().copied().flatten().collect();
    let mut steps: Vec<f64> = known.windows(2).map(|w| w[1] - w[0]).collect();
    steps.sort_by(f64::total_cmp);
    let usual = steps.get(steps.len() / 2).copied().unwrap_or(0.0);
    let secs = secs.unwrap_or(match usual {
        step if step >= 1e6 => 1e-9,
        // Ticks of 100 ns, as Windows and Kinect count.
        step if step >= 1e5 => 1e-7,
        step if step >= 1e3 => 1e-6,
        step if step >= 2.0 => 1e-3,
        _ => 1.0,
    });
    let first = known.first().copied().unwrap_or(0.0);
    for time in times.iter_mut().flatten() {
        // Times since 1970 leave few digits for the fraction.
        *time = (*time - first) * secs;
    }
}
