//! Builds clips from tables of points: the common part of C3D, TRC and tables of positions.

mod gaps;
mod point;

pub(super) use self::point::{Point, SHORT_GAP_SECS, UNSEEN};

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

use self::gaps::{Filled, union};
use self::point::{SHOWN, is_seen};
use super::{Limits, Loaded, ParseError, Place, Warning};
use crate::clip::{Clip, Points};
use crate::math::{Quat, Vec3};
use crate::pose::Hand;
use crate::roles::Role;
use crate::roles::points::{numbered_counts, recognise_posed, subject_of};

/// What is wrong with points in a picture.
pub(crate) const IN_A_PICTURE: &str = "x and y alone: two dimensions are not enough for a person (triangulate several views); of an animal or a thing, name its points with --roles";

/// Models of face and hands beside the body: their points come behind its 33.
pub(super) const WITH_HANDS_AND_FACE: [usize; 5] = [75, 501, 543, 553, 1629];
/// Points of the body in these.
pub(super) const BODY_OF_THESE: usize = 33;

/// Points of a file with their rate and unit.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PointTable {
    pub(super) points: Vec<Point>,
    pub(super) rate_hz: f64,
    pub(super) metres_per_unit: Option<f64>,
    /// True if a point at the origin was not seen.
    pub(super) zero_is_missing: bool,
}

impl PointTable {
    /// Clips of the table: one, or one for each subject (`Anna:LFHD`) whose points make a body. Points that were never
    /// seen are left out. O(points × frames).
    ///
    /// # Errors
    /// No point was ever seen, or there are more points than `limits` allow.
    pub(super) fn into_loaded(
        mut self,
        name: &str,
        mut warnings: Vec<Warning>,
        limits: &Limits,
    ) -> Result<Loaded, ParseError> {
        if self.points.len() > limits.joints {
            let expected = format!("at most {} points", limits.joints);
            let found = self.points.len().to_string();
            return Err(ParseError::new(Place::File, expected, found));
        }
        self.mark_unseen(&mut warnings);
        self.name_subjects();
        self.keep_body(&mut warnings);
        self.leave_out(&mut warnings);
        if self.is_in_picture() {
            let text = "these are image coordinates with estimated depth or none, so directions of limbs are wrong; give world \
                coordinates (MediaPipe's `pose_world_landmarks`)";
            warnings.push(Warning::new(Place::File, text));
        }
        if self.points.is_empty() {
            return Err(ParseError::new(
                Place::File,
                "at least one point with a position",
                "none; the file contains no motion",
            ));
        }
        let clips = self
            .subjects(name, &mut warnings)
            .into_iter()
            .map(|(name, points)| self.clip(name, points, &mut warnings))
            .collect();
        Ok(Loaded { clips, warnings })
    }

    /// Positions with a coordinate that is not finite, and those at the origin where that means so, become unseen.
    fn mark_unseen(&mut self, warnings: &mut Vec<Warning>) {
        let zero_is_missing = self.zero_is_missing;
        let mut nines = 0;
        let rests = |p: &Vec3| *p == Vec3::zeros();
        // Who has nothing but the origin was not there.
        let moving: BTreeSet<String> = (self.points.iter())
            .filter(|point| point.positions.iter().any(|p| is_seen(p) && !rests(p)))
            .map(|point| subject_of(&point.name).to_owned())
            .collect();
        for point in &mut self.points {
            // The middle of the hips may be the origin of every frame.
            let is_origin = is_root_name(&point.name)
                && moving.contains(subject_of(&point.name))
                && point.positions.iter().all(rests);
            for position in &mut point.positions {
                let is_code = is_seen(position) && is_missing_code(position);
                nines += usize::from(is_code);
                if !is_seen(position) || is_code || zero_is_missing && !is_origin && rests(position)
                {
                    *position = UNSEEN;
                }
            }
        }
        if nines > 0 {
            let text = format!("{nines} coordinates of nines only (9999, -9999) are read as gaps");
            warnings.push(Warning::new(Place::File, text));
        }
    }

