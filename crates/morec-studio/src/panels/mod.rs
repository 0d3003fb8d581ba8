//! The panels: functions of the state that draw and emit commands.

mod annotators;
mod background;
mod bars;
mod budget;
mod card;
mod carried;
mod channel;
mod chooser;
mod class_name;
mod classes;
mod compare;
mod curves;
mod cuts;
mod details;
mod deviation;
mod discard;
mod drop;
pub mod focus;
mod groups;
mod help;
mod history;
mod import_report;
mod kinds;
mod label;
mod label_files;
mod learning_curve;
mod leave;
mod library;
mod live;
mod live_deviation;
mod live_line;
mod matrix;
mod moments;
mod notices;
mod path_field;
mod player;
mod proposals;
mod reports;
mod roles;
mod scale;
mod shelf;
mod similar;
mod strips;
mod teach;
mod thesis;
mod thesis_params;
mod thesis_plane;
mod timeline;
mod tracks;
mod train;
mod undo;
mod video;
mod view;
mod whole;
mod widgets;
mod words;

use egui::scroll_area::{ScrollBarVisibility, ScrollSource};
use egui::{CentralPanel, Context, Frame, ScrollArea, Sense, Ui, UiBuilder, Vec2};

use crate::state::{Panel, State};
use crate::theme::Colours;
pub use strips::wanted_clips;
pub use widgets::Out;
use widgets::padded;

/// Panels are laid out in so much room at least, points.
const LEAST: Vec2 = Vec2::new(900.0, 450.0);

/// Draws the whole window.
pub fn show(ctx: &Context, state: &State, out: Out) {
    contents(ctx, state, out);
    focus::outline(ctx, state.dark);
}

fn contents(ctx: &Context, state: &State, out: Out) {
    strips::want_nothing(ctx);
    bars::top(ctx, state, out);
    bars::bottom(ctx, state, out);
    notices::show(ctx, state, out);
    help::show(ctx, state, out);
    chooser::show(ctx, state, out);
    history::show(ctx, state, out);
    label_files::show(ctx, state, out);
    path_field::show(ctx, state, out);
    undo::show(ctx, state, out);
    leave::show(ctx, state, out);
    discard::show(ctx, state, out);
    drop::show(ctx, state);
    if state.store.is_none() {
        return empty(ctx, state, out);
    }
    CentralPanel::default()
        .frame(Frame::NONE)
        .show(ctx, |ui| scrolled(ui, state, out));
}

/// A panel in the room that there is; one that is too small shows a part of it.
fn scrolled(ui: &mut Ui, state: &State, out: Out) {
    let room = ui.available_size();
    if room.x >= LEAST.x && room.y >= LEAST.y {
        return panel(ui, state, out);
    }
    ScrollArea::both()
        .id_salt(state.panel)
        .auto_shrink(false)
        // The wheel is for what lies inside: timelines and views zoom by it.
        .scroll_source(ScrollSource::SCROLL_BAR)
        .scroll_bar_visibility(ScrollBarVisibility::AlwaysVisible)
        .show(ui, |ui| {
            let (rect, _) = ui.allocate_exact_size(room.max(LEAST), Sense::hover());
            let builder = UiBuilder::new().max_rect(rect);
            ui.scope_builder(builder, |ui| panel(ui, state, out));
            focus::follow_around(ui);
        });
}

fn panel(ui: &mut Ui, state: &State, out: Out) {
    match state.panel {
        Panel::Library => library::show(ui, state, out),
        Panel::Label => label::show(ui, state, out),
        Panel::Classes => classes::show(ui, state, out),
        Panel::Train => train::show(ui, state, out),
        Panel::Live => live::show(ui, state, out),
    }
}

/// Shown while no database is open.
fn empty(ctx: &Context, state: &State, out: Out) {
    CentralPanel::default().show(ctx, |ui| {
        let c = Colours::now(ui);
        ui.add_space(ui.available_height() * 0.3);
        ui.vertical_centered(|ui| {
            ui.spacing_mut().item_spacing.y = 12.0;
            if let Some(job) = state.jobs.running.iter().find(|j| j.shown) {
                ui.heading(&job.name);
                let stage = job.stage();
                ui.colored_label(c.muted, stage.name.clone());
                let share = stage.share().unwrap_or(0.0);
                ui.add(
                    egui::ProgressBar::new(share)
                        .desired_width(260.0)
                        .desired_height(6.0),
                );
                return;
            }
            import_report::show(ui, state, out);
            ui.heading("No database is open");
            ui.colored_label(c.muted, "Drop clips or a database here, or");
            widgets::file_buttons(ui, out);
        });
    });
}
