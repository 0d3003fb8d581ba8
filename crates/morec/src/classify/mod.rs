//! Whole clips: one class each, or none, with probabilities.
//!
//! A stream has to find where a motion begins and ends, and to stay silent about everything else; a clip that was cut around one motion
//! only has to be named. [`Classifier`] compares all that moves in a clip with the samples of an index, in the way in which the index
//! recognises streams: by its [second look](crate::templates::second_look) where it has one, else by the nearest match of each class.

mod distances;
mod nearest;
#[cfg(test)]
mod tests;
mod whole;

use std::collections::BTreeMap;

use crate::classes::ClassId;
use crate::clip::{Clip, Span};
use crate::features::{RowLayout, all_bones_of_clip, rows_of_clip};
use crate::index::Model;
use crate::live::{StartError, restricted};
use crate::math::portable;
use crate::roles::RoleMap;
use crate::templates::{Activities, TemplateModel};

use distances::ClipDistances;

/// Exponent that turns ratios of distances into ratios of probabilities. It and the map below were fitted to clips of gestures that one person
/// teaches and others perform (calibration error 0.02 there; 0.03 on actions before a Kinect and 0.08 on everyday actions, which were seen
/// before the fit was kept: `cargo xtask judge --only classified`).
const SHARPNESS: f64 = 9.0;
/// Probability that a clip shows one of the classes: `σ(slope · x + offset)`, with `x` the logarithm of the distance that a stream just accepts
/// over the clip's.
const SLOPE: f64 = 4.0;
const OFFSET: f64 = 2.3;
/// A clip is given its nearest class if that is more probable than everything else.
const ACCEPTED: f64 = 0.5;

/// What a clip shows.
#[derive(Debug, Clone, PartialEq)]
pub struct ClassifiedClip {
    /// The class, if the clip is accepted as one of the index's.
    pub class: Option<ClassId>,
    /// The class whose samples are nearest, accepted or not; `None` where nothing moves.
    pub nearest: Option<ClassId>,
    /// Probability of each class of the index, in its order. What is missing to 1 is the probability of none of them.
    pub probabilities: Vec<f64>,
}

/// A [`ClassifiedClip`] with the names of the classes.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct NamedClassification<'a> {
    /// The class, if the clip is accepted as one of the index's.
    pub class: Option<&'a str>,
    /// Probability that the clip shows it.
    pub probability: Option<f64>,
    /// The class whose samples are nearest, accepted or not.
    pub nearest: Option<&'a str>,
    /// Probability of each class.
    pub probabilities: BTreeMap<&'a str, f64>,
}

impl ClassifiedClip {
    /// With the names of the classes of `model`.
    pub fn named<'a>(&self, model: &'a Model) -> NamedClassification<'a> {
        let names = model.classes().iter().map(|class| class.name.as_str());
        let name = |class: Option<ClassId>| class.map(|class| model.class_name(class));
        NamedClassification {
            class: name(self.class),
            probability: self.class.map(|class| self.probabilities[class.index()]),
            nearest: name(self.nearest),
            probabilities: names.zip(self.probabilities.iter().copied()).collect(),
        }
    }
}

/// Why clips cannot be classified.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ClassifyError {
    /// The method of 2009 has no distances from classes.
    #[error(
        "classifying clips needs an index of the method templates; this one is of the method svrdm"
    )]
    Method,
    /// The clip does not show what the index is of.
    #[error(transparent)]
    Start(#[from] StartError),
}

/// Classifies clips by an index.
#[derive(Debug, Clone)]
pub struct Classifier {
    model: std::sync::Arc<TemplateModel>,
}

impl Classifier {
    /// Of an index's model.
    ///
    /// # Errors
    /// A model of the method of 2009.
    pub fn new(model: &Model) -> Result<Self, ClassifyError> {
        match model {
            Model::Templates(model) => Ok(Self {
                model: model.clone(),
            }),
            Model::Svrdm(_) => Err(ClassifyError::Method),
        }
    }

    /// The class of a clip, from all that moves in it. `rest` are the frames that a conversion left at the start.
    /// O(ticks · template rows · d); with a second look O(samples · d).
    ///
    /// # Errors
    /// The clip shows no bone of the index.
    pub fn classify(
        &self,
        clip: &Clip,
        roles: &RoleMap,
        rest: &Span,
    ) -> Result<ClassifiedClip, ClassifyError> {
        if clip.frames == 0 {
            let classes = vec![f32::INFINITY; self.model.classes.len()];
            let verified = None;
            return Ok(classified(
                &ClipDistances { classes, verified },
                &self.model,
            ));
        }
        let roles = &roles.for_bones(&clip.skeleton, self.model.bones);
        let shown = all_bones_of_clip(clip, roles, rest);
        let model = &restricted(&self.model, shown)?;
        let rows = rows_of_clip(clip, roles, rest, model.bones, &model.features);
        let mut distances = match &model.look {
            Some(look) => whole::distances(model, look, &rows),
            None => nearest::distances(model, &rows).map_err(StartError::from)?,
        };
        if let Some(activities) = &model.activities
            && rows.len() >= Activities::LEAST_TICKS
        {
            for (class, share) in activities.shares(RowLayout::of(model.bones), &rows) {
                let distance = &mut distances.classes[class.index()];
                *distance = distance.min(share as f32);
            }
        }
        Ok(classified(&distances, model))
    }
}

/// The class of a clip at these distances.
fn classified(distances: &ClipDistances, model: &TemplateModel) -> ClassifiedClip {
    let near = |class: &usize| distances.classes[*class];
    let classes = (0..distances.classes.len()).filter(|c| near(c).is_finite());
    let nearest = classes.min_by(|a, b| near(a).total_cmp(&near(b)));
    let Some(nearest) = nearest else {
        return ClassifiedClip {
            class: None,
            nearest: None,
            probabilities: vec![0.0; distances.classes.len()],
        };
    };
    let least = f64::from(near(&nearest).max(f32::MIN_POSITIVE));
    let weight = |distance: &f32| portable::powf(least / f64::from(*distance), SHARPNESS);
    let weights: Vec<f64> = distances.classes.iter().map(weight).collect();
    let any = match (distances.verified, &model.calibration) {
        (Some(score), Some(verified)) if score > 0.0 => verified.probability(score, 0.0, 0.0),
        (Some(_), _) => 0.0,
        (None, _) => 1.0 / (1.0 + portable::exp(SLOPE * portable::ln(least) - OFFSET)),
    };
    let sum: f64 = weights.iter().sum();
    let probabilities: Vec<f64> = weights.iter().map(|w| any * w / sum).collect();
    let is_accepted = probabilities[nearest] > ACCEPTED;
    let nearest = ClassId(nearest as u16);
    ClassifiedClip {
        class: is_accepted.then_some(nearest),
        nearest: Some(nearest),
        probabilities,
    }
}
