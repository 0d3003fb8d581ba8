//! Landmarks in one JSON document, as scripts around pose estimators write them: somewhere in it a list of frames, in each a
//! list of points (`{"x": 0.1, "y": 0.9, "z": 0.0}` or `[0.1, 0.9, 0.0]`), or an object of named ones.
//!
//! There is no common form, so the first list is taken that looks so; fields called `world` come first, as the others hold
//! places in the picture.

use serde_json::{Map, Value};

use super::points::{Point, PointTable, UNSEEN, check_size};
use super::timing::{self, Clock};
use super::{Limits, Loaded, ParseError, Place};
use crate::math::Vec3;

/// Frames a second of a document without times.
const ASSUMED_HZ: f64 = 30.0;
/// Fewer points are no body.
const LEAST_POINTS: usize = 5;
/// Lists and objects within each other, down to the points.
const DEEPEST: usize = 6;

/// True if text begins as such a document does.
pub(super) fn looks_so(head: &[u8]) -> bool {
    let contains = |word: &[u8]| {
        head.windows(word.len())
            .any(|at| at.eq_ignore_ascii_case(word))
    };
    let words: [&[u8]; 3] = [b"landmark", b"keypoint", b"joints"];
    // Two dimensions, scenes of suits and glTF have words in common with these.
    let others: [&[u8]; 3] = [b"\"asset\"", b"\"pose_keypoints_2d\"", b"\"actors\""];
    let numbers = contains(b"\"z\"") || contains(b"[[") || contains(b"[0.") || contains(b"[-");
    matches!(head.trim_ascii_start(), [b'{' | b'[', ..])
        && numbers
        && words.iter().any(|word| contains(word))
        && !others.iter().any(|word| contains(word))
}

/// Reads the landmarks of a document: a clip of points called `name`. `rate_hz` replaces the rate in the file. O(bytes);
/// the document takes several times its bytes in memory.
///
/// # Errors
/// Where and what: no JSON, no list of frames with points in three dimensions, more than `limits` allow.
pub fn read(
    bytes: &[u8],
    name: &str,
    rate_hz: Option<f64>,
    limits: &Limits,
) -> Result<Loaded, ParseError> {
    let document: Value = serde_json::from_slice(bytes).map_err(|error| {
        let line = u64::try_from(error.line()).unwrap_or(0);
        ParseError::new(Place::Line(line), "JSON", error.to_string())
    })?;
    let frames = frames_in(&document, DEEPEST).ok_or_else(|| {
        ParseError::new(
            Place::File,
            "a list of frames, each with at least 5 points that have x, y and z",
            "JSON without one",
        )
    })?;
    let mut points: Vec<Point> = Vec::new();
    let mut times = Vec::with_capacity(frames.len());
    for (at, frame) in frames.iter().enumerate() {
        times.push(time_of(frame));
        for (name, place) in points_in(frame, DEEPEST).unwrap_or_default() {
            let point = match points.iter_mut().find(|point| point.name == name) {
                Some(point) => point,
                None => {
                    if points.len() == limits.joints {
                        let expected = format!("at most {} points", limits.joints);
                        return Err(ParseError::new(Place::File, expected, "more"));
                    }
                    points.push(Point {
                        name,
                        positions: Vec::new(),
                    });
                    let last = points.len() - 1;
                    &mut points[last]
                }
            };
            point.positions.resize(at, UNSEEN);
            point.positions.push(place);
        }
    }
    check_size(points.len(), frames.len(), bytes.len())?;
    for point in &mut points {
        point.positions.resize(frames.len(), UNSEEN);
    }
    let clock = Clock {
        given_hz: rate_hz,
        stated_hz: rate_in(&document),
        assumed_hz: ASSUMED_HZ,
    };
    let mut warnings = Vec::new();
    let rate_hz = timing::regular(&times, &clock, &mut points, &mut warnings);
    let table = PointTable {
        points,
        rate_hz,
        metres_per_unit: None,
        zero_is_missing: true,
    };
    table.into_loaded(name, warnings, limits)
}

/// The first list of which most elements hold points.
fn frames_in(value: &Value, depth: usize) -> Option<&Vec<Value>> {
    if depth == 0 {
        return None;
    }
    if let Value::Array(list) = value {
        let looked_at = list.len().min(20);
        let with = list
            .iter()
            .take(looked_at)
            .filter(|frame| points_in(frame, depth - 1).is_some());
        // A list of points is no list of frames, nor is one of people.
        if point_list(value).is_none() && with.count() * 2 > looked_at {
            return Some(list);
        }
    }
    children(value).find_map(|child| frames_in(child, depth - 1))
}

/// Values within a list or an object, those that say `world` first.
fn children(value: &Value) -> impl Iterator<Item = &Value> {
    let (list, object) = match value {
        Value::Array(list) => (Some(list.iter()), None),
        Value::Object(object) => (None, Some(object)),
        _ => (None, None),
    };
    let says = |world: bool| {
        let fields = object.into_iter().flat_map(Map::iter);
        let fields = fields.filter(move |(key, _)| key.to_lowercase().contains("world") == world);
        fields.map(|(_, child)| child)
    };
    list.into_iter()
        .flatten()
        .chain(says(true))
        .chain(says(false))
}

/// The points of one frame, with their names or numbers.
fn points_in(value: &Value, depth: usize) -> Option<Vec<(String, Vec3)>> {
    if depth == 0 {
        return None;
    }
    point_list(value).or_else(|| children(value).find_map(|child| points_in(child, depth - 1)))
}

