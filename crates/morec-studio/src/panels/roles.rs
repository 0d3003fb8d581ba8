//! Roles of joints beside the skeleton: a click on a part of the body and one on a joint change a role.

use egui::{Grid, Rect, RichText, Sense, Ui, Vec2, WidgetType};
use morec::kinematics::WorldPose;
use morec::roles::Role;

use super::{Out, widgets};
use crate::body::ClipMotion;
use crate::body::camera::View;
use crate::format;
use crate::state::{Command, LibraryCommand, State};
use crate::theme::Colours;

/// A joint can be clicked so far from its middle, points.
const REACH: f32 = 8.0;

/// The parts of the body with their joints; a click on a part asks for its joint.
pub fn show(ui: &mut Ui, state: &State, out: Out) {
    let c = Colours::now(ui);
    let Some(motion) = &state.player.motion else {
        ui.colored_label(c.muted, "…");
        return;
    };
    // Without a bone there are no rows, and no speeds.
    if motion.speed.is_empty() {
        ui.colored_label(
            c.warn,
            "No body part has a joint, so nothing can be recognised in this clip: click a part, then its joint.",
        );
    }
    for doubt in &motion.doubts {
        let text = RichText::new(format!("⚠ {}", crate::store::sentence(doubt)));
        ui.label(text.size(12.0).color(c.warn));
    }
    asked(ui, state, motion, out);
    let joints = motion.clip.skeleton.joints();
    const BETWEEN: f32 = 8.0;
    let width = (0.5 * (ui.available_width() - BETWEEN)).clamp(150.0, 280.0);
    Grid::new("roles")
        .num_columns(2)
        .spacing([BETWEEN, 1.0])
        .show(ui, |ui| {
            for (at, role) in Role::ALL.into_iter().enumerate() {
                let joint = motion.roles.joint(role).and_then(|j| joints.get(j));
                let name = joint.map_or("—", |j| j.name.as_str());
                part(ui, state, role, name, width, out);
                if at % 2 == 1 {
                    ui.end_row();
                }
            }
        });
}

/// Prompt while a part of the body waits for its joint.
fn asked(ui: &mut Ui, state: &State, motion: &ClipMotion, out: Out) {
    let c = Colours::now(ui);
    let Some(role) = state.library.role else {
        let hint = "Click a wrong part, then its joint in the picture.";
        ui.label(RichText::new(hint).size(12.0).color(c.muted));
        return;
    };
    let mut library = |command| out.push(Command::Library(command));
    let text = format!("Which joint is the {}?", role.name().replace('_', " "));
    ui.label(RichText::new(text).color(c.accent).strong());
    ui.horizontal(|ui| {
        let joints = motion.clip.skeleton.joints();
        ui.menu_button("By name", |ui| {
            egui::ScrollArea::vertical()
                .max_height(320.0)
                .show(ui, |ui| {
                    for (at, joint) in joints.iter().enumerate() {
                        if ui.button(&joint.name).clicked() {
                            let joint = Some(at);
                            library(LibraryCommand::GiveRole { role, joint });
                            ui.close();
                        }
                    }
                });
        });
        if ui
            .button("None")
            .on_hover_text("No joint for this part")
            .clicked()
        {
            library(LibraryCommand::GiveRole { role, joint: None });
        }
        if ui.button("Leave it").clicked() {
            library(LibraryCommand::Role(None));
        }
        let mut all = !state.library.roles_of_one;
        let count = format::count(state.clips_of_roles().len(), "clip");
        let response = ui.checkbox(&mut all, format!("in all of this rig ({count})"));
        if response.changed() {
            library(LibraryCommand::RolesOfAll(all));
        }
    });
}

fn part(ui: &mut Ui, state: &State, role: Role, joint: &str, width: f32, out: Out) {
    let c = Colours::now(ui);
    let on = state.library.role == Some(role);
    let (rect, response) = ui.allocate_exact_size(Vec2::new(width, 19.0), Sense::click());
    let name = role.name().replace('_', " ");
    widgets::named(
        &response,
        WidgetType::SelectableLabel,
        format!("Part {name}: {joint}"),
        on,
    );
    if on {
        ui.painter()
            .rect_filled(rect, 3.0, ui.visuals().selection.bg_fill);
    } else if response.hovered() {
        ui.painter().rect_filled(rect, 3.0, c.tint(c.accent, 0.12));
    }
    let inner = rect.shrink2(Vec2::new(4.0, 0.0));
    let middle = inner.left() + 0.46 * inner.width();
    let colour = if joint == "—" { c.warn } else { c.text };
    widgets::text_in(
        ui,
        inner.with_max_x(middle - 4.0),
        &name,
        12.0,
        c.muted,
        false,
    );
    widgets::text_in(ui, inner.with_min_x(middle), joint, 12.0, colour, false);
    if response.clicked() {
        out.push(Command::Library(LibraryCommand::Role(
            (!on).then_some(role),
        )));
    }
}

/// The joints of the performer as discs that can be clicked, while a part waits for its joint.
pub fn joints(
    ui: &mut Ui,
    state: &State,
    motion: &ClipMotion,
    pose: &WorldPose,
    view: &View,
    out: Out,
) {
    let Some(role) = state.library.role else {
        return;
    };
    let c = Colours::now(ui);
    let now = motion.roles.joint(role);
    for (at, joint) in motion.clip.skeleton.joints().iter().enumerate() {
        let Some((place, _)) = pose.positions.get(at).and_then(|p| view.project(p)) else {
            continue;
        };
        let rect = Rect::from_center_size(place, Vec2::splat(2.0 * REACH));
        let response = ui.interact(rect, ui.id().with(("joint", at)), Sense::click());
        widgets::named(
            &response,
            WidgetType::Button,
            format!("Joint {}", joint.name),
            now == Some(at),
        );
        let plays = Role::ALL
            .into_iter()
            .any(|r| motion.roles.joint(r) == Some(at));
        let (fill, radius) = match (now == Some(at), response.hovered(), plays) {
            (true, ..) => (c.accent, 6.0),
            (_, true, _) => (c.warn, 6.0),
            (_, _, true) => (c.text, 4.0),
            _ => (c.muted, 3.0),
        };
        let painter = ui.painter();
        painter.circle(place, radius, fill, (1.0, c.well));
        if response.on_hover_text(&joint.name).clicked() {
            let joint = Some(at);
            out.push(Command::Library(LibraryCommand::GiveRole { role, joint }));
        }
    }
}
