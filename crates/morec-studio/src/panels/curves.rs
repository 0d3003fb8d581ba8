//! The tracks under the labels: what is recognised, cuts, the misfit, the speed.

use egui::epaint::Mesh;
use egui::{Color32, Pos2, Rect, Sense, Shape, Stroke, Ui, Vec2, WidgetType, pos2};

use morec_ops::SoundEnvelope;

use super::scale::Scale;
use super::tracks::{ROW, plain_track, remark};
use super::{Out, widgets};
use crate::state::{Command, PlayCommand, State};
use crate::theme::Colours;

/// The track of the angle reaches up to at least this many degrees: what is hardly off shall look like it.
const LEAST_DEGREES: f64 = 20.0;
/// Name of the track of the misfit.
const MISFIT: &str = "Misfit (thesis)";
/// Name of the track of the sound.
const SOUND: &str = "Sound";

/// Track of the detections in the clip that is shown.
pub fn detections(ui: &mut Ui, state: &State, scale: &Scale, out: Out) {
    let c = Colours::now(ui);
    let rect = plain_track(ui, state, scale, "Recognised", ROW, out);
    let shown = state.player.motion.as_ref().map(|m| m.id);
    let Some((clip, found)) = &state.detections else {
        let text = if state.train.index.is_some() {
            "…"
        } else {
            "train an index: detections appear here"
        };
        return widgets::text_in(
            ui,
            rect.shrink2(Vec2::new(8.0, 0.0)),
            text,
            11.0,
            c.muted,
            false,
        );
    };
    if shown != Some(*clip) {
        return;
    }
    let painter = ui.painter_at(rect);
    for (at, found) in found.iter().enumerate() {
        if found.span.stop_secs < scale.from || found.span.start_secs > scale.to {
            continue;
        }
        let bar = Rect::from_x_y_ranges(
            scale.x(found.span.start_secs)..=scale.x(found.span.stop_secs),
            rect.top() + 4.0..=rect.bottom() - 4.0,
        );
        painter.rect_filled(bar, 2.0, c.class(state.classes.place(&found.class)));
        if let Some(reported) = found.reported_secs {
            painter.vline(scale.x(reported), rect.y_range(), (1.0, c.muted));
        }
        if let Some(count) = found.repetitions {
            let (inner, text) = (bar.shrink2(Vec2::new(4.0, 0.0)), format!("× {count}"));
            let colour = c.text_on(c.class(state.classes.place(&found.class)));
            widgets::text_in(ui, inner.intersect(rect), &text, 11.0, colour, false);
        }
        let response = ui.interact(
            bar.intersect(rect),
            ui.id().with(("found", at)),
            Sense::click(),
        );
        widgets::named(
            &response,
            WidgetType::Button,
            format!("recognised {} {:.2} s", found.class, found.span.start_secs),
            false,
        );
        if response
            .on_hover_text(format!(
                "{}, score {:.2}",
                found.class,
                found.score.unwrap_or(0.0)
            ))
            .clicked()
        {
            out.push(Command::Play(PlayCommand::Stretch(
                found.span.start_secs,
                found.span.stop_secs,
            )));
        }
    }
}

/// The misfit of the thesis's method, on a logarithmic scale, with its cuts.
pub fn misfit(ui: &mut Ui, state: &State, scale: &Scale, out: Out) {
    let c = Colours::now(ui);
    let rect = plain_track(ui, state, scale, MISFIT, 40.0, out);
    let Some(curves) = &state.curves else { return };
    if let Some(note) = curves.note.as_ref().filter(|_| curves.forward.is_empty()) {
        return remark(ui, rect, MISFIT, note);
    }
    let painter = ui.painter_at(rect);
    let level = |value: f64| value.max(1e-3).log10();
    let all = || {
        curves
            .forward
            .iter()
            .chain(&curves.backward)
            .map(|p| level(p.value))
    };
    let (low, high) = (
        all().fold(f64::MAX, f64::min),
        all().fold(f64::MIN, f64::max),
    );
    let y = |value: f64| {
        rect.bottom()
            - 3.0
            - ((level(value) - low) / (high - low).max(1e-9)) as f32 * (rect.height() - 6.0)
    };
    for (points, colour) in [(&curves.backward, c.muted), (&curves.forward, c.accent)] {
        // Passes begin anew at each cut: a line does not go from one to the next.
        let line = points.iter().map(|p| (p.secs, y(p.value)));
        for part in parts(line, scale, 1.0) {
            painter.line(part, Stroke::new(1.2, colour));
        }
    }
    for cut in &curves.ppca {
        painter.vline(scale.x(*cut), rect.y_range(), (1.0, c.warn));
    }
}

