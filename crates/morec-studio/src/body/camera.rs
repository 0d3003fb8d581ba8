//! The camera of the view.

use egui::{Pos2, Rect, Vec2};
use morec::math::Vec3;

/// Nearer than this nothing is drawn, metres.
const NEAR: f64 = 0.15;
/// From the middle of the picture to its upper edge: 24°.
const HALF_ANGLE: f64 = 24.0 * std::f64::consts::PI / 180.0;

/// Width of the narrowest picture, of its height.
const NARROWEST: f64 = 0.8;

/// A camera that looks at a point from some way off. Right-handed, Y up, metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    pub target: Vec3,
    /// About the vertical; 0 looks from +Z, which is the front of somebody who faces +Z.
    pub yaw: f64,
    /// Above the horizon.
    pub pitch: f64,
    pub distance: f64,
    /// True if the target follows the performer.
    pub follow: bool,
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            target: Vec3::new(0.0, 0.9, 0.0),
            yaw: 0.55,
            pitch: 0.16,
            distance: 3.2,
            follow: true,
        }
    }
}

/// A camera before a picture: its axes in the world, and the picture's middle and scale.
#[derive(Debug, Clone, Copy)]
pub struct View {
    eye: Vec3,
    right: Vec3,
    up: Vec3,
    pub forward: Vec3,
    centre: Pos2,
    scale: f64,
}

impl Camera {
    /// Steepest look from above or below, radians.
    pub const STEEPEST: f64 = 1.5;
    /// Least and greatest distance, metres.
    pub const NEAREST: f64 = 0.6;
    pub const FARTHEST: f64 = 400.0;

    /// The distance at which what reaches so far from the target is seen whole, metres.
    pub fn distance_of(half: f64) -> f64 {
        (1.5 * half / HALF_ANGLE.tan()).clamp(Self::NEAREST, Self::FARTHEST)
    }

    /// The distance at which places at these offsets from the target are in the picture, seen from where it is seen now, metres.
    pub fn distance_to_see(&self, offsets: impl Iterator<Item = Vec3>) -> f64 {
        // Room at the edges, and pictures that are higher than wide.
        let slope = 0.85 * HALF_ANGLE.tan();
        let (right, up, forward) = self.axes();
        let needed = offsets.map(|at| {
            let aside = at.dot(&up).abs().max(at.dot(&right).abs() / NARROWEST);
            aside / slope - at.dot(&forward)
        });
        // A place that is not a number is nowhere.
        let least = needed.filter(|d| d.is_finite()).fold(0.0, f64::max);
        least.clamp(Self::NEAREST, Self::FARTHEST)
    }

    /// Turns by a drag over this many points.
    pub fn orbit(&mut self, drag: Vec2) {
        self.yaw -= f64::from(drag.x) * 0.008;
        self.pitch =
            (self.pitch + f64::from(drag.y) * 0.008).clamp(-Self::STEEPEST, Self::STEEPEST);
    }

    /// Moves the target by a drag over this many points of a picture of this height.
    pub fn pan(&mut self, drag: Vec2, height: f32) {
        let metres = self.distance * 0.9 / f64::from(height.max(1.0));
        let (right, up, _) = self.axes();
        self.target -= right * (f64::from(drag.x) * metres);
        self.target += up * (f64::from(drag.y) * metres);
        self.follow = false;
    }

    /// Nearer for factors above 1.
    pub fn zoom(&mut self, factor: f64) {
        if factor.is_finite() && factor > 0.0 {
            self.distance = (self.distance / factor).clamp(Self::NEAREST, Self::FARTHEST);
        }
    }

    fn axes(&self) -> (Vec3, Vec3, Vec3) {
        let (sin_y, cos_y) = self.yaw.sin_cos();
        let (sin_p, cos_p) = self.pitch.sin_cos();
        let back = Vec3::new(sin_y * cos_p, sin_p, cos_y * cos_p);
        let right = Vec3::new(cos_y, 0.0, -sin_y);
        (right, back.cross(&right), -back)
    }

    /// This camera before a picture.
    pub fn view(&self, rect: Rect) -> View {
        let (right, up, forward) = self.axes();
        View {
            eye: self.target - forward * self.distance,
            right,
            up,
            forward,
            centre: rect.center(),
            scale: f64::from(rect.height()) / (2.0 * HALF_ANGLE.tan()),
        }
    }
}

impl View {
    /// Projects a point of the world: its place in the picture and its depth in metres; `None` behind the camera.
    pub fn project(&self, point: &Vec3) -> Option<(Pos2, f64)> {
        let from_eye = point - self.eye;
        let depth = from_eye.dot(&self.forward);
        // A place that is not a number is nowhere.
        if depth.is_nan() || depth <= NEAR {
            return None;
        }
        let scale = self.scale / depth;
        let x = from_eye.dot(&self.right) * scale;
        let y = from_eye.dot(&self.up) * scale;
        Some((self.centre + Vec2::new(x as f32, -y as f32), depth))
    }

    /// Depth of a point before the camera, metres.
    pub fn depth(&self, point: &Vec3) -> f64 {
        (point - self.eye).dot(&self.forward)
    }

    /// The part of a line that lies before the camera, in the picture.
    pub fn line(&self, a: &Vec3, b: &Vec3) -> Option<[Pos2; 2]> {
        let depth = |p: &Vec3| (p - self.eye).dot(&self.forward) - 1.01 * NEAR;
        let (da, db) = (depth(a), depth(b));
        let cut = |inside: &Vec3, outside: &Vec3, di: f64, d_o: f64| {
            inside + (outside - inside) * (di / (di - d_o))
        };
        let (a, b) = match (da > 0.0, db > 0.0) {
            (true, true) => (*a, *b),
            (true, false) => (*a, cut(a, b, da, db)),
            (false, true) => (cut(b, a, db, da), *b),
            (false, false) => return None,
        };
        Some([self.project(&a)?.0, self.project(&b)?.0])
    }

    /// Towards the camera from a point, a unit vector.
    pub fn towards_eye(&self, point: &Vec3) -> Vec3 {
        (self.eye - point).normalize()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture() -> Rect {
        Rect::from_min_size(Pos2::ZERO, Vec2::new(400.0, 300.0))
    }

    #[test]
    fn the_target_is_in_the_middle_and_up_is_up() {
        let camera = Camera::default();
        let view = camera.view(picture());
        let (at, depth) = view.project(&camera.target).unwrap();
        assert!((at - picture().center()).length() < 1e-3);
        assert!((depth - camera.distance).abs() < 1e-9);
        let (above, _) = view.project(&(camera.target + Vec3::y() * 0.5)).unwrap();
        assert!(above.y < at.y);
    }

    #[test]
    fn from_the_front_the_left_hand_is_at_the_right() {
        let camera = Camera {
            yaw: 0.0,
            pitch: 0.0,
            ..Camera::default()
        };
        let view = camera.view(picture());
        // Whoever faces +Z has the left hand at +X.
        let (hand, _) = view.project(&(camera.target + Vec3::x())).unwrap();
        assert!(hand.x > picture().center().x);
    }

    #[test]
    fn what_is_behind_is_not_drawn_and_lines_are_cut() {
        let camera = Camera::default();
        let view = camera.view(picture());
        let behind = view.eye - view.forward;
        assert_eq!(view.project(&behind), None);
        assert!(view.line(&behind, &camera.target).is_some());
        assert_eq!(view.line(&behind, &(behind - view.forward)), None);
    }
}
