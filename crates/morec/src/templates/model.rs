//! A trained set of templates: what an index file holds for this method.

use crate::classes::ClassInfo;
use crate::decode::{CandidatePolicy, DecodeParams};
use crate::features::{BoneSet, FeatureParams, RowLayout, Rows};
use crate::math::portable;
use crate::templates::second_look::SecondLook;

use super::sample::TemplateSample;
use super::{
    Activities, Calibration, Evidence, Exemplars, HeldPoses, OperatingPoint, PackedSymmetric,
    PerformerKind, StrangerGate, Verifier, threshold_at,
};

/// Everything the template recogniser needs, immutable.
#[derive(Debug, Clone, PartialEq)]
pub struct TemplateModel {
    /// Parameters of feature rows.
    pub features: FeatureParams,
    /// Bones of the rows.
    pub bones: BoneSet,
    /// Parameters of decoding.
    pub decode: DecodeParams,
    /// The classes; a [`ClassId`](crate::classes::ClassId) is an index into this.
    pub classes: Vec<ClassInfo>,
    /// Templates of the classes, before the metric.
    pub samples: Vec<TemplateSample>,
    /// Templates of what must not be taken for any class, before the metric.
    pub negatives: Vec<Rows>,
    /// `S_w + ρ tr(S_t)/d I`: see [`Metric::new`](super::Metric::new).
    pub ridged: PackedSymmetric,
    /// `S_t`.
    pub total: PackedSymmetric,
    /// Distances at or above this are never reported.
    pub threshold: f32,
    /// The same for each class by itself, of older indexes; empty if the one holds for all.
    pub class_thresholds: Vec<f32>,
    /// Thresholds for other rates of false alarms, ascending; empty in older indexes.
    pub operating: Vec<OperatingPoint>,
    /// Meaning of scores; older indexes report margins.
    pub calibration: Option<Calibration>,
    /// The wider gate for performers unlike the teacher; none in older indexes, and where many teach.
    pub stranger: Option<StrangerGate>,
    /// The second look at candidates, if there was enough to learn it from.
    pub verifier: Option<Verifier>,
    /// Poses of classes that are held, which have no templates; none in older indexes, and of bodies.
    pub held: Option<HeldPoses>,
    /// The second look at whole motions, which decides where there is one; none in older indexes, and of performers without a body.
    pub look: Option<SecondLook>,
    /// Windows of classes that are activities, which have no templates; none in older indexes.
    pub activities: Option<Activities>,
    /// If template rows are whole multiples of a step, column by column: the steps. Files then hold bytes.
    pub step: Option<Vec<f32>>,
}

/// Parts that do not fit together.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum TemplateModelError {
    /// A table's width is not what the bones give.
    #[error("{what} has {found} values in a row, the bones give {expected}")]
    Width {
        /// Name of the part.
        what: &'static str,
        /// Number expected from the bones.
        expected: usize,
        /// Number found.
        found: usize,
    },
    /// A number that must be sensible is not.
    #[error("{0}")]
    Value(String),
    /// The bones in common with a stream are too few to tell anything by.
    #[error("the stream shows no bone that the index uses")]
    NoBones,
}

impl TemplateModel {
    /// Checks that all parts fit together.
    ///
    /// # Errors
    /// The first part that does not fit the others.
    pub fn check(&self) -> Result<(), TemplateModelError> {
        self.features.check().map_err(TemplateModelError::Value)?;
        self.decode.check().map_err(TemplateModelError::Value)?;
        let expected = RowLayout::of(self.bones).dim();
        let tables = self.samples.iter().map(|s| ("a template", s.rows.dim()));
        let tables = tables.chain(self.negatives.iter().map(|r| ("a negative", r.dim())));
        let matrices = [
            ("the within-class covariance", self.ridged.dim()),
            ("the covariance", self.total.dim()),
        ];
        if let Some((what, found)) = tables.chain(matrices).find(|(_, found)| *found != expected) {
            return Err(TemplateModelError::Width {
                what,
                expected,
                found,
            });
        }
        if self.bones.is_empty() {
            return Err(TemplateModelError::NoBones);
        }
        if let Some(sample) = self
            .samples
            .iter()
            .find(|s| s.class.index() >= self.classes.len())
        {
            let message = format!(
                "a template of class {}, of {}",
                sample.class.0,
                self.classes.len()
            );
            return Err(TemplateModelError::Value(message));
        }
        if let Some(verifier) = &self.verifier {
            verifier
                .check(self.classes.len())
                .map_err(TemplateModelError::Value)?;
        }
        if let Some(stranger) = &self.stranger {
            stranger.check().map_err(TemplateModelError::Value)?;
        }
        if let Some(held) = &self.held {
            held.check(RowLayout::of(self.bones), self.classes.len())
                .map_err(TemplateModelError::Value)?;
        }
        if let Some(look) = &self.look {
            look.check(self.bones, self.classes.len())
                .map_err(TemplateModelError::Value)?;
        }
        if let Some(activities) = &self.activities {
            activities
                .check(RowLayout::of(self.bones), self.classes.len())
                .map_err(TemplateModelError::Value)?;
        }
        if !(self.threshold.is_finite() && self.threshold > 0.0) {
            let message = format!("the threshold must be above 0, found {}", self.threshold);
            return Err(TemplateModelError::Value(message));
        }
        self.check_class_thresholds()
            .and_then(|()| self.check_sizes())
            .map_err(TemplateModelError::Value)
    }

