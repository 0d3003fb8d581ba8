//! A pose as a line of JSON: what live recognition reads and what `morec record` writes.
//!
//! One object a line, right-handed axes, Y up:
//!
//! ```json
//! {"t": 1.25, "actor": 0, "positions": {"hips": [0, 0.92, 0], "left_thigh": [0.09, 0.9, 0]}}
//! {"t": 1.27, "root": [0, 0.92, 0], "rotations": {"hips": [0, 0, 0, 1], "left_arm": [0, 0, 0.38, 0.92]}}
//! ```
//!
//! - `t`: seconds on the sender's clock; without it the time of arrival counts.
//! - `actor`: whom it shows, 0 if nothing is said.
//! - `positions`: where joints are in the world, by role, in any one unit of length; or
//! - `rotations`: how joints are turned in their parents' frames, `[x, y, z, w]`, by role. Turned by nothing, a
//!   person stands in a T-pose, facing +Z, the left side at +X. Lengths are those of a standard body; `root` is where
//!   its hips are.
//!
//! - `hand`: `left` or `right`, for a line about one hand: names in `positions` then need no side, and `points` are its. Without it, the
//!   side of points whose names say none follows from the way in which fingers curl.
//! - `points`: a list of `[x, y, z]` in the order of a model with this many points: hands of 20 (SHREC), 21 (MediaPipe), 25 (WebXR) and 26
//!   (OpenXR) points, or the landmarks of a body. `{"left": […], "right": […]}` are both hands of one performer.
//!
//! Roles are those of mapping files: hips, torso, neck, head, and left_ and right_ thigh, shin, foot, shoulder, arm,
//! forearm, hand, and the points of hands: left_ and right_ palm, thumb_1 to thumb_3, thumb_tip, index_1 and so on. Points of hands are
//! known by the names of MediaPipe and OpenXR, too. What a line leaves out, or
//! gives as `null`, is unknown at that time. Other fields are ignored.

use std::collections::BTreeMap;
use std::io::Write;

use crate::vmc::{HUMANOID, HUMANOID_BONES};
use morec::features::Hand;
use morec::live::Recording;
use morec::math::{Quat, Vec3, rotation_of_xyzw};
use morec::nan::{NoNumber, without_nan};
use morec::roles::Role;
use morec::roles::points::{NUMBERED_HANDS, NumberedPoints, hand_role};
use serde_json::{Map, Value, json};

/// A pose as a line gives it.
#[derive(Debug, Default, serde::Deserialize)]
#[serde(default)]
struct PoseFields {
    t: Option<f64>,
    actor: u16,
    hand: Option<Hand>,
    root: Option<[f64; 3]>,
    positions: BTreeMap<String, Option<[f64; 3]>>,
    points: NumberedPoints,
    rotations: BTreeMap<String, Option<[f64; 4]>>,
}

/// A pose in the order of roles; what is unknown is not a number.
#[derive(Debug, Clone, PartialEq)]
pub struct PoseLine {
    /// On the sender's clock.
    pub time_secs: Option<f64>,
    /// The performer it shows.
    pub actor: u16,
    /// The hand that the line says it is about.
    pub hand: Option<Hand>,
    /// Places of the role joints.
    pub positions: [Vec3; Role::COUNT],
    /// True if positions of the right hand are those of a hand whose side nothing says.
    pub is_sideless: bool,
    /// Points that only other frames tell what they are, in the order of their numbers.
    pub points: Vec<Vec3>,
    /// Names in `positions` that are of no part of the body.
    pub unknown: Vec<String>,
    /// Empty if the line gave positions.
    pub rotations: Vec<Quat>,
}

