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

/// What never changes of [`LANES`] cells of the dynamic program.
#[derive(Debug, Clone)]
#[repr(align(64))]
pub struct CellRows {
    /// `|T_j|²`.
    pub norm: Lanes,
    /// 0 for the first cell of a template, where a path may begin at any tick; else [`FAR`].
    pub start: Lanes,
    /// [`FAR`] for cells between templates, which no path leaves; else 0.
    pub least: Lanes,
}

impl CellRows {
    /// Of no template.
    pub const NONE: Self = Self {
        norm: [0.0; LANES],
        start: [FAR; LANES],
        least: [FAR; LANES],
    };
}

/// Totals `D(j,t)` of [`LANES`] cells at a tick, and the ticks since these paths began: an age needs no clock and so never overflows.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
pub struct Totals {
    /// `D(j,t)`.
    pub total: Lanes,
    /// Ticks.
    pub age: [i32; LANES],
}

impl Totals {
    /// No path.
    pub const EMPTY: Self = Self {
        total: [FAR; LANES],
        age: [0; LANES],
    };
}

/// [`LANES`] cells of the dynamic program, all that is kept of them together: of thousands of streams each comes from
/// memory anew, and what lies together comes at once.
#[derive(Debug, Clone)]
#[repr(align(64))]
pub struct Cells {
    /// `c(j,t)` at the last tick.
    pub local: Lanes,
    /// At the tick before the last, and at the last.
    pub totals: [Totals; 2],
}

impl Cells {
    /// Before the first tick.
    pub const EMPTY: Self = Self {
        local: [0.0; LANES],
        totals: [Totals::EMPTY; 2],
    };
}

/// Ticks that are worked on together where they are known: a row then comes from memory once for all of them.
pub const TICKS: usize = 4;

/// One tick of [`TemplateBank`](super::TemplateBank): distances of the cells' rows `T` from `z`, as `max(0, |T|² + |z|² − 2 T·z)`
/// (cancellation can leave a hair below zero), and the transitions of every cell. `rows` are [`interleaved`].
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
pub fn step(rows: &[Lanes], fixed: &[CellRows], z: &[f32], cells: &mut [Cells]) {
    advance(rows, fixed, [z], cells, |_, _| {});
}

/// [`TICKS`] ticks, with the same bits as one after the other. `out` has the totals of all blocks at the first tick, then at the next.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
pub fn step_ticks(
    rows: &[Lanes],
    fixed: &[CellRows],
    stream: [&[f32]; TICKS],
    cells: &mut [Cells],
    out: &mut [Totals],
) {
    let blocks = cells.len();
    advance(
        rows,
        fixed,
        stream,
        cells,
        |block, totals: &[Totals; TICKS]| {
            for (tick, totals) in totals.iter().enumerate() {
                out[tick * blocks + block] = *totals;
            }
        },
    );
}

/// The last of a block's cells, which the first of the next look back to: at the two ticks before, and at each of those worked on.
struct Behind<const N: usize> {
    before: [[(f32, i32); 2]; 2],
    now: [[(f32, i32); 2]; N],
    local: [f32; N],
}

