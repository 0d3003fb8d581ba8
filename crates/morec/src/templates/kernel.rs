//! The inner loops of matching, compiled once for each set of vector instructions and chosen when the program runs.
//!
//! Each is an ordinary loop over lanes that do not depend on each other, so every choice does the same additions in
//! the same order and gives the same bits; multiplications and additions are never fused. Without the choosing they
//! would run on what every processor of the kind has (on x86-64: SSE2, four numbers at a time).

use multiversion::multiversion;

use crate::decode::FAR;

/// Cells or exemplars that are worked on at once, kept in registers while the coordinates go by: four of AVX-512, eight
/// of AVX2, sixteen of SSE2 and NEON. Memory is then read once and in order, which is what bounds the time.
pub const LANES: usize = 64;

/// The same value of [`LANES`] cells.
pub type Lanes = [f32; LANES];

/// Rows laid out so that equal coordinates of [`LANES`] of them lie together: block by block, in a block coordinate by
/// coordinate. What is left of the last block is zero.
pub fn interleaved<'r>(
    len: usize,
    dim: usize,
    rows: impl Iterator<Item = (usize, &'r [f32])>,
) -> Vec<Lanes> {
    let mut blocks = vec![[0.0; LANES]; len.div_ceil(LANES) * dim];
    for (place, row) in rows {
        for (k, value) in row.iter().enumerate() {
            blocks[place / LANES * dim + k][place % LANES] = *value;
        }
    }
    blocks
}

/// [`LANES`] cells of the dynamic program, all that is kept of them together: of thousands of streams each comes from
/// memory anew, and what lies together comes at once.
#[derive(Debug, Clone)]
#[repr(align(64))]
pub struct Cells {
    /// `c(j,t)` at the last tick.
    pub local: Lanes,
    /// `D(j,t)` at the last two ticks, in turn.
    pub total: [Lanes; 2],
    /// Ticks since these paths began: an age needs no clock and so never overflows.
    pub age: [[i32; LANES]; 2],
}

impl Cells {
    /// Before the first tick.
    pub const EMPTY: Self = Self {
        local: [0.0; LANES],
        total: [[FAR; LANES]; 2],
        age: [[0; LANES]; 2],
    };
}

/// The last of a block's cells, which the first of the next look back to.
struct Behind {
    local: f32,
    before: [(f32, i32); 2],
    earlier: (f32, i32),
}

/// One tick of [`TemplateBank`](super::TemplateBank): distances of the cells' rows `T` from `z`, as `max(0, |T|² + |z|² − 2 T·z)`
/// (cancellation can leave a hair below zero), and the three transitions of every cell. `rows` are [`interleaved`], `norms`
/// hold the `|T|²`; the totals and ages at `now` are those of two ticks before and become those of this tick.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
pub fn step(rows: &[Lanes], norms: &[Lanes], z: &[f32], now: usize, cells: &mut [Cells]) {
    let z_norm: f32 = z.iter().map(|v| v * v).sum();
    let mut behind = Behind {
        local: 0.0,
        before: [(FAR, 0); 2],
        earlier: (FAR, 0),
    };
    for ((block, norm), cells) in rows.chunks_exact(z.len()).zip(norms).zip(cells) {
        // Columns with the cells behind them in front: a step back along the template is a step back in these.
        let [mut before, mut earlier] = [[0.0; LANES + 2], [0.0; LANES + 2]];
        let [mut before_age, mut earlier_age] = [[0; LANES + 2], [0; LANES + 2]];
        [(before[0], before_age[0]), (before[1], before_age[1])] = behind.before;
        (earlier[1], earlier_age[1]) = behind.earlier;
        before[2..].copy_from_slice(&cells.total[1 - now]);
        before_age[2..].copy_from_slice(&cells.age[1 - now]);
        earlier[2..].copy_from_slice(&cells.total[now]);
        earlier_age[2..].copy_from_slice(&cells.age[now]);

        let local_before = cells.local;
        distances(block, norm, z_norm, z, &mut cells.local);
        let mut local = [0.0; LANES + 1];
        local[0] = behind.local;
        local[1..].copy_from_slice(&cells.local);

        let (total, age) = (&mut cells.total[now], &mut cells.age[now]);
        for lane in 0..LANES {
            let mut best = before[lane + 1] + local[lane + 1];
            let mut best_age = before_age[lane + 1] + 1;
            let two_stream = earlier[lane + 1] + 0.5 * (local_before[lane] + local[lane + 1]);
            let better = two_stream < best;
            best = if better { two_stream } else { best };
            best_age = if better {
                earlier_age[lane + 1] + 2
            } else {
                best_age
            };
            let two_template = before[lane] + local[lane] + local[lane + 1];
            let better = two_template < best;
            total[lane] = if better { two_template } else { best };
            age[lane] = if better {
                before_age[lane] + 1
            } else {
                best_age
            };
        }
        behind = Behind {
            local: local[LANES],
            before: [
                (before[LANES], before_age[LANES]),
                (before[LANES + 1], before_age[LANES + 1]),
            ],
            earlier: (earlier[LANES + 1], earlier_age[LANES + 1]),
        };
    }
}

