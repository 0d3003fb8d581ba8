//! How good an index is on what it was not taught: cross-validation, and what became of every label and detection.

use std::collections::BTreeSet;
use std::path::Path;

use morec::crossval::{CrossvalData as Tested, CrossvalError, CrossvalOptions, FoldBy, crossval};
use morec::eval::{Evaluation, FoundVerdict, Timeline, TruthVerdict, timelines};
use morec::explain::Miss;
use morec::train::TrainError;

use super::{JobOutcome, JobProgress, train};

/// What a cross-validation found.
pub struct CrossvalResult {
    pub evaluation: Evaluation,
    pub timelines: Vec<Timeline>,
    /// Why labels were missed.
    pub misses: Vec<Miss>,
    /// What was left out in turn: "each person", "each clip", "half of the labels".
    pub by: &'static str,
}

/// A moment in a clip that is worth looking at.
#[derive(Debug, Clone, PartialEq)]
pub struct Moment {
    pub clip: String,
    pub start_secs: f64,
    pub stop_secs: f64,
    /// What is labelled there, if anything.
    pub truth: Option<String>,
    /// What was recognised there, if anything.
    pub found: Option<String>,
    /// Why it was missed, if it was and that is known.
    pub why: Option<String>,
}

impl Moment {
    pub fn is_right(&self) -> bool {
        self.truth == self.found
    }
}

impl CrossvalResult {
    /// What became of every label, and the detections that belong to none.
    pub fn moments(&self) -> Vec<Moment> {
        let mut moments = Vec::new();
        for timeline in &self.timelines {
            // A clip that several folds tested has the fold in its stream's name.
            let clip = clip_of(&timeline.stream.clip);
            for (truth, verdict) in &timeline.truths {
                let found = match verdict {
                    TruthVerdict::Right => Some(truth.class.clone()),
                    TruthVerdict::Mistaken(class) => Some(class.clone()),
                    TruthVerdict::Missed => None,
                };
                moments.push(Moment {
                    clip: clip.clone(),
                    start_secs: truth.start_secs,
                    stop_secs: truth.stop_secs,
                    truth: Some(truth.class.clone()),
                    found,
                    why: self.why(&timeline.stream.clip, &truth.class, truth.start_secs),
                });
            }
            let alarms = timeline
                .founds
                .iter()
                .filter(|(_, verdict)| *verdict == FoundVerdict::FalseAlarm);
            moments.extend(alarms.map(|(found, _)| Moment {
                clip: clip.clone(),
                start_secs: found.start_secs,
                stop_secs: found.stop_secs,
                truth: None,
                found: Some(found.class.clone()),
                why: None,
            }));
        }
        moments
    }

    fn why(&self, stream: &str, class: &str, start_secs: f64) -> Option<String> {
        let same = |m: &&Miss| {
            m.clip == stream && m.class == class && (m.start_secs - start_secs).abs() < 1e-6
        };
        let miss = self.misses.iter().find(same)?;
        Some(match miss.sensitivity {
            Some(alarms) => format!(
                "{}; at {alarms:.2} false alarms a minute it would have been near enough",
                miss.reason
            ),
            None => miss.reason.to_string(),
        })
    }
}

fn clip_of(stream: &str) -> String {
    stream.split(" (fold").next().unwrap_or(stream).to_owned()
}

/// Trains and tests every fold of the database at `path`.
pub fn judge(path: &Path, classes: &[String], progress: &JobProgress) -> JobOutcome {
    match judged(path, classes, progress) {
        Ok(judged) => JobOutcome::Judged(Box::new(judged)),
        Err(None) => JobOutcome::Cancelled,
        Err(Some(why)) => JobOutcome::Failed(why),
    }
}

fn judged(
    path: &Path,
    classes: &[String],
    progress: &JobProgress,
) -> Result<CrossvalResult, Option<String>> {
    let material = train::material(path, classes).map_err(|e| Some(e.to_string()))?;
    let people: BTreeSet<&str> = material
        .samples
        .iter()
        .filter_map(|s| s.person.as_deref())
        .collect();
    let (by, said) = if people.len() >= 2 {
        (FoldBy::Person, "each person in turn")
    } else if material.clips.len() >= 2 {
        (FoldBy::Clip, "each clip in turn")
    } else {
        (FoldBy::Half { seed: 1 }, "half of the labels")
    };
    let mut clips = material.clips;
    clips.extend_from_slice(train::everyday());
    let tested = Tested {
        clips: &clips,
        samples: &material.samples,
        classes: &material.classes,
        unknown: &[],
        tests: None,
    };
    let outcome = crossval(
        &tested,
        &CrossvalOptions::from(by),
        &train::recipe(),
        progress,
    )
    .map_err(|e| match e {
        CrossvalError::Train {
            source: TrainError::Cancelled,
            ..
        } => None,
        other => Some(format!("Not judged: {other}")),
    })?
    .tested;
    let (streams, truths, founds) = (&outcome.streams, &outcome.truths, &outcome.founds);
    let said_of = |e: morec::eval::EvalError| Some(format!("Not judged: {e}"));
    Ok(CrossvalResult {
        misses: outcome.misses.clone(),
        evaluation: Evaluation::of(streams, truths, founds).map_err(said_of)?,
        timelines: timelines(streams, truths, founds).map_err(said_of)?,
        by: said,
    })
}
