//! Points of hands: by names, or by their numbers in the order of a known model.

use std::collections::BTreeMap;

use super::names::{numbers, words};
use crate::math::Vec3;
use crate::pose::{Hand, KeyPose};
use crate::roles::Role;

/// A point of a hand, whichever.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum HandPoint {
    Wrist,
    Palm,
    /// Finger from the thumb, and point from its base.
    Finger(usize, usize),
}

impl HandPoint {
    fn of(self, hand: Hand) -> Role {
        let points = hand.points();
        match self {
            HandPoint::Wrist => points.wrist,
            HandPoint::Palm => points.palm,
            HandPoint::Finger(finger, at) => points.fingers[finger][at],
        }
    }
}

/// Points of a hand that are enough to be one: fewer belong to a body.
const LEAST: usize = 8;

/// The counts of points of a hand whose order is known: SHREC 2021, MediaPipe, SHREC 2017, WebXR, OpenXR.
pub const NUMBERED_HANDS: [usize; 5] = [20, 21, 22, 25, 26];

/// What each of `count` points of `hand` is, in the order of the model with this many points: `None` for a joint within the palm. `None` as a
/// whole if there is no such model.
pub fn numbered_hand(count: usize, hand: Hand) -> Option<Vec<Option<Role>>> {
    let (_, model) = models(count).first()?;
    let role = |number| Some(model(number)?.of(hand));
    Some((0..count).map(role).collect())
}

/// Points in the order of their numbers, as a line of JSON has them: of one performer, or of both hands.
#[derive(Debug, serde::Deserialize)]
#[serde(untagged)]
pub enum NumberedPoints {
    /// Of a performer, or of the hand that the line is about.
    Of(Vec<OptionalPlace>),
    /// Of both hands in one line.
    Hands(BTreeMap<Hand, Vec<OptionalPlace>>),
}

impl Default for NumberedPoints {
    fn default() -> Self {
        Self::Of(Vec::new())
    }
}

/// A place that may be unknown.
type OptionalPlace = Option<[f64; 3]>;

/// A point of a known hand: what it is, and where.
type PlacedPoint = (Role, OptionalPlace);

impl NumberedPoints {
    /// The points of known hands, and those of whom the line does not say what they are; `hand` is the one that it is about.
    ///
    /// # Errors
    /// The number of points found, if no known hand model has that number.
    pub fn by_hand(
        self,
        hand: Option<Hand>,
    ) -> Result<(Vec<PlacedPoint>, Vec<OptionalPlace>), usize> {
        let hands = match (self, hand) {
            (Self::Hands(hands), _) => hands,
            (Self::Of(points), Some(hand)) if !points.is_empty() => {
                BTreeMap::from([(hand, points)])
            }
            (Self::Of(points), _) => return Ok((Vec::new(), points)),
        };
        let mut placed = Vec::new();
        for (hand, points) in hands {
            let roles = numbered_hand(points.len(), hand).ok_or(points.len())?;
            let known = roles.into_iter().zip(points);
            placed.extend(known.filter_map(|(role, place)| Some((role?, place))));
        }
        Ok((placed, Vec::new()))
    }
}

/// The point of a hand of this name, and the side that the name says: of `hand` if it says none. `INDEX_FINGER_TIP`, `left_index_tip`,
/// `thumb-metacarpal`, `palm`.
pub fn hand_role(name: &str, hand: Hand) -> Option<(Option<Hand>, Role)> {
    let (side, point) = meaning(name)?;
    Some((side, point.of(side.unwrap_or(hand))))
}

/// The points of hands among points of these names, with their set's name. `poses` are places of the points in some frames: they
/// tell a hand from a body where points have numbers alone, and a left hand from a right one where no name does. O(points · poses).
pub fn recognise_hands(
    names: &[&str],
    poses: &[Vec<Vec3>],
) -> Option<(&'static str, Vec<(Role, usize)>)> {
    if let Some(numbered) = recognise_numbered_hand(names, poses) {
        return Some(numbered);
    }
    let named: Vec<(Option<Hand>, HandPoint, usize)> = names
        .iter()
        .enumerate()
        .filter_map(|(at, name)| {
            let (hand, point) = meaning(name)?;
            Some((hand, point, at))
        })
        .collect();
    let fingers = named
        .iter()
        .filter(|(_, point, _)| matches!(point, HandPoint::Finger(..)));
    // Half of the points at least: a body's few fingers make no hand of it.
    if fingers.clone().count() < LEAST || 2 * named.len() < names.len() {
        return None;
    }
    let sideless: Vec<(HandPoint, usize)> = named
        .iter()
        .filter(|(hand, ..)| hand.is_none())
        .map(|(_, point, at)| (*point, *at))
        .collect();
    let side = side(&sideless, poses);
    let mut roles: Vec<(Role, usize)> = Vec::new();
    for (hand, point, at) in named {
        let role = point.of(hand.unwrap_or(side));
        if roles.iter().all(|(known, _)| *known != role) {
            roles.push((role, at));
        }
    }
    Some(("points of a hand", roles))
}

