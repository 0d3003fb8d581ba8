//! Clips that are marked as background: the mark of chosen clips, the list for training.

use egui::{
    Align, Checkbox, Layout, Response, RichText, ScrollArea, TextWrapMode, Ui, Vec2, WidgetInfo,
    WidgetType,
};
use morec_db::{ClipId, ClipInfo};

use super::{Out, widgets};
use crate::format;
use crate::lists::List;
use crate::state::{Command, State};
use crate::store::Edit;
use crate::theme::Colours;

/// Most rows that are seen at once.
const ROWS: f32 = 8.0;

/// The mark of clips, to be set and taken away.
pub fn mark(ui: &mut Ui, clips: &[&ClipInfo], out: Out) {
    let on = clips.iter().all(|clip| clip.is_background());
    let mut wanted = on;
    let text = "none of the classes is seen";
    let response = ui.add(Checkbox::new(&mut wanted, text));
    named(&response, "Background", on);
    let response = response.on_hover_text(
        "Clips of walking, standing or other gestures, from which training learns what to reject.  B",
    );
    if response.changed() {
        let clips = clips.iter().map(|clip| clip.id).collect();
        out.push(Command::Edit(Edit::Background { clips, on: wanted }));
    }
    let labelled = clips.iter().filter(|c| c.is_background() && c.samples > 0);
    match labelled.count() {
        0 => {}
        n => {
            let c = Colours::now(ui);
            let (clips, are, they) = match n {
                1 if clips.len() == 1 => ("It".to_owned(), "has", "is"),
                1 => ("1 clip".to_owned(), "has", "is"),
                n => (format::count(n, "clip"), "have", "are"),
            };
            let text =
                format!("{clips} {are} labels and {they} used as labelled, not as background.");
            ui.label(RichText::new(text).size(12.0).color(c.warn));
        }
    }
}

/// Entries of a clip's menu.
pub fn menu(ui: &mut Ui, state: &State, clip: &ClipInfo, out: Out) {
    let on = !clip.is_background();
    let text = match on {
        true => "Use as background",
        false => "No longer background",
    };
    if ui.button(text).clicked() {
        // The menu of a selected clip is that of all that are selected.
        let selected = &state.library.selected;
        let clips = match selected.contains(&clip.id) {
            true => selected.clone(),
            false => vec![clip.id],
        };
        out.push(Command::Edit(Edit::Background { clips, on }));
        ui.close();
    }
}

/// The clips that may be background, to be ticked.
pub fn list(ui: &mut Ui, state: &State, out: Out) {
    let Some(store) = &state.store else { return };
    let c = Colours::now(ui);
    ui.add_space(8.0);
    widgets::section(ui, "BACKGROUND");
    let clips = store.snapshot.clips.iter();
    let clips: Vec<&ClipInfo> = clips
        .filter(|clip| clip.samples == 0 || clip.is_background())
        .collect();
    let text = match clips.is_empty() {
        true => {
            "Every clip has labels. Import clips of other motion of the same kind of skeleton: this reduces false alarms."
        }
        false => "Tick clips that contain none of the classes: this reduces false alarms.",
    };
    ui.label(RichText::new(text).size(12.0).color(c.muted));
    let row = ui.spacing().interact_size.y;
    ScrollArea::vertical()
        .id_salt("background")
        .max_height(ROWS * (row + ui.spacing().item_spacing.y))
        .auto_shrink([false, true])
        .show_rows(ui, row, clips.len(), |ui, rows| {
            let list = List::new(ui, "background", clips.len());
            list.scroll(ui, list.wanted, rows.start, row);
            for at in rows {
                tick(ui, clips[at], (&list, at), out);
            }
        });
}

fn tick(ui: &mut Ui, clip: &ClipInfo, (list, at): (&List, usize), out: Out) {
    let c = Colours::now(ui);
    let (text, colour) = match clip.samples {
        0 => (format::duration(clip.duration_secs()), c.muted),
        n => (
            format!("{}: used as labelled", format::count(n, "label")),
            c.warn,
        ),
    };
    let size = Vec2::new(ui.available_width(), ui.spacing().interact_size.y);
    ui.allocate_ui_with_layout(size, Layout::right_to_left(Align::Center), |ui| {
        ui.label(RichText::new(text).size(11.5).color(colour));
        ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
            // The name gives way to what is said of the clip.
            ui.style_mut().wrap_mode = Some(TextWrapMode::Truncate);
            let mut on = clip.is_background();
            let response = ui.add(Checkbox::new(&mut on, &clip.name));
            let name = format!("Background {}", clip.name);
            named(&response, &name, clip.is_background());
            list.row(ui, at, &response, false);
            if response.changed() {
                let clips: Vec<ClipId> = vec![clip.id];
                out.push(Command::Edit(Edit::Background { clips, on }));
            }
        });
    });
}

fn named(response: &Response, name: &str, on: bool) {
    response.widget_info(|| WidgetInfo::selected(WidgetType::Checkbox, true, on, name));
}
