//! Clips and labels as training takes them: principal components, cut-out samples, background streams.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use rayon::prelude::*;

use crate::classes::{ClassId, ClassInfo};
use crate::features::Rows;
use crate::labels::Sample;
use crate::pca::{Moments, Pca};
use crate::pivots::{PivotMap, PivotSet, pose_rows_of_clip};
use crate::train::{LabelSet, StreamKind, TrainClip, TrainError};

use super::SvrdmOptions;
use super::sample::{ThesisSample, described};

/// A stream that holds stretches of no class.
#[derive(Debug, Clone)]
pub struct Background {
    /// Pose rows, `frames × D`.
    pub rows: Rows,
    /// Frames of what is labelled or held back: to be left out of account.
    pub known: Vec<Range<usize>>,
    /// True if it is the rest of a labelled clip.
    pub unlabelled: bool,
}

/// Training data of the thesis's method.
#[derive(Debug, Clone)]
pub struct ThesisTrainingData {
    pub classes: Vec<ClassInfo>,
    pub pivots: PivotSet,
    pub pca: Pca,
    pub samples: Vec<ThesisSample>,
    pub background: Vec<Background>,
    /// Pivots that a clip lacks, with the clip's name.
    pub missing: Vec<String>,
    /// Classes that are not learned, since no sample of them can be described.
    pub left_out: Vec<ClassInfo>,
}

/// Pose rows of every clip, the components of all of them (Eqs. 4.2 and 4.3), the samples of the classes.
///
/// # Errors
/// Parameters out of range, a clip without the pivots, or no sample.
pub fn of_clips(
    clips: &[TrainClip],
    labelling: &LabelSet<'_>,
    options: &SvrdmOptions,
) -> Result<ThesisTrainingData, TrainError> {
    let params = &options.params;
    params.pose.check().map_err(TrainError::Params)?;
    params.stages.check().map_err(TrainError::Params)?;
    let pivots = params.pivots.set().map_err(TrainError::Params)?;
    let made: Result<Vec<(Rows, Vec<String>)>, TrainError> = clips
        .par_iter()
        .map(|clip| {
            let map = PivotMap::of_clip(&pivots, &clip.clip, &clip.roles).map_err(|e| {
                TrainError::Clip {
                    clip: clip.name.clone(),
                    problem: e.to_string(),
                }
            })?;
            let rows = pose_rows_of_clip(&clip.clip, &pivots, &map, &clip.rest, &params.pose);
            let missing = map.missing();
            let note = (!missing.is_empty())
                .then(|| format!("{} lacks {}", clip.name, missing.join(", ")));
            Ok((rows, note.into_iter().collect()))
        })
        .collect();
    let (rows, missing): (Vec<Rows>, Vec<Vec<String>>) = made?.into_iter().unzip();
    let mut moments = Moments::new(pivots.row_dim());
    // One clip after the other: the sum is the same for any number of threads.
    rows.iter().for_each(|rows| moments.push_rows(rows));
    let pca = Pca::fit(&moments, params.keep).map_err(|e| TrainError::Params(e.to_string()))?;
    if params.stages.eigenvectors > pca.dims() {
        return Err(TrainError::Params(format!(
            "{} eigenvectors of rows of {} values",
            params.stages.eigenvectors,
            pca.dims()
        )));
    }
    let groups = groups(clips);
    let mut material = ThesisTrainingData {
        classes: vec![],
        pivots,
        pca,
        samples: vec![],
        background: vec![],
        missing: missing.concat(),
        left_out: vec![],
    };
    for ((clip, rows), group) in clips.iter().zip(rows).zip(groups) {
        material.add(clip, rows, group, labelling, options);
    }
    if material.samples.is_empty() {
        return Err(TrainError::NoSamples);
    }
    material.keep_shown_classes(classes(labelling));
    Ok(material)
}

impl ThesisTrainingData {
    /// Takes those of `classes` that a sample shows, and numbers the samples' classes among them.
    fn keep_shown_classes(&mut self, classes: Vec<ClassInfo>) {
        let shown: BTreeSet<usize> = self.samples.iter().map(|s| s.class.index()).collect();
        let places: BTreeMap<usize, u16> = shown.iter().copied().zip(0..).collect();
        for sample in &mut self.samples {
            sample.class = ClassId(places[&sample.class.index()]);
        }
        let (kept, left_out): (Vec<_>, Vec<_>) =
            (0..).zip(classes).partition(|(at, _)| shown.contains(at));
        self.classes = kept.into_iter().map(|(_, class)| class).collect();
        self.left_out = left_out.into_iter().map(|(_, class)| class).collect();
    }

    fn add(
        &mut self,
        clip: &TrainClip,
        rows: Rows,
        group: usize,
        labelling: &LabelSet<'_>,
        options: &SvrdmOptions,
    ) {
        let of_clip = |s: &&Sample| s.clip == clip.name;
        let rate_hz = options.params.pose.rate_hz;
        let mut known = vec![];
        let mut whole = false;
        for sample in labelling.samples.iter().filter(of_clip) {
            let span = frames(sample, rate_hz, rows.len());
            whole |= sample.whole_clip;
            known.push(span.clone());
            let Some(class) = labelling.classes.iter().position(|c| *c == sample.class) else {
                continue;
            };
            // Shorter than its directions are many, a sample has no feature vector; without motion neither.
            if span.len() > options.params.stages.eigenvectors {
                let sample = ThesisSample {
                    class: ClassId(class as u16),
                    group,
                    rows: self.pca.project(&rows.slice(span)),
                };
                if described(&sample.rows, self.pca.dims(), &options.params.stages).is_some() {
                    self.samples.push(sample);
                }
            }
        }
        for sample in labelling.held_back.iter().filter(of_clip) {
            whole |= sample.whole_clip;
            known.push(frames(sample, rate_hz, rows.len()));
        }
        let unlabelled = clip.source == StreamKind::Labelled;
        let serves = match clip.source {
            StreamKind::Labelled => {
                options.unlabelled_is_background && labelling.unlabelled_is_background && !whole
            }
            StreamKind::Background => true,
            StreamKind::Everyday => false,
        };
        if serves {
            self.background.push(Background {
                rows,
                known,
                unlabelled,
            });
        }
    }
}

/// At most `count` frames.
fn frames(sample: &Sample, rate_hz: f64, count: usize) -> Range<usize> {
    if sample.whole_clip {
        return 0..count;
    }
    sample.span.frames_among(count, rate_hz)
}

/// For each clip, a number that it shares with the clips of its person.
fn groups(clips: &[TrainClip]) -> Vec<usize> {
    let mut numbers = BTreeMap::new();
    let mut number = |name: &str| {
        let next = numbers.len();
        *numbers.entry(name.to_owned()).or_insert(next)
    };
    clips
        .iter()
        .map(|c| number(c.person.as_deref().unwrap_or(&c.name)))
        .collect()
}

fn classes(labelling: &LabelSet<'_>) -> Vec<ClassInfo> {
    let info = |name: &String| {
        let of_class: Vec<&Sample> = labelling
            .samples
            .iter()
            .filter(|s| s.class == *name)
            .collect();
        let people: BTreeSet<&String> = of_class.iter().filter_map(|s| s.person.as_ref()).collect();
        ClassInfo {
            name: name.clone(),
            samples: of_class.len(),
            people: people.len(),
        }
    };
    labelling.classes.iter().map(info).collect()
}
