//! Joints of Kinect v2 as text, after the description of NTU RGB+D (Shahroudy et al. 2016): the number of frames, in each the
//! number of bodies, and for each body a line of its own, the number of joints, and a line for each joint that begins with its
//! place in metres and ends with how well it was tracked.

use std::collections::BTreeMap;

use super::cells::lines;
use super::descriptor::FormatDescriptor;
use super::points::{Point, PointTable, UNSEEN, check_size};
use super::{Limits, Loaded, ParseError, Place, Warning};
use crate::math::Vec3;

pub(super) const FORMAT: FormatDescriptor = FormatDescriptor {
    name: "ntu_skeleton",
    title: "Kinect joints (NTU)",
    noun: "a recording of a Kinect",
    endings: &["skeleton"],
    looks_so: |h| !h.is_binary() && looks_so(h.bytes),
    up: None,
    read: |file| Ok(file.at_rate(read(file.bytes, file.name, file.rate_hz, file.limits)?)),
};

/// In the order of `JointType` of the Kinect for Windows SDK 2.0.
pub(crate) const JOINTS: [&str; 25] = [
    "SpineBase",
    "SpineMid",
    "Neck",
    "Head",
    "ShoulderLeft",
    "ElbowLeft",
    "WristLeft",
    "HandLeft",
    "ShoulderRight",
    "ElbowRight",
    "WristRight",
    "HandRight",
    "HipLeft",
    "KneeLeft",
    "AnkleLeft",
    "FootLeft",
    "HipRight",
    "KneeRight",
    "AnkleRight",
    "FootRight",
    "SpineShoulder",
    "HandTipLeft",
    "ThumbLeft",
    "HandTipRight",
    "ThumbRight",
];
/// Values on the line of a joint.
const VALUES: usize = 12;
/// Frames a second of the sensor; the files do not say.
const RATE_HZ: f64 = 30.0;

/// True if text begins so: two counts, a line of a body, 25, and a line of a joint.
pub(super) fn looks_so(head: &[u8]) -> bool {
    let text = String::from_utf8_lossy(&head[..head.len().min(4096)]);
    let mut lines = text.lines().map(|line| line.split_whitespace().count());
    let mut begins = || Some([lines.next()?, lines.next()?]);
    begins() == Some([1, 1])
        && lines.by_ref().take(200).any(|count| count == VALUES)
        && text.lines().any(|line| line.trim() == "25")
}

/// Reads the bodies of a file, each a clip called `name` (`name.1`, `name.2` of several), 30 frames a second unless
/// `rate_hz` says otherwise. O(bytes).
///
/// # Errors
/// The place and the cause: a line that is missing or holds something else, no body at all, more than `limits` allow.
pub fn read(
    bytes: &[u8],
    name: &str,
    rate_hz: Option<f64>,
    limits: &Limits,
) -> Result<Loaded, ParseError> {
    let rows = lines(bytes, limits)?;
    let mut rows = NtuLines(rows.iter());
    let declared = rows.count("the number of frames")?;
    check_size(JOINTS.len(), declared, bytes.len(), limits)?;
    let mut warnings = Vec::new();
    let mut bodies: BTreeMap<String, Vec<Vec<Vec3>>> = BTreeMap::new();
    let mut frames = 0;
    while frames < declared {
        match frame(&mut rows, frames, &mut bodies) {
            Ok(()) => frames += 1,
            Err(error) if frames > 0 => {
                let text = format!("{declared} frames are declared, {frames} are whole: {error}");
                warnings.push(Warning::new(error.at, text));
                break;
            }
            Err(error) => return Err(error),
        }
    }
    let several = bodies.len() > 1;
    let mut points = Vec::new();
    for (number, mut joints) in (1..).zip(bodies.into_values()) {
        for (joint, positions) in JOINTS.iter().zip(&mut joints) {
            positions.resize(frames, UNSEEN);
            points.push(Point {
                name: match several {
                    true => format!("{number}:{joint}"),
                    false => (*joint).to_owned(),
                },
                positions: std::mem::take(positions),
            });
        }
    }
    if points.is_empty() {
        return Err(ParseError::new(Place::File, "a body in some frame", "none"));
    }
    let table = PointTable {
        points,
        rate_hz: rate_hz.unwrap_or(RATE_HZ),
        metres_per_unit: Some(1.0),
        zero_is_missing: true,
    };
    table.into_loaded(name, warnings, limits)
}