/// [`recognise_hands`] of points that have numbers alone, or behind the name of the hand: `12`, `left_12`, `Right:12`, `hand_1_12`. They are
/// hands if they look like hands.
pub fn recognise_numbered_hand(
    names: &[&str],
    poses: &[Vec<Vec3>],
) -> Option<(&'static str, Vec<(Role, usize)>)> {
    let mut groups: Vec<(&str, Vec<usize>)> = Vec::new();
    for (at, name) in names.iter().enumerate() {
        let before = name.trim_end_matches(|c: char| c.is_ascii_digit());
        match groups.iter().position(|(known, _)| *known == before) {
            Some(known) => groups[known].1.push(at),
            None if groups.len() == 2 => return None,
            None => groups.push((before, vec![at])),
        }
    }
    let mut all: Vec<(Role, usize)> = Vec::new();
    let mut sets = Vec::new();
    for (before, group) in groups {
        let own: Vec<&str> = group.iter().map(|at| names[*at]).collect();
        let order = numbers(&own)?;
        let of_model = |(set, model): &(&'static str, NumberedHand)| {
            let known = order.iter().zip(&group);
            let points: Vec<(HandPoint, usize)> = known
                .filter_map(|(number, at)| Some((model(*number)?, *at)))
                .collect();
            let of_set = RIGHT_HANDS.contains(set).then_some(Hand::Right);
            let told = side_of(before).or(of_set);
            let told = told.unwrap_or_else(|| side(&points, poses));
            // Whose other hand is known, this is not it.
            let taken = all.iter().any(|(role, _)| Hand::of(*role) == Some(told));
            let hand = if taken { told.other() } else { told };
            let roles: Vec<_> = points.iter().map(|(p, at)| (p.of(hand), *at)).collect();
            is_like_a_hand(&roles, poses, hand).then_some((*set, roles))
        };
        let (set, roles) = models(own.len()).iter().find_map(of_model)?;
        sets.push(set);
        all.extend(roles);
    }
    Some((sets.first()?, all))
}

/// The side that a name says.
fn side_of(name: &str) -> Option<Hand> {
    let words = words(&name.replace(':', "_"));
    words.iter().find_map(|word| match word.as_str() {
        "left" | "l" => Some(Hand::Left),
        "right" | "r" => Some(Hand::Right),
        _ => None,
    })
}

/// The set of this many numbered points, and what each number is.
type NumberedHand = fn(usize) -> Option<HandPoint>;

/// Sets in which all hands are right ones, some of them in left-handed axes, where bones say the other side.
const RIGHT_HANDS: [&str; 2] = ["DHG hand (22)", "BigHand (21)"];

