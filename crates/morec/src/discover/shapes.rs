//! Candidates as points for a first comparison, and the elastic distance of two candidates.

use multiversion::multiversion;
use rayon::prelude::*;

use super::candidates::MovingStretch;
use crate::cluster::resampled;
use crate::features::Rows;

/// Rows that a candidate of any length becomes.
const POINTS: usize = 16;
/// Points by which a path may leave the diagonal.
const BAND: usize = 3;
/// A coordinate of all points, with room for points beyond the ends: none of them is on a path.
const LINE: usize = 24;
/// Points that are compared with one at once: all within the band, and one more.
const NEAR: usize = 2 * BAND + 2;
/// Points of the other that are taken together.
const TOGETHER: usize = 4;
/// Coordinates of a code after which a sum is compared with its bound.
pub(super) const HEAD: usize = 32;
/// Sums of squares side by side.
const SUMS: usize = 8;

/// Coordinates of a code at most: they hold as much of the variance as 192 principal components do, without the eigenvectors of a matrix of hundreds of rows.
const CODE: usize = 288;

/// All candidates, resampled to as many points each.
pub(super) struct ShapeTable {
    /// Values in a point.
    dim: usize,
    /// The points of each candidate, coordinate by coordinate.
    lines: Vec<[f32; LINE]>,
    /// Mean squared distance of a candidate's points from their mean.
    spread: Vec<f32>,
    /// The same points in the coordinates that vary most: their squared distance is the mean over the points, or little less.
    codes: Vec<f32>,
    code_len: usize,
}

impl ShapeTable {
    /// Of stretches of `clips`, all of the same width. O(stretches · values of a row).
    pub(super) fn of(clips: &[Rows], stretches: &[MovingStretch]) -> Self {
        let dim = clips.first().map_or(0, Rows::dim);
        let shape = |s: &MovingStretch| {
            let points = resampled(&clips[s.clip].slice(s.start..s.stop), POINTS);
            let mut lines = vec![[0.0; LINE]; dim];
            for (at, point) in points.chunks_exact(dim.max(1)).enumerate() {
                for (line, value) in lines.iter_mut().zip(point) {
                    line[BAND + at] = *value;
                }
            }
            (lines, spread(&points, dim))
        };
        let shapes: Vec<(Vec<[f32; LINE]>, f32)> = stretches.par_iter().map(shape).collect();
        let spread = shapes.iter().map(|(_, spread)| *spread).collect();
        let lines: Vec<[f32; LINE]> = shapes.into_iter().flat_map(|(lines, _)| lines).collect();
        let code_len = (POINTS * dim).next_multiple_of(HEAD).min(CODE);
        Self {
            codes: codes(&lines, dim, code_len),
            dim,
            lines,
            spread,
            code_len,
        }
    }

    pub(super) fn dim(&self) -> usize {
        self.dim
    }

    fn lines(&self, of: usize) -> &[[f32; LINE]] {
        &self.lines[of * self.dim..(of + 1) * self.dim]
    }

    /// The points of a candidate.
    pub(super) fn points(&self, of: usize) -> impl Iterator<Item = Vec<f32>> {
        let lines = self.lines(of);
        (BAND..BAND + POINTS).map(|at| lines.iter().map(|line| line[at]).collect())
    }

    /// The first coordinates of a code, [`HEAD`] of them.
    pub(super) fn head(&self, of: usize) -> &[f32] {
        &self.code(of)[..HEAD]
    }

    fn code(&self, of: usize) -> &[f32] {
        &self.codes[of * self.code_len..(of + 1) * self.code_len]
    }

    /// By what distances of the two are divided: the mean of their spreads.
    pub(super) fn unit(&self, a: usize, b: usize) -> f32 {
        (0.5 * (self.spread[a] + self.spread[b])).max(f32::MIN_POSITIVE)
    }

    /// Mean squared distance of points of the same number over the mean spread; `None` if not below `bound`.
    pub(super) fn linear(&self, a: usize, b: usize, bound: f32) -> Option<f32> {
        let unit = self.unit(a, b);
        let found = squared_distance_below(self.code(a), self.code(b), bound * unit)?;
        Some(found / unit)
    }

    /// Mean squared distance along the best path over the mean spread, r: dynamic time warping with symmetric weights (Sakoe and
    /// Chiba 1978). `None` if not below `bound`. O(points · band · values).
    pub(super) fn elastic(&self, a: usize, b: usize, bound: f32) -> Option<f32> {
        let unit = self.unit(a, b);
        let weight = (2 * POINTS) as f32;
        let found = path_cost_below(self.lines(a), self.lines(b), bound * unit * weight);
        let r = found / (unit * weight);
        (r < bound).then_some(r)
    }

