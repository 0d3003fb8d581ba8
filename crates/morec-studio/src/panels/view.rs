//! The performer in three dimensions: floor, shadow, limbs, trail.

use egui::{Pos2, Rect, Sense, Shape, Stroke, Ui, Vec2, WidgetType};
use morec::kinematics::WorldPose;
use morec::math::Vec3;
use morec::roles::Role;

use super::compare::Other;
use super::{Out, player, widgets};
use crate::body::ClipMotion;
use crate::body::mesh::Painter;
use crate::body::{Body, Camera};
use crate::state::{Command, Panel, State, ViewCommand};
use crate::theme::Colours;

/// Extent of the floor around the performer, metres.
const FLOOR: i32 = 6;
/// A trail reaches so far into past and future, seconds.
const TRAIL_SECS: f64 = 1.0;
/// Poses of the onion skin, seconds from now.
const ONION: [f64; 4] = [-0.4, -0.2, 0.2, 0.4];

/// Contents of the picture.
pub struct Scene<'a> {
    pub body: &'a Body,
    pub pose: &'a WorldPose,
    pub floor: f64,
    /// The clip, for trail and onion skin.
    pub motion: Option<(&'a ClipMotion, f64)>,
    /// Other performers.
    pub others: Vec<Other<'a>>,
    /// Said at the performer's feet, where there are others.
    pub caption: Option<String>,
}

/// The performer of the clip that is shown, `height` points high, with the buttons of the player below.
pub fn clip_over_transport(ui: &mut Ui, state: &State, height: f32, out: Out) {
    let size = Vec2::new(ui.available_width(), height);
    let rect = Rect::from_min_size(ui.cursor().min, size);
    ui.scope_builder(egui::UiBuilder::new().max_rect(rect), |ui| {
        clip(ui, state, out)
    });
    ui.advance_cursor_after_rect(rect);
    player::transport(ui, state, out);
    player::name_below(ui, state);
}

/// Draws the performer of the clip that is shown.
pub fn clip(ui: &mut Ui, state: &State, out: Out) {
    let rect = ui.available_rect_before_wrap();
    let Some(motion) = &state.player.motion else {
        let c = Colours::now(ui);
        ui.painter().rect_filled(rect, 4.0, c.well);
        widgets::nothing(ui, "No clip is shown", "Choose one in the library.");
        return;
    };
    let pose = motion.pose(state.player.at_secs);
    let scene = Scene {
        body: &motion.body,
        pose: &pose,
        floor: motion.floor,
        motion: Some((motion, state.player.at_secs)),
        others: super::compare::others(state, motion, &Colours::now(ui)),
        caption: super::compare::caption(state, motion),
    };
    draw(ui, rect, state, &scene, out);
}

/// Draws a scene into `rect`; drags and wheel move the camera.
pub fn draw(ui: &mut Ui, rect: Rect, state: &State, scene: &Scene, out: Out) {
    let c = Colours::now(ui);
    let response = ui.allocate_rect(rect, Sense::click_and_drag());
    widgets::named(&response, WidgetType::Image, "Performer", false);
    let camera = moved(ui, &response, &state.camera);
    if camera != state.camera {
        out.push(Command::Look(ViewCommand::Camera(camera)));
    }
    let painter = ui.painter_at(rect);
    painter.add(sky(rect, &c));
    let view = camera.view(rect);
    painter.extend(floor(&view, scene.floor, &camera, &c));
    let mut bodies = Painter::new(view);
    let palette = c.body();
    painter.add(bodies.shadow(scene.body, scene.pose, scene.floor, palette.shadow));
    if let Some((motion, at)) = scene.motion {
        if state.onion {
            painter.extend(onion(motion, at, &view, &c));
        }
        if let Some(joint) = state.trail.and_then(|role| motion.roles.joint(role)) {
            painter.extend(trail(motion, at, joint, &view, &c));
        }
    }
    for other in &scene.others {
        painter.add(bodies.shadow(other.body, &other.pose, scene.floor, palette.shadow));
        bodies.body(other.body, &other.pose, &other.palette);
    }
    bodies.body(scene.body, scene.pose, &palette);
    let has_body = !bodies.is_empty();
    painter.add(bodies.finish());
    let is_points = scene.motion.is_some_and(|(motion, _)| motion.is_points());
    if is_points || !has_body {
        painter.extend(points(scene.pose, &view, &c));
    }
    captions(ui, rect, &view, scene);
    if let Some((motion, _)) = scene.motion.filter(|_| state.panel == Panel::Library) {
        super::roles::joints(ui, state, motion, scene.pose, &view, out);
    }
    remarks(ui, rect, scene, has_body);
    controls(ui, rect, state, out);
}

/// Joints or markers as points.
fn points<'a>(
    pose: &'a WorldPose,
    view: &'a crate::body::camera::View,
    c: &Colours,
) -> impl Iterator<Item = Shape> + use<'a> {
    let colour = c.text;
    let places = pose.positions.iter().filter_map(|at| view.project(at));
    places.map(move |(at, _)| Shape::circle_filled(at, 2.5, colour))
}

