//! The timeline: ruler, labels, detections, cuts, misfit, speed. Only what is in view is drawn.

use egui::{Rect, RichText, ScrollArea, Sense, Ui, Vec2, WidgetType, pos2};

use morec_ops::CutMethod;

use super::scale::{NAMES, Scale};
use super::{Out, annotators, channel, curves, cuts, tracks, widgets};
use crate::format;
use crate::state::{Command, PlayCommand, State, TimelineCommand};
use crate::theme::Colours;

const RULER: f32 = 22.0;

pub fn show(ui: &mut Ui, state: &State, out: Out) {
    if state.player.motion.is_none() {
        widgets::nothing(ui, "No clip is shown", "Choose one at the left.");
        // A panel is as high as what is in it.
        ui.allocate_space(ui.available_size());
        return;
    }
    tools(ui, state, out);
    let c = Colours::now(ui);
    let area = ui.available_rect_before_wrap();
    let timeline = &state.timeline;
    let width = area.width() - NAMES - 10.0;
    if (width - timeline.width).abs() > 0.5 {
        out.push(Command::Timeline(TimelineCommand::Width(width)));
    }
    let scale = Scale {
        left: area.left() + NAMES,
        width,
        from: timeline.from_secs,
        to: timeline.from_secs + timeline.span(),
    };
    navigate(ui, area, &scale, out);
    let ruler = Rect::from_min_size(area.min, Vec2::new(area.width(), RULER));
    draw_ruler(ui, ruler, state, &scale, out);
    let body = Rect::from_min_max(pos2(area.left(), ruler.bottom() + 2.0), area.max);
    let pointer = ui.input(|i| i.pointer.hover_pos());
    let on_names = pointer.is_some_and(|at| body.contains(at) && at.x < scale.left);
    ui.scope_builder(egui::UiBuilder::new().max_rect(body), |ui| {
        ScrollArea::vertical()
            .auto_shrink(false)
            .scroll_source(egui::scroll_area::ScrollSource {
                // Over the tracks the wheel zooms.
                mouse_wheel: on_names,
                ..Default::default()
            })
            .show(ui, |ui| {
                ui.spacing_mut().item_spacing.y = 2.0;
                tracks::labels(ui, state, &scale, out);
                curves::detections(ui, state, &scale, out);
                curves::deviation(ui, state, &scale, out);
                cuts::show(ui, state, &scale, out);
                channel::map(ui, state, &scale, out);
                curves::misfit(ui, state, &scale, out);
                curves::speed(ui, state, &scale, out);
                curves::sound(ui, state, &scale, out);
                channel::curve(ui, state, &scale, out);
            });
    });
    playhead(ui, area, state, &scale, &c);
}

fn tools(ui: &mut Ui, state: &State, out: Out) {
    ui.horizontal(|ui| {
        let mut timeline = |command| out.push(Command::Timeline(command));
        let middle = 0.5 * (state.timeline.from_secs + state.timeline.to_secs);
        for (text, name, factor) in [("−", "Zoom out", 1.0 / 1.6), ("+", "Zoom in", 1.6)] {
            let response = ui.add(egui::Button::new(text).min_size(Vec2::new(26.0, 22.0)));
            let response = response.on_hover_text(name);
            if response.clicked() {
                timeline(TimelineCommand::Zoom {
                    factor,
                    about_secs: middle,
                });
            }
        }
        if ui.button("Whole clip").clicked() {
            timeline(TimelineCommand::Whole);
        }
        if ui
            .selectable_label(state.timeline.snap, "Snap")
            .on_hover_text("Ends snap to cuts, stillness, other labels and the playhead")
            .clicked()
        {
            timeline(TimelineCommand::Snap(!state.timeline.snap));
        }
        if tracks::are_many(state)
            && ui
                .selectable_label(state.timeline.all_classes, "All classes")
                .on_hover_text("Show tracks of all classes, not only of those in this clip")
                .clicked()
        {
            timeline(TimelineCommand::AllClasses(!state.timeline.all_classes));
        }
        ui.separator();
        ui.menu_button("Cut all clips", |ui| {
            if ui.button("By kernel change points").clicked() {
                timeline(TimelineCommand::Cut(CutMethod::Kernel));
                ui.close();
            }
            if ui.button("By the thesis's method (PPCA)").clicked() {
                timeline(TimelineCommand::Cut(CutMethod::Ppca));
                ui.close();
            }
        });
        channel::menu(ui, state, out);
        annotators::menu(ui, state, out);
        if let Some((start, stop)) = state.timeline.range {
            ui.separator();
            let text = format!("{:.2} s selected", stop - start);
            ui.label(RichText::new(text).color(Colours::now(ui).muted));
            if ui.button("Play it").clicked() {
                out.push(Command::Play(PlayCommand::Stretch(start, stop)));
            }
        }
    });
}

