//! Landmarks in one JSON document, as scripts around pose estimators write them: somewhere in it a list of frames, in each a
//! list of points (`{"x": 0.1, "y": 0.9, "z": 0.0}` or `[0.1, 0.9, 0.0]`), or an object of named ones.
//!
//! There is no common form, so the first list is taken that looks so; fields called `world` come first, as the others hold
//! places in the picture.

mod clock;
mod hands;
mod head;
mod leap;
mod matrix;
mod rows;

use std::collections::HashMap;

use serde_json::{Map, Value};

use self::clock::{number_of, rate_in, time_of};
use self::head::looks_so;
use super::descriptor::FormatDescriptor;
use super::points::{Point, UNSEEN, check_size};
use super::table::axis_of;
use super::timing::{Clock, Stamps, TimedPoints};
use super::{Limits, Loaded, ParseError, Place, Warning, json};
use crate::math::Vec3;
use crate::nan::{NoNumber, without_nan};

pub(super) const FORMAT: FormatDescriptor = FormatDescriptor {
    name: "landmarks",
    title: "landmarks (JSON)",
    noun: "JSON of landmarks",
    // Most files that end in .json are no motion: content alone decides.
    endings: &["landmarks"],
    looks_so: |h| !h.is_binary() && looks_so(h.bytes),
    up: None,
    read: |file| Ok(file.at_rate(read(file.bytes, file.name, file.rate_hz, file.limits)?)),
};

/// Frames a second of a document without times.
const ASSUMED_HZ: f64 = 30.0;
/// Fewer places of a point are no motion.
const LEAST_FRAMES: usize = 2;
/// Fewer points are no body.
const LEAST_POINTS: usize = 5;
/// Elements of a list that tell whether it is one of frames.
const LOOKED_AT: usize = 40;
/// Lists and objects within each other, down to the points.
const DEEPEST: usize = 6;

/// Lists of more are frames, not bodies.
#[cfg(feature = "files")]
const MOST_BODIES: usize = 6;

/// True if a document holds bodies of one moment, or an empty list of bodies.
#[cfg(feature = "files")]
pub(crate) fn is_one_frame(bytes: &[u8]) -> bool {
    let Ok(mut document) = serde_json::from_slice::<Value>(bytes) else {
        return false;
    };
    rows::into_points(&mut document, None);
    let empty = |list: &Value| list.as_array().is_some_and(Vec::is_empty);
    let nobody = ["people", "bodies"]
        .iter()
        .any(|field| document.get(field).is_some_and(empty));
    let holds = points_in(&document, DEEPEST).is_some() || is_flat(&document, DEEPEST);
    let lists = frames_in(&document, DEEPEST).map_or(0, |frames| frames.len());
    nobody || empty(&document) || looks_so(bytes) && holds && lists <= MOST_BODIES
}

