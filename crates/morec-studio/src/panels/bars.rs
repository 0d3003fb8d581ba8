//! The bar at the top, with the panels; the bar at the bottom, with what was done and what is being done.

use egui::{
    Align, Button, Context, Frame, Layout, Margin, RichText, ScrollArea, TopBottomPanel, Ui, Vec2,
};

use morec_db::HistoryStep;
use morec_db::exchange::LabelFormat;

use super::Out;
use crate::state::{Command, FileCommand, Panel, State};
use crate::store::{Edit, Snapshot};
use crate::theme::Colours;

pub fn top(ctx: &Context, state: &State, out: Out) {
    let c = Colours::of(state.dark);
    let frame = Frame::new()
        .fill(c.ground)
        .inner_margin(Margin::symmetric(10, 0));
    TopBottomPanel::top("top")
        .frame(frame)
        .exact_height(42.0)
        .show(ctx, |ui| {
            ui.horizontal_centered(|ui| {
                file_menu(ui, state, out);
                if is_narrow(ui) {
                    ui.spacing_mut().item_spacing.x = 2.0;
                }
                ui.add_space(6.0);
                for panel in Panel::ALL {
                    tab(ui, state, panel, out);
                }
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                    right(ui, state, out);
                    let width = ui.available_width();
                    if width > 90.0 {
                        title(ui, state, &c, out);
                    }
                });
            });
        });
}

fn file_menu(ui: &mut Ui, state: &State, out: Out) {
    use FileCommand::*;
    let height = ui.ctx().content_rect().height() - 70.0;
    let area = ScrollArea::vertical().max_height(height);
    let contents = |ui: &mut Ui| {
        let open = state.store.is_some();
        let shown = open && state.player.motion.is_some();
        item(ui, ("Open …", "Ctrl O"), true, AskOpen, out);
        item(ui, ("New database …", ""), true, AskNew, out);
        ui.separator();
        item(ui, ("Import clips …", "Ctrl I"), true, AskImport, out);
        item(ui, ("Import a folder …", ""), true, AskImportFolder, out);
        item(ui, ("Import labels …", ""), open, AskImportLabels, out);
        ui.separator();
        item(ui, ("Save a copy as …", "Ctrl S"), open, AskSave, out);
        if let Some(last) = state.last.as_ref().filter(|p| p.exists()) {
            let text = format!("Open {} again", crate::format::file_name(last));
            item(ui, (&text, ""), true, Open(last.clone()), out);
        }
        ui.separator();
        item(ui, ("Export this clip …", ""), shown, AskExportClip, out);
        let part = shown && state.selected_stretch().is_some();
        let text = "Export the selection as a clip …";
        item(ui, (text, ""), part, AskExportStretch, out);
        item(
            ui,
            ("A page of it to send …", ""),
            shown,
            AskExportPage,
            out,
        );
        ui.add_enabled_ui(open, |ui| {
            ui.menu_button("Export labels", |ui| {
                for form in LabelFormat::ALL {
                    item(ui, (form_name(form), ""), true, AskExportLabels(form), out);
                }
            });
        });
        let trained = !state.train.bytes.is_empty();
        item(ui, ("Export the index …", ""), trained, AskExportIndex, out);
    };
    ui.menu_button("File", |ui| area.show(ui, contents));
}

/// An entry of the menu, with its keys if it has any.
fn item(ui: &mut Ui, (text, keys): (&str, &str), on: bool, command: FileCommand, out: Out) {
    let button = Button::new(text).min_size(Vec2::new(220.0, 24.0));
    let button = match keys.is_empty() {
        true => button,
        false => button.shortcut_text(keys),
    };
    if ui.add_enabled(on, button).clicked() {
        out.push(Command::File(command));
        ui.close();
    }
}

/// Name of a form of labels in the menu.
fn form_name(form: LabelFormat) -> &'static str {
    match form {
        LabelFormat::Tsv => "Table (TSV) …",
        LabelFormat::Csv => "Table (CSV) …",
        LabelFormat::Json => "JSON …",
        LabelFormat::Eaf => "ELAN, a file for each clip …",
        LabelFormat::Audacity => "Audacity, a file for each clip …",
        LabelFormat::Babel => "BABEL …",
        LabelFormat::LabelStudio => "Label Studio …",
        LabelFormat::Boris => "BORIS project …",
        LabelFormat::Bids => "BIDS events, a file for each clip …",
    }
}

fn tab(ui: &mut Ui, state: &State, panel: Panel, out: Out) {
    let c = Colours::now(ui);
    let on = state.panel == panel;
    let text = RichText::new(panel.name()).size(14.0);
    let text = if on {
        text.strong().color(c.text)
    } else {
        text.color(c.muted)
    };
    let button = Button::selectable(on, text)
        .fill(egui::Color32::TRANSPARENT)
        .stroke(egui::Stroke::NONE)
        .min_size(Vec2::new(if is_narrow(ui) { 0.0 } else { 64.0 }, 30.0));
    let response = ui.add(button);
    if on {
        let rect = response.rect;
        let line = egui::Rect::from_min_max(
            egui::pos2(rect.left() + 8.0, rect.bottom() + 3.0),
            egui::pos2(rect.right() - 8.0, rect.bottom() + 5.5),
        );
        ui.painter().rect_filled(line, 1.0, c.accent);
    }
    if response.clicked() {
        out.push(Command::Show(panel));
    }
}

/// True if the bar has room for what must be there alone.
fn is_narrow(ui: &Ui) -> bool {
    ui.ctx().content_rect().width() < 800.0
}

