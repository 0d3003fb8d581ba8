//! Compares a performed motion with the nearest sample, bone by bone.

use crate::TimeSpan;
use crate::features::{ALL_BONES, BONE_WEIGHTS, BoneSet, Rows};
use crate::math::portable;

use super::align::WarpingPath;

/// A performance against the nearest sample of its class.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct MotionDeviation {
    /// Mean angle between its bones and the sample's along the warping path, degrees: 0 if it is the sample. Bones count by their weights
    /// in feature rows.
    pub off_degrees: f64,
    /// Its duration over the sample's.
    pub pace: f64,
    /// Every bone, the one that is farthest off first.
    pub bones: Vec<BoneDeviation>,
    /// The same angle at each of its ticks, from its start.
    pub over_time_degrees: Vec<f64>,
}

impl MotionDeviation {
    /// The angle over time of a performance in `span`: seconds and degrees.
    pub fn curve(&self, span: TimeSpan) -> impl Iterator<Item = (f64, f64)> {
        let tick_secs = span.duration_secs() / self.over_time_degrees.len().max(1) as f64;
        let at = move |tick: usize| span.start_secs + (tick as f64 + 0.5) * tick_secs;
        let degrees = self.over_time_degrees.iter().enumerate();
        degrees.map(move |(tick, degrees)| (at(tick), *degrees))
    }

    /// When all of it was farthest off, and by how much, of the same performance.
    pub fn worst(&self, span: TimeSpan) -> Option<(f64, f64)> {
        self.curve(span).max_by(|a, b| a.1.total_cmp(&b.1))
    }
}

/// A bone of a performance.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct BoneDeviation {
    /// Name of the bone.
    pub bone: &'static str,
    /// Mean angle between the two along the warping path, degrees.
    pub off_degrees: f64,
    /// The largest, and when, on the clip's clock.
    pub worst_degrees: f64,
    /// When that was.
    pub worst_secs: f64,
}

/// A performance against the nearest sample in short, for an event: [`MotionDeviation`] with its first bone.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Deviation {
    /// Mean angle between its bones and the nearest sample's, degrees; 0 if it is the sample.
    pub off_degrees: f64,
    /// Its duration over the sample's, which an event has of its own.
    #[serde(skip)]
    pub pace: f64,
    /// Name of the bone that is farthest off.
    pub worst_bone: &'static str,
    /// The largest angle of that bone, degrees.
    pub worst_degrees: f64,
}

/// Compares one performance with another, bone by bone: rows of `bones`, `tick_hz` a second, those of `stretch` from `start_secs` on.
/// `None` without rows or bones. O(rows²).
pub fn deviation_from(
    sample: &Rows,
    stretch: &Rows,
    bones: BoneSet,
    start_secs: f64,
    tick_hz: f64,
) -> Option<MotionDeviation> {
    let mut meter = DeviationMeter::new(bones, tick_hz);
    meter.compare([sample].into_iter(), stretch, false)?;
    Some(meter.motion(start_secs))
}

/// Compares performances with samples, and holds the angles of the last.
#[derive(Debug, Clone)]
pub struct DeviationMeter {
    bones: BoneSet,
    tick_hz: f64,
    warping: WarpingPath,
    /// Ticks of the stretch along the path to the nearest sample.
    ticks: Vec<usize>,
    /// At each step of that path the angle of every bone, degrees.
    angles: Vec<f64>,
    /// Rows of the stretch, and of the sample.
    lengths: (usize, usize),
}

impl DeviationMeter {
    /// For rows of `bones`, `tick_hz` a second.
    pub fn new(bones: BoneSet, tick_hz: f64) -> Self {
        Self::with_room(bones, tick_hz, (0, 0))
    }

    /// The same with room for samples and stretches of so many rows: within it, nothing is allocated until [`motion`](Self::motion) is asked
    /// for.
    pub fn with_room(bones: BoneSet, tick_hz: f64, (sample, stretch): (usize, usize)) -> Self {
        let steps = 2 * sample + stretch;
        Self {
            bones,
            tick_hz,
            warping: WarpingPath::with_room(sample, stretch),
            ticks: Vec::with_capacity(steps),
            angles: Vec::with_capacity(steps * bones.len()),
            lengths: (0, 0),
        }
    }

    /// Another with as much room.
    #[must_use]
    pub fn emptied(&self) -> Self {
        Self {
            warping: self.warping.emptied(),
            ticks: Vec::with_capacity(self.ticks.capacity()),
            angles: Vec::with_capacity(self.angles.capacity()),
            ..*self
        }
    }

