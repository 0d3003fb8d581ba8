//! The leading eigenvectors of several symmetric matrices at once, a matrix in each lane.
//!
//! All segments that end with a chunk are described together: what is one after the other in a matrix is then side by side in eight.

use multiversion::multiversion;

/// Matrices that are solved together.
pub const AT_ONCE: usize = 8;

/// A number of each matrix.
type Lane = [f64; AT_ONCE];

const ZERO: Lane = [0.0; AT_ONCE];

/// Halvings of the range in which an eigenvalue lies. [`REFINED`] Rayleigh quotients make of its 2⁻²⁰ what double precision has.
const HALVED: usize = 20;
const REFINED: usize = 3;

/// Eigenvalues nearer to each other than this share of the trace are not told apart here.
const LEAST_GAP: f64 = 1e-4;

/// Finds the eigenvectors of the largest eigenvalues of positive semidefinite matrices.
///
/// Householder's reduction to tridiagonal form; bisection by Sturm's sequence for the eigenvalues; an eigenvector of a tridiagonal matrix
/// from both of its ends (Dhillon and Parlett, *Multiple representations to compute orthogonal eigenvectors*, 2004, §2). O(n³) with a
/// small factor, as nothing of the other eigenvectors is made; no allocation after `new`.
#[derive(Debug, Clone)]
pub struct LeadingEigenvectors {
    dim: usize,
    count: usize,
    /// The lower triangles, row by row, each row of `dim` places. Afterwards the reflections, column by column.
    matrix: Vec<Lane>,
    diagonal: Vec<Lane>,
    /// Below the diagonal, and squared.
    below: Vec<Lane>,
    below_squared: Vec<Lane>,
    /// `2 / |v|²` of each reflection.
    reflected: Vec<Lane>,
    /// Ranges of the eigenvalues, the largest first: `count` and one more, if there are so many.
    low: Vec<Lane>,
    high: Vec<Lane>,
    /// `count` vectors of `dim` values.
    vectors: Vec<Lane>,
    /// Room for rows.
    rows: [Vec<Lane>; 2],
    /// Matrices whose vectors are found.
    found: [bool; AT_ONCE],
}

impl LeadingEigenvectors {
    /// Room for `count` vectors of `dim` values.
    pub fn new(count: usize, dim: usize) -> Self {
        let row = vec![ZERO; dim];
        let values = vec![ZERO; (count + 1).min(dim)];
        Self {
            dim,
            count,
            matrix: vec![ZERO; dim * dim],
            diagonal: row.clone(),
            below: row.clone(),
            below_squared: row.clone(),
            reflected: row.clone(),
            low: values.clone(),
            high: values,
            vectors: vec![ZERO; count * dim],
            rows: [row.clone(), row],
            found: [false; AT_ONCE],
        }
    }

    /// Sets matrix `lane` by its entries `(i, j)` with `j ≤ i`.
    pub fn set(&mut self, lane: usize, entry: impl Fn(usize, usize) -> f64) {
        for i in 0..self.dim {
            for j in 0..=i {
                self.matrix[i * self.dim + j][lane] = entry(i, j);
            }
        }
    }

    /// Finds the vectors of all matrices that were [set](Self::set), which are no more after it.
    pub fn solve(&mut self) {
        solve(self);
    }

    /// Component `i` of vector `j` of matrix `lane`, of length 1 and either sign. `None` if it was not found: an eigenvalue is too near to
    /// the next, the matrix is 0, or holds what is no number.
    pub fn vectors(&self, lane: usize) -> Option<impl Fn(usize, usize) -> f64> {
        self.found[lane].then_some(move |j: usize, i: usize| self.vectors[j * self.dim + i][lane])
    }
}

