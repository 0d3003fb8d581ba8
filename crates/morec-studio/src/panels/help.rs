//! The page of keys.

use egui::{Align2, Context, Grid, RichText, Window};

use super::Out;
use crate::keys::HELP;
use crate::state::{Command, State};
use crate::theme::Colours;

pub fn show(ctx: &Context, state: &State, out: Out) {
    if !state.show_keys {
        return;
    }
    let mut open = true;
    Window::new("Keys")
        .open(&mut open)
        .collapsible(false)
        .resizable(false)
        .anchor(Align2::CENTER_CENTER, [0.0, 0.0])
        .show(ctx, |ui| {
            let c = Colours::now(ui);
            Grid::new("keys")
                .num_columns(3)
                .spacing([18.0, 3.0])
                .show(ui, |ui| {
                    let mut before = "";
                    for (area, keys, what) in HELP {
                        let shown = if *area == before { "" } else { area };
                        before = area;
                        ui.label(RichText::new(shown).color(c.muted));
                        ui.label(RichText::new(*keys).strong());
                        ui.label(*what);
                        ui.end_row();
                    }
                });
        });
    if !open {
        out.push(Command::ShowKeys(false));
    }
}
