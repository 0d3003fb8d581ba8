//! The trained data of the second look, as stored in an index.

use crate::classes::ClassId;
use crate::features::{BoneSet, Rows};
use crate::templates::bytes::{snapped, steps};
use crate::templates::{OperatingPoint, PackedSymmetric, PerformerKind, threshold_at};

use super::body::BodyTrack;
use super::segment::SEGMENT_ROWS;

/// Taught segments, their metric, and the bound of the score.
///
/// A segment's distance from a sample is `d = D / max(0.05, (V_T + V_S) / 2 V₀)^0.85`: `D` the mean squared distance along the cheapest
/// alignment, `V` the spreads of both, `V₀` their median over the samples. With `d₁` to the nearest sample of all classes the score is
///
/// - `s = ln(s_T / d₁)` for six classes and more, `s_T` the median over samples of the median distance from other classes;
/// - `t = ln(c₃ / d₁)` for one class, `c₃` the third smallest distance from stretches of other motion (the atlas);
/// - `½ (s + t)` in between: with few classes `s_T` says little.
#[derive(Debug, Clone, PartialEq)]
pub struct SecondLook {
    /// The class of each sample.
    pub classes: Vec<ClassId>,
    /// [`SEGMENT_ROWS`] rows of each sample, before the metric; of [`BodyTrack::columns`].
    pub segments: Rows,
    /// Rows of other motion in the same form; none for six classes and more.
    pub atlas: Rows,
    /// As [`TemplateModel::ridged`](crate::templates::TemplateModel::ridged), of these rows.
    pub ridged: PackedSymmetric,
    /// As [`TemplateModel::total`](crate::templates::TemplateModel::total), of these rows.
    pub total: PackedSymmetric,
    /// `s_T`; 0 where there is one class.
    pub scale: f32,
    /// Scores above it are reported.
    pub bound: f32,
    /// Bounds for other rates of false alarms, by ascending rate.
    pub operating: Vec<OperatingPoint>,
    /// Matches farther than this are no candidates.
    pub reach: f32,
    /// Median score of the taught samples, each among the others.
    pub own_score: f32,
    /// The performer that is expected.
    pub performer: PerformerKind,
    /// If rows are whole multiples of a step, column by column: the steps. Files then hold bytes.
    pub step: Option<Vec<f32>>,
}

impl SecondLook {
    /// Checks that all parts fit together, for an index over `bones` of `classes` classes.
    ///
    /// # Errors
    /// A sentence about the first part that does not fit.
    pub fn check(&self, bones: BoneSet, classes: usize) -> Result<(), String> {
        let expected = BodyTrack::columns(bones).len();
        let widths = [self.segments.dim(), self.ridged.dim(), self.total.dim()];
        let atlas = (!self.atlas.is_empty()).then(|| self.atlas.dim());
        if let Some(found) = widths.into_iter().chain(atlas).find(|w| *w != expected) {
            return Err(format!(
                "the second look has {found} values in a row, the bones give {expected}"
            ));
        }
        if self.segments.len() != SEGMENT_ROWS * self.classes.len() || self.classes.is_empty() {
            return Err(format!(
                "{} rows of the second look, expected {SEGMENT_ROWS} for each of {} samples",
                self.segments.len(),
                self.classes.len()
            ));
        }
        if !self.atlas.len().is_multiple_of(SEGMENT_ROWS) {
            return Err(format!(
                "{} rows of other motion, expected a multiple of {SEGMENT_ROWS}",
                self.atlas.len()
            ));
        }
        if let Some(class) = self.classes.iter().find(|class| class.index() >= classes) {
            return Err(format!("a segment of class {}, of {classes}", class.0));
        }
        let numbers = [self.scale, self.bound, self.reach, self.own_score];
        let sensible =
            numbers.iter().all(|v| v.is_finite()) && self.scale >= 0.0 && self.reach > 0.0;
        let has_score = self.scale > 0.0 || !self.atlas.is_empty();
        match sensible && has_score {
            true => Ok(()),
            false => Err(format!(
                "scale, bound and reach of the second look must be sensible, found {numbers:?}"
            )),
        }
    }

    /// With the bound for this rate of false alarms a minute; `None` if no rates are noted.
    pub fn with_sensitivity(&self, alarms_per_minute: f64) -> Option<Self> {
        let bound = threshold_at(&self.operating, alarms_per_minute)?;
        Some(Self {
            bound,
            ..self.clone()
        })
    }

    /// With every row moved to the nearest step of a byte, column by column: what a file holds, to the bit.
    #[must_use]
    pub fn compacted(self) -> Self {
        let step = steps([&self.segments, &self.atlas].into_iter(), self.ridged.dim());
        Self {
            segments: snapped(self.segments, &step),
            atlas: snapped(self.atlas, &step),
            step: Some(step),
            ..self
        }
    }

    /// With the columns that `kept` places of those that `bones` place. The scale is measured anew.
    pub fn restricted(&self, bones: BoneSet, kept: BoneSet) -> Self {
        let left = BodyTrack::columns(kept);
        let places = BodyTrack::columns(bones).into_iter().enumerate();
        let keep: Vec<usize> = places
            .filter(|(_, column)| left.contains(column))
            .map(|(place, _)| place)
            .collect();
        let mut look = Self {
            segments: self.segments.columns(&keep),
            atlas: self.atlas.columns(&keep),
            ridged: self.ridged.restricted(&keep),
            total: self.total.restricted(&keep),
            step: (self.step.as_ref()).map(|step| keep.iter().map(|k| step[*k]).collect()),
            ..self.clone()
        };
        look.scale = look.measured_scale();
        look
    }

    /// Rows of one sample.
    pub fn segment(&self, sample: usize) -> &[f32] {
        let values = SEGMENT_ROWS * self.segments.dim();
        &self.segments.values()[sample * values..][..values]
    }
}