fn right(ui: &mut Ui, state: &State, out: Out) {
    let (theme, hint) = match state.dark {
        true => ("☀", "Light theme"),
        false => ("🌙", "Dark theme"),
    };
    let icon = |ui: &mut Ui, text: &str, name: &str| {
        let response = ui
            .add(Button::new(text).min_size(Vec2::splat(28.0)))
            .on_hover_text(name);
        response.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, true, name));
        response.clicked()
    };
    if icon(ui, theme, hint) {
        out.push(Command::Dark(!state.dark));
    }
    if icon(ui, "?", "Keys") {
        out.push(Command::ShowKeys(!state.show_keys));
    }
    if ui.button("History").clicked() {
        out.push(Command::ShowHistory(!state.show_history));
    }
    let names = state.store.as_ref().map(|s| {
        let snapshot = &s.snapshot;
        (
            snapshot.undo_step().map(|step| named(snapshot, step)),
            snapshot.redo_name().map(str::to_owned),
        )
    });
    let (undo, redo) = names.unwrap_or_default();
    for (text, name, what, edit) in [
        ("⟳", "Redo", redo, Edit::Redo),
        ("⟲", "Undo", undo, Edit::Undo(None)),
    ] {
        let button = Button::new(text).min_size(Vec2::splat(28.0));
        let response = ui.add_enabled(what.is_some(), button);
        response.widget_info(|| {
            egui::WidgetInfo::labeled(egui::WidgetType::Button, what.is_some(), name)
        });
        let response = response.on_hover_text(match &what {
            Some(what) => format!("{name}: {what}"),
            None => format!("Nothing to {}", name.to_lowercase()),
        });
        if response.clicked() {
            out.push(Command::Edit(edit));
        }
    }
}

/// A step by its name, with the program that made it, if that is another.
fn named(snapshot: &Snapshot, step: &HistoryStep) -> String {
    match snapshot.is_foreign(step) {
        true => format!("{}, by {}", step.what, step.made_by),
        false => step.what.clone(),
    }
}

/// The database's name; of one that nobody has named and that holds work, a way to keep it.
fn title(ui: &mut Ui, state: &State, c: &Colours, out: Out) {
    let Some(store) = &state.store else { return };
    let name = store
        .path()
        .file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    let text = match store.temporary {
        true => format!("{} (not saved)", name.trim_end_matches(".mdb")),
        false => name,
    };
    ui.add_space(6.0);
    if state.is_unsaved() {
        if ui.button("Save as …").clicked() {
            out.push(Command::File(FileCommand::AskSave));
        }
        let text = RichText::new("⚠ Not saved yet").color(c.warn);
        ui.add(egui::Label::new(text).truncate())
            .on_hover_text("This database has no file of its own.");
        return;
    }
    ui.add(egui::Label::new(RichText::new(text).color(c.muted)).truncate())
        .on_hover_text(match store.temporary {
            true => "This database is in a temporary folder; keep it with File, Save a copy as"
                .to_owned(),
            false => store.path().display().to_string(),
        });
}

pub fn bottom(ctx: &Context, state: &State, out: Out) {
    let c = Colours::of(state.dark);
    let frame = Frame::new()
        .fill(c.ground)
        .inner_margin(Margin::symmetric(12, 0));
    TopBottomPanel::bottom("bottom")
        .frame(frame)
        .exact_height(28.0)
        .show(ctx, |ui| {
            ui.horizontal_centered(|ui| {
                jobs(ui, state, out);
                let said = RichText::new(&state.said).size(12.0);
                ui.add(egui::Label::new(said).truncate());
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                    command_line(ui, state, &c);
                });
            });
        });
}

fn jobs(ui: &mut Ui, state: &State, out: Out) {
    for (at, job) in state
        .jobs
        .running
        .iter()
        .enumerate()
        .filter(|(_, j)| j.shown)
    {
        let stage = job.stage();
        ui.add(egui::Spinner::new().size(13.0));
        ui.label(RichText::new(&job.name).size(12.0));
        // Before the bar, whose text grows: a button that moves is missed by a click.
        let text = if job.is_cancelled() {
            "stopping …"
        } else {
            "Stop"
        };
        let button = Button::new(RichText::new(text).size(11.0)).small();
        if ui.add_enabled(!job.is_cancelled(), button).clicked() {
            out.push(Command::Cancel(at));
        }
        if let Some(share) = stage.share() {
            ui.add(
                egui::ProgressBar::new(share)
                    .desired_width(90.0)
                    .desired_height(5.0),
            );
            let text = format!("{} {} of {}", stage.name, stage.done, stage.total);
            ui.label(RichText::new(text).size(11.0).weak());
        }
        ui.separator();
    }
}

/// The command that does what was done last, which can be copied.
fn command_line(ui: &mut Ui, state: &State, c: &Colours) {
    if state.command_line.is_empty() || ui.available_width() < 80.0 {
        return;
    }
    let copy = ui.add(Button::new(RichText::new("Copy").size(11.0)).small());
    if copy
        .on_hover_text("Copy the command that does the same")
        .clicked()
    {
        ui.ctx().copy_text(state.command_line.clone());
    }
    let shown = crate::format::without_folders(&state.command_line);
    let text = RichText::new(format!("$ {shown}"))
        .monospace()
        .size(11.0)
        .color(c.muted);
    ui.add(egui::Label::new(text).truncate())
        .on_hover_text(format!(
            "The command that does the same:\n{}",
            state.command_line
        ));
}
