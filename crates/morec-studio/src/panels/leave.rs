//! The question before a database that is not saved is left.

use egui::{Context, Id, Modal, RichText};

use super::{Out, widgets};
use crate::format;
use crate::state::{Command, FileCommand, State};
use crate::theme::Colours;

pub fn show(ctx: &Context, state: &State, out: Out) {
    let (Some(then), Some(store)) = (&state.leaving, &state.store) else {
        return;
    };
    // Where no dialog can be opened, the path is typed first; the question would lie over the field.
    if state.typed.is_some() {
        return;
    }
    let c = Colours::of(state.dark);
    let modal = Modal::new(Id::new("leave")).show(ctx, |ui| {
        ui.set_width(430.0);
        ui.label(RichText::new("Save the database?").size(16.0).strong());
        ui.add_space(4.0);
        let labels = store.snapshot.accepted().count();
        let clips = store.snapshot.clips.len();
        ui.label(format!(
            "It has no file of its own yet: {} and {}. If you discard it, they cannot be restored.",
            format::count(clips, "clip"),
            format::count(labels, "label")
        ));
        ui.add_space(8.0);
        ui.horizontal(|ui| {
            let buttons = [
                ("Save …", FileCommand::LeaveSaving),
                ("Discard", FileCommand::LeaveDiscarding),
                ("Cancel", FileCommand::Stay),
            ];
            for (at, (text, command)) in buttons.into_iter().enumerate() {
                let is_chosen = match at {
                    0 => widgets::default_button(ui, text, &c),
                    _ => ui.button(text).clicked(),
                };
                if is_chosen {
                    out.push(Command::File(command));
                }
            }
            let what = match then {
                FileCommand::Close => "then the window closes",
                _ => "then the other database is opened",
            };
            ui.colored_label(c.muted, what);
        });
    });
    if modal.should_close() {
        out.push(Command::File(FileCommand::Stay));
    }
}
