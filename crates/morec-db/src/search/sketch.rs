//! Sketches of clips: prefix sums of their rows at every second row, in a byte a value, with the error of what lies between.
//!
//! Windows of whatever place and length are compared by means over their parts ([`summary`](super::summary)), which are
//! differences of prefix sums. A sketch gives these to within an error that it states, so that the distance of a window is
//! bounded from below ([`bound`](super::bound)) without its rows. Between its blocks a prefix sum is a cubic with the slopes of
//! central differences (Catmull and Rom, *A class of local interpolating splines*, 1974).

use morec::features::{RowLayout, Rows};

use super::boxes::{BOX_BYTES, boxed};
use super::windows::{TRAVEL, X};

/// Rows in a block.
pub const BLOCK: usize = 2;
/// Places between two rows at which prefix sums are asked for: parts of a window are eighths of it.
pub const PLACES: usize = 8;
/// Coordinates of directions, filled up to whole vectors, then those of the root, filled up.
pub const LANES: usize = 48;
/// A value for each lane, where vector loads want it.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub struct SketchLanes(pub [f32; LANES]);

impl Default for SketchLanes {
    fn default() -> Self {
        Self::ZERO
    }
}

impl SketchLanes {
    /// 0 in every lane, for sums to begin with.
    pub const ZERO: Self = Self([0.0; LANES]);
}

/// The first lane of the root.
pub const ROOT_LANE: usize = 40;
/// Lanes that are kept: directions, then the root.
const KEPT: usize = X + TRAVEL;
/// The finest unit; others follow in quarters of octaves.
const LEAST_UNIT: f32 = 1.0 / 4096.0;
/// Whole numbers below this are exact in single precision.
const EXACT: f64 = 16_777_216.0;
/// Bytes of a block: directions, root, errors of both.
const BLOCK_BYTES: usize = X + 2 * TRAVEL + 2;
/// Bytes before the box: the number of rows.
const HEAD: usize = 4;
/// Bytes of the scale of a lane: the code of its unit, and what blocks add on the whole, in units.
const SCALE_BYTES: usize = 3;
/// Bytes of all scales, after the box.
const SCALES_BYTES: usize = SCALE_BYTES * KEPT;

/// Weights of the block before, of the block and of the next in a prefix sum within the block.
pub type BlockWeights = [f32; 3];

/// Weights at each place of a block, its end too.
pub fn weights() -> [BlockWeights; PLACES * BLOCK + 1] {
    std::array::from_fn(|place| {
        // Between rows prefix sums are straight lines, and so is what stands for them.
        let (row, share) = (place / PLACES, (place % PLACES) as f32 / PLACES as f32);
        let (here, there) = (weights_at_row(row), weights_at_row((row + 1).min(BLOCK)));
        std::array::from_fn(|i| here[i] + share * (there[i] - here[i]))
    })
}

/// Weights at a row of a block, or at its end.
fn weights_at_row(row: usize) -> BlockWeights {
    let f = row as f32 / BLOCK as f32;
    let (f2, f3) = (f * f, f * f * f);
    let (slope, rise, next) = (f3 - 2.0 * f2 + f, 3.0 * f2 - 2.0 * f3, f3 - f2);
    [0.5 * slope, 0.5 * slope + rise + 0.5 * next, 0.5 * next]
}

/// How the prefix sums of a lane are kept.
struct LaneScale {
    /// Of its [unit](unit_of).
    code: u8,
    /// Subtracted from what each block adds, in units.
    centre: i16,
}

/// The unit that a code stands for: four to an octave, each a short binary fraction of it, so that it is the same everywhere.
fn unit_of(code: u8) -> f32 {
    let octave = i32::from(code / 4);
    LEAST_UNIT * 2f32.powi(octave) * (1.0 + f32::from(code % 4) / 4.0)
}

/// The lane of a kept value.
fn lane_of(kept: usize) -> usize {
    if kept < X { kept } else { ROOT_LANE + kept - X }
}

/// Sums before each block and after the last in whole units.
fn in_units(sums: &[[f64; LANES]], lane: usize, code: u8) -> impl Iterator<Item = f64> + '_ {
    let unit = f64::from(unit_of(code));
    sums.iter()
        .step_by(BLOCK)
        .map(move |sums| (sums[lane] / unit).round())
}

impl LaneScale {
    /// The finest scale in which what each block adds to a lane differs from the centre by no more than `most`.
    fn of(sums: &[[f64; LANES]], lane: usize, most: f64) -> Option<Self> {
        (0..=u8::MAX).find_map(|code| Self::by_code(sums, lane, code, most))
    }

