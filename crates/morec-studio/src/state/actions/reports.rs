//! Reports of trainings, cross-validations and learning curves: kept in the database, opened again, exported.

use std::path::Path;

use morec_db::{MotionDb, ReportInfo, ReportKind};
use morec_ops::{KeptCrossval, KeptTraining, LearningCurve};
use serde_json::{Value, json};

use super::lines::ShownCommand;
use crate::jobs::export::write_whole;
use crate::jobs::judge::CrossvalResult;
use crate::jobs::train::TrainedIndex;
use crate::state::State;
use crate::state::train::OpenedReport;
use crate::store::NewReport;

impl State {
    /// Keeps the report of a cross-validation.
    pub(super) fn keep_judged(&mut self, judged: &CrossvalResult) {
        if let Some(store) = &mut self.store {
            store.keep_report(NewReport {
                kind: ReportKind::Crossval,
                title: judged.kept.title(&judged.evaluation),
                report: judged.kept.to_json(&judged.evaluation),
            });
        }
    }

    /// Keeps the report of a training.
    pub(super) fn keep_trained(&mut self, trained: &TrainedIndex) {
        let kept = KeptTraining::of(&trained.report, trained.secs, trained.bytes.len());
        if let Some(store) = &mut self.store {
            store.keep_report(NewReport {
                kind: ReportKind::Training,
                title: KeptTraining::title(&trained.report),
                report: json!(kept),
            });
        }
    }

    /// Keeps a learning curve, and shows it.
    pub(super) fn keep_curve(&mut self, curve: LearningCurve) {
        if let Some(store) = &mut self.store {
            store.keep_report(NewReport {
                kind: ReportKind::Curve,
                title: curve.title(),
                report: json!(curve),
            });
        }
        self.close_curve();
        self.train.curve = Some(curve);
    }

    /// Ends the look at a learning curve.
    pub(super) fn close_curve(&mut self) {
        let is_curve = |opened: &mut OpenedReport| opened.info.kind == ReportKind::Curve;
        self.train.opened.take_if(is_curve);
        self.train.curve = None;
    }

    /// Shows a cross-validation in place of the one before.
    pub(super) fn show_judged(&mut self, judged: CrossvalResult) {
        self.train.judged = Some(judged.into());
        self.train.opened = None;
        self.train.cell = None;
        self.train.moment = None;
    }

    /// Contents of a report of the database, with what is known of it.
    fn report(&self, id: i64) -> Option<Result<(ReportInfo, Value), String>> {
        let store = self.store.as_ref()?;
        let info = store.snapshot.reports.iter().find(|r| r.id == id)?.clone();
        let read = MotionDb::open_read_only(store.path()).and_then(|db| db.report(id));
        Some(read.map(|value| (info, value)).map_err(|e| e.to_string()))
    }

    /// Shows a report of the database as it was when it was made.
    pub(super) fn open_report(&mut self, id: i64) {
        let Some(read) = self.report(id) else { return };
        let shown = read.and_then(|(info, value)| self.show_report_of(info, value));
        if let Err(why) = shown {
            self.complain(format!("Report {id} cannot be shown: {why}"));
        }
    }

    fn show_report_of(&mut self, info: ReportInfo, value: Value) -> Result<(), String> {
        let training = match info.kind {
            ReportKind::Training => {
                let kept: KeptTraining =
                    serde_json::from_value(value).map_err(|e| e.to_string())?;
                Some(kept)
            }
            ReportKind::Crossval => {
                let kept: KeptCrossval =
                    serde_json::from_value(value).map_err(|e| e.to_string())?;
                self.show_judged(CrossvalResult::of(kept).map_err(|e| e.to_string())?);
                None
            }
            ReportKind::Curve => {
                let curve = serde_json::from_value(value).map_err(|e| e.to_string())?;
                self.train.curve = Some(curve);
                None
            }
        };
        self.train.opened = Some(OpenedReport { info, training });
        if let Some(store) = &self.store {
            let line = ShownCommand::new("morec db reports").word(store.path());
            self.show_line(line);
        }
        Ok(())
    }

    /// Ends the look at a report of the database.
    pub(super) fn close_report(&mut self) {
        match self.train.opened.take().map(|opened| opened.info.kind) {
            Some(ReportKind::Crossval) => {
                self.train.judged = None;
                self.train.cell = None;
                self.train.moment = None;
            }
            Some(ReportKind::Curve) => self.train.curve = None,
            _ => {}
        }
    }

    /// Writes a report of the database as JSON.
    pub(super) fn export_report(&mut self, id: i64, path: &Path) {
        let name = crate::format::file_name(path);
        let Some(read) = self.report(id) else { return };
        let written = read.and_then(|(info, value)| {
            let text = format!("{:#}\n", json!({"about": info, "report": value}));
            write_whole(path, text.as_bytes())
        });
        match written {
            Ok(()) => self.say(format!("{name} written")),
            Err(why) => self.complain(format!("{name}: not written: {why}")),
        }
        if let Some(store) = &self.store {
            let line = ShownCommand::new("morec db reports").word(store.path());
            let line = line.with("--only", id.to_string()).with("-o", path);
            self.show_line(line);
        }
    }
}