    /// Values of rows and covariances whose squares are no numbers any more would match everything or nothing.
    fn check_sizes(&self) -> Result<(), String> {
        /// Directions are within 1, velocities and the root within their saturation, all times weights of at most 100.
        const LARGEST: f32 = 1e4;
        let beyond = |values: &[f32], most: f32| {
            let mut values = values.iter();
            let value = values.find(|v| v.is_nan() || v.abs() > most)?;
            Some(format!("values must be within {most}, found {value}"))
        };
        let looks = || self.look.iter();
        let held = self.held.iter().map(|held| &held.poses);
        let activities = self.activities.iter().map(|a| &a.windows);
        let references = held.chain(activities);
        let rows = self.samples.iter().map(|sample| &sample.rows);
        let rows = rows.chain(&self.negatives);
        let repetitions = self.activities.iter().flat_map(|a| &a.repetitions);
        let rows = rows.chain(repetitions.map(|sample| &sample.rows));
        let rows = rows.chain(looks().flat_map(|look| [&look.segments, &look.atlas]));
        let mut rows = rows.chain(references.clone().flat_map(|r| [&r.rows, &r.others]));
        let tables = [&self.ridged, &self.total].into_iter();
        let tables = tables.chain(looks().flat_map(|look| [&look.ridged, &look.total]));
        let mut tables = tables.chain(references.flat_map(|r| [&r.ridged, &r.total]));
        let of_rows = rows.find_map(|rows| beyond(rows.values(), LARGEST));
        let of_metric = || tables.find_map(|table| beyond(table.packed(), LARGEST * LARGEST));
        of_rows.or_else(of_metric).map_or(Ok(()), Err)
    }

    fn check_class_thresholds(&self) -> Result<(), String> {
        let given = &self.class_thresholds;
        if !given.is_empty() && given.len() != self.classes.len() {
            return Err(format!(
                "thresholds for {} classes, of {}",
                given.len(),
                self.classes.len()
            ));
        }
        match given.iter().find(|t| !(t.is_finite() && **t > 0.0)) {
            Some(found) => Err(format!(
                "the threshold of a class must be above 0, found {found}"
            )),
            None => Ok(()),
        }
    }

    /// The policy by which distances become candidates.
    pub fn rule(&self) -> CandidatePolicy {
        match &self.verifier {
            Some(verifier) => CandidatePolicy::Verify {
                reach: verifier.reach,
            },
            None => CandidatePolicy::Gate {
                threshold: self.threshold,
            },
        }
    }

    /// The model with the threshold for this rate of false alarms a minute, as background motion raised them in
    /// training; with a verifier, with the bar for it. `None` if the model notes no rates.
    pub fn with_sensitivity(&self, alarms_per_minute: f64) -> Option<Self> {
        if alarms_per_minute.is_nan() || alarms_per_minute <= 0.0 {
            return None;
        }
        let activities = self.activities.as_ref();
        let activities = activities.map(|a| a.with_sensitivity(alarms_per_minute));
        if let Some(verifier) = &self.verifier {
            let bar = threshold_at(&verifier.operating, alarms_per_minute)?;
            let verifier = Some(Verifier {
                bar: bar.into(),
                ..verifier.clone()
            });
            return Some(Self {
                verifier,
                activities,
                ..self.clone()
            });
        }
        if let Some(look) = &self.look {
            return Some(Self {
                look: Some(look.with_sensitivity(alarms_per_minute)?),
                activities,
                ..self.clone()
            });
        }
        let threshold = threshold_at(&self.operating, alarms_per_minute)?;
        let scale = threshold / self.threshold;
        let class_thresholds = self.class_thresholds.iter().map(|t| t * scale);
        Some(Self {
            threshold,
            class_thresholds: class_thresholds.collect(),
            stranger: (self.stranger.as_ref()).map(|s| s.with_sensitivity(alarms_per_minute)),
            activities,
            ..self.clone()
        })
    }

    /// The model for this kind of performer. `None` if it is to have a wider gate and has none.
    pub fn with_performer(&self, performer: PerformerKind) -> Option<Self> {
        let mut model = self.clone();
        if let Some(look) = &mut model.look {
            look.performer = performer;
            return Some(model);
        }
        match &mut model.stranger {
            Some(gate) => gate.performer = performer,
            None if performer == PerformerKind::Anyone => return None,
            None => {}
        }
        Some(model)
    }

