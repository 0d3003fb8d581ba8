//! Positions of joints, computed from points.

use super::names::normalised_one;
use crate::math::Vec3;
use crate::roles::Role;

/// A joint's place among points, by their indices.
#[derive(Debug, Clone, PartialEq)]
pub enum PointJoint {
    /// The middle of these; of one, the point itself.
    Middle(Vec<PointJoint>),
    /// A point, by its index.
    Point(usize),
    /// A hip joint's centre, from the pelvis.
    HipCentre {
        /// True if it is the left one.
        left: bool,
        /// The left and the right anterior superior iliac spine.
        front: [usize; 2],
        /// The middle of these is the sacrum.
        back: Vec<usize>,
    },
}

impl PointJoint {
    /// Its position, `point` giving those of the points; `None` if the pelvis has no direction. O(points in it).
    pub fn at(&self, point: impl Fn(usize) -> Vec3 + Copy) -> Option<Vec3> {
        match self {
            PointJoint::Point(index) => Some(point(*index)),
            PointJoint::Middle(parts) => {
                let mut sum = Vec3::zeros();
                for part in parts {
                    sum += part.at(point)?;
                }
                Some(sum / parts.len().max(1) as f64)
            }
            PointJoint::HipCentre { left, front, back } => {
                let back = back.iter().map(|&p| point(p)).sum::<Vec3>() / back.len() as f64;
                hip_centre(*left, front.map(point), back)
            }
        }
    }

    /// The points that it depends on.
    pub fn points(&self) -> Vec<usize> {
        match self {
            PointJoint::Point(index) => vec![*index],
            PointJoint::Middle(parts) => parts.iter().flat_map(PointJoint::points).collect(),
            PointJoint::HipCentre { front, back, .. } => {
                front.iter().chain(back).copied().collect()
            }
        }
    }

    /// The point that it is, if it is one.
    pub fn single(&self) -> Option<usize> {
        match self {
            PointJoint::Point(index) => Some(*index),
            PointJoint::Middle(parts) => match parts.as_slice() {
                [one] => one.single(),
                _ => None,
            },
            PointJoint::HipCentre { .. } => None,
        }
    }
}

/// The hip joint's centre after Bell, Pedersen and Brand (1990), in widths between the anterior superior iliac spines
/// from their middle: 0.36 to the side, 0.19 back, 0.30 down.
fn hip_centre(left: bool, [left_front, right_front]: [Vec3; 2], back: Vec3) -> Option<Vec3> {
    let across = left_front - right_front;
    let width = across.norm();
    let to_left = across.try_normalize(1e-9)?;
    let middle = (left_front + right_front) / 2.0;
    let forward = middle - back;
    let forward = (forward - to_left * forward.dot(&to_left)).try_normalize(1e-9)?;
    let up = forward.cross(&to_left);
    let side = if left { 0.36 } else { -0.36 };
    Some(middle + (to_left * side - forward * 0.19 - up * 0.30) * width)
}

/// A line of a table: alternatives between `|`, of which the first whose points are all there is taken. Each is the
/// middle of what stands between `+`: names of points, `@role` for where a role is, or `hip(l;left;right;back+back)` for
/// a hip joint's centre.
pub(super) struct Expression<'a>(&'a str);

impl<'a> Expression<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self(text)
    }

    /// The place among points of normalised `names`; `roles` are those known so far.
    pub(super) fn place(
        &self,
        names: &[String],
        roles: &[(Role, PointJoint)],
    ) -> Option<PointJoint> {
        let mut alternatives = self.0.split('|');
        alternatives.find_map(|text| alternative(text, names, roles))
    }
}

fn alternative(text: &str, names: &[String], roles: &[(Role, PointJoint)]) -> Option<PointJoint> {
    let find = |name: &str| names.iter().position(|known| known == name);
    if let Some(hip) = text.strip_prefix("hip(").and_then(|t| t.strip_suffix(')')) {
        let [side, left, right, back] = hip.split(';').collect::<Vec<_>>().try_into().ok()?;
        return Some(PointJoint::HipCentre {
            left: side == "l",
            front: [find(left)?, find(right)?],
            back: back.split('+').map(find).collect::<Option<_>>()?,
        });
    }
    let part = |text: &str| match text.strip_prefix('@') {
        Some(role) => {
            let role = Role::from_name(role)?;
            let known = roles.iter().find(|(known, _)| *known == role);
            known.map(|(_, place)| place.clone())
        }
        None => find(text).map(PointJoint::Point),
    };
    let mut parts: Vec<PointJoint> = text.split('+').map(part).collect::<Option<_>>()?;
    if parts.len() == 1 {
        return parts.pop();
    }
    Some(PointJoint::Middle(parts))
}

/// The place that a mapping file says: names of points between `+`, spelt as the clip spells them or nearly so.
pub(in crate::roles) fn said(text: &str, names: &[&str]) -> Result<PointJoint, String> {
    let find = |name: &str| {
        let exact = names.iter().position(|known| *known == name);
        let nearly = || {
            let name = normalised_one(name);
            let mut same = (0..names.len()).filter(|&p| normalised_one(names[p]) == name);
            same.next().filter(|_| same.next().is_none())
        };
        exact.or_else(nearly).ok_or_else(|| name.to_owned())
    };
    // A name may have a plus in it.
    if let Some(point) = names.iter().position(|known| *known == text) {
        return Ok(PointJoint::Point(point));
    }
    let mut parts = text
        .split('+')
        .map(|name| find(name.trim()).map(PointJoint::Point))
        .collect::<Result<Vec<PointJoint>, String>>()?;
    match parts.len() {
        1 => Ok(parts.remove(0)),
        _ => Ok(PointJoint::Middle(parts)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hips_lie_below_and_behind_the_spines() {
        // A pelvis that faces +Z, left is +X; 0.24 m wide.
        let [left, right] = [Vec3::new(0.12, 1.0, 0.0), Vec3::new(-0.12, 1.0, 0.0)];
        let back = Vec3::new(0.0, 1.0, -0.16);
        let centre = hip_centre(true, [left, right], back).unwrap();
        let expected = Vec3::new(0.36, 0.0, 0.0) * 0.24 + Vec3::new(0.0, 1.0 - 0.072, -0.0456);
        assert!((centre - expected).norm() < 1e-12, "{centre}");
        let other = hip_centre(false, [left, right], back).unwrap();
        assert!((other.x + centre.x).abs() < 1e-12);
        assert_eq!(hip_centre(true, [left, left], back), None);
    }

    #[test]
    fn the_first_alternative_that_is_whole() {
        let names = ["a", "b", "c"].map(str::to_owned);
        let place = |text: &str| Expression::new(text).place(&names, &[]);
        assert_eq!(place("x|a+x|b+c|a").unwrap().points(), [1, 2]);
        assert_eq!(place("x|c").unwrap().single(), Some(2));
        assert_eq!(place("x|y"), None);
        let at = |p: usize| Vec3::repeat(p as f64);
        assert_eq!(place("a+c").unwrap().at(at), Some(Vec3::repeat(1.0)));
    }

    #[test]
    fn mapping_files_name_points() {
        let names = ["Reed:LKNE", "Reed:LKNM", "A+B"];
        assert_eq!(said("LKNE + Reed:LKNM", &names).unwrap().points(), [0, 1]);
        assert_eq!(said("A+B", &names).unwrap().single(), Some(2));
        assert_eq!(said("LKNE+RKNE", &names).unwrap_err(), "RKNE");
    }
}
