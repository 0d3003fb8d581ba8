//! Feature rows in about three bits a value, for keeping.
//!
//! Values are rounded to 1/64 and written in [blocks](crate::blocks), which are read at about the speed of memory. The first `u32` is the
//! number of rows; its top two bits say so.
//!
//! Rows of earlier releases are read here as well. In these a row is foreseen, because it says much twice: where a bone points
//! follows from where it pointed and how it turned; a bone moves at right angles to its direction, so that two
//! coordinates of its velocity give the third; and motion goes on as it began. What nothing foretells went through an
//! adaptive range coder: less than two bits a value, and 22 ns to read one. Its binary digits are [counted](Whole::counted) if the top bit
//! alone is set, and a tree of choices otherwise.

use mocap::coder::{Coder, Reader, Whole};

use crate::blocks::{read_blocks, write_blocks};
use crate::retime::unsaturated;
use crate::{FeatureParams, RowLayout, Rows};

/// In the number of rows: they are in blocks.
const BLOCKS: u32 = 3 << 30;
/// In the number of rows: digits are counted.
const COUNTED: u32 = 1 << 31;

/// Values are whole multiples of this.
const STEP: f64 = 1.0 / 64.0;
/// Levels stay within this; rows hold directions and saturated velocities, so only root motion could come near.
const LIMIT: i64 = 1 << 24;
/// Share of the last change that is expected again.
const GOES_ON: f64 = 0.3;
/// Of a velocity's share of its largest: nearer to saturation than this says no more about its size.
const MOST_SATURATED: f64 = 0.95;

impl Rows {
    /// The rows in few bytes, each value moved by 1/128 at most (values are held to ±2^18; what is no number
    /// becomes 0). O(values).
    pub fn to_packed(&self) -> Vec<u8> {
        let levels = self.values().iter().map(|value| level(f64::from(*value)));
        let levels: Vec<i32> = levels.map(|level| level as i32).collect();
        let mut bytes = (self.len() as u32 | BLOCKS).to_le_bytes().to_vec();
        write_blocks(&levels, self.dim(), &mut bytes);
        bytes
    }

    /// Reads rows of `dim` values that [`to_packed`](Self::to_packed) of this release or an earlier one wrote; `None` if the bytes are damaged.
    /// `params` must be those that rows of earlier releases were made with: their directions are predicted from velocities.
    pub fn from_packed(bytes: &[u8], dim: usize, params: &FeatureParams) -> Option<Rows> {
        let (len, codes) = bytes.split_first_chunk::<4>()?;
        let len = u32::from_le_bytes(*len);
        let layout = RowLayout::from_dim(dim)?;
        let rows = (len & !BLOCKS) as usize;
        match len & BLOCKS {
            BLOCKS => {
                let values = read_blocks(codes, rows, dim, STEP as f32)?;
                Some(Rows::from_values(dim, values))
            }
            mark => foreseen(codes, rows, layout, params, mark == COUNTED),
        }
    }
}

/// Rows of earlier releases.
fn foreseen(
    codes: &[u8],
    len: usize,
    layout: RowLayout,
    params: &FeatureParams,
    is_counted: bool,
) -> Option<Rows> {
    let mut forecast = Forecast::new(layout, params, is_counted);
    let mut coder = Reader::new(codes);
    let mut rows = Rows::new(layout.dim());
    let (mut levels, mut row) = (vec![0i64; layout.dim()], vec![0f32; layout.dim()]);
    for _ in 0..len {
        forecast.row(&mut coder, &mut levels);
        // Every row takes a share of a bit at least: what claims to be endless ends here.
        if coder.is_beyond_end() {
            return None;
        }
        row.iter_mut()
            .zip(&levels)
            .for_each(|(value, level)| *value = (*level as f64 * STEP) as f32);
        rows.push(&row);
    }
    Some(rows)
}

fn level(value: f64) -> i64 {
    rounded(value / STEP)
}

/// The nearest whole number within the limit, halves away from zero; 0 of what is no number. `f64::round` would be a call to the
/// C library, because the oldest x86-64 processors have no instruction for it.
fn rounded(value: f64) -> i64 {
    let value = value.clamp(-LIMIT as f64, LIMIT as f64);
    let whole = value as i64;
    let rest = value - whole as f64;
    whole + i64::from(rest >= 0.5) - i64::from(rest <= -0.5)
}

/// Forecast of the next row, and past errors of forecasts of each kind.
struct Forecast {
    layout: RowLayout,
    bones: Vec<BoneHistory>,
    root: [CoordinateHistory; RowLayout::ROOT],
    tick_secs: f64,
    saturation: f64,
    velocity_weight: f64,
    /// The first two coordinates of a velocity.
    velocity: [Misses; 2],
    /// The third, from the direction.
    across: Misses,
    direction: Misses,
    root_misses: [Misses; RowLayout::ROOT],
}

