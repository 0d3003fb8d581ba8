//! The last minutes of the stream as a timeline: movement, what was recognised, what was marked.

use egui::{Rect, RichText, Sense, Ui, WidgetType, pos2};

use super::scale::Scale;
use super::{Out, curves, widgets};
use crate::format;
use crate::jobs::teach::Meaning;
use crate::state::live::{Run, SPANS};
use crate::state::{Command, LiveCommand, State};
use crate::theme::Colours;

const NAMES: f32 = 100.0;

pub fn show(ui: &mut Ui, state: &State, out: Out) {
    let c = Colours::now(ui);
    let Some(run) = &state.live.run else {
        let hint = "Drag over a motion to label it.";
        widgets::nothing(ui, "The last minutes appear here", hint);
        // A panel is as high as what is in it.
        ui.allocate_space(ui.available_size());
        return;
    };
    ui.horizontal(|ui| {
        widgets::section(ui, "THE LAST MINUTES");
        spans(ui, state, out);
        if let Some((start, stop)) = state.live.range {
            ui.label(RichText::new(format!("{:.2} s selected", stop - start)).color(c.muted));
            if ui.small_button("Clear").clicked() {
                out.push(Command::Live(LiveCommand::Range(None)));
            }
        } else {
            ui.label(
                RichText::new(
                    "drag to select a stretch; without a selection, keys label the last motion",
                )
                .size(12.0)
                .color(c.muted),
            );
        }
    });
    let area = ui.available_rect_before_wrap();
    let (from, to) = state.live.looking.extent(run.now_secs);
    let scale = Scale {
        left: area.left() + NAMES,
        width: area.width() - NAMES - 8.0,
        from,
        to,
    };
    ground(ui, area, &scale, out);
    navigate(ui, area, state, &scale, out);
    let height = area.height() - 20.0;
    let band = |from: f32, to: f32| {
        Rect::from_min_max(
            pos2(scale.left, area.top() + from * height),
            pos2(scale.right(), area.top() + to * height - 3.0),
        )
    };
    let (movement, seen, marks) = (band(0.0, 0.42), band(0.42, 0.72), band(0.72, 1.0));
    for (rect, name) in [
        (movement, "Movement"),
        (seen, "Recognised"),
        (marks, "Marked"),
    ] {
        ui.painter().rect_filled(rect, 0.0, c.well);
        let text = Rect::from_min_max(
            pos2(area.left(), rect.top()),
            pos2(scale.left - 8.0, rect.bottom()),
        );
        widgets::text_in(ui, text, name, 12.0, c.muted, false);
    }
    draw_movement(ui, run, movement, &scale, &c);
    draw_seen(ui, state, run, seen, &scale, out);
    draw_marks(ui, state, marks, &scale, &c);
    ruler(ui, area, &scale, run.now_secs, &c);
    if let Some((start, stop)) = state.live.range {
        let rect = Rect::from_x_y_ranges(
            scale.x(start)..=scale.x(stop),
            area.top()..=area.top() + height,
        );
        ui.painter_at(area)
            .rect_filled(rect, 0.0, c.accent.gamma_multiply(0.22));
    }
}

/// How much is shown, and buttons that look back.
fn spans(ui: &mut Ui, state: &State, out: Out) {
    let looking = &state.live.looking;
    let mut live = |command| out.push(Command::Live(command));
    for (secs, name) in SPANS {
        let on = (looking.span_secs - secs).abs() < 0.5;
        if ui.selectable_label(on, name).clicked() {
            live(LiveCommand::Span(secs));
        }
    }
    let half = 0.5 * looking.span_secs;
    let moves = [
        ("◀", "Look back", -half, true),
        ("▶", "Look on", half, looking.until_secs.is_some()),
        ("▶|", "Now", f64::MAX, looking.until_secs.is_some()),
    ];
    for (text, name, secs, on) in moves {
        let response = ui.add_enabled(on, egui::Button::new(text).small());
        response.widget_info(|| egui::WidgetInfo::labeled(WidgetType::Button, on, name));
        if response.on_hover_text(name).clicked() {
            live(LiveCommand::Back(secs));
        }
    }
    ui.separator();
}