    /// Candidates of `members` by the sums of their linear distances to all of them, the most central first.
    pub(super) fn central_first(&self, members: &[usize]) -> Vec<usize> {
        let to_all = |&a: &usize| -> f32 {
            let each = members.iter();
            each.filter_map(|&b| squared_distance_below(self.code(a), self.code(b), f32::INFINITY))
                .sum()
        };
        let mut order: Vec<(f32, usize)> = members.iter().map(|m| (to_all(m), *m)).collect();
        order.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        order.into_iter().map(|(_, member)| member).collect()
    }
}

fn spread(points: &[f32], dim: usize) -> f32 {
    let mut mean = vec![0f64; dim];
    for point in points.chunks_exact(dim.max(1)) {
        mean.iter_mut()
            .zip(point)
            .for_each(|(m, v)| *m += f64::from(*v) / POINTS as f64);
    }
    let squares = points
        .chunks_exact(dim.max(1))
        .flat_map(|point| point.iter().zip(&mean));
    let sum: f64 = squares.map(|(v, m)| (f64::from(*v) - m).powi(2)).sum();
    (sum / POINTS as f64) as f32
}

/// Points through the cosine transform over their number, which keeps distances and gathers most of them in few coordinates; those that vary most
/// come first, so that a sum soon passes its bound, and those beyond [`CODE`] are left out.
fn codes(lines: &[[f32; LINE]], dim: usize, code_len: usize) -> Vec<f32> {
    let len = (POINTS * dim).max(1);
    let cosines = cosines();
    let transform = |line: &[f32; LINE]| {
        cosines.map(|of| {
            of.iter()
                .zip(&line[BAND..])
                .map(|(c, v)| c * v)
                .sum::<f32>()
        })
    };
    let transformed: Vec<f32> = lines.par_iter().flat_map_iter(transform).collect();
    let count = (transformed.len() / len).max(1) as f64;
    let (mut sum, mut squares) = (vec![0f64; len], vec![0f64; len]);
    for shape in transformed.chunks_exact(len) {
        for (k, v) in shape.iter().enumerate() {
            sum[k] += f64::from(*v);
            squares[k] += f64::from(*v).powi(2);
        }
    }
    let variance = |k: usize| squares[k] - sum[k].powi(2) / count;
    let mut order: Vec<usize> = (0..len).collect();
    order.sort_by(|&a, &b| variance(b).total_cmp(&variance(a)));
    order.truncate(code_len);
    let code = |shape: &[f32]| {
        let mut code: Vec<f32> = order.iter().map(|&k| shape[k]).collect();
        code.resize(code_len, 0.0);
        code
    };
    transformed.chunks_exact(len).flat_map(code).collect()
}

/// The orthonormal cosine transform (DCT-II) of [`POINTS`] values, over the root of their number.
fn cosines() -> [[f32; POINTS]; POINTS] {
    let mut lines = [[0.0; POINTS]; POINTS];
    for (k, line) in lines.iter_mut().enumerate() {
        let scale = if k == 0 {
            1.0f64
        } else {
            std::f64::consts::SQRT_2
        } / POINTS as f64;
        for (i, weight) in line.iter_mut().enumerate() {
            let angle = std::f64::consts::PI * (i as f64 + 0.5) * k as f64 / POINTS as f64;
            *weight = (scale * crate::math::portable::sin_cos(angle).1) as f32;
        }
    }
    lines
}

/// Squared distance of two codes, or `None` as soon as it is not below `bound`.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn squared_distance_below(a: &[f32], b: &[f32], bound: f32) -> Option<f32> {
    let mut sum = 0.0;
    for (a, b) in a.as_chunks::<HEAD>().0.iter().zip(b.as_chunks::<HEAD>().0) {
        let mut sums = [0f32; SUMS];
        for k in 0..HEAD / SUMS {
            for lane in 0..SUMS {
                let apart = a[k * SUMS + lane] - b[k * SUMS + lane];
                sums[lane] += apart * apart;
            }
        }
        let [a, b, c, d, e, f, g, h] = sums;
        sum += ((a + e) + (c + g)) + ((b + f) + (d + h));
        if sum >= bound {
            return None;
        }
    }
    Some(sum)
}

