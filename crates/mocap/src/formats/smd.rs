//! SMD: skeletal animation of the Source engine as text, after Valve's description (*Studiomdl Data*): nodes with their parents, then
//! for each time a line for every bone that moved: where it is in its parent's frame, and angles in radians about X, then Y, then
//! Z.

use super::builder::{ClipBuilder, check_size};
use super::cells::lines;
use super::descriptor::FormatDescriptor;
use super::{Limits, Loaded, ParseError, Place, Warning};
use crate::clip::Joint;
use crate::math::{Axis, Quat, Vec3};

pub(super) const FORMAT: FormatDescriptor = FormatDescriptor {
    name: "smd",
    title: "SMD",
    noun: "an SMD animation",
    endings: &["smd"],
    looks_so: |h| {
        !h.is_binary()
            && h.lines().take(20).any(|l| l.starts_with(b"version 1"))
            && h.contains(b"\nnodes")
            && h.contains(b"\nskeleton")
            && !h.contains(b"vertexanimation")
    },
    up: None,
    read: |file| Ok(file.at_rate(read(file.bytes, file.name, file.limits)?)),
};

/// Frames a second; the files do not say.
const ASSUMED_HZ: f64 = 30.0;

/// Reads an SMD file: one clip called `name`, 30 frames a second. A bone that a frame leaves out stays as it was. O(bytes).
///
/// # Errors
/// The place and the cause: no nodes, a node whose parent does not exist, no times, a line that is no bone's, more than `limits` allow.
pub fn read(bytes: &[u8], name: &str, limits: &Limits) -> Result<Loaded, ParseError> {
    let rows = lines(bytes, limits)?;
    let rows: Vec<(u64, &str)> = rows
        .into_iter()
        .map(|(line, text)| (line, without_comment(text).trim()))
        .filter(|(_, text)| !text.is_empty())
        .collect();
    let nodes = nodes(section(&rows, "nodes")?, limits)?;
    let frames = frames(section(&rows, "skeleton")?, &nodes, limits)?;
    check_size(frames.len(), nodes.len(), 0, bytes.len(), limits)?;
    let mut warnings = Vec::new();
    let text = format!(
        "the format has no frame rate; {ASSUMED_HZ} Hz is assumed (--file-rate sets another)"
    );
    warnings.push(Warning::new(Place::File, text));
    let joints = nodes.iter().enumerate().map(|(j, node)| Joint {
        name: node.name.clone(),
        parent: node.parent,
        offset: frames.first().map_or_else(Vec3::zeros, |frame| frame[j].0),
        tip: None,
    });
    let mut builder = ClipBuilder::new(joints.collect());
    for frame in &frames {
        builder.push_local(
            frame.iter().map(|bone| bone.1),
            frame.iter().map(|bone| bone.0),
        );
    }
    let clip = builder.finish(name.to_owned(), ASSUMED_HZ)?;
    Ok(Loaded {
        clips: vec![clip],
        warnings,
    })
}

fn without_comment(text: &str) -> &str {
    let end = ["//", "#", ";"]
        .iter()
        .filter_map(|mark| {
            let at = text.find(mark)?;
            // A name may have such marks.
            text[..at]
                .matches('"')
                .count()
                .is_multiple_of(2)
                .then_some(at)
        })
        .min();
    &text[..end.unwrap_or(text.len())]
}

/// The lines between `title` and `end`; to the end of a file that breaks off.
fn section<'a, 'b>(
    rows: &'a [(u64, &'b str)],
    title: &str,
) -> Result<&'a [(u64, &'b str)], ParseError> {
    let Some(begin) = rows
        .iter()
        .position(|(_, text)| text.eq_ignore_ascii_case(title))
    else {
        let expected = format!("a section `{title}` in the SMD file");
        return Err(ParseError::new(Place::File, expected, "none"));
    };
    let rest = &rows[begin + 1..];
    let end = rest
        .iter()
        .position(|(_, text)| text.eq_ignore_ascii_case("end"));
    Ok(&rest[..end.unwrap_or(rest.len())])
}

