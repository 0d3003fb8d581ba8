//! Notices of errors, shown until they are dismissed; what is not saved, until it is.

use egui::{Align, Color32, Context, Frame, Layout, Margin, TopBottomPanel, Ui};

use super::Out;
use crate::format;
use crate::state::{Command, FileCommand, State};
use crate::theme::Colours;
use crate::unsaved::Leftover;

/// Number of notices that are shown at once.
const SHOWN: usize = 3;

pub fn show(ctx: &Context, state: &State, out: Out) {
    leftovers(ctx, state, out);
    unsaved(ctx, state, out);
    if state.notices.is_empty() {
        return;
    }
    let c = Colours::of(state.dark);
    strip(ctx, "notices", (&c, c.bad), |ui| {
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

/// A strip below the bar at the top.
fn strip(
    ctx: &Context,
    name: &'static str,
    (c, colour): (&Colours, Color32),
    add: impl FnOnce(&mut Ui),
) {
    let frame = Frame::new()
        .fill(c.panel.lerp_to_gamma(colour, 0.16))
        .inner_margin(Margin::symmetric(12, 6));
    TopBottomPanel::top(name).frame(frame).show(ctx, add);
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

/// What was done is in a database without a name of its own.
fn unsaved(ctx: &Context, state: &State, out: Out) {
    if !state.is_unsaved() {
        return;
    }
    let c = Colours::of(state.dark);
    strip(ctx, "unsaved", (&c, c.warn), |ui| {
        let text = "Not saved yet: this database has no file of its own.";
        line(ui, c.warn, text, |ui| {
            if ui.button("Save as …").clicked() {
                out.push(Command::File(FileCommand::AskSave));
            }
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
fn leftovers(ctx: &Context, state: &State, out: Out) {
    if state.leftovers.is_empty() {
        return;
    }
    let c = Colours::of(state.dark);
    strip(ctx, "leftovers", (&c, c.warn), |ui| {
        for (at, left) in state.leftovers.iter().enumerate().take(SHOWN) {
            let when = left.changed_secs.map(format::utc).unwrap_or_default();
            let what = match left.contents {
                Some(_) => format!("{}, last changed {when}", contents(left)),
                None => contents(left),
            };
            let text = format!("A database was left without being saved: {what}.");
            line(ui, c.warn, &text, |ui| {
                if ui.button("Discard it …").clicked() {
                    out.push(Command::File(FileCommand::AskDiscard(Some(at))));
                }
                if ui.button("Open it").clicked() {
                    out.push(Command::File(FileCommand::OpenLeftover(at)));
                }
            });
        }
    });
}
