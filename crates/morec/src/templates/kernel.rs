//! The inner loops of matching, compiled once for each set of vector instructions and chosen when the program runs.
//!
//! Each is an ordinary loop over lanes that do not depend on each other, so every choice does the same additions in
//! the same order and gives the same bits; multiplications and additions are never fused. Without the choosing they
//! would run on what every processor of the kind has (on x86-64: SSE2, four numbers at a time). Products of whole numbers are in [`dot`](super::dot).

use multiversion::multiversion;

use crate::decode::FAR;

pub use super::dot::LANES;
use super::dot::{AT_ONCE, PairProducts, Pairs};
use super::units::StreamRows;

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

/// What never changes of [`LANES`] cells, but for their rows.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
pub struct CellsFixed {
    /// `|T_j|²`, in whole units.
    pub norm: [i32; LANES],
    /// Added to `c(j,t)`: [`FAR`] where there is no template, else 0.
    pub outside: Lanes,
    /// Total of a path that begins here, before `c(j,t)`: 0 in the first cell of a template and where there is none, else [`FAR`].
    pub begun: Lanes,
}

impl CellsFixed {
    /// Where there is no template.
    pub const OUTSIDE: Self = Self {
        norm: [0; LANES],
        outside: [FAR; LANES],
        begun: [0.0; LANES],
    };

    /// A cell of a template.
    pub fn set(&mut self, lane: usize, norm: i32, is_first: bool) {
        self.norm[lane] = norm;
        self.outside[lane] = 0.0;
        self.begun[lane] = if is_first { 0.0 } else { FAR };
    }
}

/// Total and age of a cell.
pub type Reached = (f32, i32);

/// The last of a block's cells at a tick, which the first of the next look back to.
#[derive(Clone, Copy)]
struct Behind {
    local: f32,
    before: [Reached; 2],
    earlier: Reached,
}

/// Ticks of [`TemplateBank`](super::TemplateBank): the squared distances of the cells' rows `T` from each `z` of `stream`, as
/// `|T|² + |z|² − 2 T·z` in whole units, of which one is `unit` of a squared distance, and the three transitions of every cell.
/// Of `cells`, the totals and ages at `now` are those of two ticks before. Writes totals and ages of the templates' last cells at each tick to
/// `ends`, tick by tick; `extents` are first and last cells.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
pub fn step(
    (rows, fixed, unit): (&[Pairs], &[CellsFixed], f32),
    (stream, dots): (&StreamRows, PairProducts),
    now: usize,
    cells: &mut [Cells],
    (extents, ends): (&[(usize, usize)], &mut [Reached]),
) {
    let nothing = Behind {
        local: 0.0,
        before: [(FAR, 0); 2],
        earlier: (FAR, 0),
    };
    let mut behind = [nothing; AT_ONCE];
    let count = stream.count;
    let pairs = stream.pairs.each_ref().map(Vec::as_slice);
    let width = pairs[0].len();
    let mut sums = [[0; LANES]; AT_ONCE];
    let mut end = 0;
    for (place, (fixed, cells)) in fixed.iter().zip(cells).enumerate() {
        let rows = &rows[place * width..][..width];
        dots(rows, &pairs[..count], &mut sums[..count]);
        let first_end = end;
        for tick in 0..count {
            let local = match stream.norms[tick] {
                Some(norm) => distances(fixed, norm, &sums[tick], unit),
                None => far_distances(fixed, rows, &stream.exact[tick], unit),
            };
            behind[tick] = advance(fixed, &local, &behind[tick], cells, (now + tick) % 2);
            end = first_end;
            while let Some((_, cell)) = extents.get(end)
                && cell / LANES == place
            {
                let (now, lane) = ((now + tick) % 2, cell % LANES);
                ends[tick * extents.len() + end] = (cells.total[now][lane], cells.age[now][lane]);
                end += 1;
            }
        }
    }
}

/// The recurrence, for cells whose rows are at the distances `local`. Returns what the cells behind them ask for.
#[inline(always)]
fn advance(
    fixed: &CellsFixed,
    local: &Lanes,
    behind: &Behind,
    cells: &mut Cells,
    now: usize,
) -> Behind {
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
    cells.local = *local;
    let mut shifted = [0.0; LANES + 1];
    shifted[0] = behind.local;
    shifted[1..].copy_from_slice(local);
    let local = shifted;

    let (total, age) = (&mut cells.total[now], &mut cells.age[now]);
    for lane in 0..LANES {
        let mut best = before[lane + 1] + local[lane + 1];
        let mut best_age = before_age[lane + 1] + 1;
        let mut take = |total: f32, age: i32| {
            let better = total < best;
            best = if better { total } else { best };
            best_age = if better { age } else { best_age };
        };
        let slow = earlier[lane + 1] + 0.5 * (local_before[lane] + local[lane + 1]);
        take(slow, earlier_age[lane + 1] + 2);
        let fast = before[lane] + local[lane] + local[lane + 1];
        take(fast, before_age[lane] + 1);
        take(fixed.begun[lane] + local[lane + 1], 0);
        total[lane] = best;
        age[lane] = best_age;
    }
    Behind {
        local: local[LANES],
        before: [
            (before[LANES], before_age[LANES]),
            (before[LANES + 1], before_age[LANES + 1]),
        ],
        earlier: (earlier[LANES + 1], earlier_age[LANES + 1]),
    }
}

