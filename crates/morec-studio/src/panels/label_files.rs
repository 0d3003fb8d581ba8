//! What files of labels would change, before they do.

use egui::{Checkbox, Context, Id, Modal, Rect, RichText, ScrollArea, Sense, Ui, Vec2};
use morec_db::labels::{ChangedLabel, LabelChange};

use super::{Out, widgets};
use crate::format;
use crate::state::{Command, FileCommand, LabelImport, State};
use crate::theme::Colours;

const ROW: f32 = 22.0;
/// Shares of the width: change, clip, class, stretch, what it was.
const SHARES: [f32; 5] = [0.11, 0.27, 0.2, 0.2, 0.22];

pub fn show(ctx: &Context, state: &State, out: Out) {
    let Some(import) = &state.label_import else {
        return;
    };
    let modal = Modal::new(Id::new("labels of files"));
    let modal = modal.show(ctx, |ui| contents(ui, state, import, out));
    if modal.should_close() {
        out.push(Command::File(FileCommand::DismissLabels));
    }
}

fn contents(ui: &mut Ui, state: &State, import: &LabelImport, out: Out) {
    let c = Colours::now(ui);
    let room = ui.ctx().content_rect().size();
    ui.set_width((room.x - 40.0).min(760.0));
    let files = match &import.files.paths[..] {
        [one] => format::file_name(one),
        many => format::count(many.len(), "file"),
    };
    ui.label(
        RichText::new(format!("Labels of {files}"))
            .size(16.0)
            .strong(),
    );
    ui.add_space(4.0);
    let changes = import.changes();
    ui.label(RichText::new(format::changed_labels(&changes.counts)).strong());
    for note in import.files.notes.iter().take(6) {
        ui.label(RichText::new(note).size(12.0).color(c.warn));
    }
    if import.files.notes.len() > 6 {
        let more = format!("and {} more", import.files.notes.len() - 6);
        ui.label(RichText::new(more).size(12.0).color(c.warn));
    }
    let mut replace = import.replace;
    let text = "These files contain all labels of their clips: move, rename and remove existing labels accordingly";
    let response = ui.add(Checkbox::new(&mut replace, text));
    widgets::named(
        &response,
        egui::WidgetType::Checkbox,
        "Replace labels",
        replace,
    );
    if response.changed() {
        out.push(Command::File(FileCommand::ReplaceLabels(replace)));
    }
    ui.add_space(4.0);
    ScrollArea::vertical()
        .max_height((room.y - 250.0).clamp(60.0, 320.0))
        .auto_shrink([false, true])
        .show_rows(ui, ROW, changes.changes.len(), |ui, rows| {
            for change in &changes.changes[rows] {
                row(ui, state, change);
            }
        });
    ui.add_space(6.0);
    ui.horizontal(|ui| {
        let any =
            !changes.changes.is_empty() || changes.counts.people + changes.counts.annotated > 0;
        let apply = ui.add_enabled_ui(any, |ui| widgets::default_button(ui, "Apply", &c));
        if apply.inner {
            out.push(Command::File(FileCommand::ApplyLabels));
        }
        if ui.button("Cancel").clicked() {
            out.push(Command::File(FileCommand::DismissLabels));
        }
    });
}

fn row(ui: &mut Ui, state: &State, change: &ChangedLabel) {
    let c = Colours::now(ui);
    let (rect, response) =
        ui.allocate_exact_size(Vec2::new(ui.available_width(), ROW), Sense::hover());
    let store = state.store.as_ref();
    let clip = store.and_then(|s| s.snapshot.clip(change.clip));
    let clip = clip.map_or("", |clip| clip.name.as_str());
    let (what, colour) = match change.change {
        LabelChange::Added => ("added", c.good),
        LabelChange::Judged => ("judged", c.muted),
        LabelChange::Moved => ("moved", c.accent),
        LabelChange::Renamed => ("renamed", c.accent),
        LabelChange::Gone => ("gone", c.bad),
    };
    let stretch = |start: f64, stop: f64| format!("{start:.2} to {stop:.2} s");
    let was = change.was.as_ref();
    let was = was.map(|(class, start, stop)| format!("was {class} {}", stretch(*start, *stop)));
    let texts = [
        (what.to_owned(), colour),
        (clip.to_owned(), c.text),
        (change.class.clone(), c.text),
        (stretch(change.start_secs, change.stop_secs), c.muted),
        (was.unwrap_or_default(), c.muted),
    ];
    let name: Vec<&str> = texts.iter().map(|(text, _)| text.as_str()).collect();
    widgets::named(&response, egui::WidgetType::Label, name.join(" "), false);
    let mut left = rect.left();
    for ((text, colour), share) in texts.iter().zip(SHARES) {
        let width = share * rect.width();
        let cell = Rect::from_min_size(
            egui::pos2(left, rect.top()),
            Vec2::new(width - 8.0, rect.height()),
        );
        widgets::text_in(ui, cell, text, 12.5, *colour, false);
        left += width;
    }
}
