//! Labels that taught nothing in a fold of a cross-validation: what was found there cannot be for their sake.

use std::collections::{BTreeMap, BTreeSet};

use morec::TimeSpan;
use morec::labels::Sample;
use morec::train::TrainClip;
use morec_measure::crossval::{FoldBy, folds};

/// Labels that did not teach.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Unlearned {
    /// All of these clips, by name.
    pub clips: BTreeSet<String>,
    /// Single ones, of clips by name.
    pub labels: Vec<(String, TimeSpan)>,
}

impl Unlearned {
    /// True if the label of the clip at this time did not teach.
    pub fn holds(&self, clip: &str, span: TimeSpan) -> bool {
        /// Times in the database are frames, those of labels may be seconds.
        const SAME_SECS: f64 = 0.05;
        let same = |(of, at): &(String, TimeSpan)| of == clip && at.is_near(span, SAME_SECS);
        self.clips.contains(clip) || self.labels.iter().any(same)
    }

    /// For each clip that is tested, the labels without which the model was trained that tested it.
    pub fn of_folds(by: FoldBy, clips: &[TrainClip], samples: &[Sample]) -> BTreeMap<String, Self> {
        let person = |clip: &TrainClip| clip.person.clone().unwrap_or_else(|| clip.name.clone());
        let people = clips.iter().map(|clip| (clip.name.clone(), person(clip)));
        let people: BTreeMap<String, String> = people.collect();
        let mut of_clips = BTreeMap::new();
        for fold in folds(by, samples, &people) {
            let held_back = fold.held_back.iter().map(|&at| &samples[at]);
            let unlearned = Self {
                labels: held_back.map(|s| (s.clip.clone(), s.span)).collect(),
                clips: fold.left_out,
            };
            let tested = fold.tested.into_iter();
            of_clips.extend(tested.map(|clip| (clip, unlearned.clone())));
        }
        of_clips
    }
}
