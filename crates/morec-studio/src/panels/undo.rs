//! The question before a step of another program is taken back.

use egui::{Context, Id, Modal, RichText};

use super::{Out, widgets};
use crate::state::{Command, State};
use crate::store::Edit;
use crate::theme::Colours;

pub fn show(ctx: &Context, state: &State, out: Out) {
    let Some(store) = state.store.as_ref().filter(|_| state.undo_asks) else {
        return;
    };
    let Some(step) = store.snapshot.foreign_step() else {
        return out.push(Command::UndoAsks(false));
    };
    let c = Colours::of(state.dark);
    let modal = Modal::new(Id::new("undo")).show(ctx, |ui| {
        ui.set_width(430.0);
        let title = format!("The last change was made by {}", step.made_by);
        ui.label(RichText::new(title).size(16.0).strong());
        ui.label(format!("“{}”", step.what));
        let mine = store.snapshot.my_step();
        if let Some(mine) = mine {
            ui.colored_label(
                c.muted,
                format!("The last change made here: “{}”", mine.what),
            );
        }
        ui.add_space(8.0);
        ui.horizontal(|ui| {
            let mut undo = |id: i64| {
                out.push(Command::UndoAsks(false));
                out.push(Command::Edit(Edit::Undo(Some(id))));
            };
            if widgets::default_button(ui, "Undo it", &c) {
                undo(step.id);
            }
            let button = ui.add_enabled(mine.is_some(), egui::Button::new("Mine only"));
            if let Some(mine) = mine.filter(|_| button.clicked()) {
                undo(mine.id);
            }
            if ui.button("Cancel").clicked() {
                out.push(Command::UndoAsks(false));
            }
        });
    });
    if modal.should_close() {
        out.push(Command::UndoAsks(false));
    }
}
