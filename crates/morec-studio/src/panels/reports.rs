//! Reports that the database keeps: their list, and the one that was opened.

use egui::{Id, RichText, ScrollArea, Sense, Ui, Vec2, WidgetType};

use super::{Out, widgets};
use crate::format;
use crate::lists::List;
use crate::state::{Command, FileCommand, State, TrainCommand};
use crate::theme::Colours;

const ROW: f32 = 22.0;
/// Rows that are seen at once.
const ROWS: usize = 6;

/// The reports, the last first.
pub fn list(ui: &mut Ui, state: &State, out: Out) {
    let Some(store) = &state.store else { return };
    let c = Colours::now(ui);
    let reports = &store.snapshot.reports;
    ui.add_space(8.0);
    widgets::section(ui, "REPORTS IN THE DATABASE");
    if reports.is_empty() {
        ui.colored_label(c.muted, "No report is stored yet.");
        return;
    }
    ui.spacing_mut().item_spacing.y = 0.0;
    let height = ROW * reports.len().min(ROWS) as f32;
    let area = ScrollArea::vertical()
        .id_salt("reports")
        .max_height(height)
        .auto_shrink([false, true]);
    area.show_rows(ui, ROW, reports.len(), |ui, rows| {
        let list = List::following(ui, "reports", reports.len());
        list.scroll(ui, list.wanted, rows.start, ROW);
        for at in rows {
            let report = &reports[at];
            let size = Vec2::new(ui.available_width(), ROW);
            let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
            // What is opened changes what lies above, and with it the numbers of widgets.
            let id = Id::new(("report", report.id));
            let response = ui.interact(rect, id, Sense::click());
            let opened = state.train.opened.as_ref();
            let on = opened.is_some_and(|opened| opened.info.id == report.id);
            let what = report.kind.title();
            let called = format!("Report {}: {what}, {}", report.id, report.title);
            widgets::named(&response, WidgetType::SelectableLabel, &called, on);
            widgets::row_ground(ui, rect, &response, on);
            let inner = rect.shrink2(Vec2::new(4.0, 0.0));
            let text = format!("{what}: {}", report.title);
            widgets::text_in(ui, inner, &text, 12.0, c.text, false);
            let when = format!("{called}\n{}", format::utc(report.made_secs));
            let response = response.on_hover_text(when);
            if list.row(ui, at, &response, on) {
                out.push(Command::Train(TrainCommand::OpenReport(report.id)));
            }
        }
    });
}

/// The report that was opened: when it was made, and what is said of a training.
pub fn opened(ui: &mut Ui, state: &State, out: Out) {
    let Some(opened) = &state.train.opened else {
        return;
    };
    let c = Colours::now(ui);
    widgets::boxed(ui, |ui| {
        ui.horizontal_wrapped(|ui| {
            let when = format::utc(opened.info.made_secs);
            let title = format!("Report of {when}: {}", opened.info.kind.title());
            ui.label(RichText::new(title).strong());
            ui.colored_label(c.muted, &opened.info.title);
            if ui.button("Export the report …").clicked() {
                let command = FileCommand::AskExportReport(opened.info.id);
                out.push(Command::File(command));
            }
            if ui.button("Close the report").clicked() {
                out.push(Command::Train(TrainCommand::CloseReport));
            }
        });
        let Some(training) = &opened.training else {
            let text = "Labels may have changed since then.";
            ui.colored_label(c.muted, text);
            return;
        };
        let figures = format!(
            "{:.1} s, {} kB",
            training.secs,
            training.bytes.div_ceil(1024)
        );
        for line in std::iter::once(&figures).chain(&training.said) {
            ui.label(RichText::new(line).size(12.0).color(c.muted));
        }
        for note in &training.notes {
            ui.label(RichText::new(format!("• {note}")).size(12.0));
        }
    });
    ui.add_space(10.0);
}
