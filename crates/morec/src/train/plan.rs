//! What decides about matches: a verifier, the second look, or gates and thresholds alone.

use std::collections::BTreeSet;

use crate::classes::ClassInfo;
use crate::decode::{DecodeParams, FAR};
use crate::features::{BoneSet, Profile};
use crate::templates::MatchGate;

use super::comparison::TrainingContext;
use super::mining::TrainGates;
use super::params::TrainParams;
use super::second_look;
use super::set::{TrainSample, TrainSet};
use super::verifier;

/// Share of a body's distance at rest below which a match is a candidate of the second look: a body at rest never matches.
const CANDIDATE_REST_GATE: f32 = 0.85;

/// What will decide about matches, as far as it is known before they are computed.
pub struct DecisionPlan {
    /// The gate against a body at rest under a verifier, if enough people showed enough samples for one.
    verified_gate: Option<f32>,
    /// A verifier is learned from the matches.
    pub verifies: bool,
    /// The second look compares whole motions, unless a verifier decides.
    pub judges_whole: bool,
    /// What the second look learns from.
    pub judged: Vec<TrainSample>,
    /// What matches must be like.
    pub gates: TrainGates,
}

impl DecisionPlan {
    pub fn new(
        step: &TrainingContext<'_>,
        bones: BoneSet,
        classes: &[ClassInfo],
        (gestures, going_on): (&[TrainSample], &[TrainSample]),
    ) -> Self {
        let (set, params) = (step.set, step.params);
        let verified_gate = verified_gate(classes, gestures, params).filter(|_| params.verify);
        let verifies = verified_gate.is_some() && verifier::has_background(set, params);
        let judges_whole = params.judge_whole
            && Profile::of(bones) == Profile::Body
            && second_look::are_apart(set, gestures, bones, params);
        // The second look needs no gate of its own for strangers.
        let wide = wide_gate(set, gestures, params).filter(|_| !verifies && !judges_whole);
        Self {
            verified_gate,
            verifies,
            judges_whole,
            // The second look compares activities too; their windows report them.
            judged: match judges_whole {
                true => [gestures, going_on].concat(),
                false => Vec::new(),
            },
            gates: TrainGates {
                plain: MatchGate::plain(params.decode.rest_gate),
                wide,
            },
        }
    }

    /// True if the second look is learned before the matches are known.
    pub fn decides_by_look(&self) -> bool {
        self.judges_whole && !self.verifies
    }

    /// How far matches are computed: the gate of a verifier, and the farthest distance that a threshold may reach.
    pub fn reach(&self, largest_threshold: f64) -> (Option<MatchGate>, f32) {
        let verified = self.verified_gate.filter(|_| self.verifies);
        let farthest = match largest_threshold > 0.0 {
            true => largest_threshold as f32,
            false => FAR,
        };
        (verified.map(MatchGate::plain), farthest)
    }

    /// Parameters of decoding under this plan; `has_look` if the second look was learned.
    pub fn decode(&self, params: &DecodeParams, has_look: bool) -> DecodeParams {
        let mut decode = params.clone();
        if let Some(gate) = self.verified_gate {
            decode.rest_gate_verified = gate;
        }
        if has_look {
            decode.rest_gate = CANDIDATE_REST_GATE;
        }
        decode
    }
}

/// The wider gate of matches, if so few people teach that a stranger is likely to be unlike them. Who is not named is one person.
fn wide_gate(set: &TrainSet, samples: &[TrainSample], params: &TrainParams) -> Option<MatchGate> {
    let people: BTreeSet<Option<&str>> = samples
        .iter()
        .map(|s| set.streams[s.stream].person.as_deref())
        .collect();
    let few = people.len() < params.verify_people && params.alarms_per_minute > 0.0;
    (few && params.stranger.rest_gate > 0.0).then_some(MatchGate {
        discount: params.stranger.discount,
        rest_share: params.stranger.rest_gate,
    })
}

/// The gate against a body at rest under a verifier, if enough people showed enough samples that a verifier is better
/// than the plain rule. With few samples the gate has to do what the verifier could not learn.
fn verified_gate(
    classes: &[ClassInfo],
    samples: &[TrainSample],
    params: &TrainParams,
) -> Option<f32> {
    let mut counts: Vec<usize> = classes.iter().map(|c| c.samples).collect();
    counts.sort_unstable();
    let people: BTreeSet<&str> = samples.iter().map(|s| s.group.as_str()).collect();
    let median = counts.get(counts.len() / 2).copied().unwrap_or(0);
    let enough = median >= params.verify_samples && people.len() >= params.verify_people;
    enough.then_some(if median >= params.many_samples {
        params.decode.rest_gate_verified
    } else {
        params.rest_gate_few
    })
}