/// Reads the bodies of frame number `at`.
fn frame(
    rows: &mut NtuLines,
    at: usize,
    bodies: &mut BTreeMap<String, Vec<Vec<Vec3>>>,
) -> Result<(), ParseError> {
    const MOST_BODIES: usize = 6;
    let count = rows.count("the number of bodies")?;
    if count > MOST_BODIES {
        let expected = format!("at most {MOST_BODIES} bodies, as the sensor tracks");
        return Err(ParseError::new(Place::File, expected, count.to_string()));
    }
    for _ in 0..count {
        let (_, body) = rows.next("the line of a body")?;
        let id = body
            .split_whitespace()
            .next()
            .unwrap_or_default()
            .to_owned();
        let joints = rows.count("the number of joints")?;
        if joints != JOINTS.len() {
            return Err(ParseError::new(
                Place::File,
                "25 joints",
                joints.to_string(),
            ));
        }
        let tracks = bodies
            .entry(id)
            .or_insert_with(|| vec![Vec::new(); JOINTS.len()]);
        for track in tracks.iter_mut() {
            let (line, text) = rows.next("the line of a joint")?;
            let values: Option<Vec<f64>> = text
                .split_whitespace()
                .map(|word| word.parse().ok())
                .collect();
            let values = values
                .filter(|values| values.len() == VALUES)
                .ok_or_else(|| {
                    let expected = format!("{VALUES} numbers of a joint");
                    ParseError::new(Place::Line(line), expected, format!("`{text}`"))
                })?;
            track.resize(at, UNSEEN);
            let tracked = values[VALUES - 1] != 0.0;
            track.push(match tracked {
                true => Vec3::new(values[0], values[1], values[2]),
                false => UNSEEN,
            });
        }
    }
    Ok(())
}

/// Lines that are not empty, with their numbers.
struct NtuLines<'a, 'b>(std::slice::Iter<'b, (u64, &'a str)>);

impl<'a> NtuLines<'a, '_> {
    fn next(&mut self, expected: &str) -> Result<(u64, &'a str), ParseError> {
        let end = || ParseError::new(Place::File, expected, "the end of the file");
        let (line, text) = self
            .0
            .find(|(_, text)| !text.trim().is_empty())
            .ok_or_else(end)?;
        Ok((*line, text))
    }

    fn count(&mut self, expected: &str) -> Result<usize, ParseError> {
        let (line, text) = self.next(expected)?;
        text.trim()
            .parse()
            .map_err(|_| ParseError::new(Place::Line(line), expected, format!("`{text}`")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(frames: usize, bodies: usize) -> String {
        let mut text = format!("{frames}\n");
        for frame in 0..frames {
            text += &format!("{bodies}\n");
            for body in 0..bodies {
                text += &format!("7205759403793110{body} 0 1 1 1 1 0 0.02 0.05 2\n25\n");
                for (j, _) in JOINTS.iter().enumerate() {
                    let (x, y) = (body as f64 + 0.01 * frame as f64, 0.05 * j as f64);
                    text += &format!("{x} {y} 3.1 277 191 1036 519 -0.2 0.04 0.96 -0.06 2\n");
                }
            }
        }
        text
    }

    fn open(text: &str) -> Result<Loaded, ParseError> {
        assert!(looks_so(text.as_bytes()) || text.len() < 300);
        read(text.as_bytes(), "s", None, &Limits::default())
    }

    #[test]
    fn bodies_become_clips_of_points() {
        let loaded = open(&file(4, 1)).unwrap();
        let clip = &loaded.clips[0];
        assert_eq!(
            (clip.frames, clip.skeleton.len(), clip.rate_hz),
            (4, 25, 30.0)
        );
        assert_eq!(clip.skeleton.joints()[3].name, "Head");
        let off = clip.tracks[3].positions[2] - Vec3::new(0.02, 0.15, 3.1);
        assert!(off.norm() < 1e-12);
        assert_eq!(open(&file(4, 2)).unwrap().clips.len(), 2);
    }

    #[test]
    fn what_breaks_off_is_kept_up_to_there() {
        let text = file(4, 1);
        let cut = &text[..text.len() - 200];
        let loaded = open(cut).unwrap();
        assert_eq!(loaded.clips[0].frames, 3);
        assert!(
            loaded
                .warnings
                .iter()
                .any(|w| w.text.contains("3 are whole"))
        );
        assert!(open("1\n0\n").is_err());
        assert!(open("x\n").is_err());
        assert!(open("3\n1\n7 1\n25\n1 2\n").is_err());
    }
}
