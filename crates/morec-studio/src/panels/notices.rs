//! Notices of errors, shown until they are dismissed.

use egui::{Context, Frame, Margin, TopBottomPanel};

use super::Out;
use crate::state::{Command, State};
use crate::theme::Colours;

/// Number of notices that are shown at once.
const SHOWN: usize = 3;

pub fn show(ctx: &Context, state: &State, out: Out) {
    if state.notices.is_empty() {
        return;
    }
    let c = Colours::of(state.dark);
    let fill = c.panel.lerp_to_gamma(c.bad, 0.16);
    let frame = Frame::new()
        .fill(fill)
        .inner_margin(Margin::symmetric(12, 6));
    TopBottomPanel::top("notices").frame(frame).show(ctx, |ui| {
        for (at, notice) in state.notices.iter().enumerate().take(SHOWN) {
            ui.horizontal(|ui| {
                ui.colored_label(c.bad, "⚠");
                ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                    if ui.button("Dismiss").clicked() {
                        out.push(Command::Dismiss(at));
                    }
                    ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
                        ui.add(egui::Label::new(&notice.text).wrap());
                    });
                });
            });
        }
        if state.notices.len() > SHOWN {
            ui.label(format!("and {} more", state.notices.len() - SHOWN));
        }
    });
}