#[inline(always)]
fn distances(fixed: &CellsFixed, norm: i32, products: &[i32; LANES], unit: f32) -> Lanes {
    let mut out = [0.0; LANES];
    for lane in 0..LANES {
        let units = (fixed.norm[lane] + norm) - 2 * products[lane];
        out[lane] = units as f32 * unit + fixed.outside[lane];
    }
    out
}

/// The same for a `z` that is too long for whole units.
#[inline(always)]
fn far_distances(fixed: &CellsFixed, rows: &[Pairs], z: &[f32], unit: f32) -> Lanes {
    let mut out = [0.0; LANES];
    for (pairs, z) in rows.iter().zip(z.as_chunks::<2>().0) {
        for lane in 0..LANES {
            let [a, b] = pairs.0[lane].map(f32::from);
            out[lane] += (a - z[0]) * (a - z[0]) + (b - z[1]) * (b - z[1]);
        }
    }
    for lane in 0..LANES {
        out[lane] = out[lane] * unit + fixed.outside[lane];
    }
    out
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

/// Columns whose sums stand side by side at least.
pub const COLUMNS: usize = 16;

/// For each of the `ROWS` rows of `rows`, one after the other, `Σ row[k] · lines[k]`: the lines one after the other and padded to a multiple of
/// [`COLUMNS`], `out` not padded. `WIDE` columns go side by side while as many are left. Each sum is in the order of `k`.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
pub fn combinations<const ROWS: usize, const WIDE: usize>(
    lines: &[f32],
    rows: &[f32],
    out: &mut [f32],
) {
    let (dim, padded) = (
        rows.len() / ROWS,
        (out.len() / ROWS).next_multiple_of(COLUMNS),
    );
    let rows: [&[f32]; ROWS] = std::array::from_fn(|row| &rows[row * dim..][..dim]);
    let mut from = 0;
    while from < padded {
        if from + WIDE <= padded {
            combine::<ROWS, WIDE>((lines, padded), from, rows, out);
            from += WIDE;
        } else {
            combine::<ROWS, COLUMNS>((lines, padded), from, rows, out);
            from += COLUMNS;
        }
    }
}

/// The same of `WIDE` columns from `from` on, of lines of `padded` columns.
#[inline(always)]
fn combine<const ROWS: usize, const WIDE: usize>(
    (lines, padded): (&[f32], usize),
    from: usize,
    rows: [&[f32]; ROWS],
    out: &mut [f32],
) {
    let (dim, places) = (rows[0].len(), out.len() / ROWS);
    let rows = rows.map(|row| &row[..dim]);
    let mut sums = [[0.0; WIDE]; ROWS];
    for k in 0..dim {
        let Some(line) = lines[k * padded + from..].first_chunk::<WIDE>() else {
            break;
        };
        for (sums, row) in sums.iter_mut().zip(rows) {
            let value = row[k];
            for lane in 0..WIDE {
                sums[lane] += line[lane] * value;
            }
        }
    }
    for (out, sums) in out.chunks_exact_mut(places).zip(&sums) {
        let to = &mut out[from..];
        let count = to.len().min(WIDE);
        to[..count].copy_from_slice(&sums[..count]);
    }
}

/// Numbers whose squares are summed side by side, each place in a sum of its own. Rows are padded with zeros to whole blocks.
pub const SUMS: usize = 8;
pub type SumBlock = [f64; SUMS];

/// Blocks of a row, the last padded with zeros.
pub fn blocks(row: &[f32]) -> impl Iterator<Item = [f32; SUMS]> {
    row.chunks(SUMS).map(|part| {
        let mut block = [0.0; SUMS];
        block[..part.len()].copy_from_slice(part);
        block
    })
}

/// `to = from + row`; returns `|row|²`.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
pub fn add_row(from: &[SumBlock], row: &[f32], to: &mut [SumBlock]) -> f64 {
    let mut squares = [0.0; SUMS];
    for ((to, from), row) in to.iter_mut().zip(from).zip(blocks(row)) {
        for lane in 0..SUMS {
            let value = f64::from(row[lane]);
            to[lane] = from[lane] + value;
            squares[lane] += value * value;
        }
    }
    squares.iter().sum()
}

/// `|Σ weights[k] · lines[k]|²`.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
pub fn square_of_combination(lines: &[&[SumBlock]; 6], weights: &[f64; 6]) -> f64 {
    let mut squares = [0.0; SUMS];
    for block in 0..lines[0].len() {
        let mut values = [0.0; SUMS];
        for (line, weight) in lines.iter().zip(weights) {
            for lane in 0..SUMS {
                values[lane] += weight * line[block][lane];
            }
        }
        for lane in 0..SUMS {
            squares[lane] += values[lane] * values[lane];
        }
    }
    squares.iter().sum()
}

/// `|m|²` of the mean `m = (end − start) · share`.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
pub fn square_of_mean(end: &[SumBlock], start: &[SumBlock], share: f64) -> f64 {
    let mut squares = [0.0; SUMS];
    for (end, start) in end.iter().zip(start) {
        for lane in 0..SUMS {
            let value = (end[lane] - start[lane]) * share;
            squares[lane] += value * value;
        }
    }
    squares.iter().sum()
}

/// `|m − point|²` of the mean `m = (end − start) · share`.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
pub fn offset_of_mean(
    end: &[SumBlock],
    start: &[SumBlock],
    share: f64,
    point: &[[f32; SUMS]],
) -> f64 {
    let mut squares = [0.0; SUMS];
    for ((end, start), point) in end.iter().zip(start).zip(point) {
        for lane in 0..SUMS {
            let value = (end[lane] - start[lane]) * share - f64::from(point[lane]);
            squares[lane] += value * value;
        }
    }
    squares.iter().sum()
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
        fn sums_of_rows_are_those_of_one_value_after_the_other(
            values in values(6 * 23), dim in 1usize..23, share in 0.01f64..1.0,
        ) {
            let row = |part: usize| &values[23 * part..][..dim];
            let rows = [0, 1, 2, 3, 4, 5].map(|part| -> Vec<SumBlock> { blocks(row(part)).map(|b| b.map(|v| f64::from(v) * 1.7)).collect() });
            let [start, end, ..] = &rows;
            let at = |part: usize, i: usize| rows[part][i / SUMS][i % SUMS];
            let near = |sum: f64, term: &dyn Fn(usize) -> f64| {
                let plain: f64 = (0..dim).map(|i| term(i) * term(i)).sum();
                (sum - plain).abs() <= 1e-12 * plain
            };
            let mean = |i: usize| (at(1, i) - at(0, i)) * share;
            prop_assert!(near(square_of_mean(end, start, share), &mean));
            let point: Vec<_> = blocks(row(2)).collect();
            let apart = |i: usize| mean(i) - f64::from(row(2)[i]);
            prop_assert!(near(offset_of_mean(end, start, share, &point), &apart));
            let weights = [1.0, -5.0, 10.0, -10.0, 5.0, share];
            let lines = [0, 1, 2, 3, 4, 5].map(|part: usize| &rows[part][..]);
            let combined = |i: usize| (0..6).map(|part| weights[part] * at(part, i)).sum();
            prop_assert!(near(square_of_combination(&lines, &weights), &combined));
            let mut to = vec![[f64::NAN; SUMS]; start.len()];
            prop_assert!(near(add_row(start, row(2), &mut to), &|i| f64::from(row(2)[i])));
            for (i, value) in row(2).iter().enumerate() {
                prop_assert_eq!(to[i / SUMS][i % SUMS].to_bits(), (at(0, i) + f64::from(*value)).to_bits());
            }
        }

        #[test]
        fn combinations_add_line_after_line(dim in 1usize..100, lines in values(9 * 100), rows in values(4 * 9)) {
            let lines: Vec<&[f32]> = lines.chunks_exact(100).map(|line| &line[..dim]).collect();
            let mut padded = vec![0.0; 9 * dim.next_multiple_of(COLUMNS)];
            for (to, line) in padded.chunks_exact_mut(dim.next_multiple_of(COLUMNS)).zip(&lines) {
                to[..dim].copy_from_slice(line);
            }
            let mut out = vec![f32::NAN; 4 * dim];
            combinations::<4, 16>(&padded, &rows, &mut out);
            for (row, out) in rows.chunks_exact(9).zip(out.chunks_exact(dim)) {
                let sum = |k: usize| lines.iter().zip(row).fold(0.0, |s, (line, v)| s + line[k] * v);
                prop_assert_eq!(bits(out), bits(&(0..dim).map(sum).collect::<Vec<f32>>()));
                let mut alone = vec![f32::NAN; dim];
                combinations::<1, 64>(&padded, row, &mut alone);
                prop_assert_eq!(bits(&alone), bits(out));
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
