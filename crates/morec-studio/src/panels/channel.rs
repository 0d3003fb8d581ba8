//! A channel of the clip as a curve with its keyframes, and the map of confidences of the method of 2009.

use std::sync::Arc;

use egui::epaint::Mesh;
use egui::{Color32, Pos2, Rect, Shape, Stroke, Ui, Vec2, WidgetType, pos2};
use morec::smooth::ChannelKind;

use super::scale::Scale;
use super::tracks::{plain_track, remark};
use super::{Out, widgets};
use crate::jobs::channel::ChannelCurve;
use crate::jobs::cut::NO_ROTATIONS;
use crate::jobs::thesis::Map;
use crate::state::{Command, State, TimelineCommand};
use crate::theme::Colours;

const HEIGHT: f32 = 64.0;
/// Name of the track of the map of confidences.
const CONFIDENCE: &str = "2009: confidence";
/// Handles of curves narrower than this are left out, points.
const HANDLES: f32 = 34.0;
/// Places in the map's columns are so wide, points.
const STEP: f32 = 2.0;

/// The curve that was chosen.
pub fn curve(ui: &mut Ui, state: &State, scale: &Scale, out: Out) {
    let Some((joint_name, kind)) = &state.channel_wanted else {
        return;
    };
    let Some(motion) = &state.player.motion else {
        return;
    };
    let c = Colours::now(ui);
    let rect = plain_track(ui, state, scale, joint_name, HEIGHT, out);
    let inner = rect.shrink2(Vec2::new(8.0, 0.0));
    let Some(joint) = motion.clip.skeleton.find(joint_name) else {
        let text = "no joint of this clip is called so";
        return widgets::text_in(ui, inner, text, 11.0, c.muted, false);
    };
    let shown = state
        .channel
        .as_ref()
        .filter(|k| k.clip == motion.id && k.joint == joint && k.kind == *kind);
    let Some(channel) = shown else {
        return widgets::text_in(ui, inner, "…", 11.0, c.muted, false);
    };
    let response = ui.interact(rect, ui.id().with("channel"), egui::Sense::hover());
    let keys = match channel.curves.len() {
        0 => 0,
        n => n + 1,
    };
    widgets::named(
        &response,
        WidgetType::Image,
        format!("Channel {joint_name}, {keys} keyframes"),
        false,
    );
    if channel.curves.is_empty() {
        return widgets::text_in(ui, inner, "does not move", 11.0, c.muted, false);
    }
    draw(ui, rect, scale, channel, &c);
}

fn draw(ui: &Ui, rect: Rect, scale: &Scale, channel: &ChannelCurve, c: &Colours) {
    let painter = ui.painter_at(rect);
    // Each component about its middle, all on one scale: a quaternion has one near 1 and others near 0.
    let (middles, extent) = channel.middles();
    let y = |component: usize, value: f64| {
        let share = (value - middles[component]) / extent.max(1e-9);
        rect.center().y - share as f32 * (rect.height() - 10.0)
    };
    let colours = [c.bad, c.good, c.accent, c.muted];
    let seen = channel
        .curves
        .iter()
        .filter(|k| k.span.stop_secs >= scale.from && k.span.start_secs <= scale.to);
    let mut lines: [Vec<Pos2>; 4] = Default::default();
    for curve in seen {
        let (left, right) = (
            scale.x(curve.span.start_secs),
            scale.x(curve.span.stop_secs),
        );
        // A point of the curve for every two of the screen.
        let steps = ((right - left) / 2.0).ceil().clamp(1.0, 256.0) as usize;
        for step in 0..=steps {
            let t = step as f64 / steps as f64;
            let value = channel.value(curve, t);
            let x = left + (right - left) * t as f32;
            let components = lines.iter_mut().zip(value).enumerate();
            for (component, (line, value)) in components.take(channel.components()) {
                line.push(pos2(x, y(component, value)));
            }
        }
        for (component, colour) in colours.iter().enumerate().take(channel.components()) {
            let at = |place: usize| {
                let x = left + (right - left) * place as f32 / 3.0;
                pos2(x, y(component, curve.points[place][component]))
            };
            if right - left > HANDLES {
                let thin = Stroke::new(0.7, colour.gamma_multiply(0.6));
                painter.line_segment([at(0), at(1)], thin);
                painter.line_segment([at(3), at(2)], thin);
                for handle in [1, 2] {
                    painter.circle_stroke(at(handle), 2.0, thin);
                }
            }
            if right - left > 4.0 {
                painter.circle_filled(at(0), 2.2, *colour);
                painter.circle_filled(at(3), 2.2, *colour);
            }
        }
    }
    for (line, colour) in lines.into_iter().zip(colours) {
        if line.len() > 1 {
            painter.line(line, Stroke::new(1.2, colour));
        }
    }
}

