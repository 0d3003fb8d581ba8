//! Poses as lines of JSON: a recording of what live sources send.
//!
//! One object a line, right-handed axes, Y up; `{"t": 1.25, "positions": {"hips": [0, 0.92, 0], …}}` for points, by role
//! or by any other name, or `{"t": 1.25, "root": [0, 0.92, 0], "rotations": {"left_arm": [x, y, z, w], …}}` for joints
//! turned in their parents' frames, from a T-pose that faces +Z. `actor` tells performers apart.
//!
//! `"hand": "left"` or `"right"` says whose points those are whose names say no side, and `"points": [[x, y, z], …]` are points in the order
//! of their numbers in a known model, of a hand or a body; or `{"left": […], "right": […]}` for both hands.

use std::collections::{BTreeMap, BTreeSet};

use super::cells::lines;
use super::descriptor::FormatDescriptor;
use super::head::Head;
use super::points::{Point, PointTable, UNSEEN, check_size};
use super::timing::{BetweenFrames, Clock, Schedule, Stamps};
use super::{Limits, Loaded, ParseError, Place, Warning, json};
use crate::clip::{Clip, Joint, JointTrack, Skeleton};
use crate::humanoid::{HUMANOID, HumanoidBone};
use crate::math::{Quat, Vec3, rotation_of_xyzw, same_hemisphere, slerp};
use crate::nan::{NoNumber, without_nan};
use crate::pose::Hand;
use crate::roles::Role;
use crate::roles::points::{NUMBERED_HANDS, NumberedPoints, hand_role};

pub(super) const FORMAT: FormatDescriptor = FormatDescriptor {
    name: "jsonl",
    title: "JSON lines",
    noun: "lines of JSON",
    endings: &["jsonl", "ndjson"],
    looks_so: is_jsonl,
    up: None,
    read: |file| read(file.bytes, file.name, file.rate_hz, file.limits),
};

/// An object with poses on the first line.
fn is_jsonl(head: &Head) -> bool {
    let mut lines = head.lines();
    let first = lines.next().unwrap_or_default();
    let holds = |word: &[u8]| first.windows(word.len()).any(|window| window == word);
    // By role or name: lists of numbers are landmarks.
    let named = |field: &[u8]| {
        let at = first
            .windows(field.len())
            .position(|window| window == field);
        let rest = at.map(|at| first[at + field.len()..].trim_ascii_start());
        let rest = rest.and_then(|rest| rest.strip_prefix(b":"));
        rest.is_some_and(|rest| rest.trim_ascii_start().starts_with(b"{"))
    };
    // Lists of points that have a time or a hand are lines; any other list is a document of landmarks.
    let is_numbered =
        named(b"\"points\"") || holds(b"\"points\"") && (holds(b"\"t\"") || holds(b"\"hand\""));
    first.starts_with(b"{")
        && (named(b"\"positions\"") || named(b"\"rotations\"") || is_numbered)
        && !holds(b"\"asset\"")
}

/// Frames a second of lines without times.
const ASSUMED_HZ: f64 = 30.0;

/// A line; fields that are not named here are ignored.
#[derive(Debug, Default, serde::Deserialize)]
#[serde(default)]
struct PoseRecord {
    t: Option<f64>,
    actor: u16,
    hand: Option<Hand>,
    root: Option<[f64; 3]>,
    positions: BTreeMap<String, Option<[f64; 3]>>,
    points: NumberedPoints,
    rotations: BTreeMap<String, Option<[f64; 4]>>,
}

impl PoseRecord {
    /// Gives every point its name; an error if as many points are no hand.
    fn name_points(&mut self) -> Result<(), String> {
        if let Some(hand) = self.hand {
            let named = std::mem::take(&mut self.positions).into_iter();
            let of_hand = |(name, place): (String, _)| match hand_role(&name, hand) {
                Some((_, role)) => (role.name().to_owned(), place),
                None => (name, place),
            };
            self.positions = named.map(of_hand).collect();
        }
        let points = std::mem::take(&mut self.points);
        let (of_hands, numbered) = points.by_hand(self.hand).map_err(|count| {
            let known = NUMBERED_HANDS.map(|count| count.to_string()).join(", ");
            format!("{count} points of a hand, where {known} are known")
        })?;
        let named = of_hands.into_iter();
        self.positions
            .extend(named.map(|(role, place)| (role.name().to_owned(), place)));
        let named = numbered.into_iter().enumerate();
        self.positions
            .extend(named.map(|(number, place)| (number.to_string(), place)));
        Ok(())
    }
}

