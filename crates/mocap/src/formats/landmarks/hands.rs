//! Hands in a frame, where the frame says which is which: by the names of fields, by a field of each hand, or by a list beside theirs.

use serde_json::{Map, Value};

use crate::math::Vec3;
use crate::pose::Hand;
use crate::roles::points::NUMBERED_HANDS;

/// Lists and objects within each other, down to the hands.
const DEEPEST: usize = 6;

/// Points with their names or numbers.
type NamedPoints = Vec<(String, Vec3)>;

/// Finds the points in a value.
type PointsIn<'f> = &'f dyn Fn(&Value) -> Option<NamedPoints>;

/// The points of the hands in `frame`, their names beginning with a side. `None` if it says no sides, or shows more than hands. `points_in`
/// finds those of one hand.
pub(super) fn in_frame(frame: &Value, points_in: PointsIn) -> Option<NamedPoints> {
    if shows_body(frame, DEEPEST) {
        return None;
    }
    let mut found = Vec::new();
    gather(frame, DEEPEST, points_in, &mut found);
    let mut points: NamedPoints = Vec::new();
    for (hand, list) in found {
        let side = hand.name();
        let known = points.iter().any(|(name, _)| name.starts_with(side));
        // Of two hands that have one name, the first is more certain.
        if !known {
            let named = list.into_iter();
            points.extend(named.map(|(name, place)| (format!("{side}_{name}"), place)));
        }
    }
    (!points.is_empty()).then_some(points)
}

/// A hand's points with its side.
type SidedPoints = (Hand, NamedPoints);

/// True if a body or a face is in it, too.
fn shows_body(value: &Value, depth: usize) -> bool {
    let says = |key: &String| {
        let key = key.to_lowercase();
        ["pose", "body", "face"]
            .iter()
            .any(|word| key.contains(word))
    };
    let own = value
        .as_object()
        .is_some_and(|fields| fields.keys().any(says));
    own || depth > 0 && children(value).any(|child| shows_body(child, depth - 1))
}

fn gather(value: &Value, depth: usize, points_in: PointsIn, found: &mut Vec<SidedPoints>) {
    if depth == 0 {
        return;
    }
    if let Some(fields) = value.as_object() {
        let before = found.len();
        found.extend(by_field(fields, points_in));
        found.extend(by_list(fields, points_in));
        found.extend(by_label(fields, points_in));
        if found.len() > before {
            return;
        }
    }
    for child in children(value) {
        gather(child, depth - 1, points_in, found);
    }
}

/// The points of `value`, if there are as many as a hand has.
fn hand_points(value: &Value, points_in: PointsIn) -> Option<NamedPoints> {
    let points = points_in(value)?;
    NUMBERED_HANDS.contains(&points.len()).then_some(points)
}

/// Places in the world before those in the picture.
fn world_first(fields: &Map<String, Value>) -> impl Iterator<Item = (String, &Value)> {
    let lower = || {
        fields
            .iter()
            .map(|(key, value)| (key.to_lowercase(), value))
    };
    let (world, others): (Vec<_>, Vec<_>) = lower().partition(|(key, _)| key.contains("world"));
    world.into_iter().chain(others)
}

/// `{"left_hand_landmarks": […], "right_hand_landmarks": […]}`.
fn by_field(fields: &Map<String, Value>, points_in: PointsIn) -> Vec<SidedPoints> {
    let of = |hand: Hand| {
        let mut named = world_first(fields).filter(|(key, _)| key.contains(hand.name()));
        named.find_map(|(_, value)| Some((hand, hand_points(value, points_in)?)))
    };
    Hand::BOTH.into_iter().filter_map(of).collect()
}

/// `{"landmarks": [[…], […]], "handedness": ["Left", "Right"]}`.
fn by_list(fields: &Map<String, Value>, points_in: PointsIn) -> Vec<SidedPoints> {
    let sides = fields
        .iter()
        .find(|(key, _)| key.to_lowercase().contains("handedness"));
    let Some(sides) = sides.and_then(|(_, sides)| sides.as_array()) else {
        return Vec::new();
    };
    let lists = world_first(fields).filter(|(key, _)| !key.contains("handedness"));
    let hands = |value: &Value| -> Option<Vec<SidedPoints>> {
        let list = value.as_array().filter(|list| list.len() == sides.len())?;
        let pairs = sides.iter().zip(list);
        pairs
            .map(|(side, hand)| Some((side_in(side, 3)?, hand_points(hand, points_in)?)))
            .collect()
    };
    lists
        .filter_map(|(_, value)| hands(value))
        .next()
        .unwrap_or_default()
}

/// `{"handedness": "Left", "landmarks": […]}`.
fn by_label(fields: &Map<String, Value>, points_in: PointsIn) -> Option<SidedPoints> {
    const LABELS: [&str; 6] = ["handedness", "hand", "side", "label", "type", "hand_type"];
    let label = |(key, value): (&String, &Value)| {
        let is_label = LABELS.contains(&key.to_lowercase().as_str());
        side_in(value, 3).filter(|_| is_label)
    };
    let hand = fields.iter().find_map(label)?;
    let mut lists = world_first(fields).filter(|(key, _)| !LABELS.contains(&key.as_str()));
    lists.find_map(|(_, value)| Some((hand, hand_points(value, points_in)?)))
}

/// The first word that is a side.
fn side_in(value: &Value, depth: usize) -> Option<Hand> {
    match value {
        Value::String(word) => {
            let mut hands = Hand::BOTH.into_iter();
            hands.find(|hand| word.eq_ignore_ascii_case(hand.name()))
        }
        Value::Array(_) | Value::Object(_) if depth > 0 => {
            children(value).find_map(|child| side_in(child, depth - 1))
        }
        _ => None,
    }
}

/// Values within a list or an object.
fn children(value: &Value) -> impl Iterator<Item = &Value> {
    let list = value.as_array().into_iter().flatten();
    let fields = value.as_object().into_iter().flat_map(Map::values);
    list.chain(fields)
}
