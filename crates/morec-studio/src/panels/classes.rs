//! Classes side by side, each with strips of its samples; segments are dragged from one to another.

use egui::{
    CentralPanel, Frame, Margin, Rangef, RichText, ScrollArea, SidePanel, Ui, Vec2, WidgetType,
    style::ScrollAnimation,
};
use morec_db::labels::{DbSample, SampleState as Judged};
use morec_ops::GroupMethod;

use super::widgets::Clipped;
use super::{
    Out, annotators, budget, card, carried, groups, label, padded, proposals, shelf, similar, view,
    widgets,
};
use crate::format;
use crate::lists::List;
use crate::state::study::StudyView;
use crate::state::{ClassCommand, Command, State};
use crate::theme::Colours;

/// Nearer than this to an edge, points, what is dragged scrolls.
const EDGE: f32 = 44.0;
/// Speed of that at the edge itself, points a second.
const EDGE_SPEED: f32 = 1100.0;

pub fn show(ui: &mut Ui, state: &State, out: Out) {
    SidePanel::right("shown")
        .frame(padded())
        .default_width(330.0)
        .width_range(260.0..=620.0)
        .show_clipped(ui, |ui| {
            let height = (ui.available_height() * 0.55).max(160.0);
            view::clip_over_transport(ui, state, height, out);
            chosen(ui, state, out);
        });
    CentralPanel::default()
        .frame(padded())
        .show_clipped(ui, |ui| {
            tools(ui, state, out);
            ui.add_space(4.0);
            match (&state.classes.similar, &state.classes.groups) {
                (None, None) if state.shelf.open => shelf::show(ui, state, out),
                (Some(found), _) => similar::show(ui, state, found, out),
                (None, Some(_)) => groups_and_columns(ui, state, out),
                (None, None) => match state.study_view() {
                    Some(StudyView::Budget) => budget::show(ui, state, out),
                    Some(StudyView::Annotators) => annotators::show(ui, state, out),
                    None => columns(ui, state, out),
                },
            }
        });
}

fn tools(ui: &mut Ui, state: &State, out: Out) {
    let c = Colours::now(ui);
    ui.horizontal_wrapped(|ui| {
        if let Some(found) = &state.classes.similar {
            similar::tools(ui, state, found, out);
            return;
        }
        if state.shelf.open && state.classes.groups.is_none() {
            return shelf::tools(ui, state, out);
        }
        if let Some(groups) = &state.classes.groups {
            groups::tools(ui, state, groups, out);
            return;
        }
        match state.study_view() {
            Some(StudyView::Budget) => return budget::tools(ui, state, out),
            Some(StudyView::Annotators) => return annotators::tools(ui, state, out),
            None => {}
        }
        let mut class = |command| out.push(Command::Classes(command));
        if ui
            .button("Propose more")
            .on_hover_text("Search all clips for more samples of the labelled classes")
            .clicked()
        {
            class(ClassCommand::Propose);
        }
        if ui.button("Next doubtful  N").clicked() {
            class(ClassCommand::NextDoubtful);
        }
        proposals::at_once(ui, state, out);
        shelf::button(ui, state, out);
        let mut class = |command| out.push(Command::Classes(command));
        let group = |cuts| ClassCommand::Group {
            cuts,
            method: GroupMethod::Hierarchy,
        };
        ui.separator();
        if ui
            .button("Group labels")
            .on_hover_text("Group labels by similarity, whatever their class")
            .clicked()
        {
            class(group(false));
        }
        if ui
            .button("Group cuts")
            .on_hover_text("Group segments by similarity: a way to begin without labels")
            .clicked()
        {
            class(group(true));
        }
        ui.separator();
        budget::buttons(ui, out);
        ui.colored_label(
            c.muted,
            "Drag a strip to another class; double click opens it.",
        );
    });
}

/// Groups with the classes beside them, so that what is in a group is dragged into a class.
fn groups_and_columns(ui: &mut Ui, state: &State, out: Out) {
    if !state.classes.order.is_empty() {
        let room = ui.available_width();
        SidePanel::right("classes beside groups")
            .frame(Frame::new())
            .default_width((0.45 * room).max(card::COLUMN + 24.0))
            .width_range(120.0..=0.7 * room)
            .show_clipped(ui, |ui| columns(ui, state, out));
    }
    groups::show(ui, state, out);
}

/// The samples of each class in a column.
fn columns(ui: &mut Ui, state: &State, out: Out) {
    let Some(store) = &state.store else { return };
    if state.classes.order.is_empty() {
        widgets::nothing(
            ui,
            "No classes yet",
            "Label a few motions, or find repeated motions and name them.",
        );
        return;
    }
    let height = ui.available_height();
    let entered = entered(state);
    ScrollArea::horizontal().auto_shrink(false).show(ui, |ui| {
        ui.horizontal_top(|ui| {
            for (place, class) in state.classes.placed() {
                let all = &store.snapshot.samples;
                let places = state.classes.columns.column(class).iter();
                let samples: Vec<&DbSample> =
                    places.filter_map(|&at| Some(&**all.get(at)?)).collect();
                let entry = entered.filter(|(of, _)| *of == class).map(|(_, at)| at);
                column(
                    ui,
                    state,
                    (place, class),
                    (samples, entry),
                    height - 14.0,
                    out,
                );
            }
        });
        // After the columns: each scroll area takes what has been asked for inside it.
        scroll_at_edge(ui, Vec2::X);
    });
}