/// The models of this many points, the commonest first; lengths of bones tell them apart.
fn models(count: usize) -> &'static [(&'static str, NumberedHand)] {
    match count {
        21 => &[
            // developers.google.com/mediapipe, "Hand landmarks detection"; OpenPose's hands have the same order.
            ("MediaPipe hand (21)", |number| match number {
                0 => Some(HandPoint::Wrist),
                _ => Some(HandPoint::Finger((number - 1) / 4, (number - 1) % 4)),
            }),
            // BigHand2.2M (Yuan et al. 2017) and First-Person Hand Action (Garcia-Hernando et al. 2018): the bases of all fingers
            // first.
            ("BigHand (21)", |number| match number {
                0 => Some(HandPoint::Wrist),
                1..=5 => Some(HandPoint::Finger(number - 1, 0)),
                _ => Some(HandPoint::Finger((number - 6) / 3, (number - 6) % 3 + 1)),
            }),
        ],
        // DHG-14/28 (De Smedt et al. 2016) and SHREC 2017: wrist and palm, then four points of each finger.
        22 => &[("DHG hand (22)", |number| match number {
            0 => Some(HandPoint::Wrist),
            1 => Some(HandPoint::Palm),
            _ => Some(HandPoint::Finger((number - 2) / 4, (number - 2) % 4)),
        })],
        // SHREC 2021, track on gestures of hands: palm, three points of the thumb, four of each finger.
        20 => &[("SHREC hand (20)", |number| match number {
            0 => Some(HandPoint::Palm),
            1 | 2 => Some(HandPoint::Finger(0, number - 1)),
            3 => Some(HandPoint::Finger(0, 3)),
            _ => Some(HandPoint::Finger(number / 4, number % 4)),
        })],
        // XrHandJointEXT of OpenXR 1.0.
        26 => &[("OpenXR hand (26)", |number| match number {
            0 => Some(HandPoint::Palm),
            _ => xr(number - 1),
        })],
        // XRHandJoint of WebXR Hand Input: the same without the palm.
        25 => &[("WebXR hand (25)", xr)],
        _ => &[],
    }
}

/// The joints of WebXR in their order: the wrist, four of the thumb, five of each finger with the metacarpal first.
fn xr(number: usize) -> Option<HandPoint> {
    match number {
        0 => Some(HandPoint::Wrist),
        1..=4 => Some(HandPoint::Finger(0, number - 1)),
        _ => {
            let (finger, at) = ((number - 5) / 5 + 1, (number - 5) % 5);
            Some(HandPoint::Finger(finger, at.checked_sub(1)?))
        }
    }
}

/// What a name says: `left_index_tip`, `THUMB_CMC`, `index-finger-phalanx-distal`, `LeftHandRing2`.
fn meaning(name: &str) -> Option<(Option<Hand>, HandPoint)> {
    // The wrist is the joint of a body's hand.
    let is_wrist = |hand: &Hand| name == hand.points().wrist.name();
    if let Some(hand) = Hand::BOTH.into_iter().find(is_wrist) {
        return Some((Some(hand), HandPoint::Wrist));
    }
    // A table of hands has the side where others have a person's name.
    let name = &name.replace(':', "_");
    let mut hand = None;
    let (mut finger, mut at) = (None, None);
    let mut whole = None;
    for word in split(name) {
        match word.as_str() {
            "left" | "l" => hand = Some(Hand::Left),
            "right" | "r" => hand = Some(Hand::Right),
            "wrist" => whole = Some(HandPoint::Wrist),
            "palm" => whole = Some(HandPoint::Palm),
            "thumb" => finger = Some(0),
            "index" => finger = Some(1),
            "middle" => finger = Some(2),
            "ring" => finger = Some(3),
            "little" | "pinky" => finger = Some(4),
            "tip" | "end" => at = Some(3),
            "base" | "1" | "mcp" | "cmc" => at = Some(0),
            "2" | "pip" => at = Some(1),
            "3" | "dip" | "ip" => at = Some(2),
            "4" => at = Some(3),
            "metacarpal" | "proximal" | "intermediate" | "distal" => at = Some(bone_end(&word)),
            _ => {}
        }
    }
    let Some(finger) = finger else {
        return Some((hand, whole?));
    };
    let lower = name.to_ascii_lowercase();
    let at = match (finger, at?) {
        // The thumb's joints of MediaPipe are one farther out than those of the fingers of the same name.
        (0, 0) if lower.contains("mcp") => 1,
        // A thumb has a metacarpal for a proximal bone, and no intermediate one.
        (0, METACARPAL) => 0,
        (_, METACARPAL) => return None,
        (0, at) if lower.contains("proximal") || lower.contains("intermediate") => at + 1,
        (_, at) => at,
    };
    Some((hand, HandPoint::Finger(finger, at)))
}

const METACARPAL: usize = usize::MAX;

/// The joint at the near end of a finger's bone.
fn bone_end(bone: &str) -> usize {
    match bone {
        "metacarpal" => METACARPAL,
        "proximal" => 0,
        "intermediate" => 1,
        _ => 2,
    }
}