    /// True if the points are a body's landmarks in a picture: x and y are shares of its width and height, or pixels beside a depth that hardly differs, y points down, and places in the
    /// world would lie around the middle of the hips.
    fn is_in_picture(&self) -> bool {
        const LEAST: usize = 15;
        const INSIDE: f64 = 0.9;
        // Of the height, where places are pixels and depth is another number or none.
        const FLAT: f64 = 0.01;
        let seen = || {
            self.points
                .iter()
                .flat_map(|p| p.positions.iter().filter(|p| is_seen(p)))
        };
        let count = seen().count();
        let inside = |p: &&Vec3| (0.0..=1.0).contains(&p.x) && (0.0..=1.0).contains(&p.y);
        let inside = seen().filter(inside).count();
        let range = |axis: usize| {
            let values = seen().map(|p| p[axis]);
            let (low, high) = values.fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(v), h.max(v)));
            high - low
        };
        let shares = inside as f64 >= INSIDE * count as f64;
        if self.points.len() < LEAST || count == 0 || !shares && range(2) > FLAT * range(1) {
            return false;
        }
        let names: Vec<&str> = self
            .points
            .iter()
            .map(|point| point.name.as_str())
            .collect();
        let known = recognise_posed(&names, &self.some_poses());
        let height = |role: Role| -> Option<f64> {
            let roles = &known.as_ref()?.roles;
            let (_, place) = roles.iter().find(|(known, _)| *known == role)?;
            let poses = self.some_poses();
            let heights = poses
                .iter()
                .filter_map(|pose| Some(place.at(|p| pose[p])?.y));
            let (sum, count) = heights.fold((0.0, 0.0), |(sum, n), y| (sum + y, n + 1.0));
            (count > 0.0).then_some(sum / count)
        };
        // The head is above in the picture, which is a smaller y.
        let head = height(Role::Head).or_else(|| height(Role::Neck));
        let hips = height(Role::LeftThigh).or_else(|| height(Role::Hips));
        matches!((head, hips), (Some(head), Some(hips)) if head < hips)
    }

    /// Places of all points in some frames.
    fn some_poses(&self) -> Vec<Vec<Vec3>> {
        const LOOKED_AT: usize = 8;
        let frames = self.points.first().map_or(0, |point| point.positions.len());
        (0..frames)
            .step_by(frames.div_ceil(LOOKED_AT).max(1))
            .map(|frame| self.points.iter().map(|p| p.positions[frame]).collect())
            .filter(|pose: &Vec<Vec3>| pose.iter().all(is_seen))
            .collect()
    }

    /// Leaves out what was never seen, and what a tracker could not name where other points have names.
    fn leave_out(&mut self, warnings: &mut Vec<Warning>) {
        let (seen, never): (Vec<_>, Vec<_>) = std::mem::take(&mut self.points)
            .into_iter()
            .partition(|point| point.positions.iter().any(is_seen));
        let (named, unnamed): (Vec<_>, Vec<_>) =
            seen.into_iter().partition(|p| !is_unlabelled(&p.name));
        note_left_out(&never, "never seen", warnings);
        if named.is_empty() {
            self.points = unnamed;
        } else {
            note_left_out(&unnamed, "without a label", warnings);
            self.points = named;
        }
    }

    /// `person0_nose` and `P2_nose` become `person0:nose` and `P2:nose` where several people have points of the same names.
    fn name_subjects(&mut self) {
        const PEOPLE: [&str; 11] = [
            "p",
            "person",
            "people",
            "subject",
            "participant",
            "body",
            "skeleton",
            "player",
            "actor",
            "user",
            "id",
        ];
        fn split(name: &str) -> Option<(&str, &str)> {
            let (whose, rest) = name.split_once(['_', ' ', '.', '-'])?;
            let word = whose.trim_end_matches(|c: char| c.is_ascii_digit());
            let known = PEOPLE.iter().any(|known| word.eq_ignore_ascii_case(known));
            (known && word.len() < whose.len()).then_some((whose, rest))
        }
        let split: Option<Vec<(&str, &str)>> = self.points.iter().map(|p| split(&p.name)).collect();
        let Some(split) = split else { return };
        let mut people: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
        for &(whose, rest) in &split {
            people.entry(whose).or_default().push(rest);
        }
        let mut lists = people.values();
        let first = lists.next();
        if people.len() < 2 || lists.any(|names| Some(names) != first) {
            return;
        }
        let names: Vec<String> = split
            .iter()
            .map(|(whose, rest)| format!("{whose}:{rest}"))
            .collect();
        for (point, name) in self.points.iter_mut().zip(names) {
            point.name = name;
        }
    }

    /// Of numbered points of a body, a face and hands (MediaPipe's holistic model), those of the body: by their word, `pose_12`, or as
    /// the first of a known number.
    fn keep_body(&mut self, warnings: &mut Vec<Warning>) {
        let numbered: Option<Vec<(String, usize)>> =
            self.points.iter().map(|p| numbered(&p.name)).collect();
        let Some(numbered) = numbered.filter(|numbered| !numbered.is_empty()) else {
            return;
        };
        let says_body = |word: &str| ["pose", "body"].iter().any(|body| word.contains(body));
        let (first, _) = &numbered[0];
        let least = numbered.iter().map(|n| n.1).min().unwrap_or(0);
        let alike = numbered.iter().all(|(word, _)| word == first);
        // Markers are numbered, too: `M1` to `M75` are no landmarks.
        let landmarks = ["landmark", "keypoint", "pose", "point", "lm", "kp"];
        let unworded = first.is_empty() || landmarks.iter().any(|word| first.starts_with(word));
        let known = alike && unworded && WITH_HANDS_AND_FACE.contains(&numbered.len());
        let kept: Vec<bool> = numbered
            .iter()
            .map(|(word, number)| match known {
                true => number - least < BODY_OF_THESE,
                false => says_body(word),
            })
            .collect();
        let count = kept.iter().filter(|kept| **kept).count();
        if count == numbered.len() || !numbered_counts().any(|known| known == count) {
            return;
        }
        let text = format!(
            "{} points; {count} are read as the body, hands and face are left out",
            numbered.len()
        );
        warnings.push(Warning::new(Place::File, text));
        let mut kept = kept.into_iter();
        self.points.retain(|_| kept.next().unwrap_or(true));
    }

    /// Points by subject, if at least two subjects have a body of their own.
    fn subjects(&mut self, name: &str, warnings: &mut Vec<Warning>) -> Vec<(String, Vec<Point>)> {
        let points = std::mem::take(&mut self.points);
        let mut groups: Vec<(&str, Vec<&Point>)> = Vec::new();
        for point in &points {
            let subject = subject_of(&point.name);
            match groups.iter_mut().find(|(known, _)| *known == subject) {
                Some((_, own)) => own.push(point),
                None => groups.push((subject, vec![point])),
            }
        }
        let bodies: Vec<String> = groups
            .iter()
            .filter(|(subject, own)| !subject.is_empty() && !is_side(subject) && is_body(own))
            .map(|(subject, _)| (*subject).to_owned())
            .collect();
        if bodies.len() < 2 {
            return vec![(name.to_owned(), points)];
        }
        let text = format!(
            "{} subjects, a clip for each: {}",
            bodies.len(),
            bodies.join(", ")
        );
        warnings.push(Warning::new(Place::File, text));
        let mut clips: Vec<(String, Vec<Point>)> = (1..=bodies.len())
            .map(|number| (format!("{name}.{number}"), Vec::new()))
            .collect();
        let mut others = Vec::new();
        for point in points {
            match bodies.iter().position(|b| b == subject_of(&point.name)) {
                Some(body) => clips[body].1.push(point),
                None => others.push(point),
            }
        }
        note_left_out(&others, "of no subject with a body", warnings);
        clips
    }

    fn clip(&self, name: String, mut points: Vec<Point>, warnings: &mut Vec<Warning>) -> Clip {
        let most = (SHORT_GAP_SECS * self.rate_hz).round().max(1.0) as usize;
        let mut filled = Filled::default();
        for (joint, point) in points.iter_mut().enumerate() {
            filled.fill(joint, &mut point.positions, most);
        }
        filled.note(&points, self.rate_hz, warnings);
        let known = Points {
            gaps: filled.long,
            metres_per_unit: self.metres_per_unit,
        };
        let points = points.into_iter().map(|p| (p.name, p.positions));
        let mut clip = Clip::of_points(name, self.rate_hz, points, known);
        clip.repaired = union(filled.short);
        clip
    }
}

