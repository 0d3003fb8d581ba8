//! Detections of a live stream, and marking what just happened.

use egui::{ProgressBar, RichText, ScrollArea, Ui, WidgetType};

use super::{Out, class_name, live_deviation, widgets};
use crate::format;
use crate::lists::List;
use crate::state::{Command, LiveCommand, State, TrainCommand};
use crate::theme::Colours;

/// Marking what just happened.
pub fn show(ui: &mut Ui, state: &State, out: Out) {
    let c = Colours::now(ui);
    widgets::section(ui, "MARK THE LAST MOTION");
    let hint = match (&state.live.run, state.live.range) {
        (None, _) => {
            "Start a source, then press a key or click a class to label the last motion. It is recognised from then on."
        }
        (_, Some(_)) => "The selected stretch was …",
        (_, None) => "The last motion was …",
    };
    ui.label(RichText::new(hint).size(12.0).color(c.muted));
    // With many classes what is recognised stays in view.
    ScrollArea::vertical()
        .id_salt("classes to mark")
        .max_height(0.45 * ui.available_height())
        .show(ui, |ui| meanings(ui, state, out));
    class_name::unnamed(ui, state, false, out);
    let busy = state.live.teaching || state.is_training();
    if busy {
        ui.horizontal(|ui| {
            ui.add(egui::Spinner::new().size(14.0));
            ui.label(if state.live.teaching {
                "keeping it …"
            } else {
                "training …"
            });
        });
    }
    if state.live.index().is_some() && state.train.is_stale() && !busy {
        widgets::train_again(ui, out);
    }
    if state.live.index().is_none() && !state.is_training() {
        ui.add_space(4.0);
        ui.colored_label(c.warn, "No index is in use yet: mark a motion, or");
        if ui.button("Train on the existing labels").clicked() {
            out.push(Command::Train(TrainCommand::Train));
        }
    }
    ui.add_space(8.0);
}

/// A button for each meaning that the motion may have: a class, a new one, background.
fn meanings(ui: &mut Ui, state: &State, out: Out) {
    let c = Colours::now(ui);
    let on = state.live.run.is_some() && !state.live.teaching;
    ui.horizontal_wrapped(|ui| {
        for (place, class) in state.classes.placed() {
            let key = state.classes.key_of(place);
            let fill = c.panel.lerp_to_gamma(c.class(Some(place)), 0.35);
            let text = match key.is_empty() {
                true => class.to_owned(),
                false => format!("{key}  {class}"),
            };
            let button = egui::Button::new(text).fill(fill);
            let response = ui.add_enabled(on, button);
            widgets::named(
                &response,
                WidgetType::Button,
                format!("Mark as {class}"),
                false,
            );
            if response.clicked() {
                out.push(Command::Live(LiveCommand::MarkAs(class.to_owned())));
            }
        }
        let next = state.classes.free_place();
        let text = format!(
            "{}a new gesture",
            if next < 9 {
                format!("{}  ", next + 1)
            } else {
                String::new()
            }
        );
        if ui.add_enabled(on, egui::Button::new(text)).clicked() {
            out.push(Command::Live(LiveCommand::Mark(next)));
        }
        let response = ui.add_enabled(on, egui::Button::new("0  none of these"));
        widgets::named(&response, WidgetType::Button, "Mark as background", false);
        let response = response
            .on_hover_text("Keep the motion as background, so that it is not recognised again");
        if response.clicked() {
            out.push(Command::Live(LiveCommand::MarkBackground));
        }
    });
}

/// The motion that may be under way, and the detections, the last first.
pub fn recognised(ui: &mut Ui, state: &State, out: Out) {
    let c = Colours::now(ui);
    widgets::section(ui, "RECOGNISED");
    let Some(run) = &state.live.run else {
        ui.colored_label(c.muted, "Nothing yet.");
        return;
    };
    match run.early_detection() {
        Some((class, early)) => {
            ui.horizontal(|ui| {
                let colour = c.class(state.classes.place(&class));
                ui.add(
                    ProgressBar::new(early.progress as f32)
                        .desired_width(90.0)
                        .desired_height(8.0)
                        .fill(colour),
                );
                let times = early.repetitions.map(|r| format!(" × {}", r.count));
                let said = format!("{class}?{}", times.unwrap_or_default());
                ui.label(RichText::new(said).color(c.muted));
            });
        }
        None => {
            ui.label(RichText::new("…").color(c.muted));
        }
    }
    live_deviation::show(ui, state);
    if run.seen.is_empty() {
        return;
    }
    let totals: Vec<String> = state
        .live
        .counts
        .iter()
        .map(|(class, n)| format!("{class} {n}"))
        .collect();
    ui.label(RichText::new(totals.join(", ")).size(12.0).color(c.muted));
    ui.separator();
    ScrollArea::vertical()
        .id_salt("seen")
        .auto_shrink(false)
        .show_rows(ui, 24.0, run.seen.len(), |ui, rows| {
            let list = List::main(ui, "recognised", run.seen.len(), 1, 0);
            list.scroll(ui, list.wanted, rows.start, 24.0);
            let first = rows.start;
            let shown = run.seen.iter().rev().enumerate();
            for (at, seen) in shown.skip(first).take(rows.len()) {
                ui.horizontal(|ui| {
                    ui.set_height(24.0);
                    widgets::chip(ui, state.classes.place(&seen.class), &seen.class);
                    let name = ui.add(egui::Button::new(&seen.class).frame(false));
                    let called = format!("Recognised {}", seen.class);
                    widgets::named(&name, WidgetType::Button, called, false);
                    let name = name.on_hover_text("Select it in the last minutes");
                    let extent = (seen.span.start_secs, seen.span.stop_secs);
                    if list.row(ui, at, &name, state.live.range == Some(extent)) {
                        out.push(Command::Live(LiveCommand::Watch(seen.actor)));
                        out.push(Command::Live(LiveCommand::GoTo(extent.0, extent.1)));
                    }
                    let who = match run.performers.len() > 1 {
                        true => format!("{} · ", seen.actor.0 + 1),
                        false => String::new(),
                    };
                    let times = seen.repetitions.map(|n| format!("× {n} · "));
                    let text = format!(
                        "{}{who}{}  {:.0} %",
                        times.unwrap_or_default(),
                        format::clock(seen.span.start_secs, 1),
                        100.0 * seen.score
                    );
                    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                        ui.label(RichText::new(text).size(12.0).color(c.muted));
                    });
                });
            }
        });
}
