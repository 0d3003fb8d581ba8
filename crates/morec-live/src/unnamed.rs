//! Points in a line of JSON that are given by number, or without the side of their hand.

use morec::features::{Hand, KeyPose};
use morec::math::Vec3;
use morec::roles::Role;
use morec::roles::points::{
    PointJoint, SideVotes, numbered_hand, recognise_numbered_hand, recognise_posed,
};

use crate::PoseLine;
use crate::json_line::UNKNOWN;

/// Frames that tell which hand it is: in the first of them it may be flat.
const VOTES: u32 = 30;

/// What the points of one performer are.
#[derive(Debug, Clone, Default)]
pub(crate) struct UnnamedPoints {
    set: Option<NumberedSet>,
    side: SideVotes,
    votes: u32,
}

/// What numbers of points stand for.
#[derive(Debug, Clone)]
struct NumberedSet {
    count: usize,
    places: Vec<(Role, PointJoint)>,
    is_hand: bool,
}

impl NumberedSet {
    /// By the number of points and what they look like.
    fn of(points: &[Vec3]) -> Option<Self> {
        let names: Vec<String> = (0..points.len()).map(|n| n.to_string()).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let poses = [points.to_vec()];
        let count = points.len();
        if recognise_numbered_hand(&names, &poses).is_some() {
            let roles = numbered_hand(count, Hand::Right)?.into_iter().enumerate();
            let places = roles.filter_map(|(at, role)| Some((role?, PointJoint::Point(at))));
            return Some(Self {
                count,
                places: places.collect(),
                is_hand: true,
            });
        }
        let found = recognise_posed(&names, &poses)?;
        Some(Self {
            count,
            places: found.roles,
            is_hand: false,
        })
    }
}

impl UnnamedPoints {
    /// Gives the points of `pose` their roles: what the first frame that tells it said, and the side of the hand by the first frames.
    pub(crate) fn name(&mut self, pose: &mut PoseLine) -> Result<(), String> {
        let points = std::mem::take(&mut pose.points);
        if !points.is_empty() {
            if self
                .set
                .as_ref()
                .is_none_or(|set| set.count != points.len())
            {
                self.set = NumberedSet::of(&points);
            }
            let set = self.set.as_ref().ok_or_else(|| {
                format!(
                    "points: expected points of a hand or landmarks of a body in a known order, found {} others",
                    points.len()
                )
            })?;
            for (role, place) in &set.places {
                pose.positions[role.index()] = place.at(|point| points[point]).unwrap_or(UNKNOWN);
            }
            pose.is_sideless |= set.is_hand;
        }
        if pose.is_sideless {
            self.tell_side(pose);
        }
        Ok(())
    }

