//! Clips and labels sorted out: which clip teaches, which is background, which is of no use.

use std::collections::{BTreeMap, BTreeSet};

use crate::labels::{ClipLength, Labels, Sample};
use crate::roles::Role;

use super::{StreamKind, TrainClip};

/// Clips, samples and classes that fit together.
#[derive(Debug, Clone, Default)]
pub struct TrainingData {
    /// Labelled clips that hold a sample, and background.
    pub clips: Vec<TrainClip>,
    /// Samples of the classes in the labelled clips.
    pub samples: Vec<Sample>,
    /// The classes, in order.
    pub classes: Vec<String>,
    /// Names of labelled clips that hold no sample of the classes; they are not used.
    pub unused: Vec<String>,
    /// What was left out or cut, each in a sentence.
    pub notes: Vec<String>,
}

/// Why clips and labels do not make training data.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum DataError {
    /// Two clips of one name.
    #[error("two clips are called {0}: labels cannot tell them apart")]
    SameName(String),
    /// A class was asked for that the labels do not show.
    #[error("the class {0} is asked for, but no clip holds a sample of it")]
    NoSampleOf(String),
    /// No label lies in any clip.
    #[error(
        "no sample to learn from: no label names any of these clips (labels name clips by file stem)"
    )]
    NoSample,
}

impl TrainingData {
    /// Resolves `labels` against `clips`. Clips of [`StreamKind::Labelled`] teach where labels lie in them; labels in other
    /// clips are not used. `classes` are those to learn, in order; every class of the labels if empty.
    ///
    /// # Errors
    /// Two clips of one name, a class without a sample, no sample at all.
    pub fn new(
        clips: Vec<TrainClip>,
        labels: &Labels,
        classes: &[String],
    ) -> Result<Self, DataError> {
        let mut lengths = BTreeMap::new();
        for clip in &clips {
            let length = ClipLength {
                frames: clip.clip.frames,
                rate_hz: clip.clip.rate_hz,
            };
            if lengths.insert(clip.name.clone(), length).is_some() {
                return Err(DataError::SameName(clip.name.clone()));
            }
        }
        let resolved = labels.resolve(&lengths);
        let mut notes: Vec<String> = resolved
            .warnings
            .iter()
            .map(|w| format!("labels, {w}"))
            .collect();
        if !resolved.absent.is_empty() {
            notes.push(format!(
                "{} labels are of clips that are not there ({} clips)",
                resolved.absent.values().sum::<usize>(),
                resolved.absent.len()
            ));
        }
        let teaching: BTreeSet<&str> = clips
            .iter()
            .filter(|c| c.source == StreamKind::Labelled)
            .map(|c| c.name.as_str())
            .collect();
        let wanted = |s: &Sample| classes.is_empty() || classes.contains(&s.class);
        let samples: Vec<Sample> = resolved
            .samples
            .into_iter()
            .filter(|s| wanted(s) && teaching.contains(s.clip.as_str()))
            .collect();
        let classes = classes_of(&samples, classes)?;
        let with_samples: BTreeSet<&str> = samples.iter().map(|s| s.clip.as_str()).collect();
        let (clips, unused): (Vec<_>, Vec<_>) = clips.into_iter().partition(|c| {
            c.source != StreamKind::Labelled || with_samples.contains(c.name.as_str())
        });
        Ok(Self {
            clips,
            samples,
            classes,
            unused: unused.into_iter().map(|c| c.name).collect(),
            notes,
        })
    }

    /// The clips that hold samples.
    pub fn labelled(&self) -> impl Iterator<Item = &TrainClip> {
        self.clips
            .iter()
            .filter(|c| c.source == StreamKind::Labelled)
    }

    /// Joint names by role, of the first labelled clip.
    pub fn role_names(&self) -> BTreeMap<Role, String> {
        let Some(clip) = self.labelled().next() else {
            return BTreeMap::new();
        };
        let joints = clip.clip.skeleton.joints();
        let name = |role: Role| Some((role, joints[clip.roles.joint(role)?].name.clone()));
        Role::ALL.into_iter().filter_map(name).collect()
    }
}

/// The classes to learn: those asked for, or all that samples show, by name.
fn classes_of(samples: &[Sample], asked: &[String]) -> Result<Vec<String>, DataError> {
    let present: BTreeSet<&str> = samples.iter().map(|s| s.class.as_str()).collect();
    if let Some(class) = asked.iter().find(|c| !present.contains(c.as_str())) {
        return Err(DataError::NoSampleOf(class.clone()));
    }
    match (samples.is_empty(), asked.is_empty()) {
        (true, _) => Err(DataError::NoSample),
        (_, true) => Ok(present.into_iter().map(str::to_owned).collect()),
        _ => Ok(asked.to_vec()),
    }
}