/// The wheel shows more or less, Shift and the wheel look back.
fn navigate(ui: &Ui, area: Rect, state: &State, scale: &Scale, out: Out) {
    let pointer = ui.input(|i| i.pointer.hover_pos());
    if !pointer.is_some_and(|at| area.contains(at)) {
        return;
    }
    let (scroll, shift) = ui.input(|i| (i.smooth_scroll_delta, i.modifiers.shift));
    let sideways = scroll.x + if shift { scroll.y } else { 0.0 };
    if sideways != 0.0 {
        let secs = -f64::from(sideways) / scale.points_per_sec();
        out.push(Command::Live(LiveCommand::Back(secs)));
    } else if scroll.y != 0.0 {
        let span = state.live.looking.span_secs * (-f64::from(scroll.y) * 0.004).exp();
        out.push(Command::Live(LiveCommand::Span(span)));
    }
}

fn ground(ui: &mut Ui, area: Rect, scale: &Scale, out: Out) {
    let rect = Rect::from_min_max(
        pos2(scale.left, area.top()),
        pos2(scale.right(), area.bottom()),
    );
    let response = ui.allocate_rect(rect, Sense::click_and_drag());
    widgets::named(&response, WidgetType::Other, "The last minutes", false);
    // The ground moves under the pointer: where the drag began is remembered as a time.
    let id = response.id.with("begun");
    let at = response.interact_pointer_pos().map(|p| scale.secs(p.x));
    if response.drag_started()
        && let Some(origin) = ui.input(|i| i.pointer.press_origin())
    {
        ui.data_mut(|d| d.insert_temp(id, scale.secs(origin.x)));
    }
    if response.dragged()
        && let (Some(at), Some(begun)) = (at, ui.data(|d| d.get_temp::<f64>(id)))
    {
        let range = (at.min(begun), at.max(begun));
        out.push(Command::Live(LiveCommand::Range(Some(range))));
    }
    if response.clicked() {
        out.push(Command::Live(LiveCommand::Range(None)));
    }
}

fn draw_movement(ui: &Ui, run: &Run, rect: Rect, scale: &Scale, c: &Colours) {
    // Frames of live sources come unevenly: each second has as many values as came in it.
    let ticks = ((scale.to - scale.from) * 30.0) as usize;
    let mut values = Vec::with_capacity(ticks);
    let Some(performer) = run.watched() else {
        return;
    };
    let (frames, speeds) = (&performer.frames, &performer.speeds);
    let mut frame = frames.partition_point(|f| f.time_secs < scale.from);
    for tick in 0..ticks {
        let until = scale.from + (tick + 1) as f64 / 30.0;
        let mut most = 0f32;
        while frame < frames.len() && frames[frame].time_secs < until {
            most = most.max(speeds[frame].min(6.0));
            frame += 1;
        }
        values.push(most);
    }
    curves::area(
        ui,
        rect,
        scale,
        &values,
        30.0,
        scale.from,
        c.tint(c.accent, 0.55),
    );
}