/// Recorded motion of one performer.
#[derive(Default)]
struct RecordedPerformer {
    stamps: Stamps,
    lines: Vec<PoseRecord>,
}

/// Reads lines of JSON: for each performer a clip called `name` (`name.1`, `name.2` … of several), of points if lines hold
/// positions, of a standard skeleton if they hold rotations. Frames at irregular times are interpolated. O(bytes).
///
/// # Errors
/// The place and the cause: no line that holds a pose, or more frames or joints than `limits` allow.
pub fn read(
    bytes: &[u8],
    name: &str,
    rate_hz: Option<f64>,
    limits: &Limits,
) -> Result<Loaded, ParseError> {
    // Hands that have lines of their own are performers of their own, as live.
    let mut performers: BTreeMap<(u16, Option<Hand>), RecordedPerformer> = BTreeMap::new();
    let limits = &json::limits_beside(bytes, limits)?;
    let rows = lines(bytes, limits)?;
    if rows.len() > limits.frames {
        let expected = format!("at most {} lines", limits.frames);
        return Err(ParseError::new(
            Place::File,
            expected,
            rows.len().to_string(),
        ));
    }
    let mut broken: Vec<(u64, String)> = Vec::new();
    for (number, text) in &rows {
        let text = without_nan(text, NoNumber::InList);
        let line = serde_json::from_str::<PoseRecord>(&text).map_err(|error| error.to_string());
        let named = |mut line: PoseRecord| line.name_points().map(|()| line);
        match line.and_then(named) {
            Ok(line) if line.positions.is_empty() && line.rotations.is_empty() => {
                broken.push((
                    *number,
                    "neither positions, points nor rotations".to_owned(),
                ));
            }
            Ok(line) => {
                let performer = performers.entry((line.actor, line.hand)).or_default();
                performer.stamps.secs.push(line.t.filter(|t| t.is_finite()));
                performer.lines.push(line);
            }
            Err(error) => broken.push((*number, error)),
        }
    }
    if performers.is_empty() {
        let (line, found) = broken
            .into_iter()
            .next()
            .unwrap_or((1, "an empty file".to_owned()));
        let expected = "lines of JSON with \"positions\", \"points\" or \"rotations\"";
        return Err(ParseError::new(Place::Line(line), expected, found));
    }
    let mut warnings = Vec::new();
    if let Some((line, why)) = broken.first() {
        let text = format!(
            "{} lines without a pose left out; the first: {why}",
            broken.len()
        );
        warnings.push(Warning::new(Place::Line(*line), text));
    }
    let several = performers.len() > 1;
    let mut clips = Vec::new();
    for (index, performer) in performers.into_values().enumerate() {
        let name = if several {
            format!("{name}.{}", index + 1)
        } else {
            name.to_owned()
        };
        let clock = Clock {
            given_hz: rate_hz,
            stated_hz: None,
            assumed_hz: ASSUMED_HZ,
        };
        let schedule = Schedule::of(&performer.stamps, &clock, &mut warnings);
        if performer
            .lines
            .iter()
            .any(|line| !line.rotations.is_empty())
        {
            clips.push(turned(&performer.lines, name, &schedule, &mut warnings)?);
        } else {
            let loaded = positions(&performer.lines, &name, &schedule, limits)?;
            clips.extend(loaded.clips);
            warnings.extend(loaded.warnings);
        }
    }
    Ok(Loaded { clips, warnings })
}

/// A clip of points.
fn positions(
    lines: &[PoseRecord],
    name: &str,
    schedule: &Schedule,
    limits: &Limits,
) -> Result<Loaded, ParseError> {
    let names: BTreeSet<&String> = lines
        .iter()
        .flat_map(|line| line.positions.keys())
        .collect();
    let values: usize = lines.iter().map(|line| line.positions.len()).sum();
    // A position takes twelve bytes at least.
    check_size(names.len(), lines.len(), 12 * values, limits)?;
    let mut points: Vec<Point> = Vec::new();
    let mut of_name: BTreeMap<&str, usize> = BTreeMap::new();
    for (frame, line) in lines.iter().enumerate() {
        for (name, position) in &line.positions {
            let next = points.len();
            let index = *of_name.entry(name).or_insert(next);
            if index == next {
                if next == limits.joints {
                    let expected = format!("at most {} points", limits.joints);
                    return Err(ParseError::new(Place::File, expected, "more"));
                }
                points.push(Point {
                    name: name.clone(),
                    positions: vec![UNSEEN; lines.len()],
                });
            }
            if let Some(position) = position {
                points[index].positions[frame] = Vec3::from(*position);
            }
        }
    }
    schedule.apply(&mut points);
    let table = PointTable {
        points,
        rate_hz: schedule.rate_hz,
        metres_per_unit: None,
        zero_is_missing: false,
    };
    table.into_loaded(name, Vec::new(), limits)
}

