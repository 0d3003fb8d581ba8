//! The page of keys.

use egui::{Align2, Context, Grid, RichText, ScrollArea, Ui, Window};

use super::Out;
use crate::keys::HELP;
use crate::state::{Command, State};
use crate::theme::Colours;

/// Windows narrower than this have one column, points.
const WIDE: f32 = 1160.0;

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
            // Small windows scroll what has no room.
            let room = ctx.content_rect().size();
            ScrollArea::vertical()
                .max_height(room.y - 120.0)
                .min_scrolled_height(room.y - 120.0)
                .show(ui, |ui| {
                    ui.spacing_mut().interact_size.y = 0.0;
                    let (first, second) = HELP.split_at(half());
                    match room.x < WIDE {
                        true => grid(ui, "keys", HELP),
                        false => {
                            ui.horizontal_top(|ui| {
                                grid(ui, "first keys", first);
                                ui.separator();
                                grid(ui, "second keys", second);
                            });
                        }
                    }
                });
        });
    if !open {
        out.push(Command::ShowKeys(false));
    }
}

/// Where the second column begins: the first area in the second half.
fn half() -> usize {
    let middle = HELP.len() / 2;
    let begins = |at: &usize| HELP[*at].0 != HELP[*at - 1].0;
    (middle.max(1)..HELP.len()).find(begins).unwrap_or(middle)
}

fn grid(ui: &mut Ui, id: &str, entries: &[(&str, &str, &str)]) {
    let c = Colours::now(ui);
    Grid::new(id)
        .num_columns(3)
        .spacing([14.0, 5.0])
        .show(ui, |ui| {
            let mut before = "";
            for (area, keys, what) in entries {
                let shown = if *area == before { "" } else { area };
                before = area;
                ui.label(RichText::new(shown).size(12.5).color(c.muted));
                ui.label(RichText::new(*keys).size(12.5).strong());
                ui.label(RichText::new(*what).size(12.5));
                ui.end_row();
            }
        });
}
