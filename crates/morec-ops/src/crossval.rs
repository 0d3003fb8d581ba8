//! Cross-validation, and its measures.

use std::collections::BTreeSet;

use morec::progress::Progress;
use morec_measure::crossval::{
    CrossvalData, CrossvalOptions, CrossvalOutcome, FoldBy, FoldReport, TaughtLimit, Tested,
    crossval,
};
use morec_measure::eval::{EvalError, Evaluation};
use morec_measure::perturb::Perturbation;
use serde::{Deserialize, Serialize};

use crate::{OperationError, TrainSettings, text};

/// How a cross-validation divides its samples, and what else it tests.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, clap::Args)]
#[serde(default, deny_unknown_fields)]
#[command(next_help_heading = "Cross-validation")]
pub struct CrossvalSettings {
    /// What to leave out of training in turn
    #[arg(long, value_enum, default_value = "person")]
    pub by: LeftOut,
    /// Train on at most N samples per class, drawn evenly across people
    #[arg(long, value_name = "N")]
    pub samples: Option<usize>,
    /// Also test worse copies: white:0.01, cam:1, drop:0.3 …
    ///
    /// Kinds, separated by commas: white:METRES, slow:METRES, const:METRES, tilt:DEGREES, speed:FACTOR (of durations),
    /// drop:SHARE, repeat:SHARE, spikes:SHARE, occlude:SHARE, cam:FACTOR, rate:HZ, mirror.
    #[arg(long, value_delimiter = ',', value_name = "KIND:SIZE")]
    #[serde(with = "text::list")]
    pub perturb: Vec<Perturbation>,
    /// Also test at these false alarms a minute, separated by commas
    ///
    /// As `morec recognize --sensitivity` [default with --report: 0.03 to 2].
    #[arg(long, value_delimiter = ',', value_name = "RATE")]
    pub sensitivities: Vec<f64>,
    /// Seed of the split into halves
    #[arg(long, default_value_t = 1, value_name = "N")]
    pub seed: u64,
}

impl Default for CrossvalSettings {
    fn default() -> Self {
        Self {
            by: LeftOut::default(),
            samples: None,
            perturb: Vec::new(),
            sensitivities: Vec::new(),
            seed: 1,
        }
    }
}

/// The part of the samples that a cross-validation leaves out in turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "snake_case")]
pub enum LeftOut {
    /// Half of each class's samples
    Half,
    /// Each clip
    Clip,
    /// Each person
    #[default]
    Person,
    /// Nothing: train on each person, test on that person's clips of --test
    Own,
}

impl LeftOut {
    /// Each person if several show the samples, else each clip if there are several, else half of the samples.
    pub fn usual(people: usize, clips: usize) -> Self {
        match (people, clips) {
            (2.., _) => LeftOut::Person,
            (_, 2..) => LeftOut::Clip,
            _ => LeftOut::Half,
        }
    }

    /// What is left out, in a sentence.
    pub fn said(self) -> &'static str {
        match self {
            LeftOut::Half => "half of the labels",
            LeftOut::Clip => "each clip in turn",
            LeftOut::Person => "each person in turn",
            LeftOut::Own => "all other people",
        }
    }
}

/// What a cross-validation recognised, and its measures.
#[derive(Debug, Clone)]
pub struct CrossvalMeasures {
    /// What was left out in turn, in words.
    pub divided: String,
    /// Streams, samples and detections of the clips as they are.
    pub tested: Tested,
    /// Measures over all tested clips.
    pub evaluation: Evaluation,
    /// Measures of the copies that are worse in one way.
    pub perturbed: Vec<(Perturbation, Evaluation)>,
    /// Measures at other rates of false alarms a minute.
    pub sensitivities: Vec<(f64, Evaluation)>,
    /// Training of each fold.
    pub folds: Vec<FoldReport>,
}

impl CrossvalSettings {
    /// The part that is left out in turn, with the seed of the shuffle.
    pub fn fold_by(&self) -> FoldBy {
        match self.by {
            LeftOut::Half => FoldBy::Half { seed: self.seed },
            LeftOut::Clip => FoldBy::Clip,
            LeftOut::Person => FoldBy::Person,
            LeftOut::Own => FoldBy::Own,
        }
    }