/// A coordinate's last two levels, and how far the last forecast of it was off.
#[derive(Clone, Copy, Default)]
struct CoordinateHistory {
    last: i64,
    before: i64,
    missed: u64,
}

#[derive(Clone, Default)]
struct BoneHistory {
    velocity: [CoordinateHistory; 3],
    direction: [CoordinateHistory; 3],
    /// Velocity before it was saturated, per second.
    rate: [f64; 3],
}

/// Numbers, foreseen by how large those around them were.
struct Misses([Whole; 12]);

impl Forecast {
    fn new(layout: RowLayout, params: &FeatureParams, is_counted: bool) -> Self {
        let new = || {
            Misses(std::array::from_fn(|_| match is_counted {
                true => Whole::counted(),
                false => Whole::of_few_digits(),
            }))
        };
        Self {
            layout,
            bones: vec![BoneHistory::default(); layout.bones()],
            root: Default::default(),
            tick_secs: 1.0 / params.tick_hz(),
            saturation: params.velocity_saturation,
            velocity_weight: params.velocity_weight,
            velocity: std::array::from_fn(|_| new()),
            across: new(),
            direction: new(),
            root_misses: std::array::from_fn(|_| new()),
        }
    }

    /// Reads a row's levels; a writer writes them.
    fn row(&mut self, coder: &mut impl Coder, levels: &mut [i64]) {
        let (directions, rest) = levels.split_at_mut(self.layout.directions().len());
        let (velocities, root) = rest.split_at_mut(self.layout.velocities().len());
        let mut bones = std::mem::take(&mut self.bones);
        let of_bones = directions
            .as_chunks_mut()
            .0
            .iter_mut()
            .zip(velocities.as_chunks_mut().0);
        for (bone, (direction, velocity)) in bones.iter_mut().zip(of_bones) {
            self.velocity(coder, bone, velocity);
            self.direction(coder, bone, direction);
        }
        self.bones = bones;
        for ((level, channel), misses) in root
            .iter_mut()
            .zip(&mut self.root)
            .zip(&mut self.root_misses)
        {
            let expected = channel.goes_on();
            *level = misses.code(coder, channel, expected, *level, 0);
        }
    }

    fn velocity(&mut self, coder: &mut impl Coder, bone: &mut BoneHistory, levels: &mut [i64; 3]) {
        let expected: [f64; 3] = std::array::from_fn(|axis| {
            bone.direction[axis].last as f64 * STEP + bone.rate[axis] * self.tick_secs
        });
        // The largest coordinate of the direction comes last: dividing by it is safe.
        let largest = (0..3)
            .max_by(|a, b| expected[*a].abs().total_cmp(&expected[*b].abs()))
            .unwrap_or(2);
        let [first, second] = [(largest + 1) % 3, (largest + 2) % 3];
        let mut around = 0;
        for (axis, misses) in [first, second].into_iter().zip(&mut self.velocity) {
            let channel = &mut bone.velocity[axis];
            let forecast = channel.goes_on();
            levels[axis] = misses.code(coder, channel, forecast, levels[axis], around);
            around += channel.missed;
        }
        let channel = &mut bone.velocity[largest];
        let along =
            expected[first] * levels[first] as f64 + expected[second] * levels[second] as f64;
        let across = -along / expected[largest];
        let forecast = if expected[largest].abs() > STEP {
            across
        } else {
            channel.goes_on()
        };
        levels[largest] = self
            .across
            .code(coder, channel, forecast, levels[largest], around / 2);
    }

    fn direction(&mut self, coder: &mut impl Coder, bone: &mut BoneHistory, levels: &mut [i64; 3]) {
        let rate = self.unsaturated(bone.velocity.map(|channel| channel.last as f64 * STEP));
        let mut around = 0;
        for axis in 0..3 {
            let channel = &mut bone.direction[axis];
            let turned = (bone.rate[axis] + rate[axis]) / 2.0 * self.tick_secs;
            let forecast = channel.last as f64 + turned / STEP;
            levels[axis] = self
                .direction
                .code(coder, channel, forecast, levels[axis], around);
            around = channel.missed;
        }
        bone.rate = rate;
    }

    /// Bone velocity before the weight and the saturation.
    fn unsaturated(&self, velocity: [f64; 3]) -> [f64; 3] {
        let velocity = velocity.map(|v| v / self.velocity_weight);
        unsaturated(velocity, self.saturation, MOST_SATURATED)
    }
}

impl CoordinateHistory {
    /// The next level if the last change goes on in part.
    fn goes_on(&self) -> f64 {
        self.last as f64 + GOES_ON * (self.last - self.before) as f64
    }
}