impl PoseLine {
    /// Reads one line of JSON (docs/formats/live-json.md).
    ///
    /// # Errors
    /// The line is not a valid pose: the text names the key, what was expected there and what was found.
    pub fn of_line(text: &str) -> Result<Self, String> {
        let text: &str = &without_nan(text, NoNumber::InList);
        // A list would do for the values of a struct in their order; here it is a mistake.
        let line: PoseFields = match serde_json::from_str(text) {
            Ok(line) if text.trim_start().starts_with('{') => line,
            Ok(_) => return Err(explain(text, "expected an object {…}")),
            Err(error) => return Err(explain(text, &error.to_string())),
        };
        let mut pose = Self {
            time_secs: line.t.filter(|t| t.is_finite()),
            actor: line.actor,
            hand: line.hand,
            positions: [UNKNOWN; Role::COUNT],
            is_sideless: false,
            points: Vec::new(),
            unknown: Vec::new(),
            rotations: Vec::new(),
        };
        if line.rotations.is_empty() {
            for (name, position) in &line.positions {
                match (pose.role_at(name)?, position) {
                    (Some(role), Some(position)) => {
                        pose.positions[role.index()] = Vec3::from(*position);
                    }
                    (Some(_), None) => {}
                    (None, _) => pose.unknown.push(shown(name)),
                }
            }
            pose.number(line.points)?;
        } else {
            pose.turn(&line)?;
        }
        if pose.known() == 0 && pose.points.is_empty() {
            if let Some(name) = pose.unknown.first() {
                return Err(no_part("positions", name));
            }
            let text = "expected `positions`, `points` or `rotations` of at least one body part, found none";
            return Err(text.to_owned());
        }
        Ok(pose)
    }

    /// Says which names were left out, if any were.
    pub fn left_out(&self) -> Option<String> {
        let first = self.unknown.first()?;
        let more = match self.unknown.len() - 1 {
            0 => String::new(),
            more => format!(" (and {more} more names left out)"),
        };
        Some(format!("left out: {}{more}", no_part("positions", first)))
    }

    /// The role of a name in `positions`, by the hand of the line; none of a name that is of no part of the body.
    fn role_at(&mut self, name: &str) -> Result<Option<Role>, String> {
        if let (None, Some(role)) = (self.hand, Role::from_name(name)) {
            return Ok(Some(role));
        }
        match (hand_role(name, self.hand.unwrap_or(Hand::Right)), self.hand) {
            (Some((Some(of), _)), Some(hand)) if of != hand => {
                let (name, hand) = (shown(name), hand.name());
                Err(format!(
                    "positions.{name}: expected a point of the {hand} hand, as in `hand`, found one of the other hand"
                ))
            }
            (Some((of, role)), hand) => {
                self.is_sideless |= of.is_none() && hand.is_none();
                Ok(Some(role))
            }
            (None, Some(_)) => Err(format!(
                "positions.{0}: no point of a hand is called {0}; the points are {1}",
                shown(name),
                hand_names()
            )),
            (None, None) => Ok(None),
        }
    }

    /// Takes points that have numbers for names.
    fn number(&mut self, points: NumberedPoints) -> Result<(), String> {
        let place = |point: Option<[f64; 3]>| point.map_or(UNKNOWN, Vec3::from);
        let (of_hands, numbered) = points.by_hand(self.hand).map_err(|count| {
            let known = one_of(&NUMBERED_HANDS);
            format!("points: expected {known} points of a hand, found {count}")
        })?;
        for (role, point) in of_hands {
            self.positions[role.index()] = place(point);
        }
        self.points = numbered.into_iter().map(place).collect();
        Ok(())
    }

    /// A standard body with its joints turned; what is not named is not turned.
    fn turn(&mut self, line: &PoseFields) -> Result<(), String> {
        let mut locals = [Quat::identity(); Role::COUNT];
        let mut named = [false; Role::COUNT];
        for (name, rotation) in &line.rotations {
            let role = Role::from_name(name).ok_or_else(|| no_part("rotations", &shown(name)))?;
            let Some(rotation) = rotation else { continue };
            let rotation = rotation_of_xyzw(*rotation).ok_or_else(|| {
                format!("rotations.{name}: expected [x, y, z, w] of length 1, found {rotation:?}")
            })?;
            (locals[role.index()], named[role.index()]) = (rotation, true);
        }
        let mut world = [(Vec3::zeros(), Quat::identity()); HUMANOID_BONES];
        self.rotations = vec![Quat::identity(); Role::COUNT];
        for (b, bone) in HUMANOID.iter().enumerate() {
            let local = bone
                .role
                .map_or(Quat::identity(), |role| locals[role.index()]);
            // The table faces −Z.
            let [x, y, z] = bone.offset;
            let offset = Vec3::new(-x, y, -z);
            world[b] = match bone.parent {
                Some(p) => (world[p].0 + world[p].1 * offset, world[p].1 * local),
                None => (line.root.map_or(offset, Vec3::from), local),
            };
            let Some(role) = bone.role else { continue };
            self.rotations[role.index()] = world[b].1;
            // A joint is known where the one that carries it is; shoulders and spine are seldom sent.
            use Role::*;
            let carried = matches!(
                role,
                LeftShin
                    | LeftFoot
                    | RightShin
                    | RightFoot
                    | LeftForearm
                    | LeftHand
                    | RightForearm
                    | RightHand
            );
            let by = bone.parent.and_then(|p| HUMANOID[p].role);
            if !carried || by.is_some_and(|role| named[role.index()]) {
                self.positions[role.index()] = world[b].0;
            }
        }
        Ok(())
    }

