//! Cross-validation of the labels in the database, and the result for every label and every false detection.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use morec::TimeSpan;
use morec::labels::{ClipDetection, GroundTruth, Sample};
use morec::train::TrainClip;
use morec_measure::crossval::Tested;
use morec_measure::eval::{
    DetectionVerdict, EvalError, Evaluation, GroundTruthVerdict, Timeline, timelines,
};
use morec_ops::{
    CrossvalSettings, KeptCrossval, LeftOut, Method, MissedLabel, OperationError, TrainSettings,
    Unlearned, tested_together,
};

use super::progress::{JobError, JobProgress};
use super::train::{material, tested};

/// Result of a cross-validation.
pub struct CrossvalResult {
    /// What the measures follow from.
    pub kept: KeptCrossval,
    pub evaluation: Evaluation,
    pub timelines: Vec<Timeline>,
    /// For each tested clip, by name, the labels that did not teach what tested it.
    pub unlearned: BTreeMap<String, Unlearned>,
}

/// What holds all of a class that cannot be tested: "one person".
pub fn only_part(by: LeftOut) -> &'static str {
    match by {
        LeftOut::Person | LeftOut::Own => "one person",
        LeftOut::Clip | LeftOut::Half => "one clip",
    }
}

/// A label with what was recognised in its place, or a false detection: the unit of the confusion matrix and of the
/// list of mistakes.
///
/// A false detection is one that matches no label: neither a label of its class, nor one that was taken for its class.
#[derive(Debug, Clone, PartialEq)]
pub struct Moment {
    pub clip: String,
    pub span: TimeSpan,
    /// Class of the label; `None` for a false detection.
    pub truth: Option<String>,
    /// Class that was recognised; `None` for a label that was missed.
    pub found: Option<String>,
    /// Reason of a miss, if it is known.
    pub why: Option<String>,
}

impl Moment {
    pub fn is_right(&self) -> bool {
        self.truth == self.found
    }

    /// The classes whose nearest label is worth comparing with: the one that was recognised, then the one that is
    /// labelled.
    pub fn compared_with(&self) -> Vec<&str> {
        let mut classes: Vec<&str> = self.found.as_deref().into_iter().collect();
        classes.extend(self.truth.as_deref());
        classes.dedup();
        classes
    }

    /// Description in a few words: `wave mistaken for clap`.
    pub fn said(&self) -> String {
        match (&self.truth, &self.found) {
            (Some(truth), Some(found)) if truth == found => truth.clone(),
            (Some(truth), Some(found)) => format!("{truth} mistaken for {found}"),
            (Some(truth), None) => format!("{truth} missed"),
            (None, Some(found)) => format!("{found} without a label"),
            (None, None) => String::new(),
        }
    }
}

impl CrossvalResult {
    /// Measures what was tested.
    pub fn of(kept: KeptCrossval) -> Result<Self, EvalError> {
        let (streams, truths, founds) = (&kept.streams, &kept.truths, &kept.founds);
        let of_fold = |(clips, without): &(Vec<String>, Unlearned)| {
            let clips = clips.iter().map(|clip| (clip.clone(), without.clone()));
            clips.collect::<Vec<_>>()
        };
        Ok(Self {
            evaluation: Evaluation::of(streams, truths, founds)?,
            timelines: timelines(streams, truths, founds)?,
            unlearned: kept.folds.iter().flat_map(of_fold).collect(),
            kept,
        })
    }

