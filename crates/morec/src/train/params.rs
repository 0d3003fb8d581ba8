//! The parameters of training.

use std::collections::BTreeMap;

use crate::decode::DecodeParams;
use crate::features::FeatureParams;

use super::kind::{ClassKind, ClassLabels};

/// Parameters of templates' training.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct TrainParams {
    /// Parameters of feature rows.
    pub features: FeatureParams,
    /// Parameters of decoding.
    pub decode: DecodeParams,
    /// Ridge of the metric, as a share of the mean variance; .15 to .5 are alike.
    pub rho: f64,
    /// Samples of a class that are copied faster at most, those of median duration; the copies are templates too, but for
    /// those that match beginnings of samples.
    pub faster_copies: usize,
    /// Duration of those copies, as a share of the sample's.
    pub faster_duration: f64,
    /// People that must show a class for copies of it: whoever teaches alone performs at the speed that was taught.
    pub faster_people: usize,
    /// Sample pairs a class's scatter is estimated from at most.
    pub max_pairs: usize,
    /// The threshold is this times the smallest distance from a template to background motion.
    pub background_share: f64,
    /// Share of everyday clips that may come nearer than what sets the threshold.
    pub everyday_may_pass: f64,
    /// The threshold lies where background motion would be reported this often a minute; 0: by
    /// [`background_share`](Self::background_share) instead.
    pub alarms_per_minute: f64,
    /// The threshold is at most this.
    pub max_threshold: f64,
    /// The threshold where there is no background at all.
    pub fallback_threshold: f64,
    /// Stretches nearer than this to a template may become negatives.
    pub negative_below: f64,
    /// Unlabelled stretches of labelled clips nearer than this times the threshold are left alone: they are
    /// probably samples that nobody labelled.
    pub suspicious_below: f64,
    /// Negatives kept at most.
    pub max_negatives: usize,
    /// True if negatives are looked for at all.
    pub mine_negatives: bool,
    /// Templates of a class at most, taken from its people in turn.
    pub max_templates: usize,
    /// Background clips up to this times the longest template are negatives as a whole: they are examples of what
    /// a class is not, and what comes before and after is part of it.
    pub whole_background: f64,
    /// Samples whose spread is below this share of what is usual for their class do not teach: they hardly move.
    pub quiet_share: f64,
    /// True if scores are probabilities instead of margins.
    pub calibrate: bool,
    /// True if candidates are verified.
    pub verify: bool,
    /// Samples that the median class must have before candidates are verified: with few, the plain rule is better.
    pub verify_samples: usize,
    /// With fewer samples of the median class than this, the gate against a body at rest is
    /// [`rest_gate_few`](Self::rest_gate_few) under a verifier.
    pub many_samples: usize,
    /// See [`many_samples`](Self::many_samples).
    pub rest_gate_few: f32,
    /// People that must teach before candidates are verified.
    pub verify_people: usize,
    /// The wider gate for performers unlike the teacher, where fewer than [`verify_people`](Self::verify_people) teach.
    pub stranger: StrangerParams,
    /// Candidates are looked at up to this times the distance that nine in ten samples of new people need.
    pub reach: f64,
    /// Examples of a class and sign from one clip, or from two seconds of a long stream, at most.
    pub examples_per_piece: usize,
    /// Near misses of a class to learn from at most, from background and from other classes each.
    pub max_negative_examples: usize,
    /// The nearest N are learned from however far they are.
    pub min_negative_examples: usize,
    /// Samples needed to verify at all, and to verify a class by itself.
    pub min_positives: usize,
    /// Near misses needed to verify at all.
    pub min_negatives: usize,
    /// Ridge of the verifier's kernel regression; .03 to .3 are alike.
    pub verifier_ridge: f64,
    /// True if rows are kept in steps of a byte.
    pub compact: bool,
    /// Bounds of the score above which a candidate is accepted.
    pub bar_range: (f64, f64),
    /// True if whole motions are judged, of bodies: see [`SecondLook`](crate::templates::second_look::SecondLook).
    #[serde(default)]
    pub judge_whole: bool,
    /// True if classes that go on are recognised as activities.
    #[serde(default)]
    pub activities: bool,
    /// Kinds of classes by name, for those whose samples do not say it.
    #[serde(default)]
    pub kinds: BTreeMap<String, ClassKind>,
}