/// The column that Up and Down enter, and where: at what is selected, else at the first sample of all.
fn entered(state: &State) -> Option<(&str, usize)> {
    let samples = &state.store.as_ref()?.snapshot.samples;
    let columns = state.classes.placed().map(|(_, class)| {
        let column = state.classes.columns.column(class);
        (class, column)
    });
    let columns: Vec<_> = columns.filter(|(_, column)| !column.is_empty()).collect();
    let is_selected = |at: &usize| {
        let sample = samples.get(*at);
        sample.is_some_and(|s| state.timeline.selected.contains(&s.id))
    };
    let mut chosen = columns.iter().filter_map(|(class, column)| {
        let at = column.iter().position(is_selected)?;
        Some((*class, at))
    });
    let first = columns.first().map(|(class, _)| (*class, 0));
    chosen.next().or(first)
}

/// Scrolls the area around `ui` along `axis` while a sample is dragged near one of its edges.
fn scroll_at_edge(ui: &Ui, axis: Vec2) {
    let area = ui.clip_rect();
    let Some(at) = ui.ctx().pointer_latest_pos() else {
        return;
    };
    if !carried::any(ui) {
        return;
    }
    let (along, across) = match axis == Vec2::X {
        true => (push(area.x_range(), at.x), area.y_range().contains(at.y)),
        false => (push(area.y_range(), at.y), area.x_range().contains(at.x)),
    };
    if across && along != 0.0 {
        let secs = ui.input(|i| i.stable_dt).min(0.1);
        let content = -along * EDGE_SPEED * secs;
        ui.scroll_with_delta_animation(axis * content, ScrollAnimation::none());
        ui.ctx().request_repaint();
    }
}

/// How strongly a place in a range, or outside, pushes on: -1 at the lower end and below, 1 at the upper and above.
fn push(range: Rangef, at: f32) -> f32 {
    let near = |distance: f32| (1.0 - distance / EDGE).clamp(0.0, 1.0);
    near(range.max - at) - near(at - range.min)
}

fn column(
    ui: &mut Ui,
    state: &State,
    (place, class): (usize, &str),
    (samples, entry): (Vec<&DbSample>, Option<usize>),
    height: f32,
    out: Out,
) {
    let c = Colours::now(ui);
    let frame = Frame::new()
        .fill(c.ground)
        .corner_radius(6.0)
        .inner_margin(Margin::same(8));
    let inner = |ui: &mut Ui| {
        ui.set_width(card::COLUMN);
        ui.set_height(height - 16.0);
        ui.vertical(|ui| {
            ui.horizontal(|ui| {
                widgets::chip(ui, Some(place), class);
                ui.add(egui::Label::new(RichText::new(class).strong()).truncate());
                let proposed = samples
                    .iter()
                    .filter(|s| s.state == Judged::Proposed)
                    .count();
                let accepted = samples.len() - proposed;
                let text = if proposed > 0 {
                    format!("{accepted} + {proposed}?")
                } else {
                    accepted.to_string()
                };
                ui.label(RichText::new(text).color(c.muted));
            });
            ui.add_space(2.0);
            ui.spacing_mut().item_spacing.y = 6.0;
            ScrollArea::vertical()
                .id_salt(class)
                .auto_shrink(false)
                .show_rows(ui, card::HEIGHT, samples.len(), |ui, rows| {
                    let list = match entry {
                        Some(at) => List::main(ui, class, samples.len(), 1, at),
                        None => List::following(ui, class, samples.len()),
                    };
                    list.scroll(ui, list.wanted, rows.start, card::HEIGHT);
                    for at in rows {
                        card::show(ui, state, samples[at], (&list, at), out);
                    }
                    scroll_at_edge(ui, Vec2::Y);
                });
        });
    };
    let place = frame.show(ui, inner).response;
    widgets::named(&place, WidgetType::Other, format!("Column {class}"), false);
    carried::accept(ui, &place, class, out);
}

/// The sample or the stretch that is selected, with what can be done.
fn chosen(ui: &mut Ui, state: &State, out: Out) {
    if state.timeline.range.is_some() {
        return label::stretch(ui, state, out);
    }
    let selected = state.selected();
    let Some(sample) = selected.first() else {
        return;
    };
    if selected.len() > 1 {
        let text = format!(
            "{} are selected, from",
            format::count(selected.len(), "label")
        );
        ui.colored_label(Colours::now(ui).warn, text);
    }
    ui.label(RichText::new(&sample.class).size(15.0).strong());
    let extent = format!(
        "{}, {} to {}",
        sample.clip_name,
        format::secs(sample.start_secs),
        format::secs(sample.stop_secs)
    );
    ui.colored_label(Colours::now(ui).muted, extent);
    label::like_this(ui, out);
    if sample.state == Judged::Proposed {
        ui.horizontal(|ui| {
            for (text, command) in [
                ("Accept  A", ClassCommand::Accept(sample.id)),
                ("Reject  R", ClassCommand::Reject(sample.id)),
            ] {
                if ui.button(text).clicked() {
                    out.push(Command::Classes(command));
                }
            }
        });
    }
}
