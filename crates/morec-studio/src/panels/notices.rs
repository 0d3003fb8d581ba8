//! Notices of errors, over the room until they are dismissed or what caused them is over; databases that were left.

use egui::{Align, Align2, Area, Color32, Context, Frame, Id, Layout, Margin, Order, Ui};

use super::Out;
use crate::format;
use crate::state::{Command, FileCommand, State};
use crate::theme::Colours;
use crate::unsaved::Leftover;

/// Number of notices that are shown at once.
const SHOWN: usize = 3;
/// Widest they are, points.
const WIDEST: f32 = 560.0;

/// Draws them over the lower right corner: no control moves when one comes.
pub fn show(ctx: &Context, state: &State, out: Out) {
    if state.notices.is_empty() && state.leftovers.is_empty() && state.undrawn.is_empty() {
        return;
    }
    let c = Colours::of(state.dark);
    let width = WIDEST.min(ctx.content_rect().width() - 40.0);
    Area::new(Id::new("notices"))
        .order(Order::Middle)
        .anchor(Align2::RIGHT_BOTTOM, [-12.0, -36.0])
        .show(ctx, |ui| {
            ui.set_width(width);
            leftovers(ui, state, &c, out);
            undrawn(ui, state, &c);
            errors(ui, state, &c, out);
        });
}

fn errors(ui: &mut Ui, state: &State, c: &Colours, out: Out) {
    if state.notices.is_empty() {
        return;
    }
    card(ui, c, c.bad, |ui| {
        for (at, notice) in state.notices.iter().enumerate().take(SHOWN) {
            line(ui, c.bad, &notice.text, |ui| {
                if ui.button("Dismiss").clicked() {
                    out.push(Command::Dismiss(at));
                }
            });
        }
        if state.notices.len() > SHOWN {
            ui.label(format!("and {} more", state.notices.len() - SHOWN));
        }
    });
}

/// Names that are drawn with gaps.
fn undrawn(ui: &mut Ui, state: &State, c: &Colours) {
    let Some(first) = state.undrawn.first() else {
        return;
    };
    let more = match state.undrawn.len() {
        1 => String::new(),
        n => format!(" and {} more", format::count(n - 1, "name")),
    };
    let code: Vec<String> = first
        .chars()
        .filter(|letter| !letter.is_ascii())
        .map(|letter| format!("U+{:04X}", u32::from(letter)))
        .take(4)
        .collect();
    card(ui, c, c.warn, |ui| {
        let text = format!(
            "No installed font has all letters of {first} ({}){more}. Install one, such as Noto Sans CJK or Noto Sans Arabic, \
             and restart the studio.",
            code.join(" ")
        );
        line(ui, c.warn, &text, |_| {});
    });
}

/// A coloured field for lines.
fn card(ui: &mut Ui, c: &Colours, colour: Color32, add: impl FnOnce(&mut Ui)) {
    Frame::new()
        .fill(c.panel.lerp_to_gamma(colour, 0.16))
        .stroke((1.0, colour))
        .corner_radius(6.0)
        .inner_margin(Margin::symmetric(12, 8))
        .show(ui, add);
}

/// A sentence at the left, buttons at the right.
fn line(ui: &mut Ui, colour: Color32, text: &str, buttons: impl FnOnce(&mut Ui)) {
    ui.horizontal(|ui| {
        ui.colored_label(colour, "⚠");
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            buttons(ui);
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                ui.add(egui::Label::new(text).wrap());
            });
        });
    });
}

/// What is in a database that was left.
pub fn contents(left: &Leftover) -> String {
    match left.contents {
        Some((clips, labels)) => format!(
            "{} and {}",
            format::count(clips as usize, "clip"),
            format::count(labels as usize, "label")
        ),
        None => "it cannot be read".to_owned(),
    }
}

/// Databases that earlier runs left without saving them.
fn leftovers(ui: &mut Ui, state: &State, c: &Colours, out: Out) {
    if state.leftovers.is_empty() {
        return;
    }
    card(ui, c, c.warn, |ui| {
        for (at, left) in state.leftovers.iter().enumerate().take(SHOWN) {
            let when = left.changed_secs.map(format::utc).unwrap_or_default();
            let what = match left.contents {
                Some(_) => format!("{}, last changed {when}", contents(left)),
                None => contents(left),
            };
            let text = format!("A database was not saved: {what}.");
            line(ui, c.warn, &text, |ui| {
                if ui.button("Discard it …").clicked() {
                    out.push(Command::File(FileCommand::AskDiscard(Some(at))));
                }
                if ui.button("Open it").clicked() {
                    out.push(Command::File(FileCommand::OpenLeftover(at)));
                }
                let later = ui.button("Later");
                if later.on_hover_text("Ask again at the next start").clicked() {
                    out.push(Command::File(FileCommand::LeaveLeftover(at)));
                }
            });
        }
    });
}
