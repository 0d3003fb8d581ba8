//! A window in the sketch of a clip: its parts from prefix sums, and the bounds of their error.

use super::boxes::total;
use super::layout::ROOT_WEIGHT;
use super::probe::{OCTAVES, SIDE, SharedLanes, SketchProbe};
use super::sketch::{LANES, PLACES, ROOT_LANE, Sketch, SketchLanes, SketchTables};
use super::windows::TRAVEL;

/// Parts of a window in the last octave.
pub const PARTS: usize = 1 << OCTAVES;

/// A window in a sketch: prefix sums at the ends of its eighths, and their errors.
pub struct WindowSketch {
    start: usize,
    rows: usize,
    per_row: f32,
    ends: [SketchLanes; PARTS + 1],
    errors: [[f32; 2]; PARTS + 1],
    /// True if what lies between its halves is there.
    halved: bool,
    /// True if all are.
    complete: bool,
}

impl Default for WindowSketch {
    fn default() -> Self {
        Self {
            start: 0,
            rows: 1,
            per_row: 1.0,
            ends: [SketchLanes::ZERO; PARTS + 1],
            errors: [[0.0; 2]; PARTS + 1],
            halved: false,
            complete: false,
        }
    }
}

impl WindowSketch {
    /// Turns to another window.
    #[inline(always)]
    pub fn turn(&mut self, start: usize, rows: usize) {
        (self.start, self.rows, self.per_row) = (start, rows, 1.0 / rows as f32);
        (self.halved, self.complete) = (false, false);
    }

    /// Takes prefix sums at the beginnings of these parts, or the end of all.
    #[inline(always)]
    pub fn take<const N: usize>(
        &mut self,
        sketch: &Sketch,
        tables: &SketchTables,
        parts: [usize; N],
    ) {
        for part in parts {
            self.end(sketch, tables, part);
        }
    }

    /// Takes what lies between the halves.
    #[inline(always)]
    pub fn take_halves(&mut self, sketch: &Sketch, tables: &SketchTables) {
        if !self.halved {
            self.take(sketch, tables, [PARTS / 2]);
            self.halved = true;
        }
    }

    /// Place at which a part begins, in eighths of rows.
    #[inline(always)]
    fn place(&self, part: usize) -> usize {
        self.start * PLACES + self.rows * part
    }

    /// Takes the ends of the other parts.
    #[inline(always)]
    pub fn take_eighths(&mut self, sketch: &Sketch, tables: &SketchTables) {
        if !self.complete {
            self.take(sketch, tables, [1, 2, 3, 5, 6, 7]);
            self.complete = true;
        }
    }

    #[inline(always)]
    fn end(&mut self, sketch: &Sketch, tables: &SketchTables, part: usize) {
        let (base, place) = (sketch.block(self.place(0)), self.place(part));
        self.errors[part] = sketch.errors(place);
        self.ends[part] = sketch.until(place, base, tables);
    }

    /// The energy of each lane in an octave, a mean over its pairs, is added to `energy`; the square of what its root may be off.
    #[inline(always)]
    pub fn energy(&self, octave: usize, energy: &mut SketchLanes) -> f32 {
        let (pairs, width) = (1 << octave, PARTS >> octave);
        let share = 1.0 / pairs as f32;
        let per_row = pairs as f32 * self.per_row;
        let mut sums = SketchLanes::ZERO;
        let mut moved = 0f32;
        for pair in 0..pairs {
            let [a, b, c] = [0, width / 2, width].map(|part| pair * width + part);
            let [left, middle, right] = [&self.ends[a].0, &self.ends[b].0, &self.ends[c].0];
            for lane in 0..LANES {
                // Half of what the means of the two halves differ by.
                let h = (2.0 * middle[lane] - left[lane] - right[lane]) * per_row;
                sums.0[lane] += h * h;
            }
            let error = self.errors[a][0] + 2.0 * self.errors[b][0] + self.errors[c][0];
            moved += (error * per_row).powi(2);
        }
        for lane in 0..LANES {
            energy.0[lane] += sums.0[lane] * share;
        }
        moved * share
    }

    /// Squares of what the deviations in an octave differ by, and of what they may be off.
    #[inline(always)]
    fn octave(&self, octave: usize, probe: &SketchProbe, squares: &mut SketchLanes) -> f32 {
        let mut energy = SketchLanes::ZERO;
        let moved = self.energy(octave, &mut energy);
        for lane in 0..LANES {
            let apart = probe.octaves[octave].0[lane] - energy.0[lane].sqrt();
            squares.0[lane] += apart * apart;
        }
        moved
    }

    /// Distance of the deviations between the halves, at least.
    #[inline(always)]
    pub fn halves(&self, probe: &SketchProbe, shared: &SharedLanes) -> f32 {
        let mut squares = SketchLanes::ZERO;
        let moved = self.octave(0, probe, &mut squares);
        (masked_sum(&squares, shared).sqrt() - moved.sqrt()).max(0.0)
    }