/// True of a place that stands for a missing one: a coordinate is 9999 or more such digits, or all are 999.
fn is_missing_code(position: &Vec3) -> bool {
    const CODES: [f64; 6] = [
        9999.0,
        99999.0,
        999_999.0,
        9_999_999.0,
        99_999_999.0,
        9999.99,
    ];
    let is_code = |value: &f64| CODES.contains(&value.abs());
    position.iter().any(is_code) || position.iter().all(|value| value.abs() == 999.0)
}

/// A name's word in lower case and the number behind it.
fn numbered(name: &str) -> Option<(String, usize)> {
    let word = name.trim_end_matches(|c: char| c.is_ascii_digit());
    Some((word.to_lowercase(), name[word.len()..].parse().ok()?))
}

/// True if points make a body, by their names and by where they are in some frames that show them all.
fn is_body(points: &[&Point]) -> bool {
    const LOOKED_AT: usize = 8;
    let names: Vec<&str> = points.iter().map(|point| point.name.as_str()).collect();
    let frames = points.first().map_or(0, |point| point.positions.len());
    let poses: Vec<Vec<Vec3>> = (0..frames)
        .step_by(frames.div_ceil(LOOKED_AT).max(1))
        .map(|frame| points.iter().map(|p| p.positions[frame]).collect())
        .filter(|pose: &Vec<Vec3>| pose.iter().all(is_seen))
        .collect();
    recognise_posed(&names, &poses).is_some()
}