/// The cost of the best path from the first points of both to the last: a step along one of them costs the squared distance of the points
/// reached, one along both twice as much. Infinite as soon as it cannot be below `bound`.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn path_cost_below(a: &[[f32; LINE]], b: &[[f32; LINE]], bound: f32) -> f32 {
    // before[j + 1]: to point j of b; the first is where paths begin.
    let mut before = [f32::INFINITY; POINTS + 1];
    before[0] = 0.0;
    for first in (0..POINTS).step_by(TOGETHER) {
        let apart = match first {
            0 => near_distances::<0>(a, b),
            TOGETHER => near_distances::<TOGETHER>(a, b),
            8 => near_distances::<8>(a, b),
            _ => near_distances::<12>(a, b),
        };
        for (i, apart) in (first..).zip(&apart) {
            let mut costs = [f32::INFINITY; POINTS + 1];
            let mut least = f32::INFINITY;
            for j in i.saturating_sub(BAND)..(i + BAND + 1).min(POINTS) {
                let apart = apart[j + BAND - i];
                let along_one = before[j + 1].min(costs[j]) + apart;
                costs[j + 1] = along_one.min(before[j] + 2.0 * apart);
                least = least.min(costs[j + 1]);
            }
            if least >= bound {
                return f32::INFINITY;
            }
            before = costs;
        }
    }
    before[POINTS]
}

/// Squared distances of points of `a`, from `FIRST` on, to those of `b` from [`BAND`] points before each: lanes that do not depend on each other.
#[inline(always)]
fn near_distances<const FIRST: usize>(
    a: &[[f32; LINE]],
    b: &[[f32; LINE]],
) -> [[f32; NEAR]; TOGETHER] {
    let mut sums = [[0f32; NEAR]; TOGETHER];
    for (a, b) in a.iter().zip(b) {
        for at in 0..TOGETHER {
            let point = a[BAND + FIRST + at];
            for lane in 0..NEAR {
                let apart = point - b[FIRST + at + lane];
                sums[at][lane] += apart * apart;
            }
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// All paths, one by one, over cells within the band.
    fn plain(a: &[f32], b: &[f32], i: usize, j: usize) -> f64 {
        let cell = f64::from(a[i] - b[j]).powi(2);
        if (i, j) == (0, 0) {
            return 2.0 * cell;
        }
        let to = |i: Option<usize>, j: Option<usize>, weight: f64| match (i, j) {
            (Some(i), Some(j)) if i.abs_diff(j) <= BAND => plain(a, b, i, j) + weight * cell,
            _ => f64::INFINITY,
        };
        let (up, left) = (i.checked_sub(1), j.checked_sub(1));
        to(up, left, 2.0)
            .min(to(up, Some(j), 1.0))
            .min(to(Some(i), left, 1.0))
    }

    fn table(shapes: &[Vec<f32>]) -> ShapeTable {
        let clips: Vec<Rows> = shapes
            .iter()
            .map(|s| Rows::from_values(2, s.clone()))
            .collect();
        let stretch = |(clip, rows): (usize, &Rows)| MovingStretch {
            clip,
            start: 0,
            stop: rows.len(),
            moving_secs: 1.0,
        };
        let stretches: Vec<MovingStretch> = clips.iter().enumerate().map(stretch).collect();
        ShapeTable::of(&clips, &stretches)
    }

    proptest! {
        #[test]
        fn distances_are_those_of_the_points(
            shapes in prop::collection::vec(prop::collection::vec(-2f32..2.0, 2 * POINTS), 3),
        ) {
            let table = table(&shapes);
            let apart = |a: usize, b: usize| -> f32 {
                shapes[a].iter().zip(&shapes[b]).map(|(a, b)| (a - b).powi(2)).sum::<f32>() / POINTS as f32
            };
            for (a, b) in [(0, 1), (1, 2), (0, 0)] {
                let expected = apart(a, b) / table.unit(a, b);
                let found = table.linear(a, b, 1e9).unwrap();
                prop_assert!((found - expected).abs() < 1e-4 * (1.0 + expected), "{found} for {expected}");
                prop_assert_eq!(table.linear(a, b, found * 0.99), None);
                let elastic = table.elastic(a, b, 1e9).unwrap();
                prop_assert!(elastic <= found + 1e-4);
                prop_assert_eq!(table.elastic(a, b, elastic * 1.01 + 1e-6), Some(elastic));
                prop_assert_eq!(table.elastic(a, b, elastic), None);
            }
        }
    }

    #[test]
    fn a_path_is_the_best_of_all() {
        // Few points, as all paths are tried: what is behind them stays the same.
        let mut a = vec![0.0; POINTS];
        let mut b = vec![0.0; POINTS];
        a[..5].copy_from_slice(&[0.0, 1.0, 3.0, 2.0, 1.0]);
        b[..5].copy_from_slice(&[0.5, 0.5, 1.0, 3.0, 1.5]);
        let line = |v: &[f32]| {
            let mut line = [9.0; LINE];
            line[BAND..BAND + POINTS].copy_from_slice(v);
            [line]
        };
        let found = path_cost_below(&line(&a), &line(&b), f32::INFINITY);
        let expected = plain(&a[..7], &b[..7], 6, 6);
        assert!(
            (f64::from(found) - expected).abs() < 1e-5,
            "{found} for {expected}"
        );
    }
}