    fn options(&self) -> CrossvalOptions {
        CrossvalOptions {
            by: self.fold_by(),
            taught: TaughtLimit {
                samples_per_class: self.samples,
                ..TaughtLimit::default()
            },
            perturbations: self.perturb.clone(),
            sensitivities: self.sensitivities.clone(),
        }
    }

    /// What is left out in turn, in words, with how many parts there are.
    ///
    /// # Errors
    /// Only one person is named, so nothing is left to train from.
    pub fn divided(&self, data: &CrossvalData<'_>) -> Result<String, OperationError> {
        let labelled: BTreeSet<&str> = data.samples.iter().map(|s| s.clip.as_str()).collect();
        let clips = data
            .clips
            .iter()
            .filter(|c| labelled.contains(c.name.as_str()));
        let named: BTreeSet<&str> = clips.clone().filter_map(|c| c.person.as_deref()).collect();
        let unnamed = clips.filter(|c| c.person.is_none()).count();
        let one = named.first().filter(|_| named.len() == 1 && unnamed == 0);
        match (self.by, one) {
            (LeftOut::Person, Some(person)) if data.tests.is_none() => {
                return Err(OperationError::Settings(format!(
                    "all labels are by one person, {person}, so nothing is left to train on without this person: divide by clip \
                     or by half instead"
                )));
            }
            _ => {}
        }
        let clips = |n: usize| match n {
            1 => "1 clip".to_owned(),
            n => format!("{n} clips"),
        };
        Ok(match (self.by, named.len(), unnamed) {
            (LeftOut::Person, 0, _) => format!(
                "each clip in turn, {}, because no persons are named: add a column `person` to the labels, or a table of people",
                clips(unnamed)
            ),
            (LeftOut::Person, people, 0) => format!("{}, {people} people", self.by.said()),
            (LeftOut::Person, people, others) => format!(
                "{}, {people} named, and {} clips without a person, each as a person",
                self.by.said(),
                clips(others)
            ),
            (LeftOut::Clip, _, _) => format!("{}, {}", self.by.said(), clips(labelled.len())),
            (LeftOut::Half | LeftOut::Own, _, _) => self.by.said().to_owned(),
        })
    }

    /// Trains as `train` says without each part in turn, recognises that part, and measures.
    ///
    /// # Errors
    /// Settings that make no sense, one person alone, a fold that cannot be trained or recognised, or `progress` cancels.
    pub fn crossval(
        &self,
        data: &CrossvalData<'_>,
        train: &TrainSettings,
        progress: &dyn Progress,
    ) -> Result<CrossvalMeasures, OperationError> {
        let divided = self.divided(data)?;
        let outcome = crossval(data, &self.options(), &train.recipe()?, progress)?;
        Ok(CrossvalMeasures::of(outcome, divided)?)
    }
}

impl CrossvalMeasures {
    fn of(outcome: CrossvalOutcome, divided: String) -> Result<Self, EvalError> {
        Ok(Self {
            divided,
            evaluation: evaluation(&outcome.tested)?,
            tested: outcome.tested,
            perturbed: measured(&outcome.perturbed)?,
            sensitivities: measured(&outcome.sensitivities)?,
            folds: outcome.folds,
        })
    }
}

fn measured<K: Copy>(results: &[(K, Tested)]) -> Result<Vec<(K, Evaluation)>, EvalError> {
    let of = |(key, tested): &(K, Tested)| Ok((*key, evaluation(tested)?));
    results.iter().map(of).collect()
}

pub(crate) fn evaluation(tested: &Tested) -> Result<Evaluation, EvalError> {
    Evaluation::of(&tested.streams, &tested.truths, &tested.founds)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_out_follows_from_people_and_clips() {
        assert_eq!(LeftOut::usual(2, 3), LeftOut::Person);
        assert_eq!(LeftOut::usual(1, 2), LeftOut::Clip);
        assert_eq!(LeftOut::usual(0, 1), LeftOut::Half);
    }
}