    /// True if it shows somebody who can be recognised: the hips and five other joints at least, ten points of hands, a head and both
    /// hands, the root of a custom skeleton and two of its points.
    pub fn shows_body(&self) -> bool {
        let known = self.known();
        let has = |role: Role| known >> role.index() & 1 == 1;
        let hands = known >> Role::BODY_COUNT & ((1 << (Role::HUMAN_COUNT - Role::BODY_COUNT)) - 1);
        let tracked = [Role::Head, Role::LeftHand, Role::RightHand];
        has(Role::Hips) && known.count_ones() > 5
            || has(Role::Point1) && known.count_ones() > 2
            || hands.count_ones() >= 10
            || tracked.into_iter().all(has)
    }

    /// The roles whose joints have a place: bit `r` for role `r`.
    pub fn known(&self) -> u128 {
        let known = |p: &Vec3| p.iter().all(|c| c.is_finite());
        (0..Role::COUNT)
            .filter(|r| known(&self.positions[*r]))
            .fold(0, |mask, r| mask | 1 << r)
    }
}

/// What is not known of a place.
pub(crate) const UNKNOWN: Vec3 = Vec3::new(f64::NAN, f64::NAN, f64::NAN);

/// The numbers in words, `20, 21 or 25`.
pub(crate) fn one_of(counts: &[usize]) -> String {
    let words: Vec<String> = counts.iter().map(usize::to_string).collect();
    match words.split_last() {
        Some((last, first)) if !first.is_empty() => format!("{} or {last}", first.join(", ")),
        _ => words.concat(),
    }
}

/// Names of the points of a hand, without a side.
fn hand_names() -> String {
    let names = Hand::Right.beside_wrist().map(Role::name);
    let bare = names.map(|name| name.trim_start_matches("right_"));
    format!("wrist, {}", bare.join(", "))
}

/// What is wrong with a name under `key`.
fn no_part(key: &str, name: &str) -> String {
    let names = Role::BODY.map(Role::name).join(", ");
    format!(
        "{key}.{name}: no body part is called {name}; the names are {names}, and points of hands from left_palm to \
         right_little_tip"
    )
}

/// A sender's text as it may be shown in a terminal: short, and nothing in it that a terminal obeys.
fn shown(text: &str) -> String {
    let start: String = text.chars().take(30).collect();
    start.escape_debug().to_string()
}

/// Why a line is no pose: the key that is wrong, what was expected and what was found.
fn explain(text: &str, otherwise: &str) -> String {
    let value: Value = match serde_json::from_str(text) {
        Ok(value) => value,
        Err(error) => {
            // The library names a line too, which is always the first here.
            let why = error.to_string();
            let why = why.split(" at line ").next().unwrap_or(&why);
            return format!("column {}: invalid JSON: {why}", error.column());
        }
    };
    let Some(object) = value.as_object() else {
        return format!("expected an object {{…}}, found {}", kind(&value));
    };
    for (key, value) in object {
        let wrong = match key.as_str() {
            "t" => (!value.is_number() && !value.is_null()).then_some((
                String::new(),
                "seconds",
                value,
            )),
            "actor" => {
                let number = value.as_u64().filter(|n| *n <= u64::from(u16::MAX));
                number
                    .is_none()
                    .then_some((String::new(), "a whole number from 0", value))
            }
            "hand" => {
                let is_side = matches!(value.as_str(), Some("left" | "right"));
                (!is_side && !value.is_null()).then_some((String::new(), "left or right", value))
            }
            "points" => numbered(value),
            "root" => (!value.is_null() && !is_numbers(value, 3)).then_some((
                String::new(),
                "[x, y, z]",
                value,
            )),
            "positions" => parts(value, 3, "[x, y, z]"),
            "rotations" => parts(value, 4, "[x, y, z, w]"),
            _ => None,
        };
        if let Some((part, expected, found)) = wrong {
            return format!("{key}{part}: expected {expected}, found {}", kind(found));
        }
    }
    otherwise.to_owned()
}

