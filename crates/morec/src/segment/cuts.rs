//! The cuts of a clip, from forward and backward passes.

use nalgebra::DMatrix;

use super::pass::{Pass, PassLengths, Values, pass};
use super::{PassDirections, PpcaParams, SegmentError};
use crate::features::Rows;
use crate::pca::{Eigen, Moments};

/// The boundary between two behaviours.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Cut {
    /// First row of the new segment.
    pub row: usize,
    /// Time, seconds.
    pub secs: f64,
    /// True if the pass from start to end found it.
    pub forward: bool,
    /// True if the pass from end to start found it.
    pub backward: bool,
}

/// A value of `H`: how badly the rows from `secs` on (before it, in the backward pass) fit the segment before them.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct MisfitSample {
    /// Start of the look-ahead window.
    pub secs: f64,
    /// Mean Mahalanobis distance; about `n` for rows that fit.
    pub value: f64,
}

/// Result of [`segment`].
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Segmentation {
    /// In the order of their times.
    pub cuts: Vec<Cut>,
    /// `H` of the pass from start to end; empty if it was not asked for or the rows are too few.
    pub forward: Vec<MisfitSample>,
    /// `H` of the pass from end to start, in the order of times.
    pub backward: Vec<MisfitSample>,
}

/// A dimension that varies by less than this share of the one that varies most does not vary.
const NOTHING: f64 = 1e-10;

/// Cuts rows, `rate_hz` a second, where their distribution changes (thesis §3.5.2, Algorithm 2 as corrected). Rows too
/// few for one model and one look-ahead have no cut. O(rows / Δ · (n³ + T n r)).
///
/// # Errors
/// Parameters or a rate that make no sense, rows that are not finite.
pub fn segment(
    rows: &Rows,
    rate_hz: f64,
    params: &PpcaParams,
) -> Result<Segmentation, SegmentError> {
    params.check().map_err(SegmentError::Params)?;
    if !(rate_hz > 0.0 && rate_hz <= 1e5) {
        return Err(SegmentError::Rate(rate_hz));
    }
    if let Some(row) = rows
        .iter()
        .position(|row| row.iter().any(|v| !v.is_finite()))
    {
        return Err(SegmentError::NotFinite { row });
    }
    let values = varying(rows);
    let lengths = PassLengths::at(rate_hz, params);
    let (forward, backward) = rayon::join(
        || match params.directions {
            PassDirections::Backward => Pass::default(),
            _ => pass(&values, lengths, params),
        },
        || match params.directions {
            PassDirections::Forward => Pass::default(),
            _ => backward(&values, lengths, params),
        },
    );
    let points = |pass: &Pass| {
        let point = |&(row, value): &(usize, f64)| MisfitSample {
            secs: row as f64 / rate_hz,
            value,
        };
        pass.points.iter().map(point).collect()
    };
    let same = params.same_secs * rate_hz;
    let cuts = join(&forward.cuts, &backward.cuts, same, rate_hz);
    Ok(Segmentation {
        cuts,
        forward: points(&forward),
        backward: points(&backward),
    })
}

/// The rows about their mean, in the directions in which they vary: a rotation, which leaves every distance as it is,
/// and smaller models to fit.
fn varying(rows: &Rows) -> Values {
    let mut moments = Moments::new(rows.dim());
    moments.push_rows(rows);
    let eigen = Eigen::of(moments.scatter());
    let most = eigen.values.first().copied().unwrap_or(0.0);
    let dim = eigen
        .values
        .iter()
        .take_while(|v| **v > NOTHING * most)
        .count();
    let centred = DMatrix::from_fn(rows.dim(), rows.len(), |k, i| {
        f64::from(rows.row(i)[k]) - moments.mean()[k]
    });
    let values = eigen.vectors.columns(0, dim).tr_mul(&centred);
    Values {
        values: values.as_slice().to_vec(),
        dim,
        space: rows.dim(),
    }
}

/// The pass over the rows turned round, its places turned back.
fn backward(rows: &Values, lengths: PassLengths, params: &PpcaParams) -> Pass {
    let turned: Vec<f64> = rows
        .values
        .chunks_exact(rows.dim.max(1))
        .rev()
        .flatten()
        .copied()
        .collect();
    let count = turned.len() / rows.dim.max(1);
    let mut found = pass(
        &Values {
            values: turned,
            ..*rows
        },
        lengths,
        params,
    );
    found
        .points
        .iter_mut()
        .for_each(|(place, _)| *place = count - *place);
    found.cuts.iter_mut().for_each(|cut| *cut = count - *cut);
    found.points.reverse();
    found.cuts.reverse();
    found
}

/// Every forward cut, and the backward ones that lie farther than `same` rows from all of them.
fn join(forward: &[usize], backward: &[usize], same: f64, rate_hz: f64) -> Vec<Cut> {
    let near = |a: usize, b: usize| a.abs_diff(b) as f64 <= same;
    let cut = |row: usize, forward, backward| Cut {
        row,
        secs: row as f64 / rate_hz,
        forward,
        backward,
    };
    let of_forward = forward
        .iter()
        .map(|&row| cut(row, true, backward.iter().any(|&b| near(row, b))));
    let alone = backward
        .iter()
        .filter(|&&row| !forward.iter().any(|&f| near(row, f)));
    let mut cuts: Vec<Cut> = of_forward
        .chain(alone.map(|&row| cut(row, false, true)))
        .collect();
    cuts.sort_by_key(|c| c.row);
    cuts
}
