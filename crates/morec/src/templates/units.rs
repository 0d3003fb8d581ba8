//! Rows in whole units of 16 bits, with fast products and exact distances.

use crate::features::Rows;

use super::dot::{AT_ONCE, Pair};

/// Length of the longest row of the templates at most, and of a row of a stream, in units: the squared distance of two such rows is below
/// 2³¹, and no value above 2¹⁵.
const LONGEST_TEMPLATE: f32 = 13_000.0;
const LONGEST_ROW: f32 = 32_700.0;

/// Units in one of what rows are measured in: a power of two, so that small whole numbers stay what they are. With the longest template at
/// 25 there are 512.
#[derive(Debug, Clone, Copy)]
pub struct Units(f32);

impl Units {
    /// The finest in which all of `templates` fit into 16 bits.
    pub fn of(templates: &[Rows]) -> Self {
        let rows = templates.iter().flat_map(Rows::iter);
        let longest = rows.map(square).fold(0.0, f32::max).sqrt();
        let mut scale = 1.0;
        // Beyond these, rows are no motion, and squares leave the range of single precision.
        while scale < 65_536.0 && 2.0 * scale * longest <= LONGEST_TEMPLATE {
            scale *= 2.0;
        }
        while scale > 1.0 / 65_536.0 && scale * longest > LONGEST_TEMPLATE {
            scale /= 2.0;
        }
        Self(scale)
    }

    /// One squared unit.
    pub fn square(self) -> f32 {
        1.0 / (self.0 * self.0)
    }

    /// `row` two values at a time, with a 0 behind an odd number of them.
    pub fn pairs(self, row: &[f32]) -> impl Iterator<Item = Pair> {
        let value = move |v: &f32| whole(v * self.0);
        row.chunks(2)
            .map(move |pair| [value(&pair[0]), pair.get(1).map_or(0, value)])
    }
}

/// The nearest whole number.
fn whole(scaled: f32) -> i16 {
    (scaled + 0.5f32.copysign(scaled)) as i16
}

fn square(row: &[f32]) -> f32 {
    row.iter().map(|v| v * v).sum()
}

/// `|row|²`, of at most [`LONGEST_ROW`].
pub fn norm(pairs: &[Pair]) -> i32 {
    let squares = pairs.as_flattened().iter().map(|v| i32::from(*v).pow(2));
    squares.sum()
}

/// Rows of a stream that are stepped through together.
#[derive(Debug, Clone, Default)]
pub struct StreamRows {
    /// Of each row; all 0 in one that is too long.
    pub pairs: [Vec<Pair>; AT_ONCE],
    /// `|z|²` of each row, in squared units; `None` if it is too long.
    pub norms: [Option<i32>; AT_ONCE],
    /// The rows in units that are not rounded.
    pub exact: [Vec<f32>; AT_ONCE],
    /// How many.
    pub count: usize,
}

impl StreamRows {
    /// `rows`, of `dim` values each, [`AT_ONCE`] of them together.
    #[cfg(feature = "train")]
    pub fn of<'r>(rows: impl Iterator<Item = &'r [f32]>, dim: usize, units: Units) -> Vec<Self> {
        let mut all: Vec<Self> = Vec::new();
        for row in rows {
            if all.last().is_none_or(|last| last.count == AT_ONCE) {
                all.push(Self::new(dim));
            }
            if let Some(last) = all.last_mut() {
                last.push(row, units);
            }
        }
        all
    }

    /// None yet, of rows of `dim` values.
    pub fn new(dim: usize) -> Self {
        let pairs = dim.div_ceil(2);
        Self {
            pairs: [(); AT_ONCE].map(|()| vec![[0; 2]; pairs]),
            norms: [None; AT_ONCE],
            exact: [(); AT_ONCE].map(|()| vec![0.0; 2 * pairs]),
            count: 0,
        }
    }

    /// Takes one more row.
    pub fn push(&mut self, row: &[f32], units: Units) {
        let at = self.count;
        self.count += 1;
        for (exact, value) in self.exact[at].iter_mut().zip(row) {
            *exact = value * units.0;
        }
        let fits = square(&self.exact[at]) <= LONGEST_ROW * LONGEST_ROW;
        let exact = self.exact[at].as_chunks().0;
        for (pair, exact) in self.pairs[at].iter_mut().zip(exact) {
            *pair = if fits { exact.map(whole) } else { [0; 2] };
        }
        self.norms[at] = fits.then(|| norm(&self.pairs[at]));
    }
}