/// The first part of the body in `value` that is no list of `count` numbers.
fn parts<'v>(
    value: &'v Value,
    count: usize,
    expected: &'static str,
) -> Option<(String, &'static str, &'v Value)> {
    let Some(parts) = value.as_object() else {
        return Some((String::new(), "an object of body parts", value));
    };
    parts
        .iter()
        .find(|(_, value)| !value.is_null() && !is_numbers(value, count))
        .map(|(name, value)| (format!(".{}", shown(name)), expected, value))
}

/// What is wrong with numbered points.
fn numbered(value: &Value) -> Option<(String, &'static str, &Value)> {
    fn found<'v>(list: &'v [Value], of: &str) -> Option<(String, &'static str, &'v Value)> {
        let mut points = list.iter().enumerate();
        let (number, point) = points.find(|(_, p)| !p.is_null() && !is_numbers(p, 3))?;
        Some((format!("{of}[{number}]"), "[x, y, z]", point))
    }
    match value {
        Value::Array(list) => found(list, ""),
        Value::Object(hands) => hands.iter().find_map(|(hand, points)| {
            let of = format!(".{}", shown(hand));
            match (hand.as_str(), points) {
                ("left" | "right", Value::Array(list)) => found(list, &of),
                ("left" | "right", _) => Some((of, "a list of [x, y, z]", points)),
                _ => Some((of, "left or right", points)),
            }
        }),
        _ => Some((
            String::new(),
            "a list of [x, y, z], or such lists for left and right",
            value,
        )),
    }
}

fn is_numbers(value: &Value, count: usize) -> bool {
    value
        .as_array()
        .is_some_and(|list| list.len() == count && list.iter().all(Value::is_number))
}

/// Type of a value, in a word or two.
fn kind(value: &Value) -> String {
    match value {
        Value::Null => "null".to_owned(),
        Value::Bool(value) => value.to_string(),
        Value::Number(value) => value.to_string(),
        Value::String(text) => format!("the text \"{}\"", shown(text)),
        Value::Array(list) if list.iter().all(Value::is_number) => {
            format!("{} numbers", list.len())
        }
        Value::Array(list) => format!("a list of {}", list.len()),
        Value::Object(_) => "an object".to_owned(),
    }
}

/// Writes a line for each frame of `recording`, its time from the first.
///
/// # Errors
/// `out` cannot be written.
pub fn write_pose_lines(recording: &Recording, out: &mut dyn Write) -> std::io::Result<()> {
    let rig = recording.rig();
    let begun_secs = recording
        .frames()
        .first()
        .map_or(0.0, |frame| frame.time_secs);
    for frame in recording.frames() {
        let pose = frame.key_pose(rig);
        let mut positions = Map::new();
        for role in Role::ALL {
            if let Some(place) = pose.get(role) {
                let place = [place.x, place.y, place.z].map(rounded);
                positions.insert(role.name().to_owned(), json!(place));
            }
        }
        if positions.is_empty() {
            continue;
        }
        let secs = rounded(frame.time_secs - begun_secs);
        let (actor, positions) = (frame.actor.0, Value::Object(positions));
        writeln!(
            out,
            r#"{{"t": {secs}, "actor": {actor}, "positions": {positions}}}"#
        )?;
    }
    Ok(())
}