#[inline(always)]
fn advance<const N: usize>(
    rows: &[Lanes],
    fixed: &[CellRows],
    stream: [&[f32]; N],
    cells: &mut [Cells],
    mut take: impl FnMut(usize, &[Totals; N]),
) {
    let nothing = [(FAR, 0); 2];
    let mut behind = Behind {
        before: [nothing; 2],
        now: [nothing; N],
        local: [0.0; N],
    };
    let squares = stream.map(|z| z.iter().map(|v| v * v).sum::<f32>());
    let dim = stream[0].len();
    for (place, ((block, fixed), cells)) in rows.chunks_exact(dim).zip(fixed).zip(cells).enumerate()
    {
        let mut local = [[0.0; LANES]; N];
        distances(block, &fixed.norm, squares, stream, &mut local);
        let [mut earlier, mut before] = cells.totals;
        let [mut earlier_behind, mut before_behind] = behind.before;
        let last = |totals: &Totals| {
            [LANES - 2, LANES - 1].map(|lane| (totals.total[lane], totals.age[lane]))
        };
        behind.before = [last(&earlier), last(&before)];
        let mut local_before = cells.local;
        let mut totals = [Totals::EMPTY; N];
        for tick in 0..N {
            let columns = Columns {
                local: &local[tick],
                local_before: &local_before,
                local_behind: behind.local[tick],
                before: shifted(&before, before_behind),
                earlier: shifted(&earlier, earlier_behind),
            };
            transitions(&columns, fixed, &mut totals[tick]);
            (earlier, before) = (before, totals[tick]);
            (earlier_behind, before_behind) = (before_behind, behind.now[tick]);
            behind.now[tick] = last(&before);
            behind.local[tick] = local[tick][LANES - 1];
            local_before = local[tick];
        }
        (cells.local, cells.totals) = (local_before, [earlier, before]);
        take(place, &totals);
    }
}

/// A block's cells at a tick with the two cells behind them in front: a step back along the template is a step back in these.
type Column = ([f32; LANES + 2], [i32; LANES + 2]);

#[inline(always)]
fn shifted(cells: &Totals, behind: [(f32, i32); 2]) -> Column {
    let (mut total, mut age) = ([0.0; LANES + 2], [0; LANES + 2]);
    [(total[0], age[0]), (total[1], age[1])] = behind;
    total[2..].copy_from_slice(&cells.total);
    age[2..].copy_from_slice(&cells.age);
    (total, age)
}

/// What the cells of a block look back to.
struct Columns<'a> {
    local: &'a Lanes,
    local_before: &'a Lanes,
    /// Cost of the cell behind the block.
    local_behind: f32,
    before: Column,
    earlier: Column,
}

/// The three transitions of every cell, and the beginning of a path.
#[inline(always)]
fn transitions(columns: &Columns<'_>, fixed: &CellRows, out: &mut Totals) {
    let Columns {
        local: here,
        local_before,
        local_behind,
        before: (before, before_age),
        earlier: (earlier, earlier_age),
    } = columns;
    let mut local = [0.0; LANES + 1];
    local[0] = *local_behind;
    local[1..].copy_from_slice(*here);
    for lane in 0..LANES {
        let mut best = before[lane + 1] + local[lane + 1];
        let mut age = before_age[lane + 1] + 1;
        let two_stream = earlier[lane + 1] + 0.5 * (local_before[lane] + local[lane + 1]);
        let better = two_stream < best;
        best = if better { two_stream } else { best };
        age = if better {
            earlier_age[lane + 1] + 2
        } else {
            age
        };
        let two_template = before[lane] + local[lane] + local[lane + 1];
        let better = two_template < best;
        best = if better { two_template } else { best };
        age = if better { before_age[lane] + 1 } else { age };
        let start = fixed.start[lane] + local[lane + 1];
        let better = start < best;
        best = if better { start } else { best };
        out.age[lane] = if better { 0 } else { age };
        out.total[lane] = best.max(fixed.least[lane]);
    }
}

/// Lanes whose sums stay in registers while the coordinates of [`TICKS`] rows go by.
const TOGETHER: usize = 16;

#[inline(always)]
fn distances<const N: usize>(
    block: &[Lanes],
    norm: &Lanes,
    squares: [f32; N],
    stream: [&[f32]; N],
    out: &mut [Lanes; N],
) {
    if N == 1 {
        return of_lanes::<N, LANES>(block, norm, squares, stream, out, 0);
    }
    for from in (0..LANES).step_by(TOGETHER) {
        of_lanes::<N, TOGETHER>(block, norm, squares, stream, out, from);
    }
}