fn point_list(value: &Value) -> Option<Vec<(String, Vec3)>> {
    let named: Vec<(String, Vec3)> = match value {
        Value::Array(list) => list
            .iter()
            .enumerate()
            .map_while(|(number, point)| Some((name_of(point, number), place_of(point)?)))
            .collect(),
        Value::Object(object) => object
            .iter()
            .filter_map(|(name, point)| Some((name.clone(), place_of(point)?)))
            .collect(),
        _ => return None,
    };
    let all = value
        .as_array()
        .is_none_or(|list| list.len() == named.len());
    (all && named.len() >= LEAST_POINTS).then_some(named)
}

fn name_of(point: &Value, number: usize) -> String {
    let said = ["name", "part", "joint", "label", "id"]
        .iter()
        .find_map(|key| match point.get(key)? {
            Value::String(text) => Some(text.clone()),
            Value::Number(number) => Some(number.to_string()),
            _ => None,
        });
    said.unwrap_or_else(|| number.to_string())
}

/// Where a point is; not a number where it says `null`.
fn place_of(point: &Value) -> Option<Vec3> {
    let number = |value: Option<&Value>| match value? {
        Value::Null => Some(f64::NAN),
        value => value.as_f64(),
    };
    let at = |key: &str| number(point.get(key).or_else(|| point.get(key.to_uppercase())));
    match point {
        Value::Object(_) => Some(Vec3::new(at("x")?, at("y")?, at("z")?)),
        Value::Array(list) if (3..=5).contains(&list.len()) => Some(Vec3::new(
            number(list.first())?,
            number(list.get(1))?,
            number(list.get(2))?,
        )),
        _ => None,
    }
}

/// The time of a frame in seconds.
fn time_of(frame: &Value) -> Option<f64> {
    const KEYS: [(&str, f64); 7] = [
        ("t", 1.0),
        ("time", 1.0),
        ("timestamp", 1.0),
        ("time_secs", 1.0),
        ("timestamp_ms", 1e-3),
        ("time_ms", 1e-3),
        ("timestamp_us", 1e-6),
    ];
    KEYS.iter()
        .find_map(|(key, unit)| Some(frame.get(key)?.as_f64()? * unit))
        .filter(|time| time.is_finite())
}

fn rate_in(document: &Value) -> Option<f64> {
    const KEYS: [&str; 5] = ["fps", "frame_rate", "frameRate", "rate", "framerate"];
    let found = |value: &Value| KEYS.iter().find_map(|key| value.get(key)?.as_f64());
    found(document).or_else(|| children(document).find_map(found))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn open(document: &Value) -> Result<Loaded, ParseError> {
        read(
            document.to_string().as_bytes(),
            "f",
            None,
            &Limits::default(),
        )
    }

    fn landmarks(frame: usize) -> Value {
        let point = |j: usize| json!({"x": 0.01 * j as f64, "y": 0.1 * frame as f64 + 0.5, "z": 0.2, "visibility": 0.9});
        (0..33).map(point).collect()
    }

    #[test]
    fn frames_are_found_wherever_they_are() {
        let list: Value = (0..6)
            .map(|f| json!({"frame": f, "timestamp": f as f64 / 25.0, "landmarks": landmarks(f)}))
            .collect();
        let within = json!({"fps": 50.0, "frames": (0..6).map(|f| json!({
            "pose_landmarks": landmarks(0), "pose_world_landmarks": landmarks(f)})).collect::<Value>()});
        let tasks: Value = (0..6)
            .map(|f| json!({"pose_landmarks": [landmarks(f)]}))
            .collect();
        let arrays = json!({"keypoints": (0..6).map(|f| (0..17)
            .map(|j| json!([0.1 * f as f64, 0.1 * j as f64, 1.0])).collect::<Value>()).collect::<Value>()});
        let named: Value = (0..6)
            .map(|f| json!({"joints": {"nose": [0.1, 1.6, 0.1 * f as f64], "left_hip": [0.1, 1, 0], "right_hip": [0, 1, 0],
                "left_knee": [0.1, 0.5, 0], "right_knee": [0, 0.5, 0]}}))
            .collect();
        for (document, points, rate_hz) in [
            (&list, 33, 25.0),
            (&within, 33, 50.0),
            (&tasks, 33, 30.0),
            (&arrays, 17, 30.0),
            (&named, 5, 30.0),
        ] {
            assert!(looks_so(document.to_string().as_bytes()));
            let clip = &open(document).unwrap().clips[0];
            assert_eq!(
                (clip.frames, clip.skeleton.len()),
                (6, points),
                "{document}"
            );
            assert!((clip.rate_hz - rate_hz).abs() < 0.01, "{}", clip.rate_hz);
            let moves = clip
                .tracks
                .iter()
                .any(|track| track.positions[0] != track.positions[5]);
            assert!(moves, "{document}");
        }
    }

    #[test]
    fn other_documents_are_refused() {
        for document in [
            json!([]),
            json!({"landmarks": []}),
            json!({"pose": {"x": 1, "y": 2, "z": 3}}),
            json!([{"landmarks": [{"x": 1, "y": 2}, {"x": 1, "y": 2}]}]),
        ] {
            assert!(open(&document).is_err(), "{document}");
        }
        assert!(read(b"{\"landmarks\": [", "f", None, &Limits::default()).is_err());
    }
}