    /// Distance of the deviations in the upper octaves, at least: of as many as give most.
    #[inline(always)]
    pub fn eighths(&self, probe: &SketchProbe, shared: &SharedLanes) -> f32 {
        let (mut squares, mut moved, mut most) = (SketchLanes::ZERO, 0f32, 0f32);
        for octave in 0..OCTAVES {
            moved += self.octave(octave, probe, &mut squares);
            most = most.max(masked_sum(&squares, shared).sqrt() - moved.sqrt());
        }
        most
    }

    /// Distance of the mean pose, at least.
    #[inline(always)]
    pub fn pose(&self, probe: &SketchProbe, shared: &SharedLanes) -> f32 {
        let (first, last) = (&self.ends[0].0, &self.ends[PARTS].0);
        let mut squares = SketchLanes::ZERO;
        for lane in 0..LANES {
            let mean = (last[lane] - first[lane]) * self.per_row;
            let apart = probe.pose.0[lane] - mean;
            squares.0[lane] = apart * apart;
        }
        let moved = (self.errors[0][0] + self.errors[PARTS][0]) * self.per_row;
        (masked_sum(&squares, shared).sqrt() - moved).max(0.0)
    }

    /// Mean root motion.
    #[inline(always)]
    pub fn mean_travel(&self) -> [f32; TRAVEL] {
        let (first, last) = (&self.ends[0].0, &self.ends[PARTS].0);
        let per_row = self.per_row / ROOT_WEIGHT as f32;
        let mut mean = [0f32; TRAVEL];
        for i in 0..TRAVEL {
            mean[i] = (last[ROOT_LANE + i] - first[ROOT_LANE + i]) * per_row;
        }
        mean
    }

    /// Distance of the travel, at least; that of the window begins at `at` in `travels`.
    #[inline(always)]
    pub fn travel(&self, probe: &SketchProbe, travels: &[f32; SIDE], at: usize) -> f32 {
        let mut squares = 0f32;
        for i in 0..TRAVEL {
            let apart = probe.travel[i] - travels[at + i];
            squares += apart * apart;
        }
        // The inverse hyperbolic sine is nowhere steeper than 1; of four values each may be off.
        let per_row = self.per_row / ROOT_WEIGHT as f32;
        let moved = (self.errors[0][1] + self.errors[PARTS][1]) * per_row + 2.0 * ASINH_ERROR;
        (squares.sqrt() - moved).max(0.0)
    }
}

/// The sum of the lanes of shared bones, by halves. Loops and no closures: these would be compiled for the oldest processor.
#[inline(always)]
fn masked_sum(lanes: &SketchLanes, shared: &SharedLanes) -> f32 {
    let (lanes, mask) = (&lanes.0, &shared.mask.0);
    let mut sixteen = [0f32; SIDE];
    for i in 0..SIDE {
        sixteen[i] =
            lanes[i] * mask[i] + lanes[16 + i] * mask[16 + i] + lanes[32 + i] * mask[32 + i];
    }
    total(&sixteen)
}

/// How far [`asinh`] may be off.
const ASINH_ERROR: f32 = 2e-5;

/// Inverse hyperbolic sines of root motion, in few operations and none that branches.
#[inline(always)]
pub fn asinh(values: &[f32; SIDE]) -> [f32; SIDE] {
    const LN: [f32; 6] = [
        0.030_449,
        -0.283_826_85,
        1.116_09,
        -2.440_029_8,
        3.514_087_3,
        -1.936_759_7,
    ];
    let mut out = [0f32; SIDE];
    for i in 0..SIDE {
        let x = values[i];
        // asinh |x| = ln y = e ln 2 + ln m, of which the last is a polynomial in m, from 1 to 2.
        let y = x.abs() + (x * x + 1.0).sqrt();
        let bits = y.to_bits();
        let exponent = ((bits >> 23) as i32 - 127) as f32;
        let m = f32::from_bits((bits & 0x007F_FFFF) | 0x3F80_0000);
        let ln = ((((LN[0] * m + LN[1]) * m + LN[2]) * m + LN[3]) * m + LN[4]) * m + LN[5];
        out[i] = (exponent * std::f32::consts::LN_2 + ln).copysign(x);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_quick_inverse_hyperbolic_sine_is_within_its_error() {
        for i in 0..400_000 {
            let x = (i as f32 / 20_000.0 - 10.0).exp();
            for x in [x, -x, 0.0, 1.0 / x] {
                let exact = f64::from(x).asinh();
                let off = f64::from(asinh(&[x; SIDE])[3]) - exact;
                assert!(off.abs() <= f64::from(ASINH_ERROR), "{x}: {off}");
            }
        }
    }
}
