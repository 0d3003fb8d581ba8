//! Full dynamic time warping of two samples.

use crate::features::Rows;

/// Pairs of row indices along the cheapest path that aligns all of `a` with all of `b` (steps (1,1), (1,0),
/// (0,1), squared Euclidean cost; Sakoe and Chiba 1978 without slope constraint). Both must have rows.
///
/// O(len(a) · len(b)) time and space.
#[cfg(feature = "train")]
pub fn align(a: &Rows, b: &Rows) -> Vec<(usize, usize)> {
    let mut warping = WarpingPath::default();
    warping.align(a, b, false);
    warping.path
}

/// The memory in which rows are aligned, and the last path.
#[derive(Debug, Clone, Default)]
pub(super) struct WarpingPath {
    total: Vec<f64>,
    path: Vec<(usize, usize)>,
}

impl WarpingPath {
    /// With room for samples of `sample` rows, twice where they are run through around, and stretches of `stretch` rows.
    pub fn with_room(sample: usize, stretch: usize) -> Self {
        Self {
            total: Vec::with_capacity(2 * sample * stretch),
            path: Vec::with_capacity(2 * sample + stretch),
        }
    }

    /// Another with as much room.
    pub fn emptied(&self) -> Self {
        Self {
            total: Vec::with_capacity(self.total.capacity()),
            path: Vec::with_capacity(self.path.capacity()),
        }
    }

    /// [`align`]; with `around`, `a` is one turn of what repeats: the path may begin at any of its rows, end at any, and go on from the last to
    /// the first. Allocates only beyond the room there is.
    pub fn align(&mut self, a: &Rows, b: &Rows, around: bool) -> &[(usize, usize)] {
        self.path.clear();
        let (turn, m) = (a.len(), b.len());
        if turn == 0 || m == 0 {
            return &self.path;
        }
        let n = if around { 2 * turn } else { turn };
        let total = &mut self.total;
        total.clear();
        total.resize(n * m, f64::INFINITY);
        for i in 0..n {
            for j in 0..m {
                let cost = squared_distance(a.row(i % turn), b.row(j));
                let before = predecessor(total, m, (i, j), around).map_or(0.0, |(.., best)| best);
                total[i * m + j] = before + cost;
            }
        }
        let cheapest = |x: &usize, y: &usize| total[x * m + m - 1].total_cmp(&total[y * m + m - 1]);
        let last = match around {
            true => (0..n).min_by(cheapest).unwrap_or(n - 1),
            false => n - 1,
        };
        let (mut i, mut j) = (last, m - 1);
        self.path.push((i % turn, j));
        while let Some((pi, pj, _)) = predecessor(total, m, (i, j), around) {
            (i, j) = (pi, pj);
            self.path.push((i % turn, j));
        }
        self.path.reverse();
        &self.path
    }
}

/// The cheapest cell before `(i, j)`; the diagonal wins ties. `None` at the first cell, and with `around` at all of the first column.
fn predecessor(
    total: &[f64],
    m: usize,
    (i, j): (usize, usize),
    around: bool,
) -> Option<(usize, usize, f64)> {
    let options = [
        (i > 0 && j > 0).then(|| (i - 1, j - 1)),
        (i > 0 && !(around && j == 0)).then(|| (i - 1, j)),
        (j > 0).then(|| (i, j - 1)),
    ];
    let costed = options
        .into_iter()
        .flatten()
        .map(|(pi, pj)| (pi, pj, total[pi * m + pj]));
    costed.reduce(|best, next| if next.2 < best.2 { next } else { best })
}

/// |a − b|² in double precision.
pub fn squared_distance(a: &[f32], b: &[f32]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(x, y)| (f64::from(*x) - f64::from(*y)).powi(2))
        .sum()
}

#[cfg(all(test, feature = "train"))]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The cheapest total over every monotone path, by trying them all.
    fn cheapest(a: &Rows, b: &Rows, i: usize, j: usize) -> f64 {
        let here = squared_distance(a.row(i), b.row(j));
        if i == 0 && j == 0 {
            return here;
        }
        let mut best = f64::INFINITY;
        if i > 0 && j > 0 {
            best = best.min(cheapest(a, b, i - 1, j - 1));
        }
        if i > 0 {
            best = best.min(cheapest(a, b, i - 1, j));
        }
        if j > 0 {
            best = best.min(cheapest(a, b, i, j - 1));
        }
        here + best
    }

    fn rows() -> impl Strategy<Value = Rows> {
        (1usize..6)
            .prop_flat_map(|n| prop::collection::vec(-4.0f32..4.0, 2 * n))
            .prop_map(|v| Rows::from_values(2, v))
    }

    proptest! {
        #[test]
        fn the_path_is_monotone_complete_and_cheapest(a in rows(), b in rows()) {
            let path = align(&a, &b);
            prop_assert_eq!(path[0], (0, 0));
            prop_assert_eq!(path[path.len() - 1], (a.len() - 1, b.len() - 1));
            for pair in path.windows(2) {
                let (di, dj) = (pair[1].0 - pair[0].0, pair[1].1 - pair[0].1);
                prop_assert!(di <= 1 && dj <= 1 && di + dj >= 1);
            }
            let cost: f64 = path.iter().map(|&(i, j)| squared_distance(a.row(i), b.row(j))).sum();
            prop_assert!((cost - cheapest(&a, &b, a.len() - 1, b.len() - 1)).abs() < 1e-9);
        }

        /// What begins anywhere in a turn and goes on into the next costs nothing.
        #[test]
        fn a_turn_is_met_from_any_of_its_rows(turn in rows(), first in 0usize..6) {
            let n = turn.len();
            let mut turned = Rows::new(2);
            (0..n).for_each(|i| turned.push(turn.row((first + i) % n)));
            let mut warping = WarpingPath::default();
            let path = warping.align(&turn, &turned, true);
            let cost: f64 = path.iter().map(|&(i, j)| squared_distance(turn.row(i), turned.row(j))).sum();
            prop_assert_eq!(cost, 0.0);
            prop_assert_eq!((path[0].1, path[path.len() - 1].1), (0, n - 1));
        }
    }
}
