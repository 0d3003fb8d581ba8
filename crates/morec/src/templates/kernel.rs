//! The inner loops of matching, compiled once for each set of vector instructions and chosen when the program runs.
//!
//! Each is an ordinary loop over lanes that do not depend on each other, so every choice does the same additions in
//! the same order and gives the same bits; multiplications and additions are never fused. Without the choosing they
//! would run on what every processor of the kind has (on x86-64: SSE2, four numbers at a time).

use multiversion::multiversion;

/// Cells or exemplars that are worked on at once, kept in registers while the coordinates go by: four of AVX-512, eight
/// of AVX2, sixteen of SSE2 and NEON. Memory is then read once and in order, which is what bounds the time.
pub const LANES: usize = 64;

/// The same value of [`LANES`] cells.
pub type Lanes = [f32; LANES];

/// Rows laid out so that equal coordinates of [`LANES`] of them lie together: block by block, in a block coordinate by
/// coordinate. What is left of the last block is zero.
pub fn interleaved<'r>(len: usize, dim: usize, rows: impl Iterator<Item = (usize, &'r [f32])>) -> Vec<Lanes> {
    let mut blocks = vec![[0.0; LANES]; len.div_ceil(LANES) * dim];
    for (place, row) in rows {
        for (k, value) in row.iter().enumerate() {
            blocks[place / LANES * dim + k][place % LANES] = *value;
        }
    }
    blocks
}

/// `max(0, |T|² + |z|² − 2 T·z)` for every cell's row `T`: its squared distance from `z`, without cancellation's hair
/// below zero. `rows` as [`interleaved`], `norms` with the `|T|²`; a block of `out` for each of `norms`.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
pub fn local_costs(rows: &[Lanes], norms: &[Lanes], z: &[f32], out: &mut [Lanes]) {
    let z_norm: f32 = z.iter().map(|v| v * v).sum();
    for ((block, norm), out) in rows.chunks_exact(z.len()).zip(norms).zip(out) {
        let mut cost = *norm;
        for lane in 0..LANES {
            cost[lane] += z_norm;
        }
        for (t, value) in block.iter().zip(z) {
            let twice = -2.0 * value;
            for lane in 0..LANES {
                cost[lane] += twice * t[lane];
            }
        }
        for lane in 0..LANES {
            cost[lane] = cost[lane].max(0.0);
        }
        *out = cost;
    }
}

/// `|T − z|²` for every row `T` of `rows`, as [`interleaved`]: the sum of the squares in order of the coordinates.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
pub fn squared_distances(rows: &[Lanes], z: &[f32], out: &mut [Lanes]) {
    for (block, out) in rows.chunks_exact(z.len()).zip(out) {
        let mut sum = [0.0; LANES];
        for (t, value) in block.iter().zip(z) {
            for lane in 0..LANES {
                let apart = t[lane] - value;
                sum[lane] += apart * apart;
            }
        }
        *out = sum;
    }
}

/// `out = Σ row[k] · lines[k]`, the lines one after the other and as long as `out`.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
pub fn combination(lines: &[f32], row: &[f32], out: &mut [f32]) {
    out.fill(0.0);
    for (line, value) in lines.chunks_exact(out.len()).zip(row) {
        for (o, a) in out.iter_mut().zip(line) {
            *o += a * value;
        }
    }
}

/// Paths that end in each cell at one tick.
#[derive(Debug, Clone, Default)]
pub struct Paths {
    /// `D(j,t)`.
    pub total: Vec<f32>,
    /// Ticks since the path began: an age needs no clock and so never overflows.
    pub age: Vec<i32>,
}

/// The three transitions of [`Bank`](super::Bank) for every cell from the third on, of all there are in `now`. `local`
/// and `local_before` are the costs at this tick and at the one before.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
pub fn advance(local: &[f32], local_before: &[f32], now: &mut Paths, before: &Paths, earlier: &Paths) {
    let n = now.total.len();
    let (local, local_1) = (&local[2..n], &local[1..n - 1]);
    let local_before = &local_before[2..n];
    let (diagonal, diagonal_age) = (&before.total[1..n - 1], &before.age[1..n - 1]);
    let (slow, slow_age) = (&earlier.total[1..n - 1], &earlier.age[1..n - 1]);
    let (fast, fast_age) = (&before.total[..n - 2], &before.age[..n - 2]);
    let (total, age) = (&mut now.total[2..n], &mut now.age[2..n]);
    for j in 0..total.len() {
        let mut best = diagonal[j] + local[j];
        let mut best_age = diagonal_age[j] + 1;
        let two_stream = slow[j] + 0.5 * (local_before[j] + local[j]);
        let better = two_stream < best;
        best = if better { two_stream } else { best };
        best_age = if better { slow_age[j] + 2 } else { best_age };
        let two_template = fast[j] + local_1[j] + local[j];
        let better = two_template < best;
        total[j] = if better { two_template } else { best };
        age[j] = if better { fast_age[j] + 1 } else { best_age };
    }
}

