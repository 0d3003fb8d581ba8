//! What was found by words: a line above the list, and the reason beside each clip.

use egui::{Rect, Sense, Ui, WidgetType};
use morec_db::ClipInfo;

use super::{Out, widgets};
use crate::format;
use crate::jobs::words::FoundWords;
use crate::state::{Column, Command, FileCommand, State};
use crate::theme::Colours;

/// What was found of the text of the search field.
pub fn found(state: &State) -> Option<&FoundWords> {
    state.library.words.of(state.library.filter.trim())
}

/// How many clips the words describe, which words nothing has, and captions to search beside the database.
pub fn summary(ui: &mut Ui, state: &State, out: Out) {
    let Some(found) = found(state) else { return };
    let c = Colours::now(ui);
    ui.horizontal_wrapped(|ui| {
        let clips = format::count(found.hits.len(), "clip");
        let text = match (found.hits.is_empty(), found.has_all) {
            (true, _) => "No clip is described by these words.".to_owned(),
            // Sorted by another column, the list does not begin with the best.
            (_, true) if matches!(state.library.sort, None | Some((Column::Found, false))) => {
                format!("{clips} described by these words, the best first.")
            }
            (_, true) => format!("{clips} described by these words."),
            (_, false) => format!("Nothing has all of these words; {clips} described by some."),
        };
        ui.colored_label(c.muted, text);
        if !found.unknown.is_empty() {
            let text = format!("Not found: {}", found.unknown.join(", "));
            ui.colored_label(c.warn, text);
        }
        let words = &state.library.words;
        if !words.captions.is_empty() {
            let captions = format::count(words.captions.len(), "caption");
            let absent = match words.absent() {
                0 => String::new(),
                n => format!(", {n} of clips that are not here"),
            };
            ui.colored_label(c.muted, format!("{captions}{absent}"));
        }
        let hint = "Descriptions of clips that are searched, too: a table, BABEL, HumanML3D or the index of CMU";
        if ui.button("Captions …").on_hover_text(hint).clicked() {
            out.push(Command::File(FileCommand::AskCaptions));
        }
    });
}

/// Why a clip was found, in a cell of its row.
pub fn reason(ui: &Ui, state: &State, clip: &ClipInfo, cell: Rect) {
    let Some(text) = found(state).and_then(|found| found.reason(clip.id)) else {
        return;
    };
    let id = ui.id().with(("reason", clip.id));
    let response = ui.interact(cell, id, Sense::hover());
    widgets::named(
        &response,
        WidgetType::Label,
        format!("Found in {text}"),
        false,
    );
    widgets::text_in(ui, cell, &text, 12.0, Colours::now(ui).good, false);
}
