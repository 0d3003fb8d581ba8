//! Evaluation: detections compared with labels.

use std::collections::{BTreeMap, BTreeSet};

use morec::classes::ClassId;
use morec::labels::{
    ClipDetection, ClipLength, GroundTruth, Mark, Resolved, Sample, StreamInfo, hint, said_absent,
    some_of,
};
use morec::live::{Detection, Model};
use morec::train::TrainClip;
use morec_measure::eval::{DetectionVerdict, Evaluation, Timeline, event_pairs, timelines};
use morec_measure::explain::{Miss, Performance, deviation, explain};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::OperationError;

/// What counts when detections are held against labels.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, clap::Args)]
#[serde(default, deny_unknown_fields)]
pub struct EvaluateSettings {
    /// Classes that count, separated by commas [default: all]
    ///
    /// Samples of other classes count as unlabelled.
    #[arg(long, value_delimiter = ',', value_name = "CLASSES")]
    pub classes: Vec<String>,
}

/// Detections, held against the labels of the clips that were searched.
#[derive(Debug, Clone, Serialize)]
pub struct EvaluateMeasures {
    /// Every measure.
    #[serde(flatten)]
    pub evaluation: Evaluation,
    /// Samples without an event, and why; only if [`explain`](Self::explain) was asked.
    #[serde(rename = "missed", skip_serializing_if = "Option::is_none")]
    pub misses: Option<Vec<Miss>>,
    /// The labels and detections of each clip, with the verdict on each.
    #[serde(skip)]
    pub timelines: Vec<Timeline>,
    /// What was left out, each in a sentence.
    #[serde(skip)]
    pub notes: Vec<String>,
    #[serde(skip)]
    truths: Vec<GroundTruth>,
    #[serde(skip)]
    founds: Vec<ClipDetection>,
}

impl EvaluateSettings {
    /// Holds `founds` against the labels of `clips`. What has no label in a labelled clip counts as none of the classes; clips
    /// that no label names are left out, and so is what was found in them, but for `unknown` ones.
    ///
    /// # Errors
    /// A class that no label has; nothing that can be measured.
    pub fn evaluate(
        &self,
        clips: &BTreeMap<String, ClipLength>,
        unknown: &BTreeSet<String>,
        labels: Resolved,
        mut founds: Vec<ClipDetection>,
    ) -> Result<EvaluateMeasures, OperationError> {
        let cases = self.cases(clips, unknown, labels)?;
        let streams: BTreeSet<&str> = cases.streams.iter().map(|s| s.clip.as_str()).collect();
        founds.retain(|found| streams.contains(found.clip.as_str()));
        Ok(EvaluateMeasures {
            evaluation: Evaluation::of(&cases.streams, &cases.truths, &founds)?,
            misses: None,
            timelines: timelines(&cases.streams, &cases.truths, &founds)?,
            notes: cases.notes,
            truths: cases.truths,
            founds,
        })
    }

