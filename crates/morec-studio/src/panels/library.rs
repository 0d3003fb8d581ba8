//! The clips as a table, and the chosen one beside it.

use crate::stretch::Stretch;
use egui::{
    CentralPanel, Key, Rect, Response, RichText, ScrollArea, Sense, SidePanel, Ui, Vec2, WidgetType,
};
use morec_db::{BACKGROUND, ClipInfo};

use super::widgets::Clipped;
use super::{
    Out, background, class_name, details, import_report, padded, strips, view, whole, widgets,
    words,
};
use crate::format;
use crate::lists::{self, List};
use crate::state::{Column, Command, FileCommand, LibraryCommand, State};
use crate::theme::Colours;

const LIST: &str = "clips";
const ROW: f32 = 26.0;
const STRIP: f32 = 68.0;

pub fn show(ui: &mut Ui, state: &State, out: Out) {
    let width = (ui.available_width() * 0.42).clamp(430.0, 760.0);
    SidePanel::right("clip")
        .frame(padded())
        .exact_width(width)
        .show_clipped(ui, |ui| {
            let height = (ui.available_height() * 0.44).max(200.0);
            view::clip_over_transport(ui, state, height, out);
            scrub(ui, state, out);
            ScrollArea::vertical()
                .auto_shrink(false)
                .show(ui, |ui| details::show(ui, state, out));
        });
    CentralPanel::default()
        .frame(padded())
        .show_clipped(ui, |ui| {
            tools(ui, state, out);
            words::summary(ui, state, out);
            class_name::unnamed(ui, state, false, out);
            import_report::show(ui, state, out);
            table(ui, state, out);
        });
}

/// A line with the playhead, for clips that are only looked at.
fn scrub(ui: &mut Ui, state: &State, out: Out) {
    let mut at = state.player.at_secs;
    let end = state.player.secs().max(0.01);
    ui.spacing_mut().slider_width = ui.available_width();
    let slider = egui::Slider::new(&mut at, 0.0..=end).show_value(false);
    let response = ui.add(slider);
    widgets::named(&response, WidgetType::Slider, "Position", false);
    if response.changed() {
        out.push(Command::Play(crate::state::PlayCommand::Seek(at)));
    }
}

/// The field that searches the list of clips, which is called `list` and lies below it.
pub(super) fn search(ui: &mut Ui, state: &State, width: f32, list: &str, out: Out) {
    let mut text = state.library.filter.clone();
    let edit = widgets::line(&mut text)
        .id(crate::keys::search_field())
        .hint_text("Search names, classes, tags …")
        .desired_width(width);
    let response = ui.add(edit);
    response.widget_info(|| {
        let mut info = egui::WidgetInfo::labeled(WidgetType::TextEdit, true, "Search clips");
        info.current_text_value = Some(state.library.filter.clone());
        info
    });
    let asked = ui.data_mut(|data| data.remove_temp::<bool>(crate::keys::search_field()));
    if asked.is_some() {
        response.request_focus();
    }
    lists::enter_by_down(ui, &response, list);
    if response.has_focus() && ui.input(|i| i.key_pressed(Key::Escape)) {
        text.clear();
    }
    if text != state.library.filter {
        out.push(Command::Library(LibraryCommand::Filter(text)));
    }
}

fn tools(ui: &mut Ui, state: &State, out: Out) {
    let c = Colours::now(ui);
    ui.horizontal_wrapped(|ui| {
        let width = (ui.available_width() - 390.0).clamp(110.0, 280.0);
        search(ui, state, width, LIST, out);
        if ui.button("Import clips …").clicked() {
            out.push(Command::File(FileCommand::AskImport));
        }
        if ui.button("Folder …").clicked() {
            out.push(Command::File(FileCommand::AskImportFolder));
        }
        let strips = state.library.strips;
        for (text, on) in [("Table", false), ("Strips", true)] {
            if ui.selectable_label(strips == on, text).clicked() {
                out.push(Command::Library(LibraryCommand::Strips(on)));
            }
        }
        let Some(store) = &state.store else { return };
        let (shown, all) = (state.library.shown().len(), store.snapshot.clips.len());
        let text = match shown == all {
            true => format::count(all, "clip"),
            false => format!("{} of {}", format::grouped(shown), format::grouped(all)),
        };
        ui.label(RichText::new(text).color(c.muted));
    });
    ui.add_space(4.0);
}

/// A column: what it is, its heading, its share of the width, whether it is a number.
const COLUMNS: [(Column, &str, f32, bool); 5] = [
    (Column::Name, "Clip", 0.40, false),
    (Column::Subject, "Person", 0.19, false),
    (Column::Length, "Length", 0.13, true),
    (Column::Labels, "Labels", 0.16, true),
    (Column::Format, "Format", 0.12, true),
];

