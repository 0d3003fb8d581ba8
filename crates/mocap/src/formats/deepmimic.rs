//! Motions of DeepMimic's humanoid as JSON, after Peng et al. (*DeepMimic*, 2018) and their description of motion files: in each
//! frame how long it lasts, where the root is, and the rotations of the joints in a fixed order, as quaternions w x y z or, for
//! knees and elbows, an angle about Z. The skeleton is not in the file; its lengths are those of the humanoid that all of them
//! are for, as its published model (URDF) has them.

use serde_json::Value;

use super::builder::{ClipBuilder, check_size};
use super::descriptor::FormatDescriptor;
use super::{Limits, Loaded, ParseError, Place, Warning, json};
use crate::clip::Joint;
use crate::math::{Axis, Quat, Vec3, rotation_of_xyzw};

pub(super) const FORMAT: FormatDescriptor = FormatDescriptor {
    name: "deepmimic",
    title: "DeepMimic motion",
    noun: "a motion of DeepMimic",
    // Its files end in .txt or .json: content alone decides.
    endings: &["deepmimic"],
    looks_so: |h| looks_so(h.bytes),
    up: Some(Axis::Y),
    read: |file| Ok(file.at_rate(read(file.bytes, file.name, file.limits)?)),
};

/// How a joint turns in a frame.
#[derive(Clone, Copy, PartialEq)]
enum Turn {
    /// Four numbers, w x y z.
    Quaternion,
    /// One number, radians about Z.
    Hinge,
    /// None.
    Fixed,
}

/// Name, parent, place in the parent's frame in metres, and how it turns; in the order of the numbers of a frame. Y up, facing
/// X, right along Z.
const JOINTS: [(&str, usize, [f64; 3], Turn); 15] = {
    use Turn::{Fixed, Hinge, Quaternion};
    [
        ("root", 0, [0.0, 0.0, 0.0], Quaternion),
        ("chest", 0, [0.0, 0.236151, 0.0], Quaternion),
        ("neck", 1, [0.0, 0.223894, 0.0], Quaternion),
        ("right_hip", 0, [0.0, 0.0, 0.084887], Quaternion),
        ("right_knee", 3, [0.0, -0.421546, 0.0], Hinge),
        ("right_ankle", 4, [0.0, -0.40987, 0.0], Quaternion),
        ("right_shoulder", 1, [-0.02405, 0.2435, 0.18311], Quaternion),
        ("right_elbow", 6, [0.0, -0.274788, 0.0], Hinge),
        ("right_wrist", 7, [0.0, -0.258947, 0.0], Fixed),
        ("left_hip", 0, [0.0, 0.0, -0.084887], Quaternion),
        ("left_knee", 9, [0.0, -0.421546, 0.0], Hinge),
        ("left_ankle", 10, [0.0, -0.40987, 0.0], Quaternion),
        ("left_shoulder", 1, [-0.02405, 0.2435, -0.18311], Quaternion),
        ("left_elbow", 12, [0.0, -0.274788, 0.0], Hinge),
        ("left_wrist", 13, [0.0, -0.258947, 0.0], Fixed),
    ]
};

/// Ends of chains, metres.
const TIPS: [(usize, [f64; 3]); 3] = [
    (2, [0.0, 0.28, 0.0]),
    (5, [0.16, -0.05, 0.0]),
    (11, [0.16, -0.05, 0.0]),
];

/// Numbers of a frame: how long it lasts, the root's place, and what the joints take.
const VALUES: usize = 44;
/// Frames a second of a file whose frames last no time.
const ASSUMED_HZ: f64 = 30.0;

/// True if text begins as such a motion does, of whatever body.
pub(super) fn looks_so(head: &[u8]) -> bool {
    let contains = |word: &[u8]| head.windows(word.len()).any(|at| at == word);
    let frames = || {
        let word = b"\"Frames\"";
        let at = head.windows(word.len()).position(|at| at == word)?;
        let mut marks = head[at + word.len()..]
            .iter()
            .filter(|byte| !byte.is_ascii_whitespace());
        let opens = [b':', b'[', b'[']
            .iter()
            .all(|mark| marks.next() == Some(mark));
        let number = marks.next()?;
        Some(opens && matches!(number, b'-' | b'.' | b'0'..=b'9'))
    };
    let words: [&[u8]; 4] = [
        b"\"Loop\"",
        b"\"LoopMode\"",
        b"\"FrameDuration\"",
        b"\"Joints\"",
    ];
    let text = head.trim_ascii_start();
    // The first field may be the frames, and all others far behind.
    let alone = || {
        text.get(1..)
            .is_some_and(|rest| rest.trim_ascii_start().starts_with(b"\"Frames\""))
    };
    text.starts_with(b"{")
        && frames() == Some(true)
        && (words.iter().any(|w| contains(w)) || alone())
}