/// Parameters of the wider gate, see [`StrangerGate`](crate::templates::StrangerGate).
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct StrangerParams {
    /// Share of the squared difference of mean poses that is the performer's stance.
    pub discount: f32,
    /// Matches count below this share of a body's distance at rest; 0: there is no wider gate.
    pub rest_gate: f32,
    /// A candidate is refused if another class is nearer than this share of its distance.
    pub rival_share: f32,
    /// The gate opens for a performer of this level.
    pub open_at: f32,
    /// It closes below this one.
    pub close_at: f32,
}

impl Default for StrangerParams {
    fn default() -> Self {
        Self {
            discount: 0.5,
            rest_gate: 0.70,
            rival_share: 1.15,
            open_at: 1.1,
            close_at: 1.0,
        }
    }
}

impl StrangerParams {
    /// No wider gate.
    pub const NONE: Self = Self {
        discount: 0.0,
        rest_gate: 0.0,
        rival_share: 0.0,
        open_at: 0.0,
        close_at: 0.0,
    };
}

impl Default for TrainParams {
    fn default() -> Self {
        Self {
            features: FeatureParams::default(),
            decode: DecodeParams::default(),
            faster_copies: 2,
            alarms_per_minute: 0.3,
            max_threshold: 2.8,
            max_templates: 24,
            whole_background: 1.5,
            quiet_share: 0.35,
            max_negatives: 120,
            calibrate: true,
            verify: true,
            compact: true,
            judge_whole: true,
            activities: true,
            stranger: StrangerParams::default(),
            ..Self::reference()
        }
    }
}

impl TrainParams {
    /// Says which classes are activities and which gestures, whatever their samples say.
    pub fn set_kinds(&mut self, activities: &[String], gestures: &[String]) {
        let named = |names: &[String], kind| -> Vec<(String, ClassKind)> {
            names.iter().map(|name| (name.clone(), kind)).collect()
        };
        self.kinds.extend(named(activities, ClassKind::Activity));
        self.kinds.extend(named(gestures, ClassKind::Gesture));
    }

    /// How a class with such `labels` is recognised, if there is other motion to tell it from.
    pub fn kind(&self, class: &str, labels: &ClassLabels) -> ClassKind {
        match self.kinds.get(class) {
            _ if !self.activities => ClassKind::Gesture,
            Some(kind) => *kind,
            None => labels.kind(),
        }
    }

    /// The values of the reference prototype.
    pub fn reference() -> Self {
        Self {
            features: FeatureParams::reference(),
            decode: DecodeParams::reference(),
            rho: 0.3,
            faster_copies: 0,
            faster_duration: 0.6,
            faster_people: 2,
            max_pairs: 200,
            background_share: 0.85,
            everyday_may_pass: 0.1,
            alarms_per_minute: 0.0,
            max_threshold: f64::MAX,
            fallback_threshold: 2.0,
            negative_below: 2.6,
            suspicious_below: 0.7,
            max_negatives: 60,
            mine_negatives: true,
            max_templates: usize::MAX,
            whole_background: 0.0,
            quiet_share: 0.0,
            calibrate: false,
            verify: false,
            verify_samples: 5,
            many_samples: 25,
            rest_gate_few: 0.64,
            verify_people: 3,
            stranger: StrangerParams::NONE,
            reach: 2.0,
            examples_per_piece: 3,
            max_negative_examples: 400,
            min_negative_examples: 60,
            min_positives: 2,
            min_negatives: 10,
            verifier_ridge: 0.03,
            compact: false,
            bar_range: (0.1, 0.3),
            judge_whole: false,
            activities: false,
            kinds: BTreeMap::new(),
        }
    }
}