    fn by_code(sums: &[[f64; LANES]], lane: usize, code: u8, most: f64) -> Option<Self> {
        let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut before = 0.0;
        for sum in in_units(sums, lane, code).skip(1) {
            (least, greatest) = (least.min(sum - before), greatest.max(sum - before));
            before = sum;
            let is_exact = sum.abs() < EXACT;
            if greatest - least > 2.0 * most || !is_exact {
                return None;
            }
        }
        let centre = ((least + greatest) / 2.0).floor();
        let fits = centre.abs() <= f64::from(i16::MAX) && greatest - centre <= most;
        fits.then_some(Self {
            code,
            centre: centre as i16,
        })
    }
}

/// The sketch of a clip's rows in the layout of all bones: 43 bytes for 2 rows. `None` of rows that no recognition makes
/// (directions longer than 1.27, values that are no numbers). O(values), times the units that are tried.
pub fn sketch(rows: &Rows) -> Option<Vec<u8>> {
    let sums = prefix_sums(rows);
    let mut out = u32::try_from(rows.len()).ok()?.to_le_bytes().to_vec();
    out.extend(boxed(rows)?);
    let mut at_blocks = vec![[0f64; LANES]; sums.len().div_ceil(BLOCK)];
    let mut centres = [0f64; LANES];
    let mut units = [0f64; LANES];
    for kept in 0..KEPT {
        let lane = lane_of(kept);
        let most = f64::from(if kept < X { i8::MAX.into() } else { i16::MAX });
        let scale = LaneScale::of(&sums, lane, most)?;
        out.push(scale.code);
        out.extend(scale.centre.to_le_bytes());
        centres[lane] = f64::from(scale.centre);
        units[lane] = f64::from(unit_of(scale.code));
        for (at, sum) in at_blocks.iter_mut().zip(in_units(&sums, lane, scale.code)) {
            at[lane] = sum;
        }
    }
    let deltas: Vec<[f32; LANES]> = at_blocks
        .windows(2)
        .map(|at| std::array::from_fn(|lane| (at[1][lane] - at[0][lane]) as f32))
        .collect();
    for (block, delta) in deltas.iter().enumerate() {
        let code = |lane: usize| f64::from(delta[lane]) - centres[lane];
        out.extend((0..X).map(|lane| (code(lane) as i8).cast_unsigned()));
        out.extend(
            (ROOT_LANE..ROOT_LANE + TRAVEL).flat_map(|lane| (code(lane) as i16).to_le_bytes()),
        );
        let near = neighbours(&deltas, block);
        let exact = &sums[block * BLOCK..][..=BLOCK];
        for error in errors_within(&at_blocks[block], near, &units, exact) {
            out.push(error_code(error)?);
        }
    }
    Some(out)
}

/// How far the cubic of a block is from these sums at most, Euclidean over directions and over the root.
fn errors_within(
    at_block: &[f64; LANES],
    near: [&[f32; LANES]; 3],
    units: &[f64; LANES],
    exact: &[[f64; LANES]],
) -> [f32; 2] {
    let mut errors = [0f64; 2];
    for (row, exact) in exact.iter().enumerate() {
        let weights = weights_at_row(row);
        let mut squares = [0f64; 2];
        for lane in 0..LANES {
            let within: f32 = (0..3).map(|i| weights[i] * near[i][lane]).sum();
            let value = (at_block[lane] + f64::from(within)) * units[lane];
            squares[usize::from(lane >= ROOT_LANE)] += (value - exact[lane]).powi(2);
        }
        errors = std::array::from_fn(|i| errors[i].max(squares[i]));
    }
    errors.map(|error| error.sqrt() as f32)
}

/// Running sums of the lanes before each row; the last row goes on until its block ends.
fn prefix_sums(rows: &Rows) -> Vec<[f64; LANES]> {
    let mut sum = [0f64; LANES];
    let mut sums = vec![sum];
    for t in 0..rows.len().next_multiple_of(BLOCK) {
        let row = rows.row(t.min(rows.len() - 1));
        for (sum, value) in sum.iter_mut().zip(&row[RowLayout::BODY.directions()]) {
            *sum += f64::from(*value);
        }
        for (sum, value) in sum[ROOT_LANE..]
            .iter_mut()
            .zip(&row[RowLayout::BODY.root()])
        {
            *sum += f64::from(*value);
        }
        sums.push(sum);
    }
    sums
}