/// Words of a name, with its digits for themselves.
fn split(name: &str) -> Vec<String> {
    let mut parts = Vec::new();
    for word in words(name) {
        let letters = word.trim_end_matches(|c: char| c.is_ascii_digit());
        let digits = &word[letters.len()..];
        parts.extend([letters, digits].map(str::to_owned));
    }
    parts.retain(|part| !part.is_empty());
    parts
}

/// Tells a left hand from a right one: fingers curl towards the palm, which lies on one side of index-to-little × forward in a right hand
/// and on the other in a left one.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SideVotes {
    to_right: f64,
    to_left: f64,
}

impl SideVotes {
    /// Takes a pose in which the hand's points are those of the right one.
    pub fn add(&mut self, pose: &KeyPose) {
        let Some(palm) = Hand::Right.palm_frame(pose) else {
            return;
        };
        for [base, .., tip] in &Hand::Right.points().fingers[1..] {
            let (Some(base), Some(tip)) = (pose.get(*base), pose.get(*tip)) else {
                continue;
            };
            // A right palm faces against its normal.
            let out = palm.normal.dot(&(tip - base));
            self.to_right += (-out).max(0.0);
            self.to_left += out.max(0.0);
        }
    }

    /// The hand so far; the right one where nothing is curled.
    pub fn hand(&self) -> Hand {
        match self.to_left > self.to_right {
            true => Hand::Left,
            false => Hand::Right,
        }
    }
}

/// The hand that these points are of.
fn side(points: &[(HandPoint, usize)], poses: &[Vec<Vec3>]) -> Hand {
    let mut votes = SideVotes::default();
    for pose in poses {
        let mut key = KeyPose::default();
        for (point, at) in points {
            key.set(point.of(Hand::Right), pose[*at]);
        }
        votes.add(&key);
    }
    votes.hand()
}

/// Bases of fingers lie nearer to each other, in lengths of a finger: some .25 in hands, where shoulders and hips are .8 of a limb apart.
const NEAR_BASES: f64 = 0.45;
/// Lengths of fingers, over their mean.
const FINGERS: std::ops::Range<f64> = 0.65..1.4;
/// The last bone of a finger is no longer than this many of the first.
const MOST_LAST: f64 = 1.25;

