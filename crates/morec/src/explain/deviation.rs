//! How well a motion was performed: its bones against those of the nearest sample.

use crate::TimeSpan;
use crate::clip::{Clip, Span};
use crate::features::{ALL_BONES, BONE_WEIGHTS, BoneSet, Rows, all_bones_of_clip, rows_of_clip};
use crate::live::{Detection, Model};
use crate::roles::RoleMap;
use crate::templates::TemplateModel;
use crate::train::align;

use super::bones::angle_at;

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

/// A motion of a clip and how well it was performed.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Performance {
    /// Name of its clip.
    pub clip: String,
    /// Name of its class.
    pub class: String,
    /// When it happened, on the clip's clock.
    #[serde(flatten)]
    pub span: TimeSpan,
    /// It against the nearest sample.
    pub deviation: MotionDeviation,
}

/// A bone of a performance.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
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

/// Compares each of the motions `found` in `clip` with the sample of its class that it is nearest to, bone by bone; `None` where no samples
/// are kept: for activities, held poses and the method of 2009. `rest` are the frames that a conversion left at the start.
/// O(motions · samples · rows²).
pub fn deviation(
    model: &Model,
    (clip, roles, rest): (&Clip, &RoleMap, &Span),
    found: &[Detection],
) -> Vec<Option<MotionDeviation>> {
    let nothing = || vec![None; found.len()];
    let Model::Templates(model) = model else {
        return nothing();
    };
    let roles = &roles.for_bones(&clip.skeleton, model.bones);
    let Ok(model) = model.restricted(all_bones_of_clip(clip, roles, rest)) else {
        return nothing();
    };
    let rows = rows_of_clip(clip, roles, rest, model.bones, &model.features);
    found.iter().map(|d| of_motion(&model, &rows, d)).collect()
}

fn of_motion(model: &TemplateModel, rows: &Rows, found: &Detection) -> Option<MotionDeviation> {
    let hz = model.features.tick_hz();
    let ticks = found.span.frames_among(rows.len(), hz);
    let stretch = rows.slice(ticks.clone());
    if stretch.is_empty() {
        return None;
    }
    let samples = model.samples.iter().filter(|s| s.class == found.class);
    let compared = samples.map(|sample| {
        let compared = ComparedBones::new(&sample.rows, &stretch, model.bones);
        (compared.off_degrees(), compared, sample.rows.len())
    });
    let (_, nearest, length) = compared.min_by(|a, b| a.0.total_cmp(&b.0))?;
    let start_secs = ticks.start as f64 / hz;
    Some(nearest.deviation(stretch.len(), start_secs, 1.0 / hz, length))
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
    if sample.is_empty() || stretch.is_empty() || bones.is_empty() {
        return None;
    }
    let compared = ComparedBones::new(sample, stretch, bones);
    Some(compared.deviation(stretch.len(), start_secs, 1.0 / tick_hz, sample.len()))
}

/// Angles of every bone at every step of a warping path, in degrees.
struct ComparedBones {
    /// Ticks of the stretch along the path.
    ticks: Vec<usize>,
    /// For each bone its name, weight and angles.
    bones: Vec<(&'static str, f64, Vec<f64>)>,
}

impl ComparedBones {
    fn new(sample: &Rows, stretch: &Rows, bones: BoneSet) -> Self {
        let path = align(sample, stretch);
        let of_bone = |(slot, bone): (usize, usize)| {
            let angles = path
                .iter()
                .map(|&(i, j)| angle_at(sample, i, stretch, j, slot));
            (ALL_BONES[bone].name, BONE_WEIGHTS[bone], angles.collect())
        };
        Self {
            bones: bones.indices().enumerate().map(of_bone).collect(),
            ticks: path.iter().map(|(_, j)| *j).collect(),
        }
    }

    /// Weighted mean over bones at one step of the path.
    fn at(&self, step: usize) -> f64 {
        let weights: f64 = self.bones.iter().map(|(_, weight, _)| weight).sum();
        let sum: f64 = (self.bones.iter())
            .map(|(_, weight, angles)| weight * angles[step])
            .sum();
        sum / weights.max(f64::MIN_POSITIVE)
    }

    fn off_degrees(&self) -> f64 {
        (0..self.ticks.len()).map(|step| self.at(step)).sum::<f64>() / self.ticks.len() as f64
    }

    fn deviation(
        &self,
        ticks: usize,
        start_secs: f64,
        tick_secs: f64,
        length: usize,
    ) -> MotionDeviation {
        let mut over_time_degrees = vec![0.0; ticks];
        let mut steps = vec![0; ticks];
        for (step, tick) in self.ticks.iter().enumerate() {
            over_time_degrees[*tick] += self.at(step);
            steps[*tick] += 1;
        }
        for (degrees, steps) in over_time_degrees.iter_mut().zip(steps) {
            *degrees /= f64::from(steps.max(1));
        }
        let of_bone = |(bone, _, angles): &(&'static str, f64, Vec<f64>)| {
            let worst = (0..angles.len()).max_by(|a, b| angles[*a].total_cmp(&angles[*b]));
            let worst = worst.unwrap_or(0);
            BoneDeviation {
                bone,
                off_degrees: angles.iter().sum::<f64>() / angles.len() as f64,
                worst_degrees: angles[worst],
                worst_secs: start_secs + self.ticks[worst] as f64 * tick_secs,
            }
        };
        let mut bones: Vec<BoneDeviation> = self.bones.iter().map(of_bone).collect();
        bones.sort_by(|a, b| b.off_degrees.total_cmp(&a.off_degrees));
        MotionDeviation {
            off_degrees: self.off_degrees(),
            pace: ticks as f64 / length as f64,
            bones,
            over_time_degrees,
        }
    }
}
