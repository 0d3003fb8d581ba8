//! Files over the window: what becomes of them if they are dropped.

use egui::{Align2, Area, Context, Frame, Id, Margin, Order, RichText};

use crate::state::State;
use crate::theme::Colours;

pub fn show(ctx: &Context, state: &State) {
    let hovered = ctx.input(|i| i.raw.hovered_files.clone());
    if hovered.is_empty() {
        return;
    }
    let c = Colours::of(state.dark);
    let paths: Vec<_> = hovered.into_iter().filter_map(|file| file.path).collect();
    let text = format!("Drop here: {}", state.if_dropped(&paths));
    let frame = Frame::new()
        .fill(c.panel)
        .stroke((3.0, c.accent))
        .corner_radius(12.0)
        .inner_margin(Margin::same(60));
    Area::new(Id::new("drop"))
        .order(Order::Foreground)
        .anchor(Align2::CENTER_CENTER, [0.0, 0.0])
        .interactable(false)
        .show(ctx, |ui| {
            frame.show(ui, |ui| ui.label(RichText::new(text).size(22.0)));
        });
}