#[inline(always)]
fn of_lanes<const N: usize, const W: usize>(
    block: &[Lanes],
    norm: &Lanes,
    squares: [f32; N],
    stream: [&[f32]; N],
    out: &mut [Lanes; N],
    from: usize,
) {
    let mut cost = [[0.0; W]; N];
    for (cost, square) in cost.iter_mut().zip(squares) {
        for lane in 0..W {
            cost[lane] = norm[from + lane] + square;
        }
    }
    for (k, row) in block.iter().enumerate() {
        for tick in 0..N {
            let twice = -2.0 * stream[tick][k];
            for lane in 0..W {
                cost[tick][lane] += twice * row[from + lane];
            }
        }
    }
    for (out, cost) in out.iter_mut().zip(&cost) {
        for lane in 0..W {
            out[from + lane] = cost[lane].max(0.0);
        }
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
        fn a_combination_adds_line_after_line((dim, lines, _) in table(), row in values(150)) {
            let mut out = vec![f32::NAN; dim];
            combination(&lines, &row, &mut out);
            let sum = |k: usize| lines.chunks_exact(dim).zip(&row).fold(0.0, |s, (line, v)| s + line[k] * v);
            prop_assert_eq!(bits(&out), bits(&(0..dim).map(sum).collect::<Vec<f32>>()));
        }

        /// One template that fills all cells, and a gap in it where `gap` lies: paths neither leave it nor cross it.
        #[test]
        fn ticks_are_as_they_are_written(
            (dim, rows, _) in table(), stream in values(9 * 11), gap in 0usize..150, together in any::<bool>(),
        ) {
            let rows: Vec<&[f32]> = rows.chunks_exact(dim).collect();
            let n = rows.len();
            let blocks = interleaved(n, dim, rows.iter().copied().enumerate());
            let norm = |row: &[f32]| row.iter().map(|v| v * v).sum::<f32>();
            let mut fixed = vec![CellRows::NONE; n.div_ceil(LANES)];
            let is_gap = |j: usize| j == gap || j == gap + 1;
            let is_first = |j: usize| j == 0 || j == gap + 2;
            for (j, row) in rows.iter().enumerate() {
                let (fixed, lane) = (&mut fixed[j / LANES], j % LANES);
                fixed.norm[lane] = norm(row);
                fixed.start[lane] = if is_first(j) { 0.0 } else { FAR };
                fixed.least[lane] = if is_gap(j) { FAR } else { 0.0 };
            }
            let mut cells = vec![Cells::EMPTY; fixed.len()];
            let stream: Vec<&[f32]> = stream.chunks_exact(dim).collect();
            let mut totals = Vec::new();
            let mut rest = stream.as_slice();
            while let Some(([a, b, c, d], others)) = rest.split_first_chunk().filter(|_| together) {
                let mut out = vec![Totals::EMPTY; TICKS * cells.len()];
                step_ticks(&blocks, &fixed, [a, b, c, d], &mut cells, &mut out);
                totals.extend(out);
                rest = others;
            }
            for z in rest {
                step(&blocks, &fixed, z, &mut cells);
                totals.extend(cells.iter().map(|cells| cells.totals[1]));
            }
            // The column before the last, and the last one: cost, total and age of each cell.
            let nothing = vec![(0.0f32, FAR, 0i32); n];
            let (mut earlier, mut before) = (nothing.clone(), nothing);
            for (tick, z) in stream.iter().enumerate() {
                let cost = |row: &&[f32]| {
                    let from = norm(row) + norm(z);
                    row.iter().zip(*z).fold(from, |sum, (t, v)| sum + -2.0 * v * t).max(0.0)
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
                        (if is_first(j) { 0.0 } else { FAR } + costs[j], 0),
                    ];
                    let best = ways.into_iter().reduce(|a, b| if b.0 < a.0 { b } else { a }).unwrap();
                    (costs[j], if is_gap(j) { best.0.max(FAR) } else { best.0 }, best.1)
                }).collect();
                for (j, (_, total, age)) in now.iter().enumerate() {
                    let found = &totals[tick * cells.len() + j / LANES];
                    prop_assert_eq!(found.total[j % LANES].to_bits(), total.to_bits());
                    prop_assert_eq!(found.age[j % LANES], *age);
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