#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn solve(s: &mut LeadingEigenvectors) {
    let trace = lanes(|l| (0..s.dim).map(|i| s.matrix[i * s.dim + i][l]).sum());
    tridiagonalise(s);
    bisect(s, trace);
    for j in 0..s.count {
        eigenvector(s, j, trace);
    }
    let gap = |j: usize, l: usize| match s.low.get(j + 1) {
        Some(next) => s.low[j][l] - next[l],
        None => f64::INFINITY,
    };
    s.found = std::array::from_fn(|l| {
        let apart = (0..s.count).all(|j| gap(j, l) > LEAST_GAP * trace[l]);
        apart && trace[l].is_finite() && trace[l] > 0.0
    });
}

#[inline(always)]
fn lanes(of: impl Fn(usize) -> f64) -> Lane {
    let mut out = ZERO;
    for (lane, value) in out.iter_mut().enumerate() {
        *value = of(lane);
    }
    out
}

/// `a + b c`, place by place.
#[inline(always)]
fn add_product(a: &mut Lane, b: &Lane, c: &Lane) {
    for l in 0..AT_ONCE {
        a[l] += b[l] * c[l];
    }
}

/// `Q M Qᵀ` with diagonal and subdiagonal only, by reflections `I − β v vᵀ` that stay in the columns of the matrix below the subdiagonal
/// and on it.
#[inline(always)]
fn tridiagonalise(s: &mut LeadingEigenvectors) {
    let n = s.dim;
    for j in 0..n.saturating_sub(2) {
        let mut square = ZERO;
        for i in j + 1..n {
            let x = s.matrix[i * n + j];
            add_product(&mut square, &x, &x);
        }
        let first = s.matrix[(j + 1) * n + j];
        let length = lanes(|l| square[l].sqrt());
        s.below[j] = lanes(|l| -length[l].copysign(first[l]));
        s.reflected[j] = lanes(|l| match square[l] > 0.0 {
            true => 1.0 / (square[l] + length[l] * first[l].abs()),
            false => 0.0,
        });
        s.matrix[(j + 1) * n + j] = lanes(|l| first[l] - s.below[j][l]);
        // p = β M v, by the lower triangle alone.
        let [v, p] = &mut s.rows;
        for i in j + 1..n {
            v[i] = s.matrix[i * n + j];
            p[i] = ZERO;
        }
        for i in j + 1..n {
            let row = &s.matrix[i * n..][..n];
            let mut sum = ZERO;
            for k in j + 1..i {
                add_product(&mut sum, &row[k], &v[k]);
                add_product(&mut p[k], &row[k], &v[i]);
            }
            add_product(&mut sum, &row[i], &v[i]);
            for l in 0..AT_ONCE {
                p[i][l] += sum[l];
            }
        }
        // M − v wᵀ − w vᵀ with w = p − (β/2) (p·v) v.
        let beta = s.reflected[j];
        let mut along = ZERO;
        for i in j + 1..n {
            p[i] = lanes(|l| beta[l] * p[i][l]);
            add_product(&mut along, &p[i], &v[i]);
        }
        let half = lanes(|l| -0.5 * beta[l] * along[l]);
        for i in j + 1..n {
            add_product(&mut p[i], &half, &v[i]);
            let row = &mut s.matrix[i * n..][..n];
            for k in j + 1..=i {
                for l in 0..AT_ONCE {
                    row[k][l] -= v[i][l] * p[k][l] + p[i][l] * v[k][l];
                }
            }
        }
    }
    if n > 1 {
        s.below[n - 2] = s.matrix[(n - 1) * n + n - 2];
    }
    for i in 0..n {
        s.diagonal[i] = s.matrix[i * n + i];
        s.below_squared[i] = lanes(|l| s.below[i][l] * s.below[i][l]);
    }
}

/// `value`, or `least` where it is nearer to 0.
#[inline(always)]
fn at_least(value: f64, least: f64) -> f64 {
    if value.abs() < least { least } else { value }
}