struct SmdNode {
    id: i64,
    name: String,
    parent: Option<usize>,
}

fn nodes(rows: &[(u64, &str)], limits: &Limits) -> Result<Vec<SmdNode>, ParseError> {
    let mut nodes: Vec<SmdNode> = Vec::with_capacity(rows.len().min(limits.joints));
    for &(line, text) in rows {
        let wrong = |found: String| {
            ParseError::new(
                Place::Line(line),
                "a node: number, \"name\", number of its parent",
                found,
            )
        };
        let parse = || -> Option<(i64, &str, i64)> {
            // Names have blanks in them, so the quotes divide the line.
            let (id, rest) = text.split_once('"')?;
            let (name, parent) = rest.rsplit_once('"')?;
            Some((id.trim().parse().ok()?, name, parent.trim().parse().ok()?))
        };
        let (id, name, parent) = parse().ok_or_else(|| wrong(format!("`{text}`")))?;
        let parent = match parent {
            ..0 => None,
            parent => {
                let at = nodes.iter().position(|node| node.id == parent);
                Some(at.ok_or_else(|| {
                    wrong(format!("parent {parent}, which does not stand before it"))
                })?)
            }
        };
        if nodes.len() == limits.joints {
            let expected = format!("at most {} joints", limits.joints);
            return Err(ParseError::new(Place::Line(line), expected, "more"));
        }
        nodes.push(SmdNode {
            id,
            name: name.to_owned(),
            parent,
        });
    }
    match nodes.is_empty() {
        true => Err(ParseError::new(
            Place::File,
            "nodes in the SMD file",
            "none",
        )),
        false => Ok(nodes),
    }
}

/// Place and rotation of a bone in its parent's frame.
type BonePlace = (Vec3, Quat);

fn frames(
    rows: &[(u64, &str)],
    nodes: &[SmdNode],
    limits: &Limits,
) -> Result<Vec<Vec<BonePlace>>, ParseError> {
    let number_of: std::collections::HashMap<i64, usize> = nodes
        .iter()
        .enumerate()
        .map(|(at, node)| (node.id, at))
        .collect();
    let mut frames: Vec<Vec<BonePlace>> = Vec::new();
    let mut current = vec![(Vec3::zeros(), Quat::identity()); nodes.len()];
    let mut time: Option<i64> = None;
    // A time that is left out repeats the frame before: a file of two lines could ask for billions. At most 64 places of bones
    // for each line are believed, and 65,536 in a small file.
    let most = rows.len().saturating_mul(64).max(1 << 16) / nodes.len().max(1) + 1;
    let mut put = |until: i64, from: i64, pose: &[BonePlace], line: u64| {
        // Times that are left out repeat what was before.
        for _ in 0..until.saturating_sub(from).max(1) {
            if frames.len() >= limits.frames.min(most.max(rows.len())) {
                let expected = "no more frames than the file's lines can mean";
                return Err(ParseError::new(
                    Place::Line(line),
                    expected,
                    "a time far behind the last",
                ));
            }
            frames.push(pose.to_vec());
        }
        Ok(())
    };
    for &(line, text) in rows {
        if let Some(next) = text.strip_prefix("time") {
            let next: i64 = next.trim().parse().map_err(|_| {
                ParseError::new(
                    Place::Line(line),
                    "`time` and a whole number",
                    format!("`{text}`"),
                )
            })?;
            if let Some(before) = time {
                put(next, before, &current, line)?;
            }
            time = Some(next);
            continue;
        }
        let bone = bone(text).and_then(|(id, bone)| Some((*number_of.get(&id)?, bone)));
        let (Some((at, bone)), Some(_)) = (bone, time) else {
            let expected = "a bone below a time: its number, x y z, three angles";
            return Err(ParseError::new(
                Place::Line(line),
                expected,
                format!("`{text}`"),
            ));
        };
        current[at] = bone;
    }
    let last = rows.last().map_or(1, |row| row.0);
    match time {
        Some(time) => put(time + 1, time, &current, last)?,
        None => {
            return Err(ParseError::new(
                Place::File,
                "times in the SMD file",
                "none",
            ));
        }
    }
    Ok(frames)
}