/// The joint of `role` in the skeleton below, if it has one.
fn bone_of(role: Role) -> Option<usize> {
    HUMANOID.iter().position(|bone| bone.role == Some(role))
}

/// The standard body that live sources of rotations are shown on, its joints by the names of their roles.
fn skeleton() -> Result<Skeleton, ParseError> {
    let joint = |bone: &HumanoidBone| {
        // The table faces −Z.
        let [x, y, z] = bone.offset;
        Joint {
            name: bone.role.map_or(bone.name, Role::name).to_owned(),
            parent: bone.parent,
            offset: Vec3::new(-x, y, -z),
            tip: None,
        }
    };
    Skeleton::new(HUMANOID.iter().map(joint).collect())
        .map_err(|error| ParseError::new(Place::File, "parents first", error.to_string()))
}

/// A clip with rotations; joints that a line leaves out stay as they were.
fn turned(
    lines: &[PoseRecord],
    name: String,
    schedule: &Schedule,
    warnings: &mut Vec<Warning>,
) -> Result<Clip, ParseError> {
    let skeleton = skeleton()?;
    let joints = skeleton.len();
    let mut poses: Vec<Vec<Quat>> = Vec::with_capacity(lines.len());
    let mut roots: Vec<Vec3> = Vec::with_capacity(lines.len());
    let mut ignored = 0;
    for line in lines {
        let mut pose = poses
            .last()
            .cloned()
            .unwrap_or_else(|| vec![Quat::identity(); joints]);
        for (name, value) in &line.rotations {
            let rotation = value.and_then(rotation_of_xyzw);
            match (Role::from_name(name).and_then(bone_of), rotation) {
                (Some(joint), Some(q)) => pose[joint] = same_hemisphere(&pose[joint], q),
                _ => ignored += 1,
            }
        }
        poses.push(pose);
        let root = line
            .root
            .map(Vec3::from)
            .filter(|r| r.iter().all(|c| c.is_finite()));
        let rest = || roots.last().copied().unwrap_or(skeleton.joints()[0].offset);
        let root = root.unwrap_or_else(rest);
        roots.push(root);
    }
    if ignored > 0 {
        let text = format!("{ignored} rotations without a role, or invalid, left out");
        warnings.push(Warning::new(Place::File, text));
    }
    if let Some(places) = &schedule.places {
        let pose = |place: &BetweenFrames| match place.t > 0.0 {
            true => (0..joints)
                .map(|j| slerp(&poses[place.before][j], &poses[place.after][j], place.t))
                .collect(),
            false => poses[place.before].clone(),
        };
        let root = |place: &BetweenFrames| match place.t > 0.0 {
            true => roots[place.before].lerp(&roots[place.after], place.t),
            false => roots[place.before],
        };
        (poses, roots) = (
            places.iter().map(pose).collect(),
            places.iter().map(root).collect(),
        );
    }
    Ok(Clip {
        name,
        skeleton,
        rate_hz: schedule.rate_hz,
        frames: roots.len(),
        rotations: poses.concat(),
        tracks: vec![JointTrack {
            joint: 0,
            positions: roots,
        }],
        repaired: schedule.gaps(),
        points: None,
    })
}

/// Writes where a clip's joints (or points) are as lines of JSON; gaps are left out. Lengths and axes stay as they are.
///
/// # Errors
/// An I/O error of `out`.
pub fn write(clip: &Clip, out: &mut dyn std::io::Write) -> std::io::Result<()> {
    let clip = clip.to_points(None);
    for frame in 0..clip.frames {
        let mut positions = serde_json::Map::new();
        for (joint, track) in clip.skeleton.joints().iter().zip(&clip.tracks) {
            if !clip.is_gap_at(track.joint, frame) {
                let at = track.positions[frame];
                positions.insert(joint.name.clone(), serde_json::json!([at.x, at.y, at.z]));
            }
        }
        let t = frame as f64 / clip.rate_hz;
        let line = serde_json::json!({ "t": t, "positions": positions });
        writeln!(out, "{line}")?;
    }
    Ok(())
}

#[cfg(test)]
mod tests;