/// Track of the angle from the performance beside it, with the moment at which it is largest; nothing without one.
pub fn deviation(ui: &mut Ui, state: &State, scale: &Scale, out: Out) {
    let Some((aligned, deviation)) = state.deviation() else {
        return;
    };
    let c = Colours::now(ui);
    let rect = plain_track(ui, state, scale, "Degrees off", 46.0, out);
    let Some((worst_secs, worst)) = deviation.worst(aligned.of.span) else {
        return;
    };
    let full = worst.max(LEAST_DEGREES);
    let y = |degrees: f64| rect.bottom() - (degrees / full) as f32 * (rect.height() - 4.0);
    let painter = ui.painter_at(rect);
    let curve = deviation.curve(aligned.of.span);
    for part in parts(curve.map(|(secs, off)| (secs, y(off))), scale, 1.0) {
        painter.line(part, Stroke::new(1.6, c.accent));
    }
    let x = scale.x(worst_secs);
    painter.vline(x, rect.y_range(), (1.2, c.bad));
    let text = format!("{worst:.0}° at {worst_secs:.2} s");
    let mark = Rect::from_min_max(
        pos2(x + 5.0, rect.top()),
        pos2(x + 140.0, rect.top() + 16.0),
    );
    let response = ui.interact(mark.intersect(rect), ui.id().with("worst"), Sense::hover());
    widgets::named(
        &response,
        WidgetType::Label,
        format!("Largest deviation: {text}"),
        false,
    );
    widgets::text_in(ui, mark, &text, 11.0, c.text, false);
}

/// Track of the bones' speed.
pub fn speed(ui: &mut Ui, state: &State, scale: &Scale, out: Out) {
    let c = Colours::now(ui);
    let rect = plain_track(ui, state, scale, "Speed", 32.0, out);
    let Some(motion) = &state.player.motion else {
        return;
    };
    area(
        ui,
        rect,
        scale,
        &motion.speed,
        motion.tick_hz,
        0.0,
        c.tint(c.accent, 0.55),
    );
}

/// Track of the sound of the clip's video; none of a clip without a video.
pub fn sound(ui: &mut Ui, state: &State, scale: &Scale, out: Out) {
    let Some(video) = state.shown_video() else {
        return;
    };
    let rect = plain_track(ui, state, scale, SOUND, 32.0, out);
    match state.shown_sound().map(|sound| &sound.envelope) {
        None => remark(ui, rect, SOUND, "…"),
        Some(Err(why)) => remark(ui, rect, SOUND, why),
        Some(Ok(sound)) => {
            let colour = Colours::now(ui).tint(Colours::now(ui).good, 0.55);
            let hz = SoundEnvelope::HZ;
            area(
                ui,
                rect,
                scale,
                &sound.peaks,
                hz,
                -video.offset_secs,
                colour,
            );
        }
    }
}

/// Values at an even rate as a filled area: the highest of each point of the screen.
pub fn area(
    ui: &Ui,
    rect: Rect,
    scale: &Scale,
    values: &[f32],
    hz: f64,
    origin: f64,
    colour: Color32,
) {
    let highest = values.iter().copied().fold(1e-6, f32::max);
    let mut mesh = Mesh::default();
    let mut x = rect.left().max(scale.x(origin));
    while x < rect.right() {
        let at =
            |x: f32| (((scale.secs(x) - origin) * hz).floor().max(0.0) as usize).min(values.len());
        let (first, last) = (at(x), at(x + 2.0).max(at(x) + 1).min(values.len()));
        let value = values
            .get(first..last)
            .into_iter()
            .flatten()
            .copied()
            .fold(0.0, f32::max);
        if value > 0.0 {
            let top = rect.bottom() - value / highest * (rect.height() - 2.0);
            mesh.add_colored_rect(
                Rect::from_min_max(pos2(x, top), pos2(x + 2.0, rect.bottom())),
                colour,
            );
        }
        x += 2.0;
    }
    ui.painter_at(rect).add(Shape::mesh(mesh));
}

/// The visible parts of a line; more than `gap` seconds between points divide it.
fn parts(points: impl Iterator<Item = (f64, f32)>, scale: &Scale, gap: f64) -> Vec<Vec<Pos2>> {
    let mut parts: Vec<Vec<Pos2>> = vec![Vec::new()];
    let mut last: Option<(f64, f32)> = None;
    for (secs, y) in points {
        let near = last.is_none_or(|(before, _)| secs - before <= gap && secs >= before);
        if !near {
            parts.push(Vec::new());
        }
        if secs >= scale.from - gap && secs <= scale.to + gap {
            let at = pos2(scale.x(secs), y);
            if let Some(part) = parts.last_mut()
                // Points within half a point of the screen add nothing.
                && part.last().is_none_or(|p| at.x - p.x > 0.5 || (at.y - p.y).abs() > 2.0)
            {
                part.push(at);
            }
        }
        last = Some((secs, y));
    }
    parts.retain(|part| part.len() > 1);
    parts
}