/// To the sixth decimal.
fn rounded(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_are_taken_as_they_are() {
        let pose = PoseLine::of_line(
            r#"{"t": 2.5, "actor": 3, "positions": {"head": [0, 1.6, 0.1]}, "note": 1}"#,
        )
        .unwrap();
        assert_eq!(
            (pose.time_secs, pose.actor, pose.known()),
            (Some(2.5), 3, 1 << Role::Head.index())
        );
        assert_eq!(pose.positions[Role::Head.index()], Vec3::new(0.0, 1.6, 0.1));
    }

    #[test]
    fn an_arm_turned_about_the_vertical_reaches_forward() {
        // The left arm lies along +X; −90° about Y takes it to +Z, where the person looks.
        let line = r#"{"rotations": {"hips": [0,0,0,1], "left_arm": [0,-0.7071068,0,0.7071068]}}"#;
        let pose = PoseLine::of_line(line).unwrap();
        let at = |role: Role| pose.positions[role.index()];
        let arm = (at(Role::LeftForearm) - at(Role::LeftArm)).normalize();
        assert!((arm - Vec3::z()).norm() < 1e-6, "{arm}");
        assert!(at(Role::LeftThigh).x > 0.0 && at(Role::Neck).y > at(Role::Hips).y);
        // Nothing was said of the forearm, so nothing is known of the hand.
        assert!(at(Role::LeftHand).x.is_nan());
    }

    #[test]
    fn a_place_that_is_no_number_is_unknown() {
        let line = r#"{"t": NaN, "positions": {"head": [0, 1.6, 0], "hips": [NaN, NaN, NaN], "neck": [0, Infinity, 0]}}"#;
        let pose = PoseLine::of_line(line).unwrap();
        assert_eq!(
            (pose.time_secs, pose.known()),
            (None, 1 << Role::Head.index())
        );
    }

    #[test]
    fn names_of_no_part_of_the_body_are_left_out_and_said() {
        let line =
            r#"{"positions": {"head": [0, 1.6, 0], "LeftToe": [0, 0, 0], "tail": [0, 0, 0]}}"#;
        let pose = PoseLine::of_line(line).unwrap();
        assert_eq!(pose.known(), 1 << Role::Head.index());
        let said = pose.left_out().unwrap();
        assert!(
            said.contains("LeftToe") && said.contains("1 more"),
            "{said}"
        );
    }

    #[test]
    fn rubbish_is_no_pose() {
        for (line, said) in [
            ("", "column 0: invalid JSON: EOF while parsing a value"),
            ("hello", "column 1: invalid JSON: expected value"),
            ("{}", "expected `positions`, `points` or `rotations`"),
            ("[1,2]", "expected an object {…}, found 2 numbers"),
            (
                r#"{"positions": {"tail": [0,0,0]}}"#,
                "positions.tail: no body part is called tail; the names are hips, left_thigh",
            ),
            (
                r#"{"positions": {"head": [0,0]}}"#,
                "positions.head: expected [x, y, z], found 2 numbers",
            ),
            (
                r#"{"positions": {"head": null}}"#,
                "expected `positions`, `points` or `rotations`",
            ),
            (
                r#"{"positions": 5}"#,
                "positions: expected an object of body parts, found 5",
            ),
            (
                r#"{"rotations": {"head": [0,0,0,0]}}"#,
                "rotations.head: expected [x, y, z, w] of length 1",
            ),
            (
                r#"{"rotations": {"head": [0,0,"up",1]}}"#,
                "rotations.head: expected [x, y, z, w], found a list of 4",
            ),
            (
                r#"{"t": "soon", "positions": {"head": [0,0,0]}}"#,
                "t: expected seconds, found the text \"soon\"",
            ),
            (
                r#"{"actor": -1, "positions": {"head": [0,0,0]}}"#,
                "actor: expected a whole number from 0, found -1",
            ),
        ] {
            let error = PoseLine::of_line(line).unwrap_err();
            assert!(error.contains(said), "{line}: {error}");
        }
    }

    /// Names are a stranger's: a terminal would obey them, or scroll for pages.
    #[test]
    fn what_a_sender_calls_things_is_shown_short_and_harmless() {
        let name = format!("\\u001b]0;owned\\u0007{}", "x".repeat(60_000));
        for line in [
            format!(r#"{{"positions": {{"{name}": [0,0,0]}}}}"#),
            format!(r#"{{"rotations": {{"{name}": [0,0,0]}}}}"#),
            format!(r#"{{"t": "{name}"}}"#),
        ] {
            let said = PoseLine::of_line(&line).unwrap_err();
            assert!(
                said.len() < 600 && !said.contains(char::is_control),
                "{said:?}"
            );
        }
    }

    #[test]
    fn no_mutation_of_a_line_is_a_panic() {
        let line = r#"{"t": 2.5, "actor": 3, "root": [0,1,0], "rotations": {"head": [0, 0, 0.1, 1e3]}, "x": null}"#;
        const SIGNS: &[u8] = b"{}[]\",:0123456789eE-+.n t";
        let mut rng = morec::rng::Rng::new(7);
        for _ in 0..20_000 {
            let mut bytes = line.as_bytes().to_vec();
            for _ in 0..=rng.below(3) {
                let at = rng.below(bytes.len());
                match rng.below(3) {
                    0 => bytes.truncate(at + 1),
                    1 => bytes[at] = SIGNS[rng.below(SIGNS.len())],
                    _ => _ = bytes.remove(at),
                }
                if bytes.is_empty() {
                    break;
                }
            }
            if let Ok(text) = std::str::from_utf8(&bytes) {
                let said = PoseLine::of_line(text).err();
                assert!(said.is_none_or(|said| !said.is_empty()));
            }
        }
    }
}
