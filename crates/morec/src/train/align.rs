//! Full dynamic time warping of two samples.

use crate::features::Rows;

/// Pairs of row indices along the cheapest path that aligns all of `a` with all of `b` (steps (1,1), (1,0),
/// (0,1), squared Euclidean cost; Sakoe and Chiba 1978 without slope constraint). Both must have rows.
///
/// O(len(a) · len(b)) time and space.
pub fn align(a: &Rows, b: &Rows) -> Vec<(usize, usize)> {
    let (n, m) = (a.len(), b.len());
    if n == 0 || m == 0 {
        return Vec::new();
    }
    let mut total = vec![f64::INFINITY; n * m];
    for i in 0..n {
        for j in 0..m {
            let cost = squared_distance(a.row(i), b.row(j));
            let before = predecessor(&total, m, i, j).map_or(0.0, |(_, _, best)| best);
            total[i * m + j] = before + cost;
        }
    }
    let mut path = vec![(n - 1, m - 1)];
    let (mut i, mut j) = (n - 1, m - 1);
    while let Some((pi, pj, _)) = predecessor(&total, m, i, j) {
        (i, j) = (pi, pj);
        path.push((i, j));
    }
    path.reverse();
    path
}

/// The cheapest cell before `(i, j)`; the diagonal wins ties. `None` at the first cell.
fn predecessor(total: &[f64], m: usize, i: usize, j: usize) -> Option<(usize, usize, f64)> {
    let options = [
        (i > 0 && j > 0).then(|| (i - 1, j - 1)),
        (i > 0).then(|| (i - 1, j)),
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

#[cfg(test)]
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
    }
}
