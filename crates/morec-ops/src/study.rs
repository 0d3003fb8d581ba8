//! Time budgets of the labels of a database, and agreement of two annotators.

use morec::labels::{GroundTruth, Sample, SharedClips, TimeBudget};
use morec_db::ClipInfo;
use morec_db::exchange::clip_lengths;
use morec_db::labels::{DbSample, SampleState};
use morec_measure::eval::{EvalError, LabelAgreement, LabelDifference, label_differences};

/// The time budget of the accepted samples among `samples`, which are those of `clips`.
pub fn time_budget<'s>(
    samples: impl IntoIterator<Item = &'s DbSample>,
    clips: &[ClipInfo],
) -> TimeBudget {
    let sample = |s: &DbSample| Sample {
        span: s.span(),
        clip: s.clip_name.clone(),
        class: s.class.clone(),
        whole_clip: s.whole_clip,
        person: s.subject.clone(),
        line: 0,
    };
    let accepted = samples.into_iter().filter(|s| is_accepted(s));
    let samples: Vec<Sample> = accepted.map(sample).collect();
    TimeBudget::of(&samples, &clip_lengths(clips))
}

fn is_accepted(sample: &DbSample) -> bool {
    sample.state == SampleState::Accepted
}

/// Two annotators of a database compared.
#[derive(Debug, Clone, PartialEq)]
pub struct ComparedAnnotators {
    /// Their names, A and B.
    pub names: [String; 2],
    /// How far they agree over the clips that both labelled; `None` if there is no such clip.
    pub agreement: Option<LabelAgreement>,
    /// The samples of both in those clips.
    pub samples: [Vec<DbSample>; 2],
    /// Where they differ, as places in `samples`.
    pub differences: Vec<LabelDifference>,
}

impl ComparedAnnotators {
    /// Compares the accepted samples of two annotators by units of `unit_secs`: starts and stops that are no further apart than a unit
    /// are no difference.
    ///
    /// # Errors
    /// As [`LabelAgreement::of`].
    ///
    /// # Panics
    /// If `unit_secs` is not above 0.
    pub fn of<'s>(
        names: [String; 2],
        samples: impl IntoIterator<Item = &'s DbSample> + Clone,
        clips: &[ClipInfo],
        unit_secs: f64,
    ) -> Result<Self, EvalError> {
        let by = |name: &String| -> Vec<DbSample> {
            let own = |s: &&DbSample| is_accepted(s) && s.annotators.contains(name);
            samples.clone().into_iter().filter(own).cloned().collect()
        };
        let mut samples = [by(&names[0]), by(&names[1])];
        let labels = |samples: &[DbSample]| samples.iter().map(label).collect::<Vec<_>>();
        let (mut a, mut b) = (labels(&samples[0]), labels(&samples[1]));
        let shared = SharedClips::of(&mut a, &mut b, &clip_lengths(clips));
        let is_alone = |s: &DbSample| {
            shared
                .alone
                .iter()
                .any(|alone| alone.contains(&s.clip_name))
        };
        for own in &mut samples {
            own.retain(|s| !is_alone(s));
        }
        let agreement = match shared.streams.is_empty() {
            true => None,
            false => Some(LabelAgreement::of(&shared.streams, &a, &b, unit_secs)?),
        };
        Ok(Self {
            names,
            agreement,
            differences: label_differences(&a, &b, unit_secs),
            samples,
        })
    }
}

fn label(sample: &DbSample) -> GroundTruth {
    GroundTruth {
        clip: sample.clip_name.clone(),
        class: sample.class.clone(),
        span: sample.span(),
    }
}
