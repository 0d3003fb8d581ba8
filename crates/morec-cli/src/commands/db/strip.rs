//! A strip of stick figures that shows a stretch of motion.

use std::fmt::Write;

use morec::TimeSpan;
use morec::clip::Clip;
use morec::features::{Hand, Profile};
use morec::kinematics::WorldPose;
use morec::math::Vec3;
use morec::roles::{BODY_LINES, Role, RoleMap};
use morec_db::StoredClip;

/// Height of a strip, in pixels.
const HEIGHT: f64 = 90.0;
/// Width of one pose.
const WIDTH: f64 = 52.0;

/// `poses` stick figures evenly over a stretch, each seen from its own three-quarter front; left limbs and right limbs in
/// two colours.
pub fn strip(stored: &StoredClip, span: TimeSpan, poses: usize) -> String {
    let clip = &stored.clip;
    let end = clip.frames.saturating_sub(1);
    let frames = span.frames_among(end, clip.rate_hz);
    let (first, last) = (frames.start.max(stored.rest.end.min(end)), frames.end);
    let mut figures = String::new();
    let mut extent = PictureBounds {
        left: 0.0,
        right: WIDTH * poses as f64,
        top: 0.0,
    };
    let height = body_height(clip, stored.roles.profile(), first);
    for pose in 0..poses {
        let at = first + (last.max(first) - first) * pose / (poses - 1).max(1);
        figure(
            &mut figures,
            &mut extent,
            stored,
            at,
            WIDTH * (pose as f64 + 0.5),
            0.75 * HEIGHT / height,
        );
    }
    let PictureBounds { left, right, top } = extent;
    let (width, height) = (right - left, HEIGHT - top);
    format!(
        "<svg width=\"{width:.0}\" height=\"{height:.0}\" viewBox=\"{left:.1} {top:.1} {width:.1} {height:.1}\" role=\"img\">\
         {figures}</svg>"
    )
}

/// Bounds of the figures, pixels, so that an arm that is stretched out is not cut off.
struct PictureBounds {
    left: f64,
    right: f64,
    top: f64,
}

impl PictureBounds {
    fn add(&mut self, (x, y): (f64, f64)) {
        const MARGIN: f64 = 2.0;
        self.left = self.left.min(x - MARGIN);
        self.right = self.right.max(x + MARGIN);
        self.top = self.top.min(y - MARGIN);
    }
}

/// Height of the pose of a frame; never 0.
fn body_height(clip: &Clip, profile: Profile, frame: usize) -> f64 {
    let pose = WorldPose::of(clip, frame);
    let heights = || pose.positions.iter().map(|p| p.y);
    let least = match profile {
        Profile::Hand | Profile::Hands => 0.2,
        _ => 0.3,
    };
    (heights().fold(f64::MIN, f64::max) - heights().fold(f64::MAX, f64::min)).max(least)
}

/// Start of the bone that ends in `joint`: its parent; in a clip of points the role before its own.
fn bone_start(clip: &Clip, roles: &RoleMap, joint: usize) -> Option<usize> {
    if clip.has_rotations() {
        return clip.skeleton.joints()[joint].parent;
    }
    let ends_here = |(_, end): &&(Role, Role)| roles.joint(*end) == Some(joint);
    let body = BODY_LINES.into_iter();
    let is_known = |role: Role| roles.joint(role).is_some();
    let hands = Hand::BOTH.into_iter().flat_map(|hand| hand.lines(is_known));
    let (start, _) = body.chain(hands).find(|bone| ends_here(&bone))?;
    roles.joint(start)
}

fn figure(
    svg: &mut String,
    extent: &mut PictureBounds,
    stored: &StoredClip,
    frame: usize,
    x: f64,
    scale: f64,
) {
    let pose = WorldPose::of(&stored.clip, frame);
    let (right, hips) = view(&pose, &stored.roles);
    let low = pose.positions.iter().map(|p| p.y).fold(f64::MAX, f64::min);
    // A jump is seen: the floor is where the feet are, but not above the world's.
    let floor = low.min(hips.y - 0.5 / scale);
    let at = |p: &Vec3| {
        (
            x + (p - hips).dot(&right) * scale,
            0.93 * HEIGHT - (p.y - floor) * scale,
        )
    };
    let (mut left, mut others, mut rights) = (String::new(), String::new(), String::new());
    for j in 0..stored.clip.skeleton.len() {
        let Some(parent) = bone_start(&stored.clip, &stored.roles, j) else {
            continue;
        };
        // Props and worlds: a root's children far away are no bones.
        let (from, to) = (at(&pose.positions[parent]), at(&pose.positions[j]));
        extent.add(from);
        extent.add(to);
        let path = match side(&stored.clip, &stored.roles, j) {
            Some(true) => &mut left,
            Some(false) => &mut rights,
            None => &mut others,
        };
        let _ = write!(path, "M{:.1} {:.1}L{:.1} {:.1}", from.0, from.1, to.0, to.1);
    }
    for (path, colour) in [(rights, "#c8553d"), (others, "#888"), (left, "#3d7bc8")] {
        if !path.is_empty() {
            let _ = write!(svg, "<path stroke=\"{colour}\" d=\"{path}\"/>");
        }
    }
}

