//! Cross-validation, and its measures.

use morec::crossval::{
    CrossvalData, CrossvalOptions, CrossvalOutcome, FoldBy, FoldReport, Tested, crossval,
};
use morec::eval::{EvalError, Evaluation};
use morec::perturb::Perturbation;
use morec::progress::Progress;
use serde::{Deserialize, Serialize};

use crate::{OperationError, TrainSettings, text};

/// How a cross-validation divides its samples, and what else it tests.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, clap::Args)]
#[serde(default, deny_unknown_fields)]
pub struct CrossvalSettings {
    /// Part that is left out of training in turn
    #[arg(long, value_enum, default_value = "person")]
    pub by: LeftOut,
    /// Let at most N samples of each class teach, from its people in turn
    #[arg(long, value_name = "N")]
    pub samples: Option<usize>,
    /// Also test copies that are worse in one way each, separated by commas: white:METRES, slow:METRES, const:METRES,
    /// tilt:DEGREES, speed:FACTOR (of durations), drop:SHARE, repeat:SHARE, spikes:SHARE, occlude:SHARE, cam:FACTOR,
    /// rate:HZ, mirror
    #[arg(long, value_delimiter = ',', value_name = "KIND:SIZE")]
    #[serde(with = "text::list")]
    pub perturb: Vec<Perturbation>,
    /// Also test at these rates of false alarms a minute (see `morec recognize --sensitivity`), separated by commas
    /// [default with --report: 0.03 to 2]
    #[arg(long, value_delimiter = ',', value_name = "RATE")]
    pub sensitivities: Vec<f64>,
    /// Seed of the shuffle that halves the samples
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
    /// One clip after the other
    Clip,
    /// One person after the other
    #[default]
    Person,
    /// Nothing: each person teaches alone and is tested in their own clips of --test
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
    /// Streams, samples and detections of the clips as they are.
    pub tested: Tested,
    /// Their measures.
    pub evaluation: Evaluation,
    /// Measures of the copies that are worse in one way.
    pub perturbed: Vec<(Perturbation, Evaluation)>,
    /// Measures at other rates of false alarms a minute.
    pub sensitivities: Vec<(f64, Evaluation)>,
    /// Training of each fold.
    pub folds: Vec<FoldReport>,
}

impl CrossvalSettings {
    fn options(&self) -> CrossvalOptions {
        CrossvalOptions {
            by: match self.by {
                LeftOut::Half => FoldBy::Half { seed: self.seed },
                LeftOut::Clip => FoldBy::Clip,
                LeftOut::Person => FoldBy::Person,
                LeftOut::Own => FoldBy::Own,
            },
            samples_per_class: self.samples,
            perturbations: self.perturb.clone(),
            sensitivities: self.sensitivities.clone(),
        }
    }

    /// Trains as `train` says without each part in turn, recognises that part, and measures.
    ///
    /// # Errors
    /// Settings that make no sense, a fold that cannot be trained or recognised, or `progress` cancels.
    pub fn crossval(
        &self,
        data: &CrossvalData<'_>,
        train: &TrainSettings,
        progress: &dyn Progress,
    ) -> Result<CrossvalMeasures, OperationError> {
        let outcome = crossval(data, &self.options(), &train.recipe()?, progress)?;
        Ok(CrossvalMeasures::of(outcome)?)
    }
}

impl CrossvalMeasures {
    fn of(outcome: CrossvalOutcome) -> Result<Self, EvalError> {
        Ok(Self {
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

fn evaluation(tested: &Tested) -> Result<Evaluation, EvalError> {
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