    /// Sorts clips into known, unknown and left out.
    fn cases(
        &self,
        clips: &BTreeMap<String, ClipLength>,
        unknown: &BTreeSet<String>,
        labels: Resolved,
    ) -> Result<LabelledStreams, OperationError> {
        if let Some(why) = labels.doubtful_unit() {
            return Err(OperationError::Settings(format!("labels: {why}")));
        }
        self.check(&labels.samples)?;
        let labelled: BTreeSet<String> = labels.samples.iter().map(|s| s.clip.clone()).collect();
        let mut notes = Vec::new();
        if !labels.absent.is_empty() {
            let known: Vec<String> = clips.keys().cloned().collect();
            notes.push(said_absent(&labels.absent, &known));
        }
        notes.extend(labels.misspelled());
        let counts = |s: &Sample| self.classes.is_empty() || self.classes.contains(&s.class);
        let counted = labels.samples.into_iter().filter(counts);
        let (lost, kept): (Vec<_>, Vec<_>) = counted.partition(|s| unknown.contains(&s.clip));
        if !lost.is_empty() {
            let count = lost.len();
            notes.push(format!(
                "{count} labels are in clips given as unknown; left out"
            ));
        }
        let truths: Vec<GroundTruth> = kept.into_iter().map(GroundTruth::from).collect();
        let known: BTreeSet<&str> = truths.iter().map(|t| t.clip.as_str()).collect();
        let (used, unlabelled): (Vec<_>, Vec<_>) = clips
            .iter()
            .partition(|(name, _)| labelled.contains(*name) || unknown.contains(*name));
        if !unlabelled.is_empty() {
            let names = some_of(unlabelled.iter().map(|(name, _)| *name));
            let count = unlabelled.len();
            notes.push(format!(
                "{count} clips have no label; left out (if they contain no class, give them as --unknown): {names}"
            ));
        }
        let streams = used.into_iter().map(|(name, length)| StreamInfo {
            clip: name.clone(),
            duration_secs: length.duration_secs(),
            unknown: !known.contains(name.as_str()),
        });
        let streams: Vec<StreamInfo> = streams.filter(|s| s.duration_secs > 0.0).collect();
        if streams.is_empty() {
            let why = "nothing to measure: no clip has labels, and none is given as --unknown";
            return Err(OperationError::Settings(why.to_owned()));
        }
        Ok(LabelledStreams {
            streams,
            truths,
            notes,
        })
    }

    fn check(&self, samples: &[Sample]) -> Result<(), OperationError> {
        let known: BTreeSet<&String> = samples.iter().map(|s| &s.class).collect();
        let Some(class) = self.classes.iter().find(|class| !known.contains(class)) else {
            return Ok(());
        };
        let known: Vec<String> = known.into_iter().cloned().collect();
        let hint = hint(class, &known);
        Err(OperationError::Settings(format!(
            "no label of these clips has the requested class {class}{hint}"
        )))
    }
}

/// Streams to measure, and their samples.
struct LabelledStreams {
    streams: Vec<StreamInfo>,
    truths: Vec<GroundTruth>,
    notes: Vec<String>,
}

impl EvaluateMeasures {
    /// Says of each sample of `clips` without an event why `model`, which recognised, did not report it.
    pub fn explain(&mut self, model: &Model, clips: &[TrainClip]) {
        let misses_in = |clip: &TrainClip| {
            let here = self.founds.iter().filter(|f| f.clip == clip.name);
            let here: Vec<&ClipDetection> = here.collect();
            let labelled = self.truths.iter().filter(|t| t.clip == clip.name);
            let labelled: Vec<&GroundTruth> = labelled.collect();
            let pairs = event_pairs(&labelled, &here);
            let missed = labelled.iter().zip(pairs).filter(|(_, p)| p.is_none());
            let sought: Vec<Mark<&str>> = missed.map(|(truth, _)| (*truth).into()).collect();
            let detected = here.iter().filter_map(|found| detection(model, found));
            let detected: Vec<Detection> = detected.collect();
            explain(model, played(clip), &sought, &detected)
        };
        self.misses = Some(clips.par_iter().flat_map_iter(misses_in).collect());
    }

    /// How well the motions of `clips` were performed that `model` recognised rightly.
    pub fn performances(&self, model: &Model, clips: &[TrainClip]) -> Vec<Performance> {
        let performed = |timeline: &Timeline| {
            let clip = clips.iter().find(|c| c.name == timeline.stream.clip);
            clip.map_or_else(Vec::new, |clip| performances(model, clip, timeline))
        };
        let timelines = self.timelines.par_iter();
        timelines.flat_map_iter(performed).collect()
    }
}

fn played(clip: &TrainClip) -> (&morec::Clip, &morec::roles::RoleMap, &morec::clip::Span) {
    (&clip.clip, &clip.roles, &clip.rest)
}