impl Misses {
    /// Codes how far `level` is from what was expected; `around`: how far others like it have just been off.
    fn code(
        &mut self,
        coder: &mut impl Coder,
        channel: &mut CoordinateHistory,
        expected: f64,
        level: i64,
        around: u64,
    ) -> i64 {
        let expected = rounded(expected);
        let digits = u64::BITS - (2 * channel.missed + around).leading_zeros();
        let whole = &mut self.0[(digits as usize).min(11)];
        let level = expected
            .saturating_add(whole.signed(coder, level - expected))
            .clamp(-LIMIT, LIMIT);
        *channel = CoordinateHistory {
            last: level,
            before: channel.last,
            missed: level.abs_diff(expected),
        };
        level
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::BoneSet;
    use mocap::coder::Writer;
    use proptest::prelude::*;

    /// Rows as earlier releases wrote them.
    fn packed_before(rows: &Rows, params: &FeatureParams, is_counted: bool) -> Vec<u8> {
        let mark = if is_counted { COUNTED } else { 0 };
        let layout = RowLayout::from_dim(rows.dim()).unwrap();
        let mut forecast = Forecast::new(layout, params, is_counted);
        let mut coder = Writer::new();
        for row in rows.iter() {
            let mut levels: Vec<i64> = row.iter().map(|value| level(f64::from(*value))).collect();
            forecast.row(&mut coder, &mut levels);
        }
        let mut bytes = (rows.len() as u32 | mark).to_le_bytes().to_vec();
        bytes.extend(coder.finish());
        bytes
    }

    proptest! {
        #[test]
        fn values_are_within_half_a_step(values in prop::collection::vec(-9f32..9.0, 0..400), bones in 0usize..4) {
            let bones = (0..bones).fold(BoneSet::NONE, BoneSet::with);
            let rows = Rows::from_values(RowLayout::of(bones).dim(), values);
            let params = FeatureParams::default();
            let again = Rows::from_packed(&rows.to_packed(), rows.dim(), &params).unwrap();
            prop_assert_eq!(again.len(), rows.len());
            for (a, b) in rows.values().iter().zip(again.values()) {
                prop_assert!((a - b).abs() <= 0.5 * STEP as f32 + 1e-6);
            }
            for is_counted in [false, true] {
                let before = packed_before(&rows, &params, is_counted);
                prop_assert_eq!(&Rows::from_packed(&before, rows.dim(), &params).unwrap(), &again);
            }
            // What has been rounded is not rounded again.
            prop_assert_eq!(Rows::from_packed(&again.to_packed(), rows.dim(), &params).unwrap(), again);
        }

        #[test]
        fn wild_values_do_no_harm(values in prop::collection::vec(any::<f32>(), 0..200)) {
            let rows = Rows::from_values(10, values);
            let params = FeatureParams::default();
            let again = Rows::from_packed(&rows.to_packed(), 10, &params).unwrap();
            for (a, b) in rows.values().iter().zip(again.values()) {
                let held = if a.is_nan() { 0.0 } else { a.clamp(-(1 << 18) as f32, (1 << 18) as f32) };
                prop_assert!((held - b).abs() <= 0.5 * STEP as f32 + held.abs() * 1e-6);
            }
        }

        #[test]
        fn rounding_is_that_of_the_standard_library(value in any::<f64>(), near in -300.0..300f64, halves in -100i32..100) {
            let half = f64::from(halves) / 2.0;
            for value in [value, near, half, half.next_up(), half.next_down(), f64::INFINITY, f64::NAN] {
                prop_assert_eq!(rounded(value), (value.round() as i64).clamp(-LIMIT, LIMIT), "{}", value);
            }
        }

        #[test]
        fn any_bytes_are_rows_or_nothing(bytes in prop::collection::vec(any::<u8>(), 0..300), dim in 0usize..20, mark in 0u8..4) {
            let _ = Rows::from_packed(&bytes, dim, &FeatureParams::default());
            // Few rows, of each kind.
            let marked: Vec<u8> = [9, 0, 0, mark << 6].into_iter().chain(bytes).collect();
            let _ = Rows::from_packed(&marked, dim, &FeatureParams::default());
        }

        #[test]
        fn what_is_cut_short_is_nothing(keep in 0usize..100) {
            let rows = Rows::from_values(10, (0..1000).map(|i| ((i * i) as f32).sin()).collect());
            let params = FeatureParams::default();
            let bytes = rows.to_packed();
            prop_assert!(Rows::from_packed(&bytes[..keep.min(bytes.len() - 1)], 10, &params).is_none());
            let before = packed_before(&rows, &params, true);
            prop_assert!(Rows::from_packed(&before[..keep.min(before.len() / 2)], 10, &params).is_none());
        }
    }
}