    fn tell_side(&mut self, pose: &mut PoseLine) {
        let of_hand = |hand: Hand| {
            let wrist = hand.points().wrist;
            std::iter::once(wrist).chain(hand.beside_wrist())
        };
        if self.votes < VOTES {
            let mut key = KeyPose::default();
            for role in of_hand(Hand::Right) {
                key.set(role, pose.positions[role.index()]);
            }
            self.side.add(&key);
            self.votes += 1;
        }
        if self.side.hand() == Hand::Left {
            for role in of_hand(Hand::Right) {
                let place = std::mem::replace(&mut pose.positions[role.index()], UNKNOWN);
                pose.positions[role.opposite().index()] = place;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points of a bent hand in MediaPipe's order, as a line has them: the palm down, fingers along +Z.
    pub(crate) fn points(hand: Hand, bend: f64) -> Vec<[f64; 3]> {
        let side = if hand == Hand::Right { 1.0 } else { -1.0 };
        let mut points = vec![[0.0, 1.0, 0.0]];
        for finger in 0..5 {
            let mut at = [(2.5 - f64::from(finger)) * 0.02 * side, 1.0, 0.09];
            for joint in 1..=4 {
                points.push(at);
                let turned = bend * f64::from(joint);
                at = [
                    at[0],
                    at[1] - 0.026 * turned.sin(),
                    at[2] + 0.026 * turned.cos(),
                ];
            }
        }
        points
    }

    fn named(unnamed: &mut UnnamedPoints, text: &str) -> Result<Vec<Role>, String> {
        let mut pose = PoseLine::of_line(text)?;
        unnamed.name(&mut pose)?;
        let known = pose.known();
        let roles = Role::ALL.into_iter();
        Ok(roles
            .filter(|role| known >> role.index() & 1 == 1)
            .collect())
    }

    #[test]
    fn the_side_of_a_hand_is_told_by_its_curl_and_kept() {
        for hand in Hand::BOTH {
            let mut unnamed = UnnamedPoints::default();
            // Once it is known, a flat hand and one bent the other way change nothing.
            for bend in [0.4; 40].into_iter().chain([0.0, -0.3]) {
                let list = serde_json::json!({"points": points(hand, bend)}).to_string();
                let roles = named(&mut unnamed, &list).unwrap();
                assert_eq!(roles.len(), 21);
                assert!(
                    roles.contains(&hand.points().fingers[1][3]),
                    "{hand:?} {bend}"
                );
            }
        }
    }

    #[test]
    fn points_are_those_of_the_hand_that_the_line_says() {
        let mut unnamed = UnnamedPoints::default();
        let mut list = serde_json::json!({"hand": "left", "points": points(Hand::Right, 0.4)});
        let roles = named(&mut unnamed, &list.to_string()).unwrap();
        assert!(roles.contains(&Role::LeftIndexTip) && roles.len() == 21);
        list["points"][8] = serde_json::Value::Null;
        let roles = named(&mut unnamed, &list.to_string()).unwrap();
        assert!(!roles.contains(&Role::LeftIndexTip) && roles.len() == 20);
        let both = serde_json::json!({"points": {"left": points(Hand::Left, 0.4), "right": points(Hand::Right, 0.4)}});
        assert_eq!(named(&mut unnamed, &both.to_string()).unwrap().len(), 42);
        let names =
            r#"{"positions": {"wrist": [0,1,0], "index_tip": [0,1,0.1], "thumb-tip": [0.1,1,0]}}"#;
        let found = named(&mut UnnamedPoints::default(), names).unwrap();
        assert_eq!(
            found,
            [Role::RightHand, Role::RightThumbTip, Role::RightIndexTip]
        );
    }

    #[test]
    fn points_that_look_like_nobody_are_refused() {
        let mut unnamed = UnnamedPoints::default();
        let spread: Vec<[f64; 3]> = (0..21)
            .map(|n| [f64::from(n * n), f64::from(n % 5), 0.0])
            .collect();
        let line = serde_json::json!({ "points": spread }).to_string();
        let error = named(&mut unnamed, &line).unwrap_err();
        assert!(
            error.starts_with("points: expected points of a hand"),
            "{error}"
        );
        for (line, said) in [
            (
                r#"{"hand": "both", "points": []}"#,
                "hand: expected left or right, found the text \"both\"",
            ),
            (
                r#"{"hand": "left", "points": [[0,0,0]]}"#,
                "points: expected 20, 21, 22, 25 or 26 points of a hand, found 1",
            ),
            (
                r#"{"points": [[0,0,0], [0,1]]}"#,
                "points[1]: expected [x, y, z], found 2 numbers",
            ),
            (
                r#"{"points": {"left": 3}}"#,
                "points.left: expected a list of [x, y, z], found 3",
            ),
            (
                r#"{"points": {"foot": []}}"#,
                "points.foot: expected left or right, found 0 numbers",
            ),
            (
                r#"{"hand": "left", "positions": {"right_index_tip": [0,0,0]}}"#,
                "positions.right_index_tip: expected a point of the left hand",
            ),
            (
                r#"{"hand": "left", "positions": {"hips": [0,0,0]}}"#,
                "positions.hips: no point of a hand is called hips; the points are wrist, palm, thumb_1",
            ),
        ] {
            let error = PoseLine::of_line(line).unwrap_err();
            assert!(error.starts_with(said), "{line}: {error}");
        }
    }
}