fn note_left_out(points: &[Point], why: &str, warnings: &mut Vec<Warning>) {
    if points.is_empty() {
        return;
    }
    let shown: Vec<&str> = points.iter().take(SHOWN).map(|p| p.name.as_str()).collect();
    let more = if points.len() > SHOWN { ", …" } else { "" };
    let text = format!(
        "{} points {why} left out: {}{more}",
        points.len(),
        shown.join(", ")
    );
    warnings.push(Warning::new(Place::File, text));
}

/// Names that trackers give to what they could not label: `*12`, `U_3`, `Unlabeled 1203`, `uname1`.
fn is_unlabelled(name: &str) -> bool {
    let bare = name.rsplit(':').next().unwrap_or(name).trim();
    let lower = bare.to_ascii_lowercase();
    let number = |rest: &str| {
        let rest = rest.trim_start_matches(['_', ' ', '-', '*']);
        !rest.is_empty() && rest.bytes().all(|b| b.is_ascii_digit())
    };
    ["*", "u_", "unlabeled", "unlabelled", "uname", "unknown"]
        .iter()
        .any(|start| lower.strip_prefix(start).is_some_and(number))
}

/// True of the name of a hand, in the place of a person's.
fn is_side(subject: &str) -> bool {
    let mut hands = Hand::BOTH.into_iter();
    hands.any(|hand| subject.eq_ignore_ascii_case(hand.name()))
}

fn is_root_name(name: &str) -> bool {
    let lower = name.to_ascii_lowercase();
    let bare = lower.rsplit(':').next().unwrap_or_default();
    // Hands may be given from their wrists.
    matches!(bare, "0" | "wrist" | "palm")
        || bare.ends_with("_0")
        || ["hip", "pelvis", "root"]
            .iter()
            .any(|root| lower.contains(root))
}