/// At the foot of the picture: why there is no body in it, and what no person's body has.
fn remarks(ui: &mut Ui, rect: Rect, scene: &Scene, has_body: bool) {
    let Some((motion, _)) = scene.motion else {
        return;
    };
    let joints = motion.clip.skeleton.len();
    let mut said: Vec<String> = Vec::new();
    if !has_body && motion.is_points() && joints > 2 {
        said.push(format!(
            "Only {joints} points are drawn, because no body part is known: assign joints under Parts of the body in the library."
        ));
    } else if !has_body {
        let joints = crate::format::count(joints, "joint");
        said.push(format!(
            "{joints} are not enough for a body: only points are drawn."
        ));
    }
    said.extend(
        motion
            .doubts
            .iter()
            .take(1)
            .map(|doubt| crate::store::sentence(doubt)),
    );
    if said.is_empty() {
        return;
    }
    let c = Colours::now(ui);
    let area = Rect::from_min_max(rect.left_bottom() - Vec2::new(-10.0, 64.0), rect.max);
    let layout = egui::Layout::bottom_up(egui::Align::Min);
    let mut below = ui.new_child(
        egui::UiBuilder::new()
            .max_rect(area.shrink(4.0))
            .layout(layout),
    );
    for text in said {
        let text = egui::RichText::new(format!("⚠ {text}"))
            .size(12.5)
            .color(c.warn);
        below.add(egui::Label::new(text).wrap());
    }
}

/// Captions at the performers' feet.
fn captions(ui: &Ui, rect: Rect, view: &crate::body::camera::View, scene: &Scene) {
    let c = Colours::now(ui);
    let own = scene
        .caption
        .as_ref()
        .map(|text| (scene.body, scene.pose, text));
    let others = scene.others.iter().map(|o| (o.body, &o.pose, &o.caption));
    for (number, (body, pose, text)) in own.into_iter().chain(others).enumerate() {
        let Some(mut place) = body.centre(pose) else {
            continue;
        };
        place.y = scene.floor;
        let Some((feet, _)) = view.project(&place) else {
            continue;
        };
        // Performers on top of each other have their names below one another.
        let at = Rect::from_center_size(
            feet + Vec2::new(0.0, 22.0 + 16.0 * number as f32),
            Vec2::new(180.0, 16.0),
        );
        let response = ui.interact(at, ui.id().with(("caption", number)), Sense::hover());
        widgets::named(&response, WidgetType::Label, format!("Seen: {text}"), false);
        ui.painter_at(rect).text(
            at.center(),
            egui::Align2::CENTER_CENTER,
            text,
            egui::FontId::proportional(12.0),
            c.text,
        );
    }
}

/// Behind the performer: a little lighter towards the floor.
fn sky(rect: Rect, c: &Colours) -> Shape {
    let mut mesh = egui::epaint::Mesh::default();
    let [top, bottom] = c.sky;
    for (at, colour) in [
        (rect.left_top(), top),
        (rect.right_top(), top),
        (rect.right_bottom(), bottom),
        (rect.left_bottom(), bottom),
    ] {
        mesh.colored_vertex(at, colour);
    }
    mesh.add_triangle(0, 1, 2);
    mesh.add_triangle(0, 2, 3);
    Shape::mesh(mesh)
}

/// The camera after this frame's drags and wheel.
fn moved(ui: &Ui, response: &egui::Response, camera: &Camera) -> Camera {
    let mut camera = *camera;
    let shift = ui.input(|i| i.modifiers.shift);
    let other = response.dragged_by(egui::PointerButton::Secondary)
        || response.dragged_by(egui::PointerButton::Middle);
    if other || (response.dragged() && shift) {
        camera.pan(response.drag_delta(), response.rect.height());
    } else if response.dragged() {
        camera.orbit(response.drag_delta());
    }
    if response.hovered() {
        let (scroll, zoom) = ui.input(|i| (i.smooth_scroll_delta.y, i.zoom_delta()));
        camera.zoom(f64::from(zoom) * (f64::from(scroll) * 0.003).exp());
    }
    camera
}

fn floor(view: &crate::body::camera::View, y: f64, camera: &Camera, c: &Colours) -> Vec<Shape> {
    let (x0, z0) = (
        camera.target.x.round() as i32,
        camera.target.z.round() as i32,
    );
    let mut shapes = Vec::new();
    for n in -FLOOR..=FLOOR {
        for step in -FLOOR..FLOOR {
            let at = |x: i32, z: i32| Vec3::new(f64::from(x), y, f64::from(z));
            let lines = [
                (at(x0 + n, z0 + step), at(x0 + n, z0 + step + 1)),
                (at(x0 + step, z0 + n), at(x0 + step + 1, z0 + n)),
            ];
            // The floor fades away from the performer.
            let far = (f64::from(n * n) + f64::from(step * step)).sqrt() / f64::from(FLOOR);
            let strength = (1.0 - far).clamp(0.0, 1.0) as f32;
            if strength < 0.03 {
                continue;
            }
            let colour = c.sky[1].lerp_to_gamma(c.muted, 0.34 * strength);
            for (a, b) in lines {
                if let Some(line) = view.line(&a, &b) {
                    shapes.push(Shape::line_segment(line, Stroke::new(1.0, colour)));
                }
            }
        }
    }
    shapes
}

