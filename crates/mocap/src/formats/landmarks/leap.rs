//! Frames of a Leap Motion, as LeapJS and its recorders write them: `hands` with `type` and `palmPosition`, and fingers in `pointables`
//! (`handId`, `type` 0 for the thumb, `mcpPosition` to `tipPosition`) or with the bones of each (`fingers`, `bones`, `nextJoint`).

use serde_json::Value;

use crate::math::Vec3;

const FINGERS: [&str; 5] = ["thumb", "index", "middle", "ring", "little"];
const POINTS: [&str; 4] = ["1", "2", "3", "tip"];

/// True if a document is of a Leap Motion.
pub(super) fn is_so(document: &Value) -> bool {
    let text = document.to_string();
    let words = [
        "palmPosition",
        "pointables",
        "palm_position",
        "stabilizedPalm",
        "nextJoint",
        "next_joint",
    ];
    words.iter().any(|word| text.contains(word))
}

/// The points of the hands of a frame, `left_index_tip`; `None` if it is no such frame, or shows no hand.
pub(super) fn hands_in(frame: &Value) -> Option<Vec<(String, Vec3)>> {
    let hands = frame.get("hands")?.as_array()?;
    let pointables = frame.get("pointables").and_then(Value::as_array);
    let mut points: Vec<(String, Vec3)> = Vec::new();
    for hand in hands {
        let Some(side) = side_of(hand) else { continue };
        if points.iter().any(|(name, _)| name.starts_with(side)) {
            continue;
        }
        let mut push = |name: &str, place: Option<Vec3>| {
            points.extend(place.map(|place| (format!("{side}_{name}"), place)));
        };
        push("palm", place(hand.get("palmPosition")));
        push(
            "wrist",
            place(hand.get("wrist").or_else(|| hand.get("wristPosition"))),
        );
        let own = field(hand, &["fingers", "digits"]).and_then(Value::as_array);
        let all = own.into_iter().flatten();
        let pointed = pointables.into_iter().flatten();
        let of_hand = pointed.filter(|finger| finger.get("handId") == hand.get("id"));
        for finger in all.chain(of_hand) {
            let number = finger.get("type").and_then(Value::as_u64);
            let Some(name) = number.and_then(|n| FINGERS.get(usize::try_from(n).ok()?)) else {
                continue;
            };
            for (point, at) in POINTS.iter().zip(joints(finger)) {
                push(&format!("{name}_{point}"), at);
            }
        }
    }
    (points.len() > FINGERS.len()).then_some(points)
}

fn side_of(hand: &Value) -> Option<&'static str> {
    match hand.get("type")?.as_str()?.to_ascii_lowercase().as_str() {
        "left" => Some("left"),
        "right" => Some("right"),
        _ => None,
    }
}

/// From the base of a finger to its tip.
fn joints(finger: &Value) -> [Option<Vec3>; 4] {
    if let Some([base, first, second, last]) = finger
        .get("bones")
        .and_then(Value::as_array)
        .map(Vec::as_slice)
    {
        return [base, first, second, last]
            .map(|bone| place(field(bone, &["nextJoint", "next_joint"])));
    }
    ["mcpPosition", "pipPosition", "dipPosition", "tipPosition"]
        .map(|joint| place(finger.get(joint)))
}

fn field<'a>(value: &'a Value, names: &[&str]) -> Option<&'a Value> {
    names.iter().find_map(|name| value.get(*name))
}

fn place(value: Option<&Value>) -> Option<Vec3> {
    if let Some(fields) = value?.as_object() {
        let axis = |name: &str| fields.get(name)?.as_f64();
        return Some(Vec3::new(axis("x")?, axis("y")?, axis("z")?));
    }
    let numbers = |list: &Vec<Value>| match list.as_slice() {
        [x, y, z] => Some(Vec3::new(x.as_f64()?, y.as_f64()?, z.as_f64()?)),
        _ => None,
    };
    value?.as_array().and_then(numbers)
}