/// Reads the landmarks of a document: a clip of points called `name`. `rate_hz` replaces the rate in the file. O(bytes);
/// the document takes several times its bytes in memory.
///
/// # Errors
/// The place and the cause: no JSON, no list of frames with points in three dimensions, more than `limits` allow.
pub fn read(
    bytes: &[u8],
    name: &str,
    rate_hz: Option<f64>,
    limits: &Limits,
) -> Result<Loaded, ParseError> {
    let mut warnings = Vec::new();
    let limits = &json::limits_beside(bytes, limits)?;
    let mut document = parse(bytes, &mut warnings)?;
    let names = names_in(&document, DEEPEST);
    rows::into_points(&mut document, names.as_ref().map(Vec::len));
    let by_name = tracks_in(&document, DEEPEST);
    let frames = frames_in(&document, DEEPEST)
        .or_else(|| {
            let frames = by_name.as_ref()?.iter();
            Some(frames.map(|frame| (None, frame)).collect())
        })
        .ok_or_else(|| no_frames(&document))?;
    let people = frames.iter().map(|(_, frame)| match hands_in(frame) {
        Some(_) => 0,
        None => people_in(frame, DEEPEST),
    });
    let people = people.max();
    if let Some(people @ 2..) = people {
        let text = format!(
            "up to {people} bodies in a frame; the first of each is read, the others are left out"
        );
        warnings.push(Warning::new(Place::File, text));
    }
    let mut points: Vec<Point> = Vec::new();
    let mut times = Vec::with_capacity(frames.len());
    let mut numbers = Vec::with_capacity(frames.len());
    for (at, (number, frame)) in frames.iter().enumerate() {
        times.push(time_of(frame));
        numbers.push(number.or_else(|| number_of(frame)));
        let found = hands_in(frame)
            .or_else(|| points_in(frame, DEEPEST))
            .unwrap_or_default();
        let names = names.as_ref().filter(|names| names.len() == found.len());
        for (number, (name, place)) in found.into_iter().enumerate() {
            let bare = name.bytes().all(|b| b.is_ascii_digit());
            let name = names
                .filter(|_| bare)
                .map_or(name, |names| names[number].clone());
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
    check_size(points.len(), frames.len(), bytes.len(), limits)?;
    for point in &mut points {
        point.positions.resize(frames.len(), UNSEEN);
    }
    // A field of times need not say its unit.
    let stamps = Stamps::of_values(times, None).numbered(numbers);
    let clock = Clock {
        given_hz: rate_hz,
        stated_hz: rate_in(&document, children(&document)),
        assumed_hz: ASSUMED_HZ,
    };
    TimedPoints::of_any_unit(points, stamps, clock).into_loaded(name, warnings, limits)
}

/// The points of hands whose sides a frame says.
fn hands_in(frame: &Value) -> Option<Vec<(String, Vec3)>> {
    const WITHIN_HAND: usize = 3;
    leap::hands_in(frame).or_else(|| hands::in_frame(frame, &|hand| points_in(hand, WITHIN_HAND)))
}

/// The document; several one behind the other, as in lines of JSON, are a list.
fn parse(bytes: &[u8], warnings: &mut Vec<Warning>) -> Result<Value, ParseError> {
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    let plain = std::str::from_utf8(bytes).map(|text| without_nan(text, NoNumber::Alone));
    let bytes = plain.as_ref().map_or(bytes, |text| text.as_bytes());
    let mut values = Vec::new();
    for value in serde_json::Deserializer::from_slice(bytes).into_iter::<Value>() {
        match value {
            Ok(value) => values.push(value),
            // What breaks off behind frames is left out.
            Err(error) if values.len() > 1 && error.is_eof() => break,
            Err(error) if values.is_empty() && error.is_eof() => {
                return json::read(bytes, warnings);
            }
            Err(error) => return Err(json::located(&error)),
        }
    }
    Ok(match values.len() {
        1 => values.remove(0),
        _ => Value::Array(values),
    })
}

fn no_frames(document: &Value) -> ParseError {
    let expected = "a list of frames, each with at least 5 points that have x, y and z";
    if leap::is_so(document) {
        let found = "a recording of a Leap Motion without places of fingers: give frames with `hands` and `pointables`";
        return ParseError::new(Place::File, expected, found);
    }
    if let Some(count) = rows::unknown(document) {
        let found = format!(
            "{count} numbers in a row, which match no known set of points: give each point as [x, y, z], or all names in a list \
             `joint_names`"
        );
        return ParseError::new(Place::File, expected, found);
    }
    let found = match is_flat(document, DEEPEST) {
        true => {
            "points in two dimensions: a direction in space needs three (triangulate several views and give TRC, C3D or a table)"
        }
        false => "JSON without one",
    };
    ParseError::new(Place::File, expected, found)
}

/// True if somewhere in it are points with x and y, or numbers in threes as detectors in pictures write them.
fn is_flat(value: &Value, depth: usize) -> bool {
    let flat = |point: &Value| match point {
        Value::Object(fields) => {
            fields.contains_key("x") && fields.contains_key("y") && !fields.contains_key("z")
        }
        Value::Array(list) => list.len() == 2 && list.iter().all(Value::is_number),
        _ => false,
    };
    match value {
        Value::Array(list) => {
            let numbers = list.len() >= 3 * LEAST_POINTS && list.iter().all(Value::is_number);
            let points = list.len() >= LEAST_POINTS && list.iter().all(flat);
            numbers
                || points
                || depth > 0 && list.iter().take(20).any(|child| is_flat(child, depth - 1))
        }
        Value::Object(fields) => {
            depth > 0
                && fields
                    .values()
                    .take(20)
                    .any(|child| is_flat(child, depth - 1))
        }
        _ => false,
    }
}

/// The first list, or object of numbered fields, of which most elements hold points.
fn frames_in(value: &Value, depth: usize) -> Option<Vec<NumberedFrame<'_>>> {
    if depth == 0 {
        return None;
    }
    let list = elements(value).filter(|list| {
        let holds = |frame: &&NumberedFrame| {
            leap::hands_in(frame.1).is_some() || points_in(frame.1, depth - 1).is_some()
        };
        // All over the list: nobody may be there for long.
        let step = list.len().div_ceil(LOOKED_AT).max(1);
        let looked_at = list.len().div_ceil(step);
        // A list of points is no list of frames, nor is one of people.
        point_list(value).is_none()
            && list.iter().step_by(step).filter(holds).count() * 4 > looked_at
    });
    list.or_else(|| children(value).find_map(|child| frames_in(child, depth - 1)))
}

/// The frames of an object whose fields are points, each with a list of its places: `{"nose": [[0.1, 0.9, 0.0], …], …}`.
fn tracks_in(value: &Value, depth: usize) -> Option<Vec<Value>> {
    if depth == 0 {
        return None;
    }
    let tracks = |fields: &Map<String, Value>| -> Option<Vec<Value>> {
        let track = |(name, list): (&String, &Value)| {
            let list = list.as_array().filter(|list| list.len() >= LEAST_FRAMES)?;
            list.iter()
                .all(|place| place_of(place).is_some())
                .then(|| (name.clone(), list.clone()))
        };
        let tracks: Vec<(String, Vec<Value>)> = fields.iter().filter_map(track).collect();
        let frames = tracks.iter().map(|(_, list)| list.len()).max()?;
        let alike = tracks.iter().all(|(_, list)| list.len() == frames);
        let frame = |at: usize| {
            let points = tracks
                .iter()
                .map(|(name, list)| (name.clone(), list[at].clone()));
            Value::Object(points.collect())
        };
        (alike && tracks.len() >= LEAST_POINTS).then(|| (0..frames).map(frame).collect())
    };
    let own = value.as_object().and_then(tracks);
    own.or_else(|| children(value).find_map(|child| tracks_in(child, depth - 1)))
}

/// A frame with its number, where the field that it is in says it.
type NumberedFrame<'a> = (Option<f64>, &'a Value);

