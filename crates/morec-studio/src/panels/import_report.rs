//! The report of the last import: refusals with their reasons, near copies, repairs.

use std::collections::BTreeMap;
use std::path::PathBuf;

use egui::{RichText, ScrollArea, Ui};
use morec::labels::some_of;

use super::Out;
use crate::format;
use crate::jobs::import::ImportSummary;
use crate::lists::List;
use crate::state::{Command, CompareCommand, FileCommand, LibraryCommand, State};
use crate::store::Edit;
use crate::theme::Colours;

/// Shows the report of the last import.
pub fn show(ui: &mut Ui, state: &State, out: Out) {
    let Some(report) = &state.import_report else {
        return;
    };
    let c = Colours::now(ui);
    let fill = c.tint(
        if report.refused.is_empty() && report.copies.is_empty() {
            c.good
        } else {
            c.warn
        },
        0.14,
    );
    egui::Frame::new()
        .fill(fill)
        .corner_radius(4.0)
        .inner_margin(8.0)
        .show(ui, |ui| {
            ui.horizontal(|ui| {
                ui.label(RichText::new(report.said()).strong());
                ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                    if ui.small_button("Close").clicked() {
                        out.push(Command::Library(LibraryCommand::DismissReport));
                    }
                    as_background(ui, state, report, out);
                });
            });
            beside(ui, report, out);
            ScrollArea::vertical()
                .id_salt("report")
                .max_height(120.0)
                .show(ui, |ui| {
                    copies(ui, report, out);
                    notes(ui, "refused", &report.refused);
                    notes(ui, "note", &report.warnings);
                });
        });
    ui.add_space(6.0);
}

/// A line for each note, with the names of all files that have it.
fn notes(ui: &mut Ui, kind: &str, said: &[(PathBuf, String)]) {
    const LINES: usize = 100;
    let mut lines: Vec<(&str, Vec<&PathBuf>)> = Vec::new();
    let mut known: BTreeMap<&str, usize> = BTreeMap::new();
    for (path, why) in said {
        let at = *known.entry(why).or_insert(lines.len());
        match lines.get_mut(at) {
            Some((_, paths)) => paths.push(path),
            None => lines.push((why, vec![path])),
        }
    }
    for (why, paths) in lines.iter().take(LINES) {
        let names = some_of(paths.iter().map(|path| format::file_name(path)));
        let all = paths.iter().map(|path| path.display().to_string());
        ui.label(RichText::new(format!("{names}: {kind}: {why}")).size(12.0))
            .on_hover_text(all.take(LINES).collect::<Vec<_>>().join("\n"));
    }
    if lines.len() > LINES {
        ui.label(RichText::new(format!("and {} more", lines.len() - LINES)).size(12.0));
    }
}

/// Labels that lie beside the clips.
fn beside(ui: &mut Ui, report: &ImportSummary, out: Out) {
    let text = match &report.beside[..] {
        [] => return,
        [one] => format!(
            "{} beside the clips contains labels",
            format::file_name(one)
        ),
        many => format!(
            "{} beside the clips contain labels",
            format::count(many.len(), "file")
        ),
    };
    ui.horizontal(|ui| {
        ui.label(text);
        if ui.button("Review the labels").clicked() {
            let command = FileCommand::ImportLabels(report.beside.clone());
            out.push(Command::File(command));
        }
    });
}

/// The imported clips are background.
fn as_background(ui: &mut Ui, state: &State, report: &ImportSummary, out: Out) {
    let Some(store) = &state.store else { return };
    let clips = store.snapshot.clips.iter();
    let clips: Vec<_> = clips
        .filter(|clip| !clip.is_background() && report.clips.contains(&clip.name))
        .map(|clip| clip.id)
        .collect();
    if clips.is_empty() {
        return;
    }
    let response = ui.small_button("Use them as background");
    let response = response.on_hover_text("These clips contain none of the classes");
    if response.clicked() {
        out.push(Command::Edit(Edit::Background { clips, on: true }));
    }
}

/// Clips that are nearly others: compared, or left out again.
fn copies(ui: &mut Ui, report: &ImportSummary, out: Out) {
    let list = List::new(ui, "copies", report.copies.len().min(50));
    for (at, copy) in report.copies.iter().take(50).enumerate() {
        ui.horizontal(|ui| {
            ui.label(RichText::new(&copy.text).size(12.0));
            let compare = ui.small_button("Compare");
            if list.row(ui, at, &compare, false) {
                out.push(Command::Compare(CompareCommand::With {
                    of: copy.of,
                    with: copy.copy,
                    mirrored: copy.mirrored,
                }));
            }
            if ui.small_button("Remove the copy").clicked() {
                out.push(Command::Edit(Edit::RemoveClips(vec![copy.copy.clip])));
            }
        });
    }
}
