//! The track of cuts: stillness and repetitions behind them; cuts are dragged into place, added and removed.

use egui::{CursorIcon, Rect, Sense, Shape, Ui, Vec2, WidgetType, pos2};

use morec_db::BY_HAND;

use super::carried::Carried;
use super::scale::Scale;
use super::tracks::{ROW, swept, track};
use super::{Out, widgets};
use crate::jobs::cut::Curves;
use crate::state::{Command, CutCommand, State, TimelineCommand};
use crate::stretch::Stretch;
use crate::theme::Colours;

/// A cut is held so far from its line, points.
const REACH: f32 = 4.0;
/// Cuts nearer than this to one another cannot be distinguished and are not held.
const NARROW: f32 = 3.0;

pub fn show(ui: &mut Ui, state: &State, scale: &Scale, out: Out) {
    let c = Colours::now(ui);
    let name = match state.cut_method() {
        Some(BY_HAND) => "Cuts, by hand",
        _ => "Cuts, stillness",
    };
    let (rect, ground) = track(ui, scale, name, ROW + 3.0, None);
    widgets::named(&ground, WidgetType::Other, "Track of cuts", false);
    match selected_here(ui, state, scale) {
        Some(stretch) if ground.drag_started_by(egui::PointerButton::Primary) => {
            ground.dnd_set_drag_payload(Carried::Stretch(stretch));
        }
        _ => swept(ui, state, scale, &ground, out),
    }
    match &state.curves {
        Some(curves) => behind(ui, rect, scale, curves, &c),
        None => widgets::text_in(
            ui,
            rect.shrink2(Vec2::new(8.0, 0.0)),
            "analysing the clip …",
            11.0,
            c.muted,
            false,
        ),
    }
    if let Some(at) = ground.interact_pointer_pos() {
        let secs = scale.secs(at.x);
        if ground.double_clicked() {
            out.push(Command::Cuts(CutCommand::Add(secs)));
        } else if ground.clicked() {
            out.push(Command::Timeline(TimelineCommand::SelectSegment(secs)));
        }
    }
    let ground = ground.on_hover_text(
        "Click: select the segment between two cuts; drag it to a class to label it. Drag a cut to move it, double click to add \
         a cut, press Delete to remove the selected cut.",
    );
    ground.context_menu(|ui| {
        if ui.button("Restore the automatic cuts").clicked() {
            out.push(Command::Cuts(CutCommand::Reset));
            ui.close();
        }
    });
    let mut last = f32::NEG_INFINITY;
    for cut in state.cuts() {
        let held = state.timeline.held_cut.filter(|h| near(h.from_secs, cut));
        let x = scale.x(held.map_or(cut, |h| h.at_secs));
        if x < scale.left || x > scale.right() {
            continue;
        }
        let apart = x - last >= NARROW || held.is_some();
        last = x;
        line(ui, state, scale, rect, (cut, x), apart, out);
    }
}

/// The selected stretch, if the pointer went down inside of it.
fn selected_here(ui: &Ui, state: &State, scale: &Scale) -> Option<Stretch> {
    let (start_secs, stop_secs) = state.timeline.range?;
    let pressed = scale.secs(ui.input(|i| i.pointer.press_origin())?.x);
    (start_secs..=stop_secs).contains(&pressed).then_some(())?;
    Some(Stretch::new(
        state.player.motion.as_ref()?.id,
        start_secs..stop_secs,
    ))
}

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-6
}

/// A cut that can be held.
fn line(
    ui: &Ui,
    state: &State,
    scale: &Scale,
    rect: Rect,
    (cut, x): (f64, f32),
    apart: bool,
    out: Out,
) {
    let c = Colours::now(ui);
    let selected = state.timeline.cut.is_some_and(|s| near(s, cut));
    let colour = if selected { c.accent } else { c.text };
    let painter = ui.painter_at(rect);
    painter.vline(
        x,
        rect.y_range(),
        (if selected { 3.0 } else { 1.5 }, colour),
    );
    if !apart {
        return;
    }
    let area = Rect::from_x_y_ranges(x - REACH..=x + REACH, rect.y_range());
    let id = ui.id().with(("cut", cut.to_bits()));
    let response = ui.interact(area.intersect(rect), id, Sense::click_and_drag());
    widgets::named(
        &response,
        WidgetType::Slider,
        format!("Cut at {cut:.2} s"),
        selected,
    );
    if response.hovered() || response.dragged() {
        ui.ctx().set_cursor_icon(CursorIcon::ResizeHorizontal);
    }
    let mut cuts = |command| out.push(Command::Cuts(command));
    if response.clicked() {
        cuts(CutCommand::Select(Some(cut)));
    }
    if response.drag_started_by(egui::PointerButton::Primary) {
        cuts(CutCommand::Grab(cut));
    }
    let pointer = response.interact_pointer_pos().map(|at| scale.secs(at.x));
    if let Some(secs) = pointer.filter(|_| response.dragged() || response.drag_stopped()) {
        cuts(CutCommand::Drag(secs));
    }
    if response.drag_stopped() {
        cuts(CutCommand::Drop);
    }
}

/// Stillness, numbered repetitions, and the cuts of the method of 2009.
fn behind(ui: &Ui, rect: Rect, scale: &Scale, curves: &Curves, c: &Colours) {
    let painter = ui.painter_at(rect);
    let seen = |from: f64, to: f64| to >= scale.from && from <= scale.to;
    for (start, stop, t_pose) in curves.still.iter().filter(|s| seen(s.0, s.1)) {
        let bar = Rect::from_x_y_ranges(scale.x(*start)..=scale.x(*stop), rect.y_range());
        let colour = if *t_pose { c.warn } else { c.muted };
        painter.rect_filled(bar, 0.0, c.tint(colour, 0.28));
    }
    for bounds in &curves.cycles {
        let pairs = bounds.windows(2).enumerate();
        for (number, pair) in pairs.filter(|(_, p)| seen(p[0], p[1])) {
            let (a, b) = (scale.x(pair[0]), scale.x(pair[1]));
            painter.vline(a, rect.bottom() - 5.0..=rect.bottom(), (1.0, c.accent));
            if b - a > 16.0 {
                painter.text(
                    pos2((a + b) / 2.0, rect.center().y),
                    egui::Align2::CENTER_CENTER,
                    (number + 1).to_string(),
                    egui::FontId::proportional(10.0),
                    c.muted,
                );
            }
        }
    }
    for cut in curves.ppca.iter().filter(|cut| seen(**cut, **cut)) {
        let x = scale.x(*cut);
        let ends = [pos2(x, rect.top()), pos2(x, rect.bottom())];
        painter.add(Shape::dashed_line(&ends, (1.5, c.warn), 3.0, 3.0));
    }
}