fn performances(model: &Model, clip: &TrainClip, timeline: &Timeline) -> Vec<Performance> {
    let right = timeline.founds.iter();
    let right = right.filter(|(_, verdict)| *verdict == DetectionVerdict::Right);
    let (named, detected): (Vec<&ClipDetection>, Vec<Detection>) = right
        .filter_map(|(found, _)| Some((found, detection(model, found)?)))
        .unzip();
    let deviations = deviation(model, played(clip), &detected);
    let performance = |(found, deviation): (&ClipDetection, Option<_>)| {
        Some(Performance {
            clip: found.clip.clone(),
            class: found.class.clone(),
            span: found.span,
            deviation: deviation?,
        })
    };
    let named = named.into_iter().zip(deviations);
    named.filter_map(performance).collect()
}

/// A row of a table of detections, where the model knows its class.
fn detection(model: &Model, found: &ClipDetection) -> Option<Detection> {
    let class = model.classes().iter().position(|c| c.name == found.class)?;
    Some(Detection {
        class: ClassId(class as u16),
        span: found.span,
        score: found.score.unwrap_or_default(),
        reported_secs: found.reported_secs.unwrap_or(found.span.stop_secs),
        repetitions: None,
    })
}

#[cfg(test)]
mod tests {
    use morec::Labels;

    use super::*;

    const LABELS: &str = "clip\tclass\tstart\tstop\na\tx\t0\t30\nb\ty\t0\t30\nz\ty\t0\t30\n";

    fn measured(
        labels: &str,
        unknown: &[&str],
        classes: &[&str],
    ) -> Result<EvaluateMeasures, OperationError> {
        let length = ClipLength {
            frames: 300,
            rate_hz: 30.0,
        };
        let clips: BTreeMap<String, ClipLength> =
            ["a", "b", "c"].map(|name| (name.to_owned(), length)).into();
        let labels = Labels::read(labels.as_bytes()).unwrap().resolve(&clips);
        let owned = |names: &[&str]| names.iter().map(|n| (*n).to_owned()).collect::<Vec<_>>();
        let settings = EvaluateSettings {
            classes: owned(classes),
        };
        let unknown = owned(unknown).into_iter().collect();
        settings.evaluate(&clips, &unknown, labels, Vec::new())
    }

    fn streams(measured: &EvaluateMeasures) -> Vec<(&str, bool)> {
        let streams = measured.timelines.iter().map(|t| &t.stream);
        streams.map(|s| (s.clip.as_str(), s.unknown)).collect()
    }

    #[test]
    fn clips_without_labels_are_left_out_unless_named_unknown() {
        let plain = measured(LABELS, &[], &[]).unwrap();
        assert_eq!(streams(&plain), [("a", false), ("b", false)]);
        let [absent, unlabelled] = plain.notes.as_slice() else {
            panic!("{:?}", plain.notes);
        };
        assert!(absent.contains("unknown clips: z"), "{absent}");
        assert!(
            unlabelled.starts_with("1 clips have no label"),
            "{unlabelled}"
        );
        let with_unknown = measured(LABELS, &["c", "b"], &[]).unwrap();
        let known = [("a", false), ("b", true), ("c", true)];
        assert_eq!(streams(&with_unknown), known);
        assert_eq!(with_unknown.truths.len(), 1);
        let said = "1 labels are in clips given as unknown";
        assert!(with_unknown.notes.iter().any(|n| n.starts_with(said)));
    }

    #[test]
    fn a_clip_with_other_classes_only_is_unknown() {
        let only_x = measured(LABELS, &[], &["x"]).unwrap();
        assert_eq!(streams(&only_x), [("a", false), ("b", true)]);
        assert_eq!(only_x.truths.len(), 1);
        let error = measured(LABELS, &[], &["walk"]).unwrap_err().to_string();
        assert!(error.contains("has the requested class walk"), "{error}");
    }

    #[test]
    fn nothing_to_measure_is_said() {
        let error = measured("clip\tclass\nz\tx\n", &[], &[]).unwrap_err();
        assert!(error.to_string().contains("nothing to measure"), "{error}");
    }
}