/// True if these are points of a hand in most poses, or there are no poses: fingers about equally long, whose bones become shorter to the tip and whose bases
/// are near each other.
fn is_like_a_hand(roles: &[(Role, usize)], poses: &[Vec<Vec3>], hand: Hand) -> bool {
    let fits = |pose: &&Vec<Vec3>| {
        let mut key = KeyPose::default();
        for (role, at) in roles {
            key.set(*role, pose[*at]);
        }
        let fingers = hand.points().fingers;
        let places = |finger: &[Role; 4]| -> Option<Vec<Vec3>> {
            finger.iter().map(|role| key.get(*role)).collect()
        };
        let fingers: Option<Vec<Vec<Vec3>>> = fingers[1..].iter().map(places).collect();
        let (Some(mean), Some(fingers)) = (hand.finger_length(&key), fingers) else {
            return false;
        };
        let bones = |finger: &Vec<Vec3>| [0, 1, 2].map(|at| (finger[at + 1] - finger[at]).norm());
        let near = |pair: &[Vec<Vec3>]| (pair[1][0] - pair[0][0]).norm() < NEAR_BASES * mean;
        fingers.windows(2).all(near)
            && fingers.iter().map(bones).all(|[first, second, last]| {
                FINGERS.contains(&((first + second + last) / mean)) && last < MOST_LAST * first
            })
    };
    poses.is_empty() || 2 * poses.iter().filter(fits).count() > poses.len()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::flat_hand;

    fn roles(names: &[&str]) -> Vec<(Role, usize)> {
        recognise_hands(names, &[]).map_or_else(Vec::new, |(_, roles)| roles)
    }

    #[test]
    fn names_of_every_producer_are_understood() {
        let fingers = ["thumb", "index", "middle", "ring", "little"];
        let own = |side: &str| -> Vec<String> {
            let points = fingers
                .iter()
                .flat_map(|f| ["1", "2", "3", "tip"].map(|p| format!("{side}{f}_{p}")));
            points.chain([format!("{side}palm")]).collect()
        };
        let check = |names: Vec<String>, hand: Hand, count: usize| {
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            let found = roles(&names);
            assert_eq!(found.len(), count, "{names:?}: {found:?}");
            let at = |role: Role| {
                found
                    .iter()
                    .find(|(r, _)| *r == role)
                    .map(|(_, at)| names[*at])
            };
            at(hand.points().fingers[1][3]).map(str::to_owned)
        };
        assert_eq!(
            check(own(""), Hand::Right, 21).as_deref(),
            Some("index_tip")
        );
        let roles_of = |hand: Hand| {
            let points = std::iter::once(hand.points().wrist).chain(hand.beside_wrist());
            points.map(|role| role.name().to_owned()).collect()
        };
        for (hand, tip) in [
            (Hand::Left, "left_index_tip"),
            (Hand::Right, "right_index_tip"),
        ] {
            assert_eq!(check(roles_of(hand), hand, 22).as_deref(), Some(tip));
        }
        assert_eq!(
            check(own("left_"), Hand::Left, 21).as_deref(),
            Some("left_index_tip")
        );
        let media_pipe = "WRIST THUMB_CMC THUMB_MCP THUMB_IP THUMB_TIP INDEX_FINGER_MCP INDEX_FINGER_PIP INDEX_FINGER_DIP \
            INDEX_FINGER_TIP MIDDLE_FINGER_MCP MIDDLE_FINGER_PIP MIDDLE_FINGER_DIP MIDDLE_FINGER_TIP RING_FINGER_MCP \
            RING_FINGER_PIP RING_FINGER_DIP RING_FINGER_TIP PINKY_MCP PINKY_PIP PINKY_DIP PINKY_TIP";
        let media_pipe = media_pipe.split_whitespace().map(str::to_owned).collect();
        assert_eq!(
            check(media_pipe, Hand::Right, 21).as_deref(),
            Some("INDEX_FINGER_TIP")
        );
        let mut web_xr: Vec<String> = vec!["wrist".into()];
        for finger in [
            "thumb",
            "index-finger",
            "middle-finger",
            "ring-finger",
            "pinky-finger",
        ] {
            let bones: &[&str] = match finger {
                "thumb" => &["metacarpal", "phalanx-proximal", "phalanx-distal", "tip"],
                _ => &[
                    "metacarpal",
                    "phalanx-proximal",
                    "phalanx-intermediate",
                    "phalanx-distal",
                    "tip",
                ],
            };
            web_xr.extend(bones.iter().map(|bone| format!("{finger}-{bone}")));
        }
        assert_eq!(
            check(web_xr, Hand::Right, 21).as_deref(),
            Some("index-finger-tip")
        );
        let mut unity: Vec<String> = vec!["L_Wrist".into(), "L_Palm".into()];
        for finger in ["Thumb", "Index", "Middle", "Ring", "Little"] {
            let bones = ["Metacarpal", "Proximal", "Intermediate", "Distal", "Tip"];
            let bones = bones
                .into_iter()
                .filter(|b| finger != "Thumb" || *b != "Intermediate");
            unity.extend(bones.map(|bone| format!("L_{finger}{bone}")));
        }
        assert_eq!(check(unity, Hand::Left, 22).as_deref(), Some("L_IndexTip"));
    }

    #[test]
    fn numbered_points_are_a_hand_if_they_look_like_one() {
        for (hand, bend) in [(Hand::Right, 0.5), (Hand::Left, 0.5)] {
            let pose = flat_hand(hand, bend, 1.0);
            let points = hand.points();
            let order: Vec<Role> = std::iter::once(points.wrist)
                .chain(points.fingers.into_iter().flatten())
                .collect();
            let places: Vec<Vec3> = order.iter().map(|role| pose.get(*role).unwrap()).collect();
            let names: Vec<String> = (0..21).map(|n| n.to_string()).collect();
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            let (set, found) = recognise_hands(&names, &[places]).unwrap();
            assert_eq!(set, "MediaPipe hand (21)");
            assert!(found.iter().map(|(role, _)| *role).eq(order), "{found:?}");
            // The same numbers all over a room are no hand, but for chance.
            let mut rng = crate::rng::Rng::new(7);
            let mut place = || Vec3::from([0, 1, 2].map(|_| rng.unit()));
            let room = (0..100).map(|_| (0..21).map(|_| place()).collect::<Vec<Vec3>>());
            let hands =
                room.filter(|pose| recognise_hands(&names, std::slice::from_ref(pose)).is_some());
            assert!(hands.count() < 20);
        }
    }
}