/// The columns while clips are searched by words: the reason takes the place of the format.
const FOUND_COLUMNS: [(Column, &str, f32, bool); 5] = [
    (Column::Name, "Clip", 0.28, false),
    (Column::Found, "Found in", 0.34, false),
    (Column::Subject, "Person", 0.14, false),
    (Column::Length, "Length", 0.12, true),
    (Column::Labels, "Labels", 0.12, true),
];

fn columns(state: &State) -> [(Column, &'static str, f32, bool); 5] {
    match words::found(state).is_some() {
        true => FOUND_COLUMNS,
        false => COLUMNS,
    }
}

fn cells(rect: Rect, state: &State) -> [Rect; 5] {
    let inner = rect.shrink2(Vec2::new(8.0, 0.0));
    let mut x = inner.left();
    columns(state).map(|(_, _, share, _)| {
        let width = inner.width() * share;
        let cell = Rect::from_min_size(
            egui::pos2(x, inner.top()),
            Vec2::new(width - 12.0, inner.height()),
        );
        x += width;
        cell
    })
}

fn table(ui: &mut Ui, state: &State, out: Out) {
    let Some(store) = &state.store else { return };
    if !state.library.strips {
        header(ui, state, out);
    }
    let clips = &store.snapshot.clips;
    if clips.is_empty() {
        widgets::nothing(
            ui,
            "No clips yet",
            "Drop files or folders here, or import them.",
        );
        ui.vertical_centered(|ui| {
            ui.add_space(8.0);
            if ui.button("Import clips").clicked() {
                out.push(Command::File(FileCommand::AskImport));
            }
        });
        return;
    }
    let shown = state.library.shown();
    if shown.is_empty() {
        let hint = format!("Nothing matches “{}”.", state.library.filter);
        return widgets::nothing(ui, "No clip found", &hint);
    }
    let as_strips = state.library.strips;
    ui.spacing_mut().item_spacing.y = if as_strips { 4.0 } else { 0.0 };
    let height = if as_strips { STRIP } else { ROW };
    ScrollArea::vertical()
        .id_salt(as_strips)
        .auto_shrink(false)
        .show_rows(ui, height, shown.len(), |ui, rows| {
            let selected = state.library.selected.last();
            let is_selected = |place: &usize| clips.get(*place).map(|c| &c.id) == selected;
            let at = shown.iter().position(is_selected);
            widgets::keep_in_view(ui, LIST, at, rows.start, height);
            let list = List::following(ui, LIST, shown.len());
            list.scroll(ui, list.wanted, rows.start, height);
            for at in rows {
                let Some(clip) = clips.get(shown[at]) else {
                    continue;
                };
                let response = match as_strips {
                    true => strip(ui, state, clip, out),
                    false => row(ui, state, clip, out),
                };
                let on = state.library.chosen().contains(&clip.id);
                if list.row(ui, at, &response, on) {
                    out.push(Command::Library(chosen(ui, clip)));
                }
            }
        });
}

/// The ground of a row: of the selected ones, and of the one under the pointer.
/// One that is shown, and that nobody has selected, is framed: keys do nothing to it.
fn ground(ui: &Ui, rect: Rect, response: &Response, selected: bool, chosen: bool) {
    let c = Colours::now(ui);
    if selected && !chosen {
        widgets::selected_frame(ui, rect);
    }
    let fill = match (selected && chosen, response.hovered()) {
        (true, _) => ui.visuals().selection.bg_fill,
        (false, true) => c.tint(c.accent, 0.10),
        (false, false) => return,
    };
    ui.painter().rect_filled(rect, 3.0, fill);
}

/// A click on a clip, with Ctrl or Shift or neither.
fn chosen(ui: &Ui, clip: &ClipInfo) -> LibraryCommand {
    let (clip, held) = (clip.id, ui.input(|i| i.modifiers));
    match held.shift {
        true => LibraryCommand::SelectTo(clip),
        false => LibraryCommand::Select {
            clip,
            add: held.command,
        },
    }
}

/// Name of a clip's row for screen readers and tests.
fn called(clip: &ClipInfo) -> String {
    match clip.is_background() {
        true => format!("{}, {BACKGROUND}", clip.name),
        false => clip.name.clone(),
    }
}

/// The menu of a clip; that of a selected one is for all that are selected.
fn clip_menu(ui: &mut Ui, state: &State, clip: &ClipInfo, out: Out) {
    let selected = &state.library.selected;
    match selected.contains(&clip.id) {
        true => whole::menu(ui, state, selected, out),
        false => whole::menu(ui, state, &[clip.id], out),
    }
    background::menu(ui, state, clip, out);
}

/// A clip as a strip of poses over its whole length, with its name at the left.
fn strip(ui: &mut Ui, state: &State, clip: &ClipInfo, out: Out) -> Response {
    let c = Colours::now(ui);
    let size = Vec2::new(ui.available_width(), STRIP);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    let on = state.library.selected.contains(&clip.id);
    widgets::named(&response, WidgetType::SelectableLabel, called(clip), on);
    response.context_menu(|ui| clip_menu(ui, state, clip, out));
    ground(ui, rect, &response, on, state.library.chosen);
    let names = (0.26 * rect.width()).clamp(90.0, 190.0);
    let text = rect
        .with_max_x(rect.left() + names)
        .shrink2(Vec2::new(8.0, 10.0));
    let line = |at: f32| {
        let top = text.top() + at * text.height() / 3.0;
        Rect::from_min_size(
            egui::pos2(text.left(), top),
            Vec2::new(text.width(), text.height() / 3.0),
        )
    };
    let labels = match clip.samples {
        0 if clip.is_background() => format!(", {BACKGROUND}"),
        0 => String::new(),
        n => format!(", {}", format::count(n, "label")),
    };
    let length = format!("{}{labels}", format::duration(clip.duration_secs()));
    let person = clip.subject.as_deref().unwrap_or_default();
    widgets::text_in(ui, line(0.0), &clip.name, 13.0, c.text, false);
    match words::found(state).is_some() {
        true => words::reason(ui, state, clip, line(1.0)),
        false => widgets::text_in(ui, line(1.0), person, 11.5, c.muted, false),
    }
    widgets::text_in(ui, line(2.0), &length, 11.5, c.muted, false);
    let picture = rect.with_min_x(rect.left() + names).shrink(3.0);
    let whole = Stretch::new(clip.id, 0.0..clip.duration_secs());
    strips::draw(ui, state, whole, picture);
    response
}

fn header(ui: &mut Ui, state: &State, out: Out) {
    let c = Colours::now(ui);
    let (rect, _) = ui.allocate_exact_size(Vec2::new(ui.available_width(), ROW), Sense::hover());
    for ((column, name, _, right), cell) in columns(state).into_iter().zip(cells(rect, state)) {
        let response = ui.interact(cell, ui.id().with(name), Sense::click());
        widgets::named(
            &response,
            WidgetType::Button,
            format!("Sort by {}", name.to_lowercase()),
            false,
        );
        let arrow = match state.library.sort {
            Some((by, down)) if by == column => {
                if down {
                    " ⏷"
                } else {
                    " ⏶"
                }
            }
            _ => "",
        };
        let colour = if response.hovered() { c.text } else { c.muted };
        widgets::text_in(ui, cell, &format!("{name}{arrow}"), 12.0, colour, right);
        if response.clicked() {
            out.push(Command::Library(LibraryCommand::Sort(column)));
        }
    }
    ui.painter().hline(
        rect.x_range(),
        rect.bottom(),
        egui::Stroke::new(1.0, c.line),
    );
}

fn row(ui: &mut Ui, state: &State, clip: &ClipInfo, out: Out) -> Response {
    let c = Colours::now(ui);
    let (rect, response) =
        ui.allocate_exact_size(Vec2::new(ui.available_width(), ROW), Sense::click());
    let on = state.library.selected.contains(&clip.id);
    widgets::named(&response, WidgetType::SelectableLabel, called(clip), on);
    response.context_menu(|ui| clip_menu(ui, state, clip, out));
    ground(ui, rect, &response, on, state.library.chosen);
    let labels = match clip.samples {
        0 if clip.is_background() => BACKGROUND.to_owned(),
        0 => String::new(),
        n => n.to_string(),
    };
    for ((column, _, _, right), cell) in columns(state).into_iter().zip(cells(rect, state)) {
        let (text, colour) = match column {
            Column::Name => (clip.name.clone(), c.text),
            Column::Subject => (clip.subject.clone().unwrap_or_default(), c.muted),
            Column::Length => (format::duration(clip.duration_secs()), c.muted),
            Column::Labels => (labels.clone(), c.text),
            Column::Format => (clip.format.clone(), c.muted),
            Column::Found => {
                words::reason(ui, state, clip, cell);
                continue;
            }
        };
        widgets::text_in(ui, cell, &text, 13.0, colour, right);
    }
    response
}
