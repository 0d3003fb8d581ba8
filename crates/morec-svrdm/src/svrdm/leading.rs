//! The leading eigenvectors of several symmetric matrices at once, a matrix in each lane.
//!
//! All segments that end with a chunk are described together: what is one after the other in a matrix is then side by side in many.

use multiversion::multiversion;

/// Matrices that are solved together.
pub const AT_ONCE: usize = 24;

/// A number of each matrix.
type Lane = [f64; AT_ONCE];

const ZERO: Lane = [0.0; AT_ONCE];

/// Rounds of the iteration before an eigenvalue is given up; two or three are the rule.
const MAX_ROUNDS: usize = 30;

/// Eigenvectors of eigenvalues nearer to each other than this share of the trace are not distinguished here.
const LEAST_GAP: f64 = 1e-4;

/// Finds the eigenvectors of the largest eigenvalues of positive semidefinite matrices.
///
/// Householder's reduction to tridiagonal form; all eigenvalues by the rational QL iteration (Reinsch, *Algorithm 464: Eigenvalues of a real,
/// symmetric, tridiagonal matrix*, 1973); an eigenvector of a tridiagonal matrix from both of its ends (Dhillon and Parlett, *Multiple
/// representations to compute orthogonal eigenvectors*, 2004, §2). O(n³) with a small factor, as nothing of the other eigenvectors is
/// made; no allocation after `new`.
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
    /// The largest eigenvalues, falling: `count` and the one after them, if there is one.
    values: Vec<Lane>,
    /// Sum of the square roots of all.
    roots: Lane,
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
            values,
            roots: ZERO,
            vectors: vec![ZERO; count * dim],
            rows: [row.clone(), row],
            found: [false; AT_ONCE],
        }
    }

    /// Bytes of its memory.
    pub fn bytes(&self) -> usize {
        let [a, b] = &self.rows;
        let tables = [
            &self.matrix,
            &self.diagonal,
            &self.below,
            &self.below_squared,
            &self.reflected,
            &self.values,
            &self.vectors,
            a,
            b,
        ];
        size_of::<Lane>() * tables.into_iter().map(Vec::len).sum::<usize>()
    }

    /// Sets matrix `lane` by its entries `(i, j)` with `j ≤ i`.
    pub fn set(&mut self, lane: usize, entry: impl Fn(usize, usize) -> f64) {
        for i in 0..self.dim {
            for j in 0..=i {
                self.matrix[i * self.dim + j][lane] = entry(i, j);
            }
        }
    }

    /// Finds the vectors of the first `count` matrices, which were [set](Self::set) and are no more after it.
    pub fn solve(&mut self, count: usize) {
        // Lanes without a matrix repeat the first: what is left of an earlier one may take more rounds than any.
        for entry in &mut self.matrix {
            let first = entry[0];
            entry[count.min(AT_ONCE)..].fill(first);
        }
        solve(self);
    }

    /// The square root of eigenvalue `j` of matrix `lane` over the sum of all of them.
    pub fn share(&self, lane: usize, j: usize) -> f64 {
        self.values[j][lane].max(0.0).sqrt() / self.roots[lane]
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
    eigenvalues(s, trace);
    for j in 0..s.count {
        eigenvector(s, j, trace);
    }
    let gap = |j: usize, l: usize| match s.values.get(j + 1) {
        Some(next) => s.values[j][l] - next[l],
        None => f64::INFINITY,
    };
    s.found = std::array::from_fn(|l| {
        let apart = (0..s.count).all(|j| gap(j, l) > LEAST_GAP * trace[l]);
        apart && s.roots[l].is_finite() && s.roots[l] > 0.0
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

/// All eigenvalues of the tridiagonal matrices; keeps the largest and the sum of the roots. A lane whose iteration has not come to an end in
/// [`MAX_ROUNDS`] gets what is no number.
#[inline(always)]
fn eigenvalues(s: &mut LeadingEigenvectors, trace: Lane) {
    let n = s.dim;
    let [d, e] = &mut s.rows;
    d.copy_from_slice(&s.diagonal);
    e.copy_from_slice(&s.below_squared);
    let least = lanes(|l| f64::EPSILON * trace[l]);
    s.values.fill(lanes(|_| f64::NEG_INFINITY));
    s.roots = ZERO;
    let mut shifted = ZERO;
    for at in 0..n {
        let mut rounds = 0;
        loop {
            let open = lanes(|l| (e[at][l].abs() > least[l] * least[l]).into());
            if at + 1 == n || open == ZERO {
                break;
            }
            rounds += 1;
            if rounds > MAX_ROUNDS {
                s.roots = lanes(|l| if open[l] > 0.0 { f64::NAN } else { s.roots[l] });
                break;
            }
            shift(d, &e[at], at, &open, &mut shifted);
            sweep(&mut d[at..], &mut e[at..], &open, &least);
        }
        let mut value = lanes(|l| d[at][l] + shifted[l]);
        for l in 0..AT_ONCE {
            s.roots[l] += value[l].max(0.0).sqrt();
        }
        for place in &mut s.values {
            for l in 0..AT_ONCE {
                let (larger, smaller) = (place[l].max(value[l]), place[l].min(value[l]));
                (place[l], value[l]) = (larger, smaller);
            }
        }
    }
}

/// Takes from the diagonal `d`, from `at` on, what makes the next eigenvalue there nearly 0; in `open` lanes.
#[inline(always)]
fn shift(d: &mut [Lane], e: &Lane, at: usize, open: &Lane, shifted: &mut Lane) {
    let mut by = ZERO;
    for l in 0..AT_ONCE {
        let s = e[l].abs().sqrt();
        let p = (d[at + 1][l] - d[at][l]) / (2.0 * s);
        let root = s / (p + (p * p + 1.0).sqrt().copysign(p));
        by[l] = if open[l] > 0.0 { d[at][l] - root } else { 0.0 };
        shifted[l] += by[l];
    }
    for d in &mut d[at..] {
        for l in 0..AT_ONCE {
            d[l] -= by[l];
        }
    }
}

/// A rational QL transformation from the last of the diagonal `d` to the first, `e` being the squares beside it; in `open` lanes.
#[inline(always)]
fn sweep(d: &mut [Lane], e: &mut [Lane], open: &Lane, least: &Lane) {
    let last = d.len() - 1;
    let mut g = lanes(|l| at_least(d[last][l], least[l] * f64::EPSILON));
    let (mut h, mut s) = (g, ZERO);
    for i in (0..last).rev() {
        for l in 0..AT_ONCE {
            let is_open = open[l] > 0.0;
            let p = g[l] * h[l];
            let r = (p + e[i][l]).max(f64::MIN_POSITIVE);
            e[i + 1][l] = if is_open { s[l] * r } else { e[i + 1][l] };
            s[l] = e[i][l] / r;
            let next = h[l] + s[l] * (h[l] + d[i][l]);
            d[i + 1][l] = if is_open { next } else { d[i + 1][l] };
            g[l] = at_least(d[i][l] - e[i][l] / g[l], least[l] * f64::EPSILON);
            h[l] = g[l] * p / r;
        }
    }
    for l in 0..AT_ONCE {
        let is_open = open[l] > 0.0;
        e[0][l] = if is_open { h[l] * s[l] * g[l] } else { e[0][l] };
        d[0][l] = if is_open { h[l] } else { d[0][l] };
    }
}

/// Vector `j` of the matrices themselves.
#[inline(always)]
fn eigenvector(s: &mut LeadingEigenvectors, j: usize, trace: Lane) {
    let n = s.dim;
    // Once more at the Rayleigh quotient, for the last digits.
    let value = tridiagonal_vector(s, j, s.values[j], trace);
    tridiagonal_vector(s, j, value, trace);
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
            leading.solve(matrices.len());
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
                let roots: f64 = all.eigenvalues.iter().map(|v| v.max(0.0).sqrt()).sum();
                // An eigenvalue is good to a few ε of the trace, so the root of one that is 0 to a few √ε; all of them are in the sum.
                let tolerance = 4.0 * (dim as f64) * f64::EPSILON.sqrt();
                for j in 0..count {
                    let expected = value(j).max(0.0).sqrt() / roots;
                    prop_assert!((leading.share(lane, j) - expected).abs() < tolerance);
                    let along: f64 = (0..dim).map(|i| vector(j, i) * all.eigenvectors[(i, order[j])]).sum();
                    prop_assert!(along.abs() > 1.0 - 1e-12, "{along}");
                }
            }
        }
    }

    proptest! {
        #[test]
        fn a_matrix_has_the_same_vectors_alone_and_among_others((dim, count, matrices) in matrices()) {
            let mut together = LeadingEigenvectors::new(count, dim);
            let mut alone = together.clone();
            for (lane, m) in matrices.iter().enumerate() {
                together.set(lane, |i, j| m[(i, j)]);
            }
            together.solve(matrices.len());
            for (lane, m) in matrices.iter().enumerate() {
                alone.set(0, |i, j| m[(i, j)]);
                alone.solve(1);
                let (Some(a), Some(b)) = (together.vectors(lane), alone.vectors(0)) else {
                    prop_assert!(together.vectors(lane).is_none() && alone.vectors(0).is_none());
                    continue;
                };
                for j in 0..count {
                    prop_assert_eq!(together.share(lane, j).to_bits(), alone.share(0, j).to_bits());
                    prop_assert!((0..dim).all(|i| a(j, i).to_bits() == b(j, i).to_bits()));
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
        leading.solve(4);
        let found = [0, 1, 2, 3].map(|lane| leading.vectors(lane).is_some());
        assert_eq!(found, [false, false, false, true]);
    }
}