/// The block before, the block and the next; at the ends the block itself.
fn neighbours(deltas: &[[f32; LANES]], block: usize) -> [&[f32; LANES]; 3] {
    [
        &deltas[block.saturating_sub(1)],
        &deltas[block],
        &deltas[(block + 1).min(deltas.len() - 1)],
    ]
}

/// The error that a code stands for: from 0.0002 in steps of a sixteenth of an octave.
fn error_of(code: u8) -> f32 {
    (f32::from(code) / 16.0 - 12.0).exp2()
}

/// The least code that does not understate an error.
fn error_code(error: f32) -> Option<u8> {
    // More than is lost in computing prefix sums in single precision, here and where they are read.
    let error = 1.0001 * error + 1e-4;
    (0..=u8::MAX).find(|code| error_of(*code) >= error)
}

/// A sketch as it is computed with.
#[derive(Debug, Default)]
pub struct Sketch {
    /// Rows of the clip.
    pub rows: usize,
    /// Of each lane.
    units: SketchLanes,
    /// Prefix sums before each block and after the last, in units: whole numbers.
    sums: Vec<SketchLanes>,
    /// Error of prefix sums within each block, Euclidean over directions and over the root.
    errors: Vec<[f32; 2]>,
}

/// Constants of reading sketches.
pub struct SketchTables {
    weights: [BlockWeights; PLACES * BLOCK + 1],
    errors: [f32; 256],
    units: [f32; 256],
}

impl SketchTables {
    pub fn new() -> Self {
        Self {
            weights: weights(),
            errors: std::array::from_fn(|code| error_of(code as u8)),
            units: std::array::from_fn(|code| unit_of(code as u8)),
        }
    }
}

/// Parts of the bytes of a sketch.
pub struct SketchBytes<'a> {
    pub rows: usize,
    pub within: &'a [u8; BOX_BYTES],
    scales: &'a [u8; SCALES_BYTES],
    blocks: &'a [[u8; BLOCK_BYTES]],
}

impl<'a> SketchBytes<'a> {
    /// `None` for bytes that are no sketch.
    #[inline(always)]
    pub fn of(bytes: &'a [u8]) -> Option<Self> {
        let (rows, bytes) = bytes.split_first_chunk::<HEAD>()?;
        let (within, bytes) = bytes.split_first_chunk::<BOX_BYTES>()?;
        let (scales, bytes) = bytes.split_first_chunk::<SCALES_BYTES>()?;
        let rows = u32::from_le_bytes(*rows) as usize;
        let (blocks, rest) = bytes.as_chunks::<BLOCK_BYTES>();
        let fits = rows > 0 && blocks.len() == rows.div_ceil(BLOCK) && rest.is_empty();
        fits.then_some(Self {
            rows,
            within,
            scales,
            blocks,
        })
    }
}

impl Sketch {
    /// Reads a sketch into this one, whose memory is used again.
    #[inline(always)]
    pub fn read(&mut self, bytes: &SketchBytes<'_>, tables: &SketchTables) {
        let blocks = bytes.blocks;
        self.rows = bytes.rows;
        self.sums.resize(blocks.len() + 1, SketchLanes::ZERO);
        self.errors.resize(blocks.len(), [0.0; 2]);
        let mut sum = SketchLanes::ZERO;
        let mut centres = SketchLanes::ZERO;
        for kept in 0..KEPT {
            let scale = &bytes.scales[SCALE_BYTES * kept..][..SCALE_BYTES];
            let lane = lane_of(kept);
            self.units.0[lane] = tables.units[usize::from(scale[0])];
            centres.0[lane] = f32::from(i16::from_le_bytes([scale[1], scale[2]]));
        }
        self.sums[0] = sum;
        let read = self.sums[1..].iter_mut().zip(&mut self.errors);
        for (block, (sums, errors)) in blocks.iter().zip(read) {
            for lane in 0..LANES {
                sum.0[lane] += centres.0[lane];
            }
            for lane in 0..X {
                sum.0[lane] += f32::from(block[lane].cast_signed());
            }
            for i in 0..TRAVEL {
                let delta = i16::from_le_bytes([block[X + 2 * i], block[X + 2 * i + 1]]);
                sum.0[ROOT_LANE + i] += f32::from(delta);
            }
            *sums = sum;
            errors[0] = tables.errors[usize::from(block[BLOCK_BYTES - 2])];
            errors[1] = tables.errors[usize::from(block[BLOCK_BYTES - 1])];
        }
    }