/// Wheel and pinch zoom, sideways wheel and Shift pan; over the names of the tracks the wheel scrolls these.
fn navigate(ui: &Ui, area: Rect, scale: &Scale, out: Out) {
    let Some(pointer) = ui
        .input(|i| i.pointer.hover_pos())
        .filter(|p| area.contains(*p) && p.x >= scale.left)
    else {
        return;
    };
    let (scroll, zoom, shift) =
        ui.input(|i| (i.smooth_scroll_delta, i.zoom_delta(), i.modifiers.shift));
    let sideways = scroll.x + if shift { scroll.y } else { 0.0 };
    if sideways != 0.0 {
        let secs = -f64::from(sideways) / scale.points_per_sec();
        out.push(Command::Timeline(TimelineCommand::Pan(secs)));
    }
    let factor = f64::from(zoom)
        * if shift {
            1.0
        } else {
            (f64::from(scroll.y) * 0.004).exp()
        };
    if (factor - 1.0).abs() > 1e-6 {
        let about_secs = scale.secs(pointer.x);
        out.push(Command::Timeline(TimelineCommand::Zoom {
            factor,
            about_secs,
        }));
    }
}

/// The distance between marks of the ruler, so that their texts have room.
fn step(points_per_sec: f64) -> f64 {
    const STEPS: [f64; 14] = [
        0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0, 60.0, 120.0, 300.0, 600.0, 1800.0,
    ];
    let fits = |step: &&f64| **step * points_per_sec >= 72.0;
    *STEPS.iter().find(fits).unwrap_or(&3600.0)
}

fn draw_ruler(ui: &mut Ui, rect: Rect, state: &State, scale: &Scale, out: Out) {
    let c = Colours::now(ui);
    let bar = Rect::from_min_max(
        pos2(scale.left, rect.top()),
        pos2(scale.right(), rect.bottom()),
    );
    let response = ui.allocate_rect(bar, Sense::click_and_drag());
    widgets::named(&response, WidgetType::Slider, "Time ruler", false);
    if let Some(pointer) = response.interact_pointer_pos() {
        out.push(Command::Play(PlayCommand::Seek(scale.secs(pointer.x))));
    }
    let painter = ui.painter_at(bar);
    painter.rect_filled(bar, 0.0, c.ground);
    let step = step(scale.points_per_sec());
    let decimals = if step < 0.1 {
        2
    } else {
        usize::from(step < 1.0)
    };
    let mut at = (scale.from / step).floor() * step;
    while at <= scale.to {
        let x = scale.x(at);
        painter.vline(x, bar.bottom() - 6.0..=bar.bottom(), (1.0, c.muted));
        let font = egui::FontId::proportional(11.0);
        painter.text(
            pos2(x + 4.0, bar.center().y - 1.0),
            egui::Align2::LEFT_CENTER,
            format::clock(at, decimals),
            font,
            c.muted,
        );
        at += step;
    }
    if let Some((start, stop)) = state.player.looped {
        let loop_bar = Rect::from_x_y_ranges(
            scale.x(start)..=scale.x(stop),
            bar.bottom() - 3.0..=bar.bottom(),
        );
        painter.rect_filled(loop_bar, 1.0, c.good);
    }
}

fn playhead(ui: &Ui, area: Rect, state: &State, scale: &Scale, c: &Colours) {
    let tracks = Rect::from_min_max(
        pos2(scale.left, area.top()),
        pos2(scale.right(), area.bottom()),
    );
    let painter = ui.painter_at(tracks);
    if let Some((start, stop)) = state.timeline.range {
        let range = Rect::from_x_y_ranges(scale.x(start)..=scale.x(stop), tracks.y_range());
        painter.rect_filled(range, 0.0, c.accent.gamma_multiply(0.18));
    }
    if let Some(held) = &state.classes.held {
        let now = Rect::from_x_y_ranges(
            scale.x(held.since_secs)..=scale.x(state.player.at_secs),
            tracks.y_range(),
        );
        painter.rect_filled(now, 0.0, c.class(Some(held.slot)).gamma_multiply(0.3));
    }
    let x = scale.x(state.player.at_secs);
    painter.vline(x, tracks.y_range(), (1.5, c.playhead));
    let top = tracks.top();
    painter.add(egui::Shape::convex_polygon(
        vec![pos2(x - 5.0, top), pos2(x + 5.0, top), pos2(x, top + 7.0)],
        c.playhead,
        egui::Stroke::NONE,
    ));
}