#[inline(always)]
fn distances(block: &[Lanes], norm: &Lanes, z_norm: f32, z: &[f32], out: &mut Lanes) {
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
    const NARROW: usize = 16;
    let dim = out.len();
    let mut from = 0;
    while dim - from >= LANES {
        place(lines, row, out, from, [0.0; LANES]);
        from += LANES;
    }
    if dim < NARROW {
        return (from..dim).for_each(|at| place(lines, row, out, at, [0.0; 1]));
    }
    while from < dim {
        // The last places overlap those before them: summing twice changes nothing.
        let start = from.min(dim - NARROW);
        place(lines, row, out, start, [0.0; NARROW]);
        from = start + NARROW;
    }
}

/// The places of `out` from `from` on, as many as `sums`, which stay in registers while the lines go by.
#[inline(always)]
fn place<const WIDE: usize>(
    lines: &[f32],
    row: &[f32],
    out: &mut [f32],
    from: usize,
    mut sums: [f32; WIDE],
) {
    for (line, value) in lines.chunks_exact(out.len()).zip(row) {
        for (sum, a) in sums.iter_mut().zip(&line[from..from + WIDE]) {
            *sum += a * value;
        }
    }
    out[from..from + WIDE].copy_from_slice(&sums);
}

/// Numbers whose squares are summed side by side, each place in a sum of its own.
const SUMS: usize = 4;

/// `|m|²` of the mean `m = (end − start) · share`, in [`SUMS`] partial sums.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
pub fn square_of_mean(end: &[f64], start: &[f64], share: f64) -> f64 {
    let mut sums = [0.0; SUMS];
    let (mut ends, mut starts) = (end.chunks_exact(SUMS), start.chunks_exact(SUMS));
    for (end, start) in ends.by_ref().zip(starts.by_ref()) {
        for lane in 0..SUMS {
            let value = (end[lane] - start[lane]) * share;
            sums[lane] += value * value;
        }
    }
    let rest = ends.remainder().iter().zip(starts.remainder());
    let rest = rest.map(|(end, start)| (end - start) * share);
    sums.iter().sum::<f64>() + rest.map(|value| value * value).sum::<f64>()
}

/// `|m − point|²` of the mean `m = (end − start) · share`, in [`SUMS`] partial sums.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
pub fn offset_of_mean(end: &[f64], start: &[f64], share: f64, point: &[f32]) -> f64 {
    let mut sums = [0.0; SUMS];
    let (mut ends, mut starts) = (end.chunks_exact(SUMS), start.chunks_exact(SUMS));
    let mut points = point.chunks_exact(SUMS);
    for ((end, start), point) in ends.by_ref().zip(starts.by_ref()).zip(points.by_ref()) {
        for lane in 0..SUMS {
            let value = (end[lane] - start[lane]) * share - f64::from(point[lane]);
            sums[lane] += value * value;
        }
    }
    let rest = ends.remainder().iter().zip(starts.remainder());
    let rest = rest
        .zip(points.remainder())
        .map(|((end, start), point)| (end - start) * share - f64::from(*point));
    sums.iter().sum::<f64>() + rest.map(|value| value * value).sum::<f64>()
}

