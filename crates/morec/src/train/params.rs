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
    ///
    /// Of the 12 signals of one clip at half and at two thirds of their duration 7 and 9 are recognised, 6 and 7
    /// without, 6 and 8 by one copy; all 49 signals there F1 0.926 and 0.939 for 0.889 and 0.926; by clip and by
    /// person, sessions of the same person the same (0.949, 0.864, 0.855), by others 0.805 for 0.813; half splits
    /// of 17 referee classes 0.938 / 0.939 for 0.936 / 0.937.
    pub faster_copies: usize,
    /// Duration of those copies, as a share of the sample's.
    ///
    /// 0.50, 0.55, 0.60, 0.65 with two copies, of the 12 signals of one clip at half and at two thirds of their
    /// duration: 8 and 8, 7 and 9, 7 and 9, 6 and 9; half splits of 17 referee classes 0.937 / 0.938 with 0.55,
    /// 0.938 / 0.939 with 0.60; sessions by others alike.
    pub faster_duration: f64,
    /// People that must show a class for copies of it: a single training subject performs at the speed of the samples.
    ///
    /// 1: sessions of the same person 0.840, calibration 0.128; 2: 0.844 and 0.121; both with `decode.rest_gate`
    /// 0.62 and one copy.
    pub faster_people: usize,
    /// Sample pairs a class's scatter is estimated from at most.
    ///
    /// More pairs give the same result; bounds time.
    pub max_pairs: usize,
    /// The threshold is this times the smallest distance from a template to background motion.
    pub background_share: f64,
    /// Share of everyday clips that may come nearer than what sets the threshold.
    ///
    /// Synthetic motion may happen to be one of the classes.
    pub everyday_may_pass: f64,
    /// The threshold lies where background motion would be reported this often a minute; 0: by
    /// [`background_share`](Self::background_share) instead.
    ///
    /// 0.2 gives about the same figures.
    pub alarms_per_minute: f64,
    /// The threshold is at most this.
    ///
    /// Applies where no background comes near; 2.2 and 1.8 cost new people on referee signals.
    pub max_threshold: f64,
    /// The threshold where there is no background at all.
    pub fallback_threshold: f64,
    /// Stretches nearer than this to a template may become negatives.
    pub negative_below: f64,
    /// Unlabelled stretches of labelled clips nearer than this times the threshold are left alone: they are
    /// probably unlabelled samples.
    pub suspicious_below: f64,
    /// Negatives kept at most.
    ///
    /// 17 referee classes, half split, seeds 1 and 4: accuracy and F1 0.942, 0.947; with 60 0.869, 0.857; 200 does
    /// the same as 120; where background is short there are fewer anyway.
    pub max_negatives: usize,
    /// True if negatives are looked for at all.
    pub mine_negatives: bool,
    /// Templates of a class at most, taken from its people in turn.
    ///
    /// Bounds time and file size.
    pub max_templates: usize,
    /// Background clips up to this times the longest template are negatives as a whole: they are examples of what
    /// a class is not, and what comes before and after is part of it.
    pub whole_background: f64,
    /// Samples whose spread is below this share of what is usual for their class do not teach: they hardly move.
    ///
    /// 8 of 532 samples before a Kinect lie below it; they were near everything.
    pub quiet_share: f64,
    /// True if scores are probabilities instead of margins.
    pub calibrate: bool,
    /// True if candidates are verified.
    pub verify: bool,
    /// Samples that the median class must have before candidates are verified: with few, the plain rule is better.
    ///
    /// With the gate of `rest_gate_few`, gestures by person from 5 and 10 samples a class: 0.735 and 0.845 right
    /// with the verifier, 0.694 and 0.796 without (all `dontcare` 0.020); sessions by five others with background:
    /// 0.801 and 0.783; both before `decode.rest_spread`.
    pub verify_samples: usize,
    /// With fewer samples of the median class than this, the gate against a body at rest is
    /// [`rest_gate_few`](Self::rest_gate_few) under a verifier.
    ///
    /// Gestures by person (50 samples a class) want the gate at 0.75 to 0.85, sessions by others (10) at 0.60 to
    /// 0.64; what lies between was not measured.
    pub many_samples: usize,
    /// See [`many_samples`](Self::many_samples).
    ///
    /// 0.60, 0.62, 0.64, 0.67: sessions by others with background, F1 of events 0.834, 0.833, 0.834, 0.820;
    /// gestures by person from 5 and 10 samples a class, right: 0.761 and 0.880 at 0.64.
    pub rest_gate_few: f32,
    /// People that must teach before candidates are verified.
    pub verify_people: usize,
    /// The wider gate for performers unlike the teacher, where fewer than [`verify_people`](Self::verify_people) teach.
    pub stranger: StrangerParams,
    /// Candidates are looked at up to this times the distance that nine in ten samples of new people need.
    pub reach: f64,
    /// Examples of a class and sign from one clip, or from two seconds of a long stream, at most.
    ///
    /// Neighbouring examples are alike; bounds time.
    pub examples_per_piece: usize,
    /// Near misses of a class to learn from at most, from background and from other classes each.
    ///
    /// Bounds time.
    pub max_negative_examples: usize,
    /// The nearest N are learned from however far they are.
    pub min_negative_examples: usize,
    /// Samples needed to verify at all, and to verify a class by itself.
    ///
    /// Fewer give no reliable fit.
    pub min_positives: usize,
    /// Near misses needed to verify at all.
    ///
    /// Fewer give no reliable fit.
    pub min_negatives: usize,
    /// Ridge of the verifier's kernel regression; .03 to .3 are alike.
    pub verifier_ridge: f64,
    /// True if rows are kept in steps of a byte.
    ///
    /// A quarter of the size; recognition uses the rows that the file holds.
    pub compact: bool,
    /// Bounds of the score above which a candidate is accepted.
    pub bar_range: (f64, f64),
    /// True if whole motions are judged, of bodies: see [`SecondLook`](crate::templates::second_look::SecondLook).
    ///
    /// Chosen on sessions and actions, one teacher: F1 of events 0.727 instead of 0.602, and 0.963 instead of
    /// 0.904.
    #[serde(default)]
    pub judge_whole: bool,
    /// Samples of a class that are templates at most, where whole motions are judged; mirrored ones are counted for themselves. 0: all.
    #[serde(default)]
    pub representatives: usize,
    /// True if classes that go on are recognised as activities.
    ///
    /// Exercises, third clip by two: F1 of events 0.865 instead of 0.800; everyday motion by style 0.655 instead of
    /// 0.596; sets of gestures are unchanged.
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
    ///
    /// Half the squared difference of mean poses is the performer's stance; 1 is useless (Kinect gestures by one
    /// teacher, other performers 0.333). All five values were chosen with a prototype on 20 pairs of people before
    /// a Kinect and on the gesture sessions.
    pub discount: f32,
    /// Matches count below this share of a body's distance at rest; 0: there is no wider gate.
    ///
    /// With a gate that is always open, the prototype's events of 20 pairs of people before a Kinect at 0.60, 0.70,
    /// 0.80, 0.90 without a discount: F1 0.854, 0.923, 0.931, 0.926; same person's sessions fall from 0.855 to
    /// 0.768 at 0.70, so it is closed for performers like the training subject.
    pub rest_gate: f32,
    /// A candidate is refused if another class is nearer than this share of its distance.
    ///
    /// 1.15 instead of 1.05 with the gate open: sessions by one teacher 0.015 to 0.02 better, the 20 pairs 0.005
    /// worse; 1.3 loses recall.
    pub rival_share: f32,
    /// The gate opens for a performer of this level.
    ///
    /// The person who taught is at 0.5 to 0.7, others at 1.2 to 1.4.
    pub open_at: f32,
    /// It closes below this one.
    ///
    /// 0.8, 1.0, 1.2: same person's sessions 0.806, 0.839, 0.844, the 20 pairs 0.948, 0.947, 0.927 (prototype,
    /// begun open).
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
            representatives: 3,
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
            representatives: 0,
            activities: false,
            kinds: BTreeMap::new(),
        }
    }
}