/// The direction that points right in the picture, and where the hips are.
fn view(pose: &WorldPose, roles: &RoleMap) -> (Vec3, Vec3) {
    let of = |role| roles.joint(role).map(|j: usize| pose.positions[j]);
    let hips = of(Role::Hips)
        .or(pose.positions.first().copied())
        .unwrap_or_else(Vec3::zeros);
    let lateral = match (of(Role::LeftThigh), of(Role::RightThigh)) {
        (Some(left), Some(right)) => left - right,
        _ => Vec3::x(),
    };
    let flat = Vec3::new(lateral.x, 0.0, lateral.z);
    let flat = if flat.norm() > 1e-9 {
        flat.normalize()
    } else {
        Vec3::x()
    };
    // Turned by 35° from the front, so that arms stretched forward are seen too.
    (
        morec::math::Axis::Y.rotation(35f64.to_radians()) * flat,
        hips,
    )
}

/// Side of the limb that a joint belongs to: left, right, or neither.
fn side(clip: &Clip, roles: &RoleMap, joint: usize) -> Option<bool> {
    let played = roles.played().filter(|(_, j)| *j == joint);
    if let Some(hand) = played.filter_map(|(role, _)| Hand::of(role)).next() {
        return Some(hand == Hand::Left);
    }
    const LEFT: [Role; 3] = [Role::LeftThigh, Role::LeftShoulder, Role::LeftArm];
    const RIGHT: [Role; 3] = [Role::RightThigh, Role::RightShoulder, Role::RightArm];
    let mut at = Some(joint);
    while let Some(j) = at {
        let plays = |sides: &[Role]| sides.iter().any(|role| roles.joint(*role) == Some(j));
        if plays(&LEFT) {
            return Some(true);
        }
        if plays(&RIGHT) {
            return Some(false);
        }
        at = bone_start(clip, roles, j);
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use morec::synth::{Person, Script};

    /// A body with stretched arms is wider than a pose's place in the strip, one with lifted arms taller.
    #[test]
    fn nothing_of_a_figure_lies_outside_the_picture() {
        let script = Script::new(3, Person::draw(31, 2)).rest(0.2).play("wave");
        let mut clip = script.film("wave", 30.0).unwrap().clip;
        let roles = RoleMap::find(&clip.skeleton);
        let hand = roles.joint(Role::LeftHand).unwrap();
        // A hand that flies four metres away after the first frame, which the figures are scaled by.
        let near = clip.skeleton.joints()[hand].offset;
        let far = 4.0 * near.normalize();
        let positions = (0..clip.frames).map(|frame| if frame == 0 { near } else { far });
        clip.tracks.push(morec::clip::JointTrack {
            joint: hand,
            positions: positions.collect(),
        });
        let span = TimeSpan::new(0.0, clip.duration_secs());
        let stored = StoredClip {
            clip,
            roles,
            rest: 0..0,
        };
        let svg = strip(&stored, span, 8);
        let quoted = |name: &str| svg.split_once(&format!("{name}=\"")).unwrap().1.to_owned();
        let numbers = |text: &str| -> Vec<f64> {
            let words = text.split(|c: char| !(c.is_ascii_digit() || "-.".contains(c)));
            words.filter_map(|word| word.parse().ok()).collect()
        };
        let shown = numbers(quoted("viewBox").split_once('"').unwrap().0);
        assert!(shown[0] < 0.0 || shown[2] > 8.0 * WIDTH || shown[1] < 0.0);
        for path in svg.split(" d=\"").skip(1) {
            for at in numbers(path.split_once('"').unwrap().0).chunks(2) {
                let inside = |value: f64, from: f64, wide: f64| value > from && value < from + wide;
                assert!(
                    inside(at[0], shown[0], shown[2]) && inside(at[1], shown[1], shown[3]),
                    "{at:?} in {shown:?}"
                );
            }
        }
    }
}