/// Halves the ranges of the eigenvalues, from 0 to the trace.
#[inline(always)]
fn bisect(s: &mut LeadingEigenvectors, trace: Lane) {
    let least = lanes(|l| 1e-30 * trace[l]);
    let margin = 1.0 + 1e-9;
    s.low.fill(lanes(|l| (1.0 - margin) * trace[l]));
    s.high.fill(lanes(|l| margin * trace[l]));
    for _ in 0..HALVED {
        for j in 0..s.low.len() {
            let middle = lanes(|l| 0.5 * (s.low[j][l] + s.high[j][l]));
            // Eigenvalues above it: positive pivots of the matrix less `middle`.
            let (mut above, mut pivot) = (ZERO, lanes(|_| 1.0));
            for i in 0..s.dim {
                let squared = if i == 0 { ZERO } else { s.below_squared[i - 1] };
                for l in 0..AT_ONCE {
                    let next = s.diagonal[i][l] - middle[l] - squared[l] / pivot[l];
                    pivot[l] = at_least(next, least[l]);
                    above[l] += if pivot[l] > 0.0 { 1.0 } else { 0.0 };
                }
            }
            for l in 0..AT_ONCE {
                let is_below = above[l] > j as f64;
                s.low[j][l] = if is_below { middle[l] } else { s.low[j][l] };
                s.high[j][l] = if is_below { s.high[j][l] } else { middle[l] };
            }
        }
    }
}

/// Vector `j` of the matrices themselves, from the eigenvalue's range.
#[inline(always)]
fn eigenvector(s: &mut LeadingEigenvectors, j: usize, trace: Lane) {
    let n = s.dim;
    let mut value = lanes(|l| 0.5 * (s.low[j][l] + s.high[j][l]));
    for _ in 0..=REFINED {
        value = tridiagonal_vector(s, j, value, trace);
    }
    let v = &mut s.vectors[j * n..][..n];
    // Reflections back, the last first.
    for j in (0..n.saturating_sub(2)).rev() {
        let mut along = ZERO;
        for i in j + 1..n {
            add_product(&mut along, &s.matrix[i * n + j], &v[i]);
        }
        let along = lanes(|l| -s.reflected[j][l] * along[l]);
        for i in j + 1..n {
            add_product(&mut v[i], &along, &s.matrix[i * n + j]);
        }
    }
    let mut square = ZERO;
    v.iter().for_each(|x| add_product(&mut square, x, x));
    let inverse = lanes(|l| 1.0 / square[l].sqrt());
    for x in v {
        *x = lanes(|l| x[l] * inverse[l]);
    }
}