/// The elements of a list, or of an object whose fields are numbers, in their order.
fn elements(value: &Value) -> Option<Vec<NumberedFrame<'_>>> {
    match value {
        Value::Array(list) => Some(list.iter().map(|child| (None, child)).collect()),
        Value::Object(fields) => {
            let mut numbered: Option<Vec<(u64, &Value)>> = Some(Vec::with_capacity(fields.len()));
            for (key, child) in fields {
                // `joint_3` is a point, not a frame.
                let lower = key.to_lowercase();
                if ["joint", "point", "landmark", "marker"]
                    .iter()
                    .any(|word| lower.contains(word))
                {
                    return None;
                }
                let digits: String = key.chars().filter(char::is_ascii_digit).collect();
                match (digits.parse(), &mut numbered) {
                    (Ok(number), Some(numbered)) => numbered.push((number, child)),
                    _ => numbered = None,
                }
            }
            let mut numbered = numbered.filter(|fields| fields.len() > 1)?;
            numbered.sort_by_key(|field| field.0);
            numbered.dedup_by_key(|field| field.0);
            (numbered.len() == fields.len()).then(|| {
                let frames = numbered.into_iter();
                frames.map(|(n, frame)| (Some(n as f64), frame)).collect()
            })
        }
        _ => None,
    }
}

/// Number of bodies in a frame.
fn people_in(value: &Value, depth: usize) -> usize {
    if depth == 0 || point_list(value).is_some() {
        return usize::from(depth > 0);
    }
    match value {
        Value::Array(list) => list
            .iter()
            .filter(|body| points_in(body, depth - 1).is_some())
            .count(),
        _ => children(value)
            .find(|child| points_in(child, depth - 1).is_some())
            .map_or(0, |child| people_in(child, depth - 1)),
    }
}

/// A list of words beside the frames whose field holds names.
fn names_in(value: &Value, depth: usize) -> Option<Vec<String>> {
    if depth == 0 {
        return None;
    }
    let fields = value.as_object()?;
    let list = |(key, child): (&String, &Value)| {
        let lower = key.to_lowercase();
        let says = ["name", "label", "joints", "keypoints", "landmarks"];
        let list = child
            .as_array()
            .filter(|_| says.iter().any(|word| lower.contains(word)))?;
        let words: Option<Vec<String>> = list
            .iter()
            .map(|word| word.as_str().map(str::to_owned))
            .collect();
        words.filter(|words| words.len() >= LEAST_POINTS)
    };
    let below = || fields.values().find_map(|child| names_in(child, depth - 1));
    fields.iter().find_map(list).or_else(below)
}