/// Positions that a file of `bytes` bytes is believed to hold: one takes three cells, unless rows are cut short.
///
/// # Errors
/// More positions than that, or than `limits` have memory for.
pub(super) fn check_size(
    points: usize,
    frames: usize,
    bytes: usize,
    limits: &Limits,
) -> Result<(), ParseError> {
    /// Twice the position while times are made regular, and a rotation of identity.
    const BYTES_A_POSITION: usize = 2 * size_of::<Vec3>() + size_of::<Quat>();
    let most = bytes.saturating_mul(4).max(1 << 20);
    let positions = points.saturating_mul(frames);
    if positions <= most {
        return limits.afford(positions, BYTES_A_POSITION);
    }
    let expected = format!("at most {most} positions in {bytes} bytes");
    let found = format!("{points} points in {frames} frames");
    Err(ParseError::new(Place::File, expected, found))
}

/// The clip as one of points, or where its joints are in the world.
pub(super) fn as_points(clip: &Clip) -> Cow<'_, Clip> {
    if clip.has_rotations() {
        Cow::Owned(clip.to_points(None))
    } else {
        Cow::Borrowed(clip)
    }
}

/// The name of a clip's unit in files of points, and the factor from the clip's unit to it: 1, unless only millimetres
/// have a name. No name for an unknown unit.
pub(super) fn named_unit(clip: &Clip) -> (&'static str, f64) {
    const NAMES: [(&str, f64); 3] = [("m", 1.0), ("cm", 0.01), ("mm", 0.001)];
    let Some(metres) = clip.points.as_ref().and_then(|p| p.metres_per_unit) else {
        return ("", 1.0);
    };
    match NAMES.iter().find(|(_, m)| (m / metres - 1.0).abs() < 1e-9) {
        Some((name, _)) => (name, 1.0),
        None => ("mm", 1000.0 * metres),
    }
}

/// Metres in a unit of length of this name.
pub(super) fn metres_of(unit: &str) -> Option<f64> {
    match unit
        .trim_matches(['\0', ' ', '\t'])
        .to_ascii_lowercase()
        .as_str()
    {
        "m" | "meter" | "meters" | "metre" | "metres" => Some(1.0),
        "dm" => Some(0.1),
        "cm" | "centimeter" | "centimeters" | "centimetre" | "centimetres" => Some(0.01),
        "mm" | "millimeter" | "millimeters" | "millimetre" | "millimetres" => Some(0.001),
        "in" | "inch" | "inches" => Some(0.0254),
        "ft" | "feet" | "foot" => Some(0.3048),
        _ => None,
    }
}

/// Clips of points whose positions are at hand: one, or one for each subject (`Anna:LFHD`) whose points make a body. For
/// each point its name and a position for each frame; one that is not finite was not seen. `metres_per_unit` is what is
/// known of the unit. O(points × frames).
///
/// # Errors
/// No point was ever seen, points with different numbers of positions, or more than `limits` allow.
pub fn from_positions(
    name: &str,
    rate_hz: f64,
    points: Vec<(String, Vec<Vec3>)>,
    metres_per_unit: Option<f64>,
    limits: &Limits,
) -> Result<Loaded, ParseError> {
    let frames = points.first().map_or(0, |(_, positions)| positions.len());
    let other = points
        .iter()
        .find(|(_, positions)| positions.len() != frames);
    if let Some((point, positions)) = other {
        let expected = format!("{frames} positions of each point");
        let found = format!("{} of {point}", positions.len());
        return Err(ParseError::new(Place::File, expected, found));
    }
    let point = |(name, positions)| Point { name, positions };
    let table = PointTable {
        points: points.into_iter().map(point).collect(),
        rate_hz,
        metres_per_unit,
        zero_is_missing: false,
    };
    table.into_loaded(name, Vec::new(), limits)
}

#[cfg(test)]
mod tests;