/// Sets vector `j` to an eigenvector of the tridiagonal matrices near `value`, and gives its Rayleigh quotient. The pivots of `T − value`
/// from the top and from the bottom meet where the vector is large.
#[inline(always)]
fn tridiagonal_vector(s: &mut LeadingEigenvectors, j: usize, value: Lane, trace: Lane) -> Lane {
    let n = s.dim;
    let least = lanes(|l| 1e-30 * trace[l]);
    let [down, up] = &mut s.rows;
    let off = |i: usize| s.below_squared[i];
    for i in 0..n {
        let before = if i == 0 { ZERO } else { off(i - 1) };
        let pivot = if i == 0 { lanes(|_| 1.0) } else { down[i - 1] };
        down[i] = lanes(|l| at_least(s.diagonal[i][l] - value[l] - before[l] / pivot[l], least[l]));
    }
    for i in (0..n).rev() {
        let after = if i + 1 == n { ZERO } else { off(i) };
        let pivot = if i + 1 == n {
            lanes(|_| 1.0)
        } else {
            up[i + 1]
        };
        up[i] = lanes(|l| at_least(s.diagonal[i][l] - value[l] - after[l] / pivot[l], least[l]));
    }
    let (mut meet, mut smallest, mut rest) = (ZERO, lanes(|_| f64::INFINITY), ZERO);
    for i in 0..n {
        for l in 0..AT_ONCE {
            let gamma = down[i][l] + up[i][l] - (s.diagonal[i][l] - value[l]);
            let smaller = gamma.abs() < smallest[l];
            meet[l] = if smaller { i as f64 } else { meet[l] };
            rest[l] = if smaller { gamma } else { rest[l] };
            smallest[l] = if smaller { gamma.abs() } else { smallest[l] };
        }
    }
    let v = &mut s.vectors[j * n..][..n];
    let (mut square, mut last) = (ZERO, ZERO);
    for i in (0..n).rev() {
        last = lanes(|l| match meet[l] == i as f64 {
            true => 1.0,
            false => -s.below[i][l] / down[i][l] * last[l],
        });
        // Behind the meeting place it is 0 so far.
        v[i] = last;
        add_product(&mut square, &last, &last);
    }
    for i in 1..n {
        for l in 0..AT_ONCE {
            let is_behind = (i as f64) > meet[l];
            let next = -s.below[i - 1][l] / up[i][l] * v[i - 1][l];
            v[i][l] = if is_behind { next } else { v[i][l] };
            square[l] += if is_behind { next * next } else { 0.0 };
        }
    }
    lanes(|l| value[l] + rest[l] / square[l])
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, SymmetricEigen};
    use proptest::prelude::*;

    /// Products of rows, some of few and some of many directions.
    fn matrix(dim: usize) -> impl Strategy<Value = DMatrix<f64>> {
        let rows = prop::collection::vec(prop::collection::vec(-1.0f64..1.0, dim), 1..dim + 20);
        (rows, 0.2f64..1.5, prop::bool::ANY).prop_map(move |(rows, fall, diagonal)| {
            let a = DMatrix::from_fn(rows.len(), dim, |i, j| rows[i][j] * fall.powi(j as i32));
            let m = a.transpose() * a;
            // Matrices that are diagonal already have no reflections.
            if diagonal {
                DMatrix::from_diagonal(&m.diagonal())
            } else {
                m
            }
        })
    }

    fn matrices() -> impl Strategy<Value = (usize, usize, Vec<DMatrix<f64>>)> {
        (1usize..20).prop_flat_map(|dim| {
            let some = prop::collection::vec(matrix(dim), 1..=AT_ONCE);
            (Just(dim), 1..=dim.min(3), some)
        })
    }

    proptest! {
        #[test]
        fn vectors_are_those_of_all_eigenpairs((dim, count, matrices) in matrices()) {
            let mut leading = LeadingEigenvectors::new(count, dim);
            for (lane, m) in matrices.iter().enumerate() {
                leading.set(lane, |i, j| m[(i, j)]);
            }
            leading.solve();
            for (lane, m) in matrices.iter().enumerate() {
                let all = SymmetricEigen::new(m.clone());
                let mut order: Vec<usize> = (0..dim).collect();
                order.sort_by(|a, b| all.eigenvalues[*b].total_cmp(&all.eigenvalues[*a]));
                let value = |j: usize| order.get(j).map_or(f64::NEG_INFINITY, |at| all.eigenvalues[*at]);
                let apart = (0..count).all(|j| value(j) - value(j + 1) > 2.0 * LEAST_GAP * m.trace());
                let Some(vector) = leading.vectors(lane) else {
                    prop_assert!(!apart);
                    continue;
                };
                for j in 0..count {
                    let along: f64 = (0..dim).map(|i| vector(j, i) * all.eigenvectors[(i, order[j])]).sum();
                    prop_assert!(along.abs() > 1.0 - 1e-12, "{along}");
                }
            }
        }
    }

    #[test]
    fn what_has_no_direction_is_not_found() {
        let mut leading = LeadingEigenvectors::new(2, 3);
        leading.set(0, |_, _| 0.0);
        leading.set(1, |i, j| if i == j { 1.0 } else { 0.0 });
        leading.set(2, |_, _| f64::NAN);
        leading.set(3, |i, j| if i == j { 3.0 - i as f64 } else { 0.0 });
        leading.solve();
        let found = [0, 1, 2, 3].map(|lane| leading.vectors(lane).is_some());
        assert_eq!(found, [false, false, false, true]);
    }
}