    /// Every label once, and every false detection once, by stream and time.
    pub fn moments(&self) -> Vec<Moment> {
        let mut moments = Vec::new();
        for timeline in &self.timelines {
            // A clip that several folds tested has the fold in its stream's name.
            let clip = clip_of(&timeline.stream.clip);
            for (truth, verdict) in &timeline.truths {
                let found = match verdict {
                    GroundTruthVerdict::Right => Some(truth.class.clone()),
                    GroundTruthVerdict::Mistaken(class) => Some(class.clone()),
                    GroundTruthVerdict::Missed => None,
                };
                moments.push(Moment {
                    clip: clip.clone(),
                    span: truth.span,
                    truth: Some(truth.class.clone()),
                    found,
                    why: self.why(&timeline.stream.clip, &truth.class, truth.span.start_secs),
                });
            }
            moments.extend(false_detections(timeline).map(|found| Moment {
                clip: clip.clone(),
                span: found.span,
                truth: None,
                found: Some(found.class.clone()),
                why: None,
            }));
        }
        moments
    }

    fn why(&self, stream: &str, class: &str, start_secs: f64) -> Option<String> {
        let same = |m: &&MissedLabel| {
            m.clip == stream && m.class == class && (m.span.start_secs - start_secs).abs() < 1e-6
        };
        let miss = self.kept.missed.iter().find(same)?;
        Some(miss.reason.clone())
    }
}

/// The detections of a stream that match no label.
fn false_detections(timeline: &Timeline) -> impl Iterator<Item = &ClipDetection> {
    // The verdict on a detection does not say which label it was taken for; the verdicts on labels do.
    let mistaken = move |found: &ClipDetection| {
        timeline.truths.iter().any(|(truth, verdict)| {
            matches!(verdict, GroundTruthVerdict::Mistaken(class) if *class == found.class)
                && truth.span.matches(found.span)
        })
    };
    let founds = timeline.founds.iter();
    founds.filter_map(move |(found, verdict)| match verdict {
        DetectionVerdict::Right | DetectionVerdict::Loose => None,
        DetectionVerdict::WrongClass | DetectionVerdict::FalseAlarm => {
            (!mistaken(found)).then_some(found)
        }
    })
}

fn clip_of(stream: &str) -> String {
    stream.split(" (fold").next().unwrap_or(stream).to_owned()
}

/// Trains and tests every fold of the database at `path`.
pub fn judge(
    path: &Path,
    train: &TrainSettings,
    by: LeftOut,
    progress: &JobProgress,
) -> Result<Box<CrossvalResult>, JobError> {
    let judged = || -> Result<_, OperationError> {
        let data = material(path, &train.classes)?;
        let how = CrossvalSettings {
            by,
            ..CrossvalSettings::default()
        };
        let tested = how.crossval(&tested(&data), train, progress)?.tested;
        let untested = untested(by, &data.clips, &data.samples);
        let unlearned = Unlearned::of_folds(how.fold_by(), &data.clips, &data.samples);
        let tested = without(tested, &untested);
        let kept = KeptCrossval {
            by,
            thesis: train.method == Method::Svrdm,
            untested,
            missed: tested.misses.iter().map(MissedLabel::from).collect(),
            streams: tested.streams,
            truths: tested.truths,
            founds: tested.founds,
            folds: tested_together(unlearned),
        };
        Ok(CrossvalResult::of(kept)?)
    };
    let judged = judged().map_err(|error| JobError::of("Not judged", error))?;
    Ok(Box::new(judged))
}

/// The classes that only one part shows: without it there is nothing that could teach them.
fn untested(by: LeftOut, clips: &[TrainClip], samples: &[Sample]) -> Vec<String> {
    let person = |clip: &str| {
        let clip = clips.iter().find(|c| c.name == clip);
        clip.and_then(|c| c.person.as_deref())
    };
    let mut parts: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for sample in samples {
        let clip = sample.clip.as_str();
        let part = match by {
            LeftOut::Person | LeftOut::Own => person(clip).unwrap_or(clip),
            LeftOut::Clip => clip,
            LeftOut::Half => return Vec::new(),
        };
        parts.entry(&sample.class).or_default().insert(part);
    }
    let alone = parts.into_iter().filter(|(_, parts)| parts.len() == 1);
    alone.map(|(class, _)| class.to_owned()).collect()
}