fn draw_seen(ui: &Ui, state: &State, run: &Run, rect: Rect, scale: &Scale, out: Out) {
    let c = &Colours::now(ui);
    let painter = ui.painter_at(rect);
    let watched = run.watched().map(|w| w.actor);
    let shown = run
        .seen
        .iter()
        .rev()
        .filter(|s| Some(s.actor) == watched)
        .take_while(|s| s.span.stop_secs > scale.from - 10.0)
        .filter(|s| s.span.start_secs < scale.to && s.span.stop_secs > scale.from);
    for seen in shown {
        let colour = c.class(state.classes.place(&seen.class));
        let extent = (seen.span.start_secs, seen.span.stop_secs);
        let bar = bar(&painter, rect, scale, extent, &seen.class, colour, c);
        let id = ui.id().with(("seen", extent.0.to_bits(), &seen.class));
        let response = ui.interact(bar.intersect(rect), id, Sense::click());
        let name = format!("{} at {:.1} s", seen.class, seen.span.start_secs);
        widgets::named(&response, WidgetType::Button, name, false);
        if response.on_hover_text(&seen.class).clicked() {
            out.push(Command::Live(LiveCommand::GoTo(extent.0, extent.1)));
        }
    }
    // What another sensitivity would have found, as outlines around it.
    let would = state.live.resensed.iter().flat_map(|r| &r.found);
    let index = state.live.index();
    for found in would.filter(|d| d.span.stop_secs > scale.from) {
        let name = index.map_or("", |index| index.model.class_name(found.class));
        let colour = c.class(state.classes.place(name));
        let frame = Rect::from_x_y_ranges(
            scale.x(found.span.start_secs)..=scale.x(found.span.stop_secs),
            rect.y_range(),
        );
        let stroke = egui::Stroke::new(1.5, colour);
        painter.rect_stroke(frame, 3.0, stroke, egui::StrokeKind::Inside);
    }
}

fn draw_marks(ui: &Ui, state: &State, rect: Rect, scale: &Scale, c: &Colours) {
    let painter = ui.painter_at(rect);
    let marks = state.live.marks.iter();
    for mark in marks.filter(|m| m.span.stop_secs > scale.from) {
        let colour = match &mark.meaning {
            Meaning::Class(class) => c.class(state.classes.place(class)),
            Meaning::Background => c.muted,
        };
        let extent = (mark.span.start_secs, mark.span.stop_secs);
        bar(
            &painter,
            rect,
            scale,
            extent,
            mark.meaning.name(),
            colour,
            c,
        );
    }
}

fn bar(
    painter: &egui::Painter,
    rect: Rect,
    scale: &Scale,
    at: (f64, f64),
    name: &str,
    colour: egui::Color32,
    c: &Colours,
) -> Rect {
    let bar = Rect::from_x_y_ranges(
        scale.x(at.0)..=scale.x(at.1).max(scale.x(at.0) + 2.0),
        rect.top() + 2.0..=rect.bottom() - 2.0,
    );
    painter.rect_filled(bar, 3.0, colour);
    let font = egui::FontId::proportional(11.0);
    let mut job =
        egui::text::LayoutJob::simple_singleline(name.to_owned(), font, c.text_on(colour));
    job.wrap = egui::text::TextWrapping::truncate_at_width((bar.width() - 6.0).max(1.0));
    let galley = painter.layout_job(job);
    // A letter and the dots say nothing.
    if !galley.elided || bar.width() > 48.0 {
        painter.galley(
            bar.center() - galley.size() / 2.0,
            galley,
            c.text_on(colour),
        );
    }
    bar
}

fn ruler(ui: &Ui, area: Rect, scale: &Scale, now: f64, c: &Colours) {
    let painter = ui.painter_at(area);
    // Six marks or so, whatever is shown.
    let every = ((scale.to - scale.from) / 6.0).max(1.0).round();
    for place in 0..400 {
        let ago = every * f64::from(place);
        let x = scale.x(now - ago);
        if x < scale.left {
            break;
        }
        if x > scale.right() + 1.0 {
            continue;
        }
        let text = if ago == 0.0 {
            "now".to_owned()
        } else {
            format!("−{}", format::duration(ago))
        };
        let align = if ago == 0.0 {
            egui::Align2::RIGHT_BOTTOM
        } else {
            egui::Align2::CENTER_BOTTOM
        };
        painter.text(
            pos2(x, area.bottom()),
            align,
            text,
            egui::FontId::proportional(11.0),
            c.muted,
        );
    }
}
