//! Strips of poses of samples, drawn once and kept.

use std::sync::Arc;

use egui::epaint::{Mesh, Vertex, WHITE_UV};
use egui::{Color32, Context, Id, Rect, Shape, Ui, Vec2, pos2};
use morec_db::ClipId;
use morec_db::labels::SampleId;

use super::Out;
use crate::body::strip::{at_moment, strip};
use crate::state::{Command, LibraryCommand, State, TimelineCommand};
use crate::stretch::Stretch;
use crate::theme::Colours;

/// Height of a strip of a sample, points.
pub const STRIP: f32 = 62.0;

/// Draws the strip of a stretch of a clip, or says that it is coming.
pub fn draw(ui: &Ui, state: &State, of: Stretch, rect: Rect) {
    if !ui.is_rect_visible(rect) {
        return;
    }
    let c = Colours::now(ui);
    ui.painter().rect_filled(rect, 3.0, c.well);
    let Some(motion) = state.motions.get(of.clip) else {
        let text = state.motions.failure(of.clip).unwrap_or("…");
        super::widgets::text_in(ui, rect.shrink(6.0), text, 11.0, c.muted, false);
        want(ui.ctx(), of.clip);
        return;
    };
    let size = rect.size();
    let id = Id::new((
        "strip",
        of.clip,
        of.span.start_secs.to_bits(),
        of.span.stop_secs.to_bits(),
        size.x as i32,
        size.y as i32,
        c.dark,
    ));
    let known = ui.data(|data| data.get_temp::<Arc<Mesh>>(id));
    let mesh = known.unwrap_or_else(|| {
        let at = Rect::from_min_size(pos2(0.0, 0.0), size);
        let mesh = Arc::new(one(&strip(motion, of.span, at, &c.body())));
        ui.data_mut(|data| data.insert_temp(id, mesh.clone()));
        mesh
    });
    let mut mesh = Mesh::clone(&mesh);
    mesh.translate(rect.min - pos2(0.0, 0.0));
    ui.painter_at(rect).add(Shape::mesh(mesh));
}

/// Draws over a strip the performer at a moment of it; all strips of a set, which take `secs`, are at the same share of theirs.
pub fn play(ui: &Ui, state: &State, of: Stretch, rect: Rect, secs: f64) {
    let Some(motion) = state
        .motions
        .get(of.clip)
        .filter(|_| ui.is_rect_visible(rect))
    else {
        return;
    };
    let share = (ui.input(|i| i.time) / secs.max(0.2)).fract();
    let (c, at) = (
        Colours::now(ui),
        of.span.start_secs + share * of.span.duration_secs(),
    );
    let place = Rect::from_min_size(rect.min, Vec2::new(rect.height(), rect.height()));
    let painter = ui.painter_at(rect);
    painter.rect_filled(place, 3.0, c.well);
    painter.add(Shape::mesh(one(&at_moment(motion, at, place, &c.body()))));
    let x = rect.left() + share as f32 * rect.width();
    painter.vline(x, rect.y_range(), (1.0, c.playhead));
    ui.ctx().request_repaint();
}

/// Shows the stretch of a strip, and selects it: the sample that it is, else the stretch itself.
pub fn go(of: Stretch, sample: Option<SampleId>, out: Out) {
    if sample.is_none() {
        return out.push(Command::Library(LibraryCommand::SelectStretch(of)));
    }
    out.push(Command::Library(LibraryCommand::GoTo(of)));
    if let Some(id) = sample {
        out.push(Command::Timeline(TimelineCommand::Select {
            id: Some(id),
            add: false,
        }));
    }
}

/// Forgets which clips were needed: a new frame is drawn.
pub fn want_nothing(ctx: &Context) {
    ctx.data_mut(|data| data.insert_temp(wanted_id(), Vec::<ClipId>::new()));
}

fn wanted_id() -> Id {
    Id::new("clips that strips are drawn of")
}

/// Says that a clip's motion is needed to draw what is seen.
fn want(ctx: &Context, clip: ClipId) {
    ctx.data_mut(|data| {
        let wanted = data.get_temp_mut_or_default::<Vec<ClipId>>(wanted_id());
        if !wanted.contains(&clip) && wanted.len() < 64 {
            wanted.push(clip);
        }
    });
}

/// The clips that were needed and are not decoded.
pub fn wanted_clips(ctx: &Context) -> Vec<ClipId> {
    ctx.data(|data| data.get_temp(wanted_id()))
        .unwrap_or_default()
}

/// Lines and discs as one mesh.
fn one(shapes: &[Shape]) -> Mesh {
    let mut mesh = Mesh::default();
    for shape in shapes {
        match shape {
            Shape::LineSegment { points, stroke } => {
                line(&mut mesh, *points, stroke.width, stroke.color)
            }
            Shape::Circle(circle) => disc(&mut mesh, circle.center, circle.radius, circle.fill),
            _ => {}
        }
    }
    mesh
}

fn line(mesh: &mut Mesh, [a, b]: [egui::Pos2; 2], width: f32, colour: Color32) {
    let along = (b - a).normalized();
    let across = Vec2::new(-along.y, along.x) * (width / 2.0);
    // Ends reach over the joint, so that limbs meet.
    let over = along * (width / 3.0);
    let first = mesh.vertices.len() as u32;
    let corners = [
        a - over + across,
        a - over - across,
        b + over - across,
        b + over + across,
    ];
    mesh.vertices.extend(corners.map(|pos| Vertex {
        pos,
        uv: WHITE_UV,
        color: colour,
    }));
    mesh.indices.extend([0, 1, 2, 0, 2, 3].map(|k| first + k));
}

fn disc(mesh: &mut Mesh, centre: egui::Pos2, radius: f32, colour: Color32) {
    const CORNERS: u32 = 12;
    let first = mesh.vertices.len() as u32;
    for k in 0..CORNERS {
        let turn = std::f32::consts::TAU * k as f32 / CORNERS as f32;
        let pos = centre + Vec2::angled(turn) * radius;
        mesh.vertices.push(Vertex {
            pos,
            uv: WHITE_UV,
            color: colour,
        });
    }
    (1..CORNERS - 1).for_each(|k| mesh.indices.extend([first, first + k, first + k + 1]));
}
