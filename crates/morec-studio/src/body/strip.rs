//! A strip of small figures: what a stretch of motion looks like at a glance.

use egui::{Pos2, Rect, Shape, Stroke, Vec2};
use morec::TimeSpan;
use morec::features::Profile;
use morec::math::{Axis, Vec3};

use super::BodySide;
use super::ClipMotion;
use super::mesh::BodyColours;

/// Figures evenly over a stretch, each seen from its own three-quarter front.
pub fn strip(motion: &ClipMotion, span: TimeSpan, rect: Rect, palette: &BodyColours) -> Vec<Shape> {
    let count = ((rect.width() / (rect.height() * 0.62)).round() as usize).clamp(2, 12);
    let width = rect.width() / count as f32;
    // Raised arms reach a quarter above the head.
    let scale = 0.68 * rect.height() / motion.body.height as f32;
    let mut shapes = Vec::new();
    for number in 0..count {
        let share = number as f64 / (count - 1) as f64;
        let secs = span.start_secs + span.duration_secs() * share;
        let foot = Pos2::new(
            rect.left() + width * (number as f32 + 0.5),
            rect.bottom() - 0.05 * rect.height(),
        );
        figure(motion, secs, foot, scale, palette, &mut shapes);
    }
    shapes
}

/// One figure in the middle of `rect`.
pub fn at_moment(motion: &ClipMotion, secs: f64, rect: Rect, palette: &BodyColours) -> Vec<Shape> {
    let scale = 0.68 * rect.height() / motion.body.height as f32;
    let foot = Pos2::new(rect.center().x, rect.bottom() - 0.05 * rect.height());
    let mut shapes = Vec::new();
    figure(motion, secs, foot, scale, palette, &mut shapes);
    shapes
}

fn figure(
    motion: &ClipMotion,
    secs: f64,
    foot: Pos2,
    scale: f32,
    palette: &BodyColours,
    out: &mut Vec<Shape>,
) {
    let (body, pose) = (&motion.body, motion.pose(secs));
    let Some(hips) = body.centre(&pose) else {
        return;
    };
    let across = match body.hip_joints {
        Some((left, right)) => pose.positions[left] - pose.positions[right],
        None => Vec3::x(),
    };
    let flat = Vec3::new(across.x, 0.0, across.z);
    let flat = flat.try_normalize(1e-9).unwrap_or_else(Vec3::x);
    // Turned by 35° from the front, so that arms stretched forward are seen too.
    let right = Axis::Y.rotation(35f64.to_radians()) * flat;
    // Hands are in the air.
    let floor = match motion.roles.profile() {
        Profile::Hand | Profile::Hands => hips.y - 0.3 * body.height,
        _ => motion.floor,
    };
    let at = |p: &Vec3| {
        let x = (p - hips).dot(&right) as f32 * scale;
        let y = (p.y - floor) as f32 * scale;
        foot + Vec2::new(x, -y)
    };
    let limit = 0.6 * body.height;
    for side in [BodySide::Right, BodySide::Middle, BodySide::Left] {
        let colour = match side {
            BodySide::Left => palette.left,
            BodySide::Right => palette.right,
            BodySide::Middle => palette.middle,
        };
        for limb in body.limbs.iter().filter(|l| l.side == side) {
            let (a, b) = (pose.positions[limb.from], pose.positions[limb.to]);
            if (b - a).norm() < limit {
                let thick = (limb.radii[0] * body.height) as f32 * scale * 1.3;
                out.push(Shape::line_segment(
                    [at(&a), at(&b)],
                    Stroke::new(thick.clamp(1.0, 4.0), colour),
                ));
            }
        }
    }
    if let Some((head, _)) = body.head {
        let centre = at(&(pose.positions[head] + Vec3::y() * (0.045 * body.height)));
        let radius = (0.055 * body.height) as f32 * scale;
        out.push(Shape::circle_filled(
            centre,
            radius.max(1.5),
            palette.middle,
        ));
    }
}
