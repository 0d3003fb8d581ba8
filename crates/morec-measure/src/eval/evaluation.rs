//! All measures of an evaluation in one value, as `morec evaluate --json` prints it.

use serde::Serialize;

use super::decisions::{Decision, decisions};
use super::pairs::pair;
use super::timing::measured_pairs;
use super::{
    Boundaries, Classification, ClipDetection, Confusion, Delay, EvalError, EvaluatedStream,
    EventScore, FalseAlarms, FrameScore, GroundTruth, Mistake, OVERLAPS, OverlapScore, Reliability,
    StreamInfo, ThesisAccuracy, UnknownFigures, all_classes, streams,
};

/// Every measure, over all streams together and class by class. Serialises to the JSON that `morec evaluate
/// --json` prints: a measure that has nothing to be computed from is `null`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Evaluation {
    /// Size of the evaluated data.
    pub totals: Totals,
    /// Thesis accuracy over known streams.
    pub thesis: ThesisAccuracy,
    /// F1 over known streams, one for each of [`OVERLAPS`].
    pub overlap: Vec<OverlapScore>,
    /// F1 of events over known streams.
    pub events: EventScore,
    /// Scores against the share of right detections, over all streams.
    pub reliability: Reliability,
    /// False alarms in known streams.
    pub false_alarms: FalseAlarms,
    /// Detections in unknown streams.
    pub unknown: UnknownFigures,
    /// Delay of the report.
    pub delay: Delay,
    /// Errors of starts and stops.
    pub boundaries: Boundaries,
    /// P_C, P_E and P_R.
    pub classification: Classification,
    /// Shares of time, and order.
    pub frames: FrameScore,
    /// Confusion matrix of known streams.
    pub confusion: Confusion,
    /// Each class that is labelled or found, by name.
    pub classes: Vec<ClassFigures>,
}

/// Size of the evaluated data.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Totals {
    /// Streams that are not unknown motion.
    pub known_clips: usize,
    /// Length, seconds.
    pub known_secs: f64,
    /// Labelled samples.
    pub samples: usize,
    /// Detections in known streams.
    pub detections: usize,
}

/// The measures of one class.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ClassFigures {
    /// Name of the class.
    pub class: String,
    /// Number of its samples.
    pub samples: usize,
    /// Its detections in known streams.
    pub detections: usize,
    /// Its detections in unknown streams.
    pub unknown_detections: usize,
    /// F1, one for each of [`OVERLAPS`].
    pub overlap: Vec<OverlapScore>,
    /// Its false alarms in known streams.
    pub false_alarms: FalseAlarms,
    /// Delay of the report.
    pub delay: Delay,
    /// Errors of starts and stops.
    pub boundaries: Boundaries,
    /// P_C, P_E and P_R of its samples.
    pub classification: Classification,
    /// Classes that its samples were taken for, most frequent first (as in [`Confusion`]).
    pub mistaken_for: Vec<Mistake>,
    /// Number of its samples that no detection matched (as in [`Confusion`]).
    pub missed: usize,
}

impl Evaluation {
    /// Computes every measure. O(samples × detections) within each stream.
    ///
    /// # Errors
    /// A stream named twice or without a length, or a sample or detection in an unknown stream or without a positive extent.
    pub fn of(
        infos: &[StreamInfo],
        truths: &[GroundTruth],
        founds: &[ClipDetection],
    ) -> Result<Self, EvalError> {
        let all = streams(infos, truths, founds)?;
        let classes = all_classes(&all);
        let (unknown, known): (Vec<_>, Vec<_>) = all.into_iter().partition(|s| s.info.unknown);
        let decided: Vec<Decision<'_>> = known.iter().flat_map(decisions).collect();
        let confusion = Confusion::new(&decided, &classes);
        let pairs = measured_pairs(&known);
        let paired = PairedClasses::new(&known);
        let per_class = |class: &&str| {
            let pairs: Vec<_> = pairs
                .iter()
                .copied()
                .filter(|(t, _)| t.class == **class)
                .collect();
            ClassFigures {
                class: (*class).to_owned(),
                samples: count_truths(&known, Some(class)),
                detections: count_founds(&known, Some(class)),
                unknown_detections: count_founds(&unknown, Some(class)),
                overlap: paired.scores(&known, Some(class)),
                false_alarms: FalseAlarms::count(&known, Some(class)),
                delay: Delay::of(&pairs),
                boundaries: Boundaries::of(&pairs),
                classification: Classification::count(&known, Some(class)),
                mistaken_for: confusion.mistakes(class),
                missed: confusion.missed(class),
            }
        };
        Ok(Self {
            totals: Totals::count(&known),
            thesis: ThesisAccuracy::count(&decided),
            overlap: paired.scores(&known, None),
            events: EventScore::count(&known),
            reliability: Reliability::count(known.iter().chain(&unknown)),
            false_alarms: FalseAlarms::count(&known, None),
            unknown: UnknownFigures::count(&unknown),
            delay: Delay::of(&pairs),
            boundaries: Boundaries::of(&pairs),
            classification: Classification::count(&known, None),
            frames: FrameScore::count(&known),
            classes: classes.iter().map(per_class).collect(),
            confusion,
        })
    }

    /// F1 at one of [`OVERLAPS`].
    pub fn f1_at(&self, min_iou: f64) -> Option<f64> {
        self.overlap
            .iter()
            .find(|score| score.min_iou == min_iou)?
            .f1
    }
}

impl Totals {
    fn count(known: &[EvaluatedStream<'_>]) -> Self {
        Self {
            known_clips: known.len(),
            known_secs: known.iter().map(|s| s.info.duration_secs).sum(),
            samples: count_truths(known, None),
            detections: count_founds(known, None),
        }
    }
}

/// For each of [`OVERLAPS`], the classes of the pairs: pairing is done once, counting for every class.
struct PairedClasses<'a>(Vec<(f64, Vec<&'a str>)>);

impl<'a> PairedClasses<'a> {
    fn new(known: &[EvaluatedStream<'a>]) -> Self {
        let classes_of = |stream: &EvaluatedStream<'a>, min_iou| {
            pair(stream, min_iou)
                .into_iter()
                .map(|(t, _)| stream.truths[t].class.as_str())
                .collect::<Vec<_>>()
        };
        Self(
            OVERLAPS
                .map(|min| (min, known.iter().flat_map(|s| classes_of(s, min)).collect()))
                .to_vec(),
        )
    }

    fn scores(&self, known: &[EvaluatedStream<'_>], class: Option<&str>) -> Vec<OverlapScore> {
        let (samples, detections) = (count_truths(known, class), count_founds(known, class));
        let matched = |classes: &[&str]| {
            classes
                .iter()
                .filter(|c| class.is_none_or(|class| class == **c))
                .count()
        };
        self.0
            .iter()
            .map(|(min, classes)| OverlapScore::new(*min, matched(classes), samples, detections))
            .collect()
    }
}

fn count_truths(streams: &[EvaluatedStream<'_>], class: Option<&str>) -> usize {
    streams
        .iter()
        .flat_map(|s| &s.truths)
        .filter(|t| class.is_none_or(|c| c == t.class))
        .count()
}

fn count_founds(streams: &[EvaluatedStream<'_>], class: Option<&str>) -> usize {
    streams
        .iter()
        .flat_map(|s| &s.founds)
        .filter(|f| class.is_none_or(|c| c == f.class))
        .count()
}