fn bone(text: &str) -> Option<(i64, BonePlace)> {
    let mut words = text.split_whitespace();
    let id = words.next()?.parse().ok()?;
    let mut value = || {
        let value: f64 = words.next()?.parse().ok()?;
        // No bone is a billion units away: the line is broken.
        (value.abs() < 1e9).then_some(value)
    };
    let place = Vec3::new(value()?, value()?, value()?);
    let [x, y, z] = [value()?, value()?, value()?];
    // About the fixed axes of the parent, X first.
    let turned = Axis::Z.rotation(z) * Axis::Y.rotation(y) * Axis::X.rotation(x);
    Some((id, (place, turned)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::WorldPose;

    fn open(text: &str) -> Result<Loaded, ParseError> {
        read(text.as_bytes(), "walk", &Limits::default())
    }

    const FILE: &str = "// made by hand\nversion 1\nnodes\n 0 \"Bip01 Pelvis\" -1\n 1 \"Bip01 Spine\" 0\n 2 \"Head\" 1\nend\n\
        skeleton\n time 0\n 0 1 2 3 0 0 1.5707963\n 1 10 0 0 0 0 0\n 2 5 0 0 0 0 0\n time 1 # quiet\n 1 10 0 0 1.5707963 0 1.5707963\n\
        time 3\n 0 2 2 3 0 0 1.5707963\nend\n";

    #[test]
    fn bones_turn_about_x_then_y_then_z_and_stay_where_nothing_moves_them() {
        let loaded = open(FILE).unwrap();
        let clip = &loaded.clips[0];
        assert_eq!((clip.frames, clip.rate_hz), (4, 30.0));
        assert_eq!(clip.skeleton.joints()[1].name, "Bip01 Spine");
        let head = |frame: usize| WorldPose::of(clip, frame).positions[2];
        assert!(
            (head(0) - Vec3::new(1.0, 17.0, 3.0)).norm() < 1e-5,
            "{}",
            head(0)
        );
        // The spine turns its X to Y, and the pelvis that to -X.
        assert!(
            (head(1) - Vec3::new(-4.0, 12.0, 3.0)).norm() < 1e-5,
            "{}",
            head(1)
        );
        assert_eq!(head(2), head(1));
        assert!((head(3) - head(1) - Vec3::x()).norm() < 1e-9);
    }

    #[test]
    fn what_cannot_be_read_is_said_with_its_line() {
        for (text, place, expected) in [
            ("version 1\nnodes\nend\n", "file", "nodes"),
            (
                "version 1\nnodes\n0 Hips -1\nend\nskeleton\nend\n",
                "line 3",
                "a node",
            ),
            (
                "version 1\nnodes\n0 \"a\" 1\n1 \"b\" -1\nend\n",
                "line 3",
                "a node",
            ),
            (
                "version 1\nnodes\n0 \"a\" -1\nend\nskeleton\n0 0 0 0 0 0 0\nend\n",
                "line 6",
                "below a time",
            ),
            (
                "version 1\nnodes\n0 \"a\" -1\nend\nskeleton\ntime 0\n0 0 0 x 0 0 0\nend\n",
                "line 7",
                "below a time",
            ),
            (
                "version 1\nnodes\n0 \"a\" -1\nend\nskeleton\ntime 0\ntime 99999999999\nend\n",
                "line 7",
                "no more frames",
            ),
            (
                "version 1\nnodes\n0 \"a\" -1\nend\nskeleton\nend\n",
                "file",
                "times",
            ),
        ] {
            let error = open(text).unwrap_err();
            assert_eq!(error.at.to_string(), place, "{text}");
            assert!(error.expected.contains(expected), "{text}: {error}");
        }
        crate::formats::mangle::each(FILE.as_bytes(), 400, |bytes| {
            let _ = read(bytes, "a", &Limits::default());
        });
    }
}