/// The place of the smallest `total[i] / (rows + i)`, the first of equals, and that quotient; `None` of nothing.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
pub fn least_mean(total: &[f32], rows: usize) -> Option<(usize, f32)> {
    const WIDE: usize = 16;
    let mut least = [f32::INFINITY; WIDE];
    let mut place = [0i32; WIDE];
    let (chunks, rest) = total.as_chunks::<WIDE>();
    for (n, chunk) in chunks.iter().enumerate() {
        let from = n * WIDE;
        for lane in 0..WIDE {
            let mean = chunk[lane] / (rows + from + lane) as i32 as f32;
            let less = mean < least[lane];
            least[lane] = if less { mean } else { least[lane] };
            place[lane] = if less { (from + lane) as i32 } else { place[lane] };
        }
    }
    let from = chunks.len() * WIDE;
    for (lane, total) in rest.iter().enumerate() {
        let mean = total / (rows + from + lane) as i32 as f32;
        if mean < least[lane] {
            (least[lane], place[lane]) = (mean, (from + lane) as i32);
        }
    }
    let lanes = place.iter().zip(&least).map(|(place, mean)| (*place as usize, *mean));
    lanes.filter(|(_, mean)| mean.is_finite()).reduce(|a, b| if (b.1, b.0) < (a.1, a.0) { b } else { a })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Values whose sums round, so that another order of additions or a fused one would show.
    fn values(count: impl Into<prop::collection::SizeRange>) -> impl Strategy<Value = Vec<f32>> {
        prop::collection::vec((-4.0f32..4.0).prop_map(|v| v * 1.1), count)
    }

    fn table() -> impl Strategy<Value = (usize, Vec<f32>, Vec<f32>)> {
        (1usize..9, 0usize..150).prop_flat_map(|(dim, rows)| (Just(dim), values(dim * rows), values(dim)))
    }

    fn bits<'a>(values: impl IntoIterator<Item = &'a f32>) -> Vec<u32> {
        values.into_iter().map(|v| v.to_bits()).collect()
    }

    proptest! {
        #[test]
        fn distances_are_those_of_one_row_after_the_other((dim, rows, z) in table()) {
            let rows: Vec<&[f32]> = rows.chunks_exact(dim).collect();
            let blocks = interleaved(rows.len(), dim, rows.iter().copied().enumerate());
            let mut norms = vec![[0.0; LANES]; rows.len().div_ceil(LANES)];
            let norm = |row: &[f32]| row.iter().map(|v| v * v).sum::<f32>();
            rows.iter().enumerate().for_each(|(i, row)| norms.as_flattened_mut()[i] = norm(row));
            let mut out = vec![[f32::NAN; LANES]; norms.len()];
            local_costs(&blocks, &norms, &z, &mut out);
            let cost = |row: &&[f32]| {
                let from = norm(row) + norm(&z);
                row.iter().zip(&z).fold(from, |sum, (t, v)| sum + -2.0 * v * t).max(0.0)
            };
            let plain: Vec<f32> = rows.iter().map(cost).collect();
            prop_assert_eq!(bits(&out.as_flattened()[..rows.len()]), bits(&plain));

            squared_distances(&blocks, &z, &mut out);
            let square = |row: &&[f32]| row.iter().zip(&z).fold(0.0, |sum, (t, v)| sum + (t - v) * (t - v));
            let plain: Vec<f32> = rows.iter().map(square).collect();
            prop_assert_eq!(bits(&out.as_flattened()[..rows.len()]), bits(&plain));
        }

        #[test]
        fn a_combination_adds_line_after_line((dim, lines, _) in table(), row in values(150)) {
            let mut out = vec![f32::NAN; dim];
            combination(&lines, &row, &mut out);
            let sum = |k: usize| lines.chunks_exact(dim).zip(&row).fold(0.0, |s, (line, v)| s + line[k] * v);
            prop_assert_eq!(bits(&out), bits(&(0..dim).map(sum).collect::<Vec<f32>>()));
        }

        #[test]
        fn transitions_are_taken_as_written(
            (local, local_before) in (3usize..90).prop_flat_map(|n| (values(n), values(n))),
            seeds in prop::collection::vec(0i32..5, 3 * 90),
        ) {
            // Few different totals: equal ones come up, and who wins them is part of the result.
            let n = local.len();
            let paths = |from: &[i32]| Paths {
                total: from[..n].iter().map(|v| *v as f32).collect(),
                age: from[..n].iter().map(|v| 7 * v).collect(),
            };
            let (before, earlier) = (paths(&seeds[..90]), paths(&seeds[90..180]));
            let mut now = paths(&seeds[180..]);
            let first = now.clone();
            advance(&local, &local_before, &mut now, &before, &earlier);
            prop_assert_eq!(&now.total[..2], &first.total[..2]);
            for j in 2..n {
                let ways = [
                    (before.total[j - 1] + local[j], before.age[j - 1] + 1),
                    (earlier.total[j - 1] + 0.5 * (local_before[j] + local[j]), earlier.age[j - 1] + 2),
                    (before.total[j - 2] + local[j - 1] + local[j], before.age[j - 2] + 1),
                ];
                let best = ways.into_iter().reduce(|a, b| if b.0 < a.0 { b } else { a }).unwrap();
                prop_assert_eq!((now.total[j].to_bits(), now.age[j]), (best.0.to_bits(), best.1));
            }
        }

        #[test]
        fn the_least_mean_is_the_first_of_the_smallest(
            total in prop::collection::vec((0u8..40).prop_map(|v| f32::from(v) * 0.25), 0..70),
            rows in 1usize..9,
        ) {
            let means = total.iter().enumerate().map(|(i, t)| (i, t / (rows + i) as f32));
            let plain = means.reduce(|a, b| if b.1 < a.1 { b } else { a });
            prop_assert_eq!(least_mean(&total, rows), plain);
        }
    }
}
