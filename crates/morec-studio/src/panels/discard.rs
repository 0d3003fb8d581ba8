//! The question before a database that an earlier run left is removed.

use egui::{Context, Id, Modal, RichText};

use super::{Out, notices, widgets};
use crate::state::{Command, FileCommand, State};
use crate::theme::Colours;

pub fn show(ctx: &Context, state: &State, out: Out) {
    let Some(at) = state.discarding else { return };
    let Some(left) = state.leftovers.get(at) else {
        return out.push(Command::File(FileCommand::AskDiscard(None)));
    };
    let c = Colours::of(state.dark);
    let modal = Modal::new(Id::new("discard")).show(ctx, |ui| {
        ui.set_width(430.0);
        let title = "Remove the database for good?";
        ui.label(RichText::new(title).size(16.0).strong());
        let text = format!("{}: this cannot be undone.", notices::contents(left));
        ui.label(crate::store::sentence(&text));
        ui.add_space(8.0);
        ui.horizontal(|ui| {
            if widgets::default_button(ui, "Keep it", &c) {
                out.push(Command::File(FileCommand::AskDiscard(None)));
            }
            if ui.button("Remove it").clicked() {
                out.push(Command::File(FileCommand::DiscardLeftover(at)));
            }
        });
    });
    if modal.should_close() {
        out.push(Command::File(FileCommand::AskDiscard(None)));
    }
}