/// Values within a list or an object, those that say `world` first, without those that say how something is turned.
fn children(value: &Value) -> impl Iterator<Item = &Value> {
    let (list, object) = match value {
        Value::Array(list) => (Some(list.iter()), None),
        Value::Object(object) => (None, Some(object)),
        _ => (None, None),
    };
    let says = |world: bool| {
        let fields = object.into_iter().flat_map(Map::iter);
        let fields = fields.filter(move |(key, _)| {
            let key = key.to_lowercase();
            let in_space = ["world", "3d", "position"]
                .iter()
                .any(|word| key.contains(word));
            in_space == world && !rows::is_no_place(&key)
        });
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
    point_list(value)
        .or_else(|| points_in_fields(value))
        .or_else(|| children(value).find_map(|child| points_in(child, depth - 1)))
}

/// A record as tables have it: `{"nose_x": 0.1, "nose_y": 0.9, "nose_z": 0.0, …}`.
fn points_in_fields(value: &Value) -> Option<Vec<(String, Vec3)>> {
    let fields = value
        .as_object()
        .filter(|fields| fields.len() >= 3 * LEAST_POINTS)?;
    let mut points: Vec<(String, [Option<f64>; 3])> = Vec::new();
    let mut places: HashMap<String, usize> = HashMap::new();
    for (key, value) in fields {
        let known = axis_of(key).filter(|_| value.is_number() || value.is_null());
        let Some((name, axis)) = known else { continue };
        let at = *places.entry(name).or_insert_with_key(|name| {
            points.push((name.clone(), [None; 3]));
            points.len() - 1
        });
        points[at].1[axis] = Some(value.as_f64().unwrap_or(f64::NAN));
    }
    let whole = points
        .into_iter()
        .filter_map(|(name, [x, y, z])| Some((name, Vec3::new(x?, y?, z?))));
    let whole: Vec<(String, Vec3)> = whole.collect();
    (whole.len() >= LEAST_POINTS).then_some(whole)
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
    let said = [
        "name",
        "part",
        "joint",
        "label",
        "jointName",
        "jointType",
        "JointType",
        "id",
    ]
    .iter()
    .find_map(|key| match point.get(key)? {
        Value::String(text) => Some(text.clone()),
        Value::Number(number) => Some(number.to_string()),
        _ => None,
    });
    said.unwrap_or_else(|| number.to_string())
}

/// Position of a point; NaN where it says `null`.
fn place_of(point: &Value) -> Option<Vec3> {
    let number = |value: Option<&Value>| match value? {
        Value::Null => Some(f64::NAN),
        value => value.as_f64(),
    };
    match point {
        Value::Object(fields) => {
            // In picture, camera and world there may be a place each: the names of axes come first.
            const AXES: [[&str; 3]; 5] = [
                ["x", "y", "z"],
                ["cameraX", "cameraY", "cameraZ"],
                ["px", "py", "pz"],
                ["posX", "posY", "posZ"],
                ["pos_x", "pos_y", "pos_z"],
            ];
            const WITHIN: [&str; 4] = ["position", "pos", "location", "translation"];
            let at =
                |key: &str| number(fields.get(key).or_else(|| fields.get(&key.to_uppercase())));
            let own = AXES
                .iter()
                .find_map(|[x, y, z]| Some(Vec3::new(at(x)?, at(y)?, at(z)?)));
            own.or_else(|| {
                let within = fields
                    .iter()
                    .find(|(key, _)| WITHIN.iter().any(|known| key.eq_ignore_ascii_case(known)));
                within.and_then(|(_, place)| place_of(place))
            })
            .or_else(|| {
                matrix::FIELDS
                    .iter()
                    .find_map(|key| matrix::place(fields.get(*key)?))
            })
        }
        Value::Array(list) if list.len() == 4 && list[0].is_array() => matrix::place(point),
        Value::Array(list) if (3..=5).contains(&list.len()) => {
            let place = [
                number(list.first())?,
                number(list.get(1))?,
                number(list.get(2))?,
            ];
            let seen = list.len() != 4 || number(list.get(3)) != Some(0.0);
            Some(if seen { place.into() } else { UNSEEN })
        }
        Value::Array(list) if list.len() == 16 => matrix::place(point),
        _ => None,
    }
}

#[cfg(test)]
mod tests;