/// The menu that chooses a channel.
pub fn menu(ui: &mut Ui, state: &State, out: Out) {
    let Some(motion) = &state.player.motion else {
        return;
    };
    let joints = motion.clip.skeleton.joints();
    let mut choose = |wanted| out.push(Command::Timeline(TimelineCommand::Channel(wanted)));
    let text = match &state.channel_wanted {
        Some((joint, _)) => format!("Channel: {joint}"),
        None => "Channel".to_owned(),
    };
    ui.menu_button(text, |ui| {
        if ui.button("None").clicked() {
            choose(None);
            ui.close();
        }
        egui::ScrollArea::vertical()
            .max_height(360.0)
            .show(ui, |ui| {
                for joint in joints {
                    let moves = joint.parent.is_none();
                    if moves && ui.button(format!("{}: position", joint.name)).clicked() {
                        choose(Some((joint.name.clone(), ChannelKind::Position)));
                        ui.close();
                    }
                    if ui.button(format!("{}: rotation", joint.name)).clicked() {
                        choose(Some((joint.name.clone(), ChannelKind::Rotation)));
                        ui.close();
                    }
                }
            });
    });
}

/// The map of confidences of the method of 2009 (Fig. 4.3): where segments start across, their length upwards.
pub fn map(ui: &mut Ui, state: &State, scale: &Scale, out: Out) {
    let Some(thesis) = &state.train.thesis else {
        return;
    };
    let c = Colours::now(ui);
    let rect = plain_track(ui, state, scale, CONFIDENCE, 44.0, out);
    let shown = state.player.motion.as_ref().map(|m| m.id);
    if state
        .player
        .motion
        .as_ref()
        .is_some_and(|m| !m.clip.has_rotations())
    {
        return remark(ui, rect, CONFIDENCE, NO_ROTATIONS);
    }
    let Some(map) = state.train.map.as_ref().filter(|m| Some(m.clip) == shown) else {
        let inner = rect.shrink2(Vec2::new(8.0, 0.0));
        return widgets::text_in(ui, inner, "…", 11.0, c.muted, false);
    };
    let response = ui.interact(rect, ui.id().with("map"), egui::Sense::hover());
    widgets::named(&response, WidgetType::Image, "Map of confidences", false);
    // Drawn anew only when the view or the map changes.
    let id = egui::Id::new((
        "map of confidences",
        map.clip,
        Arc::as_ptr(thesis) as usize,
        scale.from.to_bits(),
        scale.to.to_bits(),
        rect.width() as i32,
        c.dark,
    ));
    let known = ui.data(|d| d.get_temp::<(egui::Id, Arc<Mesh>)>(egui::Id::new("map")));
    let mesh = match known.filter(|(of, _)| *of == id) {
        Some((_, mesh)) => mesh,
        None => {
            let at = Rect::from_min_size(Pos2::ZERO, rect.size());
            let mesh = Arc::new(picture(state, map, scale, at, &c));
            ui.data_mut(|d| d.insert_temp(egui::Id::new("map"), (id, mesh.clone())));
            mesh
        }
    };
    let mut mesh = Mesh::clone(&mesh);
    mesh.translate(rect.min.to_vec2());
    ui.painter_at(rect).add(Shape::mesh(mesh));
    if let Some(at) = response.hover_pos() {
        let start = scale.secs(at.x);
        let share = f64::from((rect.bottom() - at.y) / rect.height());
        let length = (map.shortest as f64 + share * map.lengths as f64) * map.chunk_secs;
        response.on_hover_text(format!("{start:.2} s, {length:.2} s long"));
    }
}

fn picture(state: &State, map: &Map, scale: &Scale, rect: Rect, c: &Colours) -> Mesh {
    let mut mesh = Mesh::default();
    let colours: Vec<Color32> = map
        .classes
        .iter()
        .map(|class| c.class(state.classes.place(class)))
        .collect();
    let tall = rect.height() / map.lengths.max(1) as f32;
    let chunk = |x: f32| (scale.secs(scale.left + x) / map.chunk_secs).max(0.0) as usize;
    let mut x = 0.0;
    while x < rect.width() {
        let (first, last) = (chunk(x), chunk(x + STEP).max(chunk(x) + 1));
        for length in 0..map.lengths {
            let cells = (first..last).filter_map(|k| map.cells.get(k * map.lengths + length));
            let Some((level, class)) = cells.max_by_key(|cell| cell.0) else {
                continue;
            };
            if *level == 0 {
                continue;
            }
            let colour = colours.get(usize::from(*class)).copied().unwrap_or(c.muted);
            let bottom = rect.bottom() - tall * length as f32;
            let cell = Rect::from_min_max(pos2(x, bottom - tall), pos2(x + STEP, bottom));
            mesh.add_colored_rect(
                cell,
                c.tint(colour, 0.15 + 0.85 * f32::from(*level) / 255.0),
            );
        }
        x += STEP;
    }
    mesh
}
