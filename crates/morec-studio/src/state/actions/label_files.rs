//! Labels of files: read, looked at, applied.

use std::path::PathBuf;

use crate::jobs::label_files::{self, LabelFiles};
use crate::jobs::{JobOutcome, import::ImportSummary};
use crate::state::{LabelImport, Panel, State};
use crate::store::Edit;

impl State {
    /// Reads files of labels for a look at what they would change.
    pub(in crate::state) fn read_labels(&mut self, paths: Vec<PathBuf>) {
        let Some(store) = &self.store else {
            self.complain("These are labels: open or import their clips first");
            return;
        };
        let db = store.path().to_owned();
        self.jobs.start(
            "Reading labels",
            true,
            &self.wake,
            JobOutcome::LabelsRead,
            move |_| label_files::read(&db, &paths),
        );
    }

    pub(in crate::state) fn labels_read(&mut self, files: LabelFiles) {
        self.label_import = Some(LabelImport {
            files,
            replace: false,
        });
    }

    pub(in crate::state) fn replace_labels(&mut self, replace: bool) {
        if let Some(import) = &mut self.label_import {
            import.replace = replace;
        }
    }

    pub(in crate::state) fn apply_labels(&mut self) {
        let Some(LabelImport { files, replace }) = self.label_import.take() else {
            return;
        };
        if let Some(report) = &mut self.import_report {
            report.beside.retain(|path| !files.paths.contains(path));
        }
        self.edit(Edit::LabelFiles {
            paths: files.paths,
            samples: files.samples,
            people: files.people,
            annotators: files.annotators,
            replace,
        });
    }

    /// Shows what an import did, and goes on with the labels among what was imported.
    pub(in crate::state) fn show_report(&mut self, mut report: ImportSummary) {
        if !report.refused.is_empty() && self.panel != Panel::Library {
            let files = crate::format::count(report.refused.len(), "file");
            self.complain(format!("{files} refused: the library says why"));
        }
        let labels = std::mem::take(&mut report.labels);
        if !labels.is_empty() {
            self.read_labels(labels);
        }
        // Labels alone are no import.
        if report.imported + report.known > 0 || report.says_anything() {
            self.say(report.said());
            self.import_report = Some(report);
        }
    }
}