    /// Finds the sample that `stretch` is nearest to; `None` without rows or bones. With `around`, samples are turns of what repeats.
    /// O(samples · rows²).
    pub fn compare<'r>(
        &mut self,
        samples: impl Iterator<Item = &'r Rows> + Clone,
        stretch: &Rows,
        around: bool,
    ) -> Option<()> {
        if stretch.is_empty() || self.bones.is_empty() {
            return None;
        }
        let mut nearest: Option<(f64, &Rows)> = None;
        let mut last = None;
        for sample in samples.filter(|sample| !sample.is_empty()) {
            self.measure(sample, stretch, around);
            let off = self.off_degrees();
            if nearest.is_none_or(|(least, _)| off < least) {
                nearest = Some((off, sample));
            }
            last = Some(sample);
        }
        let (_, nearest) = nearest?;
        if !last.is_some_and(|last| std::ptr::eq(last, nearest)) {
            self.measure(nearest, stretch, around);
        }
        Some(())
    }

    fn measure(&mut self, sample: &Rows, stretch: &Rows, around: bool) {
        self.ticks.clear();
        self.angles.clear();
        self.lengths = (stretch.len(), sample.len());
        for &(i, j) in self.warping.align(sample, stretch, around) {
            self.ticks.push(j);
            let slots = 0..self.bones.len();
            (self.angles).extend(slots.map(|slot| angle_at(sample, i, stretch, j, slot)));
        }
    }

    /// Angles of the bone in `slot`, step by step.
    fn of_slot(&self, slot: usize) -> impl Iterator<Item = f64> {
        let steps = self.angles.chunks_exact(self.bones.len());
        steps.map(move |angles| angles[slot])
    }

    /// Weighted mean over bones at each step of the path.
    fn steps(&self) -> impl Iterator<Item = f64> {
        let weights = || self.bones.indices().map(|bone| BONE_WEIGHTS[bone]);
        let sum: f64 = weights().sum();
        let steps = self.angles.chunks_exact(self.bones.len());
        steps.map(move |angles| {
            let weighted = angles
                .iter()
                .zip(weights())
                .map(|(angle, weight)| weight * angle);
            weighted.sum::<f64>() / sum.max(f64::MIN_POSITIVE)
        })
    }

    fn off_degrees(&self) -> f64 {
        self.steps().sum::<f64>() / self.ticks.len() as f64
    }

    fn pace(&self) -> f64 {
        let (stretch, sample) = self.lengths;
        stretch as f64 / sample as f64
    }

    fn bones(&self, start_secs: f64) -> impl Iterator<Item = BoneDeviation> {
        let steps = self.ticks.len();
        self.bones.indices().enumerate().map(move |(slot, bone)| {
            let worst = (self.of_slot(slot).enumerate()).max_by(|a, b| a.1.total_cmp(&b.1));
            let (step, worst_degrees) = worst.unwrap_or((0, 0.0));
            BoneDeviation {
                bone: ALL_BONES[bone].name,
                off_degrees: self.of_slot(slot).sum::<f64>() / steps as f64,
                worst_degrees,
                worst_secs: start_secs + self.ticks[step] as f64 / self.tick_hz,
            }
        })
    }

    /// The performance that was compared, in short. No allocation.
    pub fn in_short(&self) -> Option<Deviation> {
        let farthest = |a: BoneDeviation, b: BoneDeviation| match b.off_degrees > a.off_degrees {
            true => b,
            false => a,
        };
        let worst = self.bones(0.0).reduce(farthest)?;
        Some(Deviation {
            off_degrees: self.off_degrees(),
            pace: self.pace(),
            worst_bone: worst.bone,
            worst_degrees: worst.worst_degrees,
        })
    }

    /// The performance that was compared, which began at `start_secs`.
    pub fn motion(&self, start_secs: f64) -> MotionDeviation {
        let ticks = self.lengths.0;
        let mut over_time_degrees = vec![0.0; ticks];
        let mut steps = vec![0; ticks];
        for (degrees, tick) in self.steps().zip(&self.ticks) {
            over_time_degrees[*tick] += degrees;
            steps[*tick] += 1;
        }
        for (degrees, steps) in over_time_degrees.iter_mut().zip(steps) {
            *degrees /= f64::from(steps.max(1));
        }
        let mut bones: Vec<BoneDeviation> = self.bones(start_secs).collect();
        bones.sort_by(|a, b| b.off_degrees.total_cmp(&a.off_degrees));
        MotionDeviation {
            off_degrees: self.off_degrees(),
            pace: self.pace(),
            bones,
            over_time_degrees,
        }
    }
}

/// Angle between the directions of the bone in `slot` in row `i` of `a` and row `j` of `b`, degrees.
pub fn angle_at(a: &Rows, i: usize, b: &Rows, j: usize, slot: usize) -> f64 {
    let at = |rows: &Rows, i: usize| {
        let row = &rows.row(i)[3 * slot..3 * slot + 3];
        [f64::from(row[0]), f64::from(row[1]), f64::from(row[2])]
    };
    angle(at(a, i), at(b, j)).to_degrees()
}

fn angle(a: [f64; 3], b: [f64; 3]) -> f64 {
    let dot = |a: &[f64; 3], b: &[f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let lengths = (dot(&a, &a) * dot(&b, &b)).sqrt();
    if lengths > 1e-12 {
        portable::acos((dot(&a, &b) / lengths).clamp(-1.0, 1.0))
    } else {
        0.0
    }
}
