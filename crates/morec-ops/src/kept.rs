//! Reports of trainings and cross-validations as a database keeps them.

use std::collections::BTreeMap;

use morec::TimeSpan;
use morec::labels::{ClipDetection, GroundTruth, StreamInfo};
use morec::train::TrainingReport;
use morec_db::{DbError, MotionDb, ReportKind};
use morec_measure::eval::Evaluation;
use morec_measure::explain::Miss;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::{LeftOut, Unlearned};

/// A cross-validation: what was tested and found, from which its measures follow.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct KeptCrossval {
    /// The part that was left out in turn.
    pub by: LeftOut,
    /// True if the method of 2009 was judged.
    pub thesis: bool,
    /// Classes of which nothing is left to learn from when their part is left out: they were not tested.
    pub untested: Vec<String>,
    /// The tested streams.
    pub streams: Vec<StreamInfo>,
    /// Their labels.
    pub truths: Vec<GroundTruth>,
    /// What was recognised in them.
    pub founds: Vec<ClipDetection>,
    /// Labels that were missed, with reasons.
    pub missed: Vec<MissedLabel>,
    /// Clips that were tested together, and the labels that did not teach what tested them.
    pub folds: Vec<(Vec<String>, Unlearned)>,
}

/// A label that was missed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MissedLabel {
    /// Name of the stream: the clip's, with its fold where several tested it.
    pub clip: String,
    /// Name of the class.
    pub class: String,
    /// Time of the label.
    #[serde(flatten)]
    pub span: TimeSpan,
    /// Reason in words.
    pub reason: String,
}

impl From<&Miss> for MissedLabel {
    fn from(miss: &Miss) -> Self {
        let reason = match miss.sensitivity {
            Some(alarms) => format!(
                "{}; at {alarms:.2} false alarms a minute it is found",
                miss.reason
            ),
            None => miss.reason.to_string(),
        };
        Self {
            clip: miss.clip.clone(),
            class: miss.class.clone(),
            span: miss.span,
            reason,
        }
    }
}

/// Clips whose models were taught without the same labels, together.
pub fn tested_together(unlearned: BTreeMap<String, Unlearned>) -> Vec<(Vec<String>, Unlearned)> {
    let mut folds: Vec<(Vec<String>, Unlearned)> = Vec::new();
    for (clip, without) in unlearned {
        match folds.iter_mut().find(|(_, of)| *of == without) {
            Some((clips, _)) => clips.push(clip),
            None => folds.push((vec![clip], without)),
        }
    }
    folds
}

impl KeptCrossval {
    /// The result in a line.
    pub fn title(&self, evaluation: &Evaluation) -> String {
        let found = format!(
            "{} of {} found",
            evaluation.events.matched, evaluation.totals.samples
        );
        match self.thesis {
            true => format!("{found}, method of 2009"),
            false => found,
        }
    }

    /// As it is kept, with its measures for readers of the export.
    pub fn to_json(&self, evaluation: &Evaluation) -> Value {
        let mut value = json!(self);
        value["evaluation"] = json!(evaluation);
        value
    }

    /// Keeps it in a database, as JSON with its measures. Gives the number of the report.
    ///
    /// # Errors
    /// The database cannot be written.
    pub fn keep(&self, db: &mut MotionDb, evaluation: &Evaluation) -> Result<i64, DbError> {
        let value = self.to_json(evaluation);
        db.keep_report(ReportKind::Crossval, &self.title(evaluation), &value)
    }
}

/// A training: its result in sentences, and its report for readers of the export.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct KeptTraining {
    /// Duration of training, seconds.
    pub secs: f64,
    /// Size of the index.
    pub bytes: usize,
    /// The threshold, the background and the verifier in sentences.
    pub said: Vec<String>,
    /// Notes for the user.
    pub notes: Vec<String>,
    /// The report, as `morec train --json` prints it.
    pub report: Value,
}

impl KeptTraining {
    /// The training that made an index of `bytes` bytes in `secs` seconds.
    pub fn of(report: &TrainingReport, secs: f64, bytes: usize) -> Self {
        Self {
            secs,
            bytes,
            said: training_in_words(report),
            notes: report.notes.iter().map(ToString::to_string).collect(),
            report: json!(report),
        }
    }

    /// What was learned, in a line.
    pub fn title(report: &TrainingReport) -> String {
        let labels: usize = report.classes.iter().map(|class| class.samples).sum();
        let names: Vec<&str> = report.classes.iter().map(|c| c.name.as_str()).collect();
        let plural = if labels == 1 { "" } else { "s" };
        format!("{labels} label{plural} of {}", names.join(", "))
    }

    /// Keeps it in a database. Gives the number of the report.
    ///
    /// # Errors
    /// The database cannot be written.
    pub fn keep(&self, db: &mut MotionDb, title: &str) -> Result<i64, DbError> {
        db.keep_report(ReportKind::Training, title, &json!(self))
    }
}

/// The threshold, the background and the verifier of a training, in sentences.
pub fn training_in_words(report: &TrainingReport) -> Vec<String> {
    let mut lines = Vec::new();
    if let Some(threshold) = report.threshold {
        let what = match report.judges_whole {
            true => "Least score",
            false => "Threshold",
        };
        let from = &report.threshold_from;
        lines.push(format!("{what} {threshold:.2}, set by {from}"));
    }
    let secs = report.background_secs.iter();
    let secs: Vec<String> = secs.map(|(of, secs)| format!("{of} {secs:.0} s")).collect();
    if !secs.is_empty() {
        lines.push(format!("Background: {}", secs.join(", ")));
    }
    lines.push(match report.verified {
        true => "Candidates are verified.".to_owned(),
        false => "Candidates are not verified: this needs five labels in half of the classes, three people, and background."
            .to_owned(),
    });
    lines
}