    /// Prefix sums before `place`, in eighths of rows, less those before the block `base`.
    #[inline(always)]
    pub fn until(&self, place: usize, base: usize, tables: &SketchTables) -> SketchLanes {
        let block = self.block(place);
        let [before, within, next] = tables.weights[place - PLACES * BLOCK * block];
        let last = self.sums.len() - 2;
        // At the ends the block stands for those that are not there.
        let (first, third) = (block.saturating_sub(1), (block + 1).min(last));
        let lanes = |at: usize| &self.sums[at].0;
        let (a, b) = (lanes(first), lanes(first + 1));
        let (c, d) = (lanes(block), lanes(block + 1));
        let (e, f) = (lanes(third), lanes(third + 1));
        let base = lanes(base);
        let mut out = SketchLanes::ZERO;
        for lane in 0..LANES {
            // Differences of whole numbers are exact.
            let units = (c[lane] - base[lane])
                + before * (b[lane] - a[lane])
                + within * (d[lane] - c[lane])
                + next * (f[lane] - e[lane]);
            out.0[lane] = units * self.units.0[lane];
        }
        out
    }

    /// Errors of the prefix sums at a place, in rows: of directions and of the root.
    #[inline(always)]
    pub fn errors(&self, place: usize) -> [f32; 2] {
        self.errors[self.block(place)]
    }

    /// The block of a place in eighths of rows.
    #[inline(always)]
    pub fn block(&self, place: usize) -> usize {
        (place / (PLACES * BLOCK)).min(self.errors.len() - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::search::layout::DIM;
    use proptest::prelude::*;

    /// Any place between two blocks, by adding up rows.
    fn slowly(rows: &Rows, place: usize, column: usize) -> f64 {
        let (row, share) = (place / PLACES, (place % PLACES) as f64 / PLACES as f64);
        let value = |t: usize| f64::from(rows.row(t)[column]);
        (0..row).map(value).sum::<f64>() + if share > 0.0 { share * value(row) } else { 0.0 }
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 32, failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn prefix_sums_are_within_the_error_that_is_stated(
            values in prop::collection::vec(-1f32..1.0, 40 * DIM),
            length in 1usize..40,
            base in 0usize..40,
        ) {
            let rows = Rows::from_values(DIM, values[..length * DIM].to_vec());
            let bytes = sketch(&rows).unwrap();
            let (mut read, tables) = (Sketch::default(), SketchTables::new());
            read.read(&SketchBytes::of(&bytes).unwrap(), &tables);
            prop_assert_eq!(read.rows, length);
            let base = read.block(base.min(length) * PLACES);
            let lanes: Vec<(usize, usize)> = RowLayout::BODY.directions().enumerate()
                .chain(RowLayout::BODY.root().enumerate().map(|(i, c)| (ROOT_LANE + i, c))).collect();
            for place in 0..=length * PLACES {
                let found = read.until(place, base, &tables);
                let errors = read.errors(place);
                let mut squares = [0f64; 2];
                for (lane, column) in &lanes {
                    let unit = f64::from(read.units.0[*lane]);
                    let there = f64::from(read.sums[base].0[*lane]) * unit + f64::from(found.0[*lane]);
                    let error = there - slowly(&rows, place, *column);
                    squares[usize::from(*lane >= ROOT_LANE)] += error * error;
                }
                for (square, stated) in squares.iter().zip(errors) {
                    prop_assert!(square.sqrt() <= f64::from(stated), "{} {}", square.sqrt(), stated);
                }
            }
        }

        #[test]
        fn any_bytes_are_a_sketch_or_none(bytes in prop::collection::vec(any::<u8>(), 0..400), blocks in prop::option::of(0u32..5)) {
            let mut bytes = bytes;
            let rows = blocks.unwrap_or(7) * BLOCK as u32;
            if let Some(blocks) = blocks {
                bytes.resize(HEAD + BOX_BYTES + SCALES_BYTES + blocks as usize * BLOCK_BYTES, 3);
            }
            if let Some(head) = bytes.first_chunk_mut::<4>() {
                *head = rows.to_le_bytes();
            }
            let (mut read, tables) = (Sketch::default(), SketchTables::new());
            if let Some(bytes) = SketchBytes::of(&bytes) {
                read.read(&bytes, &tables);
                read.until(rows as usize * PLACES, 0, &tables);
            }
        }
    }

    #[test]
    fn rows_beyond_what_bytes_hold_have_no_sketch() {
        let mut row = [0f32; DIM];
        row[DIM - 1] = f32::INFINITY;
        assert!(sketch(&Rows::from_values(DIM, row.to_vec())).is_none());
        row = [0f32; DIM];
        row[0] = 3.0;
        assert!(sketch(&Rows::from_values(DIM, row.to_vec())).is_none());
        assert!(SketchBytes::of(&[]).is_none());
    }
}