/// The outcome without the labels of some classes, and without what was recognised in their place.
fn without(mut outcome: Tested, classes: &[String]) -> Tested {
    let (dropped, kept) = outcome
        .truths
        .into_iter()
        .partition(|truth| classes.contains(&truth.class));
    let dropped: Vec<GroundTruth> = dropped;
    outcome.truths = kept;
    outcome.misses.retain(|miss| !classes.contains(&miss.class));
    let there = |truth: &GroundTruth, found: &ClipDetection| {
        truth.clip == found.clip && truth.span.matches(found.span)
    };
    let kept: &[GroundTruth] = &outcome.truths;
    outcome.founds.retain(|found| {
        kept.iter().any(|truth| there(truth, found))
            || !dropped.iter().any(|truth| there(truth, found))
    });
    outcome
}

#[cfg(test)]
mod tests {
    use morec::labels::StreamInfo;

    use super::*;

    fn truth(class: &str, start_secs: f64, stop_secs: f64) -> GroundTruth {
        GroundTruth {
            clip: "a".to_owned(),
            class: class.to_owned(),
            span: TimeSpan::new(start_secs, stop_secs),
        }
    }

    fn found(class: &str, start_secs: f64, stop_secs: f64) -> ClipDetection {
        ClipDetection {
            clip: "a".to_owned(),
            class: class.to_owned(),
            span: TimeSpan::new(start_secs, stop_secs),
            score: None,
            reported_secs: None,
            repetitions: None,
        }
    }

    fn moments(truths: &[GroundTruth], founds: &[ClipDetection]) -> Vec<Moment> {
        let streams = [StreamInfo {
            clip: "a".to_owned(),
            duration_secs: 60.0,
            unknown: false,
        }];
        let kept = KeptCrossval {
            by: LeftOut::Half,
            thesis: false,
            untested: Vec::new(),
            streams: streams.to_vec(),
            truths: truths.to_vec(),
            founds: founds.to_vec(),
            missed: Vec::new(),
            folds: Vec::new(),
        };
        CrossvalResult::of(kept).unwrap().moments()
    }

    fn pairs(moments: &[Moment]) -> Vec<(Option<&str>, Option<&str>)> {
        let names = moments
            .iter()
            .map(|m| (m.truth.as_deref(), m.found.as_deref()));
        let mut names: Vec<_> = names.collect();
        names.sort();
        names
    }

    #[test]
    fn every_label_is_counted_once_and_every_false_detection_once() {
        let truths = [
            truth("wave", 1.0, 2.0),
            truth("wave", 5.0, 6.0),
            truth("clap", 10.0, 11.0),
            truth("bow", 20.0, 21.0),
        ];
        let founds = [
            found("wave", 1.0, 2.0),
            // Twice in one unlabelled stretch: the confusion matrix of stretches would count one.
            found("clap", 30.0, 31.0),
            found("clap", 33.0, 34.0),
            // Taken for another class: the label's mistake, not a false detection as well.
            found("bow", 5.0, 6.0),
            // Of another class on a label that is recognised, too.
            found("clap", 10.0, 11.0),
            found("wave", 10.5, 10.9),
        ];
        let (wave, clap, bow) = (Some("wave"), Some("clap"), Some("bow"));
        let mut expected = vec![
            (wave, wave),
            (wave, bow),
            (clap, clap),
            (bow, None),
            (None, clap),
            (None, clap),
            (None, wave),
        ];
        expected.sort();
        assert_eq!(pairs(&moments(&truths, &founds)), expected);
    }

    #[test]
    fn a_long_detection_that_decides_a_label_is_no_false_detection() {
        // Most of it lies outside of the label that it is the only match of.
        let moments = moments(&[truth("wave", 5.0, 6.0)], &[found("bow", 4.9, 9.0)]);
        assert_eq!(pairs(&moments), [(Some("wave"), Some("bow"))]);
    }
}