fn trail(
    motion: &ClipMotion,
    at: f64,
    joint: usize,
    view: &crate::body::camera::View,
    c: &Colours,
) -> Vec<Shape> {
    let steps = 60;
    let place = |step: i32| -> Option<Pos2> {
        let secs = at + TRAIL_SECS * f64::from(step) / f64::from(steps);
        (secs >= 0.0 && secs <= motion.secs())
            .then(|| motion.pose(secs).positions.get(joint).copied())
            .flatten()
            .and_then(|p| Some(view.project(&p)?.0))
    };
    let mut shapes = Vec::new();
    for step in -steps..steps {
        if let (Some(a), Some(b)) = (place(step), place(step + 1)) {
            let colour = if step < 0 { c.accent } else { c.warn };
            let strength = 1.0 - step.abs() as f32 / steps as f32;
            let colour = c.well.lerp_to_gamma(colour, 0.2 + 0.8 * strength);
            shapes.push(Shape::line_segment([a, b], Stroke::new(2.5, colour)));
        }
    }
    shapes
}

fn onion(
    motion: &ClipMotion,
    at: f64,
    view: &crate::body::camera::View,
    c: &Colours,
) -> Vec<Shape> {
    let mut shapes = Vec::new();
    for offset in ONION {
        let secs = at + offset;
        if !(0.0..=motion.secs()).contains(&secs) {
            continue;
        }
        let pose = motion.pose(secs);
        let colour = if offset < 0.0 { c.accent } else { c.warn };
        let share = 0.45 - 0.6 * offset.abs() as f32;
        let stroke = Stroke::new(3.0, c.well.lerp_to_gamma(colour, share.max(0.15)));
        for limb in &motion.body.limbs {
            let (a, b) = (pose.positions[limb.from], pose.positions[limb.to]);
            if (b - a).norm() < 0.6 * motion.body.height
                && let Some(line) = view.line(&a, &b)
            {
                shapes.push(Shape::line_segment(line, stroke));
            }
        }
    }
    shapes
}

/// Buttons over the picture.
fn controls(ui: &mut Ui, rect: Rect, state: &State, out: Out) {
    let area = Rect::from_min_size(
        rect.min + Vec2::new(8.0, 8.0),
        Vec2::new(rect.width() - 16.0, 24.0),
    );
    let mut child = ui.new_child(egui::UiBuilder::new().max_rect(area));
    child.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        ui.spacing_mut().button_padding = Vec2::new(7.0, 2.0);
        ui.spacing_mut().interact_size.y = 22.0;
        ui.style_mut().override_text_style = Some(egui::TextStyle::Small);
        let mut look = |look| out.push(Command::Look(look));
        let buttons = [
            ("Front", ViewCommand::Front),
            ("Side", ViewCommand::Side),
            ("Top", ViewCommand::Top),
            ("Reset", ViewCommand::Reset),
        ];
        for (text, command) in buttons {
            if ui.button(text).clicked() {
                look(command);
            }
        }
        if ui.selectable_label(state.camera.follow, "Follow").clicked() {
            look(ViewCommand::Follow(!state.camera.follow));
        }
        if let Some(motion) = state
            .player
            .motion
            .as_ref()
            .filter(|_| state.panel != Panel::Live)
        {
            if ui.selectable_label(state.onion, "Onion skin").clicked() {
                look(ViewCommand::Onion(!state.onion));
            }
            trail_menu(ui, state, motion, &mut look);
            super::compare::controls(ui, state, out);
        }
    });
}

fn trail_menu(ui: &mut Ui, state: &State, motion: &ClipMotion, look: &mut impl FnMut(ViewCommand)) {
    let text = match state.trail {
        Some(role) => format!("Trail: {}", spoken(role)),
        None => "Trail".to_owned(),
    };
    ui.menu_button(text, |ui| {
        if ui.button("None").clicked() {
            look(ViewCommand::Trail(None));
        }
        for role in [
            Role::LeftHand,
            Role::RightHand,
            Role::LeftPalm,
            Role::RightPalm,
            Role::LeftIndexTip,
            Role::RightIndexTip,
            Role::LeftFoot,
            Role::RightFoot,
            Role::Head,
            Role::Hips,
        ] {
            if motion.roles.joint(role).is_some() && ui.button(spoken(role)).clicked() {
                look(ViewCommand::Trail(Some(role)));
            }
        }
    });
}

fn spoken(role: Role) -> String {
    role.name().replace('_', " ")
}
