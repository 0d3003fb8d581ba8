//! One pass through a clip (thesis, Algorithm 2).

use crate::pca::{ComponentCount, Moments};

use super::peaks::Peaks;
use super::{Ppca, PpcaParams};

/// Rows in double precision, without the dimensions in which a clip does not vary at all.
pub(super) struct Values {
    /// Row after row.
    pub values: Vec<f64>,
    /// Values in a row.
    pub dim: usize,
    /// Values in a row before, `n`.
    pub space: usize,
}

/// [`PpcaParams`] in rows.
#[derive(Debug, Clone, Copy)]
pub(super) struct PassLengths {
    pub first: usize,
    pub ahead: usize,
    pub step: usize,
}

impl PassLengths {
    pub(super) fn at(rate_hz: f64, params: &PpcaParams) -> Self {
        let rows = |secs: f64, least: f64| (secs * rate_hz).round().clamp(least, 1e9) as usize;
        Self {
            first: rows(params.first_secs, 2.0),
            ahead: rows(params.ahead_secs, 1.0),
            step: rows(params.step_secs, 1.0),
        }
    }
}

/// Result of one pass; places are rows from its start.
#[derive(Debug, Default)]
pub(super) struct Pass {
    /// `(place, H)`: the rows from `place` on, against the segment before it.
    pub points: Vec<(usize, f64)>,
    /// First rows of new segments.
    pub cuts: Vec<usize>,
}

/// Thesis Algorithm 2 as corrected: `K` grows by `Δ`; a cut where the peak's look-ahead window begins, and the next
/// segment from there. O(rows / Δ · (q³ + T q r)).
pub(super) fn pass(rows: &Values, lengths: PassLengths, params: &PpcaParams) -> Pass {
    let mut pass = Pass::default();
    let mut start = 0;
    while let Some(cut) = next_cut(rows, start, lengths, params, &mut pass.points) {
        pass.cuts.push(cut);
        start = cut;
    }
    pass
}

fn next_cut(
    rows: &Values,
    start: usize,
    lengths: PassLengths,
    params: &PpcaParams,
    points: &mut Vec<(usize, f64)>,
) -> Option<usize> {
    let count = rows.values.len().checked_div(rows.dim)?;
    let span = |from: usize, to: usize| &rows.values[from * rows.dim..to * rows.dim];
    let mut peaks = Peaks::new(params.rise * rows.space as f64, params.fall);
    let mut moments = Moments::new(rows.dim);
    let mut keep = ComponentCount::Quality(params.quality);
    let mut seen = start;
    let mut end = start + lengths.first;
    while end + lengths.ahead <= count {
        moments.push_values(span(seen, end));
        seen = end;
        let model = Ppca::fit(&moments, keep, rows.space, params.least_variance);
        keep = ComponentCount::Dims(model.dims());
        let h = model.mean_distance(span(end, end + lengths.ahead));
        points.push((end, h));
        if let Some(cut) = peaks.push(end, h) {
            return Some(cut);
        }
        end += lengths.step;
    }
    None
}