/// Reads a motion of the humanoid: one clip called `name`. Frames with numbers that are not finite are interpolated. O(bytes).
///
/// # Errors
/// The place and the cause: no JSON, no list of frames, frames of another body, more than `limits` allow.
pub fn read(bytes: &[u8], name: &str, limits: &Limits) -> Result<Loaded, ParseError> {
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    let mut warnings = Vec::new();
    let limits = &json::limits_beside(bytes, limits)?;
    let document = json::read(bytes, &mut warnings)?;
    let frames = document.get("Frames").and_then(Value::as_array);
    let frames = frames.filter(|frames| !frames.is_empty());
    let Some(frames) = frames else {
        return Err(ParseError::new(Place::File, "a list `Frames`", "none"));
    };
    let stated = document.get("FrameDuration").and_then(Value::as_f64);
    let width = frames[0].as_array().map_or(0, Vec::len);
    let timed = match (width, stated) {
        (VALUES, _) => true,
        (width, Some(_)) if width + 1 == VALUES => false,
        _ => return Err(another_body(width)),
    };
    check_size(frames.len(), JOINTS.len(), 0, bytes.len(), limits)?;
    let mut durations = Vec::with_capacity(frames.len());
    let mut builder = ClipBuilder::new(joints());
    let mut spoiled = 0;
    for frame in frames {
        let values = numbers(frame).filter(|values| values.len() == width);
        let pose = values.as_ref().and_then(|v| pose(&v[usize::from(timed)..]));
        durations.extend(values.filter(|_| timed).map(|values| values[0]));
        match pose {
            Some((place, rotations)) => {
                let offsets = JOINTS[1..].iter().map(|joint| Vec3::from(joint.2));
                builder.push_local(rotations, std::iter::once(place).chain(offsets));
            }
            None => {
                spoiled += 1;
                builder.push_missing();
            }
        }
    }
    if spoiled == frames.len() {
        let expected = format!("frames of {width} numbers, with quaternions of some length");
        return Err(ParseError::new(Place::File, expected, "none"));
    }
    if spoiled > 0 {
        let text = format!("{spoiled} frames lack numbers or valid rotations and are interpolated");
        warnings.push(Warning::new(Place::File, text));
    }
    let rate_hz = rate(&durations, stated, &mut warnings);
    let clip = builder.finish(name.to_owned(), rate_hz)?;
    Ok(Loaded {
        clips: vec![clip],
        warnings,
    })
}

fn joints() -> Vec<Joint> {
    let tip = |j: usize| TIPS.iter().find(|(joint, _)| *joint == j).map(|tip| tip.1);
    let joint = |(j, (name, parent, offset, _)): (usize, &(&str, usize, [f64; 3], Turn))| Joint {
        name: (*name).to_owned(),
        parent: (j > 0).then_some(*parent),
        offset: Vec3::from(*offset),
        tip: tip(j).map(Vec3::from),
    };
    JOINTS.iter().enumerate().map(joint).collect()
}

fn numbers(frame: &Value) -> Option<Vec<f64>> {
    frame.as_array()?.iter().map(Value::as_f64).collect()
}

/// The root's place and the joints' rotations; `None` if a quaternion has no length.
fn pose(values: &[f64]) -> Option<(Vec3, Vec<Quat>)> {
    let (place, mut rest) = values.split_at_checked(3)?;
    let mut rotations = Vec::with_capacity(JOINTS.len());
    for (.., turn) in JOINTS {
        let count = match turn {
            Turn::Quaternion => 4,
            Turn::Hinge => 1,
            Turn::Fixed => 0,
        };
        let (own, behind) = rest.split_at_checked(count)?;
        rest = behind;
        rotations.push(match own {
            [w, x, y, z] => rotation_of_xyzw([*x, *y, *z, *w])?,
            [angle] => Axis::Z.rotation(*angle),
            _ => Quat::identity(),
        });
    }
    Some((Vec3::new(place[0], place[1], place[2]), rotations))
}

/// The rate by how long frames last; the last one, before which there is nothing more to play, may last no time.
fn rate(durations: &[f64], stated: Option<f64>, warnings: &mut Vec<Warning>) -> f64 {
    let mut known: Vec<f64> = durations
        .iter()
        .copied()
        .filter(|secs| *secs > 1e-6)
        .collect();
    known.sort_by(f64::total_cmp);
    let usual = known.get(known.len() / 2).copied();
    let Some(secs) = usual.or(stated.filter(|secs| *secs > 1e-6)) else {
        let text = format!(
            "frames have no duration; {ASSUMED_HZ} Hz is assumed (--file-rate sets another)"
        );
        warnings.push(Warning::new(Place::File, text));
        return ASSUMED_HZ;
    };
    if let (Some(least), Some(most)) = (known.first(), known.last())
        && *most > least * 1.02
    {
        let text = format!("frames last {least:.4} to {most:.4} s; {secs:.4} s is used for all");
        warnings.push(Warning::new(Place::File, text));
    }
    // Six digits of a duration tell the rate to some thousandths.
    let rate = 1.0 / secs;
    let whole = rate.round();
    match (rate / whole - 1.0).abs() < 1e-3 {
        true => whole,
        false => rate,
    }
}

fn another_body(width: usize) -> ParseError {
    let expected = format!("frames of {VALUES} numbers, as DeepMimic's humanoid has");
    let found = match width {
        0 => "frames that are not lists of numbers".to_owned(),
        19 | 20 => format!("{width}: a motion of a quadruped robot, not of a person"),
        _ => format!("{width}: a motion of another body, whose skeleton is not in the file"),
    };
    ParseError::new(Place::File, expected, found)
}

#[cfg(test)]
mod tests;