/// The place of the smallest `total[i] / (rows + i)`, the first of equals, and that quotient; infinite of nothing.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
pub fn least_mean(total: &[f32], rows: usize) -> (usize, f32) {
    const WIDE: usize = 8;
    if total.len() < WIDE {
        let mut best = (0, f32::INFINITY);
        for (place, total) in total.iter().enumerate() {
            let mean = total / (rows + place) as i32 as f32;
            best = if mean < best.1 { (place, mean) } else { best };
        }
        return best;
    }
    let mut least = [f32::INFINITY; WIDE];
    let mut place = [0i32; WIDE];
    let mut from = 0;
    while from < total.len() {
        // The last chunk overlaps the one before it: looking twice changes nothing.
        let start = from.min(total.len() - WIDE);
        let Some(chunk) = total[start..].first_chunk::<WIDE>() else {
            break;
        };
        for lane in 0..WIDE {
            let at = (start + lane) as i32;
            let mean = chunk[lane] / (rows as i32 + at) as f32;
            let less = mean < least[lane];
            least[lane] = if less { mean } else { least[lane] };
            place[lane] = if less { at } else { place[lane] };
        }
        from += WIDE;
    }
    let mut half = WIDE / 2;
    while half > 0 {
        for lane in 0..half {
            let (mean, at) = (least[lane + half], place[lane + half]);
            let less = mean < least[lane] || (mean == least[lane] && at < place[lane]);
            least[lane] = if less { mean } else { least[lane] };
            place[lane] = if less { at } else { place[lane] };
        }
        half /= 2;
    }
    (place[0] as usize, least[0])
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
        (1usize..9, 0usize..150)
            .prop_flat_map(|(dim, rows)| (Just(dim), values(dim * rows), values(dim)))
    }

    fn bits<'a>(values: impl IntoIterator<Item = &'a f32>) -> Vec<u32> {
        values.into_iter().map(|v| v.to_bits()).collect()
    }

    proptest! {
        #[test]
        fn distances_are_those_of_one_row_after_the_other((dim, rows, z) in table()) {
            let rows: Vec<&[f32]> = rows.chunks_exact(dim).collect();
            let blocks = interleaved(rows.len(), dim, rows.iter().copied().enumerate());
            let mut out = vec![[f32::NAN; LANES]; rows.len().div_ceil(LANES)];
            squared_distances(&blocks, &z, &mut out);
            let square = |row: &&[f32]| row.iter().zip(&z).fold(0.0, |sum, (t, v)| sum + (t - v) * (t - v));
            let plain: Vec<f32> = rows.iter().map(square).collect();
            prop_assert_eq!(bits(&out.as_flattened()[..rows.len()]), bits(&plain));
        }

        #[test]
        fn means_are_apart_by_four_partial_sums(values in values(3 * 23), dim in 0usize..23, share in 0.01f64..1.0) {
            let of = |part: usize| -> Vec<f64> { values[23 * part..][..dim].iter().map(|v| f64::from(*v) * 1.7).collect() };
            let (end, start, point) = (of(0), of(1), &values[46..46 + dim]);
            let sum = |term: &dyn Fn(usize) -> f64| {
                let mut sums = [0.0f64; SUMS];
                let whole = dim - dim % SUMS;
                (0..whole).for_each(|i| sums[i % SUMS] += term(i) * term(i));
                sums.iter().sum::<f64>() + (whole..dim).map(|i| term(i) * term(i)).sum::<f64>()
            };
            let mean = |i: usize| (end[i] - start[i]) * share;
            let square = square_of_mean(&end, &start, share);
            prop_assert_eq!(square.to_bits(), sum(&mean).to_bits());
            let offset = offset_of_mean(&end, &start, share, point);
            prop_assert_eq!(offset.to_bits(), sum(&|i| mean(i) - f64::from(point[i])).to_bits());
        }

        #[test]
        fn a_combination_adds_line_after_line(dim in 1usize..150, lines in values(9 * 150), row in values(9)) {
            let lines = &lines[..9 * dim];
            let mut out = vec![f32::NAN; dim];
            combination(lines, &row, &mut out);
            let sum = |k: usize| lines.chunks_exact(dim).zip(&row).fold(0.0, |s, (line, v)| s + line[k] * v);
            prop_assert_eq!(bits(&out), bits(&(0..dim).map(sum).collect::<Vec<f32>>()));
        }

        #[test]
        fn a_tick_is_as_it_is_written((dim, rows, _) in table(), stream in values(9 * 8)) {
            let rows: Vec<&[f32]> = rows.chunks_exact(dim).collect();
            let n = rows.len();
            let blocks = interleaved(n, dim, rows.iter().copied().enumerate());
            let norm = |row: &[f32]| row.iter().map(|v| v * v).sum::<f32>();
            let mut norms = vec![[0.0; LANES]; n.div_ceil(LANES)];
            rows.iter().enumerate().for_each(|(i, row)| norms.as_flattened_mut()[i] = norm(row));
            let mut cells = vec![Cells::EMPTY; norms.len()];
            // The column before the last, and the last one: cost, total and age of each cell.
            let nothing = vec![(0.0f32, FAR, 0i32); n];
            let (mut earlier, mut before) = (nothing.clone(), nothing);
            for (tick, z) in stream.chunks_exact(dim).enumerate() {
                // Something to begin with: without first cells every path would come from nowhere.
                if tick == 2 {
                    before.iter_mut().zip(0..).for_each(|(cell, j)| (cell.1, cell.2) = ((j % 3) as f32, j));
                    before.iter().enumerate().for_each(|(j, (_, total, age))| {
                        cells[j / LANES].total[1][j % LANES] = *total;
                        cells[j / LANES].age[1][j % LANES] = *age;
                    });
                }
                step(&blocks, &norms, z, tick % 2, &mut cells);
                let cost = |row: &&[f32]| {
                    let from = norm(row) + norm(z);
                    row.iter().zip(z).fold(from, |sum, (t, v)| sum + -2.0 * v * t).max(0.0)
                };
                let costs: Vec<f32> = rows.iter().map(cost).collect();
                let back = |column: &[(f32, f32, i32)], j: usize, by: usize| {
                    j.checked_sub(by).map_or((0.0, FAR, 0), |j| column[j])
                };
                let now: Vec<_> = (0..n).map(|j| {
                    let (even, slow, fast) = (back(&before, j, 1), back(&earlier, j, 1), back(&before, j, 2));
                    let cost_1 = if j > 0 { costs[j - 1] } else { 0.0 };
                    let ways = [
                        (even.1 + costs[j], even.2 + 1),
                        (slow.1 + 0.5 * (before[j].0 + costs[j]), slow.2 + 2),
                        (fast.1 + cost_1 + costs[j], fast.2 + 1),
                    ];
                    let best = ways.into_iter().reduce(|a, b| if b.0 < a.0 { b } else { a }).unwrap();
                    (costs[j], best.0, best.1)
                }).collect();
                for (j, (cost, total, age)) in now.iter().enumerate() {
                    let (block, lane) = (&cells[j / LANES], j % LANES);
                    prop_assert_eq!(block.local[lane].to_bits(), cost.to_bits());
                    prop_assert_eq!(block.total[tick % 2][lane].to_bits(), total.to_bits());
                    prop_assert_eq!(block.age[tick % 2][lane], *age);
                }
                (earlier, before) = (before, now);
            }
        }

        #[test]
        fn the_least_mean_is_the_first_of_the_smallest(
            total in prop::collection::vec((0u8..40).prop_map(|v| f32::from(v) * 0.25), 0..70),
            rows in 1usize..9,
        ) {
            let means = total.iter().enumerate().map(|(i, t)| (i, t / (rows + i) as f32));
            let plain = means.reduce(|a, b| if b.1 < a.1 { b } else { a });
            prop_assert_eq!(least_mean(&total, rows), plain.unwrap_or((0, f32::INFINITY)));
        }
    }
}