    /// The calibration of scores in use. Indexes from before verified scores were calibrated hold the map of plain margins beside a
    /// verifier, where it never held: they report the verifier's scores.
    pub(super) fn calibration_in_use(&self) -> Option<Calibration> {
        let stale = self.verifier.is_some() && self.calibration == Some(Calibration::OF_MARGINS);
        self.calibration.filter(|_| !stale)
    }

    /// Distances from here on change nothing that the model reports, of classes and of negatives. A distance below its threshold is held
    /// against rivals, negatives, the tick before, and as far as [`separation`](crate::decode::Candidate::separation) tells apart;
    /// a verifier's evidence looks further, and a second look has a reach of its own.
    pub fn reach(&self) -> f32 {
        if let Some(look) = &self.look {
            return 1.01 * look.reach;
        }
        let wide = self.stranger.iter();
        let thresholds = (self.class_thresholds.iter().copied())
            .chain(wide.clone().map(|gate| gate.threshold))
            .chain(self.verifier.iter().map(|v| v.reach));
        let threshold = thresholds.fold(self.threshold, f32::max);
        let decode = &self.decode;
        let factor = (wide.map(|gate| gate.rival_share))
            .chain([decode.rival_share, 1.0 + decode.end_fall, 1.0 / decode.gate])
            .fold(std::f32::consts::E, f32::max);
        let evidence = self.verifier.as_ref().map_or(0.0, |_| Evidence::REACH);
        // A margin covers rounding.
        1.01 * (threshold * factor).max(evidence)
    }

    /// Rows of the longest template.
    pub fn longest(&self) -> usize {
        self.samples.iter().map(|s| s.rows.len()).max().unwrap_or(0)
    }

    /// The model for streams that offer only `bones`: the columns of the others are dropped everywhere and the
    /// threshold shrinks with the share of variance that is left.
    ///
    /// # Errors
    /// No bone of the model is left, or its parts do not fit together.
    pub fn restricted(&self, bones: BoneSet) -> Result<Self, TemplateModelError> {
        let bones = self.bones.and(bones);
        if bones.is_empty() {
            return Err(TemplateModelError::NoBones);
        }
        if bones == self.bones {
            return Ok(self.clone());
        }
        let keep = RowLayout::kept_columns(self.bones, bones);
        let total = self.total.restricted(&keep);
        let left = total.unpack().trace() / self.total.unpack().trace();
        // A normalised distance has lost that share of its scale already.
        let share = portable::powf(left, 1.0 - f64::from(self.decode.spread_exponent));
        let pick = |rows: &Rows| {
            let values = rows
                .iter()
                .flat_map(|row| keep.iter().map(|&k| row[k]))
                .collect();
            Rows::from_values(keep.len(), values)
        };
        Ok(Self {
            bones,
            samples: self
                .samples
                .iter()
                .map(|s| TemplateSample {
                    class: s.class,
                    rows: pick(&s.rows),
                })
                .collect(),
            negatives: self.negatives.iter().map(pick).collect(),
            ridged: self.ridged.restricted(&keep),
            threshold: self.threshold * share as f32,
            class_thresholds: self
                .class_thresholds
                .iter()
                .map(|t| t * share as f32)
                .collect(),
            operating: self
                .operating
                .iter()
                .map(|p| OperatingPoint {
                    threshold: p.threshold * share as f32,
                    ..*p
                })
                .collect(),
            calibration: self.calibration,
            stranger: self.stranger.as_ref().map(|s| s.scaled(share as f32)),
            verifier: self
                .verifier
                .as_ref()
                .map(|v| restricted_verifier(v, share as f32, pick)),
            look: (self.look.as_ref()).map(|look| look.restricted(self.bones, bones)),
            held: (self.held.as_ref())
                .map(|held| held.restricted(RowLayout::of(self.bones), &keep)),
            activities: (self.activities.as_ref())
                .map(|activities| activities.restricted(RowLayout::of(self.bones), &keep)),
            total,
            step: self
                .step
                .as_ref()
                .map(|step| keep.iter().map(|&k| step[k]).collect()),
            features: self.features.clone(),
            decode: self.decode.clone(),
            classes: self.classes.clone(),
        })
    }
}

/// Distances shrink with the share of variance that is left, and everything that is held against them too.
fn restricted_verifier(verifier: &Verifier, share: f32, pick: impl Fn(&Rows) -> Rows) -> Verifier {
    let restrict = |class: &Exemplars| Exemplars {
        shapes: pick(&class.shapes),
        sharpness: class.sharpness / share,
        ..class.clone()
    };
    Verifier {
        reach: verifier.reach * share,
        classes: verifier.classes.iter().map(restrict).collect(),
        ..verifier.clone()
    }
}
