//! HTR: skeletal motion of Motion Analysis as text, after Jeff Lander's description (*Working with Motion Capture File Formats*) and
//! that of the University of Wisconsin (CS 838, 1999): a header, the parent of each segment, the base position, then for each segment a
//! row for each frame. HTR2 has the rows of all segments below each frame.
//!
//! A segment's frame in that of its parent is `(T_base + T) · R_base · R`. Angles turn about the axes in the order that the header
//! names, as in BVH: `ZYX` is `R_z · R_y · R_x`. Factors of bone lengths are left out: producers disagree about what they mean.

use std::collections::HashMap;

use super::builder::{ClipBuilder, check_size};
use super::cells::{Decimal, lines, number};
use super::descriptor::FormatDescriptor;
use super::{Limits, Loaded, ParseError, Place, Warning};
use crate::clip::Joint;
use crate::math::{Axis, Quat, Vec3};
use crate::parse_error::shortened;

pub(super) const FORMAT: FormatDescriptor = FormatDescriptor {
    name: "htr",
    title: "HTR",
    noun: "an HTR motion",
    endings: &["htr", "htr2"],
    looks_so: |h| !h.is_binary() && h.says("[segmentnames&hierarchy]") && !h.says("filetype gtr"),
    up: None,
    read: |file| Ok(file.at_rate(read(file.bytes, file.name, file.limits)?)),
};

/// Frames a second of a file that does not say.
const ASSUMED_HZ: f64 = 60.0;
/// What the format writes for a segment that was not tracked is as large.
const UNTRACKED: f64 = 999_999.0;
/// Frames for each row that a file has, at most.
const FRAMES_A_ROW: usize = 16;

/// Reads an HTR or HTR2 file: one clip called `name`, in the file's units and axes. Frames in which a segment lacks a row or was not tracked
/// are interpolated. O(bytes).
///
/// # Errors
/// The place and the cause: no segments, a parent that does not exist, a row that cannot be read, no frames, more than `limits` allow.
pub fn read(bytes: &[u8], name: &str, limits: &Limits) -> Result<Loaded, ParseError> {
    let rows = lines(bytes, limits)?;
    let mut htr = HtrFile::default();
    let mut section = HtrSection::Header;
    for (line, text) in rows {
        let text = text.split('#').next().unwrap_or_default().trim();
        if text.is_empty() {
            continue;
        }
        if let Some(title) = text
            .strip_prefix('[')
            .and_then(|rest| rest.split(']').next())
        {
            section = htr.section(title.trim());
            continue;
        }
        let at = |expected: &str| {
            ParseError::new(
                Place::Line(line),
                expected,
                format!("`{}`", shortened(text)),
            )
        };
        match section {
            HtrSection::Header => htr.set(text).map_err(at)?,
            HtrSection::Hierarchy => htr.add_segment(text, limits).map_err(at)?,
            HtrSection::Base => htr.set_base(text).map_err(at)?,
            HtrSection::Segment(segment) => htr.add_row(Some(segment), text).map_err(at)?,
            HtrSection::Frame => htr.add_row(None, text).map_err(at)?,
            HtrSection::End => {}
        }
    }
    htr.into_loaded(name, bytes.len(), limits)
}

#[derive(Clone, Copy)]
enum HtrSection {
    Header,
    Hierarchy,
    Base,
    Segment(usize),
    Frame,
    End,
}

#[derive(Default)]
struct HtrSegment {
    name: String,
    parent: String,
    place: Vec3,
    turned: Quat,
    length: f64,
    rows: HashMap<i64, (Vec3, Quat)>,
}

/// A file as far as it was read.
#[derive(Default)]
struct HtrFile {
    rate_hz: Option<f64>,
    order: Option<[Axis; 3]>,
    radians: bool,
    bone_axis: Option<Axis>,
    segments: Vec<HtrSegment>,
    of_name: HashMap<String, usize>,
    /// The frame of the rows to come, in HTR2.
    frame: i64,
    untracked: usize,
}

impl HtrFile {
    fn section(&mut self, title: &str) -> HtrSection {
        let lower = title.to_ascii_lowercase();
        match lower.as_str() {
            "header" => HtrSection::Header,
            "baseposition" => HtrSection::Base,
            "endoffile" => HtrSection::End,
            _ if lower.starts_with("segmentnames") => HtrSection::Hierarchy,
            _ => match self.of_name.get(title) {
                Some(&segment) => HtrSection::Segment(segment),
                None => {
                    self.frame += 1;
                    HtrSection::Frame
                }
            },
        }
    }

    fn set(&mut self, text: &str) -> Result<(), &'static str> {
        let mut words = text.split_whitespace();
        let key = words.next().unwrap_or_default().to_ascii_lowercase();
        let value = words.next().unwrap_or_default();
        match key.as_str() {
            "dataframerate" => {
                let rate = number(value, Decimal::Point).filter(|rate| *rate > 0.0);
                self.rate_hz = Some(rate.ok_or("a rate above 0")?);
            }
            "eulerrotationorder" => {
                let axes: Option<Vec<Axis>> = value.chars().map(Axis::from_letter).collect();
                let axes = axes.and_then(|axes| <[Axis; 3]>::try_from(axes).ok());
                self.order = Some(axes.ok_or("an order of rotations, as in `ZYX`")?);
            }
            "rotationunits" => self.radians = value.to_ascii_lowercase().starts_with("rad"),
            "bonelengthaxis" => self.bone_axis = value.chars().next().and_then(Axis::from_letter),
            _ => {}
        }
        Ok(())
    }

    /// A segment and its parent; names may have blanks where a tab separates them.
    fn add_segment(&mut self, text: &str, limits: &Limits) -> Result<(), &'static str> {
        let names = match text.split_once(['\t', ',']) {
            Some(names) => Some(names),
            None => text.rsplit_once(' '),
        };
        let (name, parent) = names.ok_or("a segment and its parent")?;
        let (name, parent) = (name.trim(), parent.trim());
        if self.segments.len() == limits.joints {
            return Err("no more segments than joints are allowed");
        }
        let next = self.segments.len();
        if self.of_name.insert(name.to_owned(), next).is_some() {
            return Err("a segment of another name");
        }
        self.segments.push(HtrSegment {
            name: name.to_owned(),
            parent: parent.to_owned(),
            ..HtrSegment::default()
        });
        Ok(())
    }

    /// The segment that begins `text`, and the numbers behind it.
    fn named_row<'a>(&self, text: &'a str) -> Option<(usize, &'a str)> {
        let known = |at: usize| Some((*self.of_name.get(text[..at].trim())?, &text[at..]));
        let ends = text
            .char_indices()
            .filter(|(_, c)| c.is_whitespace() || *c == ',');
        ends.map(|(at, _)| at).find_map(known)
    }

    fn set_base(&mut self, text: &str) -> Result<(), &'static str> {
        const EXPECTED: &str = "a segment of the hierarchy, its place, its angles, its length";
        let (segment, rest) = self.named_row(text).ok_or(EXPECTED)?;
        let values = numbers(rest).filter(|v| v.len() >= 6).ok_or(EXPECTED)?;
        let turned = self.turned([values[3], values[4], values[5]]);
        let segment = &mut self.segments[segment];
        segment.place = Vec3::new(values[0], values[1], values[2]);
        segment.turned = turned;
        segment.length = values.get(6).copied().unwrap_or(0.0);
        Ok(())
    }

    /// A row of one frame: of `segment` with the frame's number first, or of the frame with a segment's name first.
    fn add_row(&mut self, segment: Option<usize>, text: &str) -> Result<(), &'static str> {
        const EXPECTED: &str = "a frame's number, x y z, three angles";
        let (segment, frame, values) = match segment {
            Some(segment) => {
                let values = numbers(text).filter(|v| v.len() >= 7).ok_or(EXPECTED)?;
                let frame = values[0];
                if frame.fract() != 0.0 || frame.abs() > 1e12 {
                    return Err(EXPECTED);
                }
                (segment, frame as i64, values[1..7].to_vec())
            }
            None => {
                let (segment, rest) = self.named_row(text).ok_or("a row of a known segment")?;
                let values = numbers(rest).filter(|v| v.len() >= 6).ok_or(EXPECTED)?;
                (segment, self.frame, values[..6].to_vec())
            }
        };
        if values.iter().any(|value| value.abs() >= UNTRACKED) {
            self.untracked += 1;
            return Ok(());
        }
        let turned = self.turned([values[3], values[4], values[5]]);
        let place = Vec3::new(values[0], values[1], values[2]);
        self.segments[segment].rows.insert(frame, (place, turned));
        Ok(())
    }

    fn turned(&self, xyz: [f64; 3]) -> Quat {
        let order = self.order.unwrap_or([Axis::Z, Axis::Y, Axis::X]);
        let angle = |axis: &Axis| match self.radians {
            true => xyz[axis.index()],
            false => xyz[axis.index()].to_radians(),
        };
        let turns = order.iter().map(|axis| axis.rotation(angle(axis)));
        turns.fold(Quat::identity(), |all, turn| all * turn)
    }

    /// Numbers of the segments with parents before their children, and the parent of each by its place in that order.
    fn in_order(&self) -> Result<Vec<(usize, Option<usize>)>, ParseError> {
        let mut children: Vec<Vec<usize>> = vec![Vec::new(); self.segments.len()];
        let mut left: Vec<(usize, Option<usize>)> = Vec::new();
        for (at, segment) in self.segments.iter().enumerate() {
            match self.of_name.get(&segment.parent) {
                Some(&parent) => children[parent].push(at),
                None if segment.parent.eq_ignore_ascii_case("global") => left.push((at, None)),
                None => {
                    let expected = format!("a parent of segment `{}`", segment.name);
                    let found = format!("`{}`, which is no segment", segment.parent);
                    return Err(ParseError::new(Place::File, expected, found));
                }
            }
        }
        left.reverse();
        let mut ordered = Vec::with_capacity(self.segments.len());
        while let Some((segment, parent)) = left.pop() {
            let below = children[segment].iter().rev();
            left.extend(below.map(|&child| (child, Some(ordered.len()))));
            ordered.push((segment, parent));
        }
        if ordered.len() < self.segments.len() || ordered.is_empty() {
            let expected = "segments of which each hangs on GLOBAL in the end";
            let found = format!("{} of {} do", ordered.len(), self.segments.len());
            return Err(ParseError::new(Place::File, expected, found));
        }
        Ok(ordered)
    }

    fn into_loaded(self, name: &str, bytes: usize, limits: &Limits) -> Result<Loaded, ParseError> {
        let ordered = self.in_order()?;
        let frames = || self.segments.iter().flat_map(|s| s.rows.keys().copied());
        let (Some(first), Some(last)) = (frames().min(), frames().max()) else {
            return Err(ParseError::new(
                Place::File,
                "rows of frames below the segments",
                "none",
            ));
        };
        let count = usize::try_from(last.saturating_sub(first)).unwrap_or(usize::MAX);
        let count = count.saturating_add(1);
        if count > FRAMES_A_ROW.saturating_mul(frames().count()) {
            let found = format!("numbers from {first} to {last}");
            return Err(ParseError::new(
                Place::File,
                "frames numbered one by one",
                found,
            ));
        }
        check_size(count, ordered.len(), 0, bytes, limits)?;
        let mut builder = ClipBuilder::new(self.joints(&ordered));
        let mut missing = 0;
        for frame in first..=last {
            let pose: Option<Vec<(Vec3, Quat)>> = ordered
                .iter()
                .map(|&(at, _)| self.segments[at].pose(frame))
                .collect();
            match pose {
                Some(pose) => {
                    builder.push_local(pose.iter().map(|p| p.1), pose.iter().map(|p| p.0));
                }
                None => {
                    missing += 1;
                    builder.push_missing();
                }
            }
        }
        let clip = builder.finish(name.to_owned(), self.rate_hz.unwrap_or(ASSUMED_HZ))?;
        Ok(Loaded {
            clips: vec![clip],
            warnings: self.warnings(missing),
        })
    }

    fn joints(&self, ordered: &[(usize, Option<usize>)]) -> Vec<Joint> {
        let axis = self.bone_axis.unwrap_or(Axis::Y).unit();
        let parents: Vec<usize> = ordered.iter().filter_map(|(_, parent)| *parent).collect();
        let joint = |(place, &(at, parent)): (usize, &(usize, Option<usize>))| {
            let segment = &self.segments[at];
            let is_leaf = !parents.contains(&place);
            Joint {
                name: segment.name.clone(),
                parent,
                offset: segment.place,
                tip: (is_leaf && segment.length > 0.0).then(|| segment.length * axis.into_inner()),
            }
        };
        ordered.iter().enumerate().map(joint).collect()
    }

    fn warnings(&self, missing: usize) -> Vec<Warning> {
        let mut texts = Vec::new();
        if self.rate_hz.is_none() {
            texts.push(format!(
                "no DataFrameRate in the header; {ASSUMED_HZ} Hz is assumed"
            ));
        }
        if self.order.is_none() {
            texts.push("no EulerRotationOrder in the header; ZYX is assumed".to_owned());
        }
        if self.untracked > 0 {
            let text = format!("{} rows of segments that were not tracked", self.untracked);
            texts.push(text);
        }
        if missing > 0 {
            texts.push(format!(
                "{missing} frames lack a segment; they are interpolated"
            ));
        }
        let warning = |text| Warning::new(Place::File, text);
        texts.into_iter().map(warning).collect()
    }
}

impl HtrSegment {
    /// Place and rotation in the parent's frame; the base position where the segment has no rows at all.
    fn pose(&self, frame: i64) -> Option<(Vec3, Quat)> {
        if self.rows.is_empty() {
            return Some((self.place, self.turned));
        }
        let (place, turned) = self.rows.get(&frame)?;
        Some((self.place + place, self.turned * turned))
    }
}

fn numbers(text: &str) -> Option<Vec<f64>> {
    let cells = text.split(|c: char| c.is_whitespace() || c == ',');
    let cells = cells.filter(|cell| !cell.is_empty());
    let sensible = |cell: &str| number(cell, Decimal::Point).filter(|value| value.abs() < 1e12);
    cells.map(sensible).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::mangle;
    use crate::kinematics::WorldPose;

    const HEAD: &str = "# Comment line\r\n[Header]\r\nFileType htr # one word\r\nDataType HTRS\nNumSegments 3\nNumFrames 2\nDataFrameRate 50\n\
        EulerRotationOrder ZYX\nCalibrationUnits mm\nRotationUnits Degrees\nGlobalAxisofGravity Y\nBoneLengthAxis Y\nScaleFactor 1.0\n\
        [SegmentNames&Hierarchy]\n#CHILD PARENT\nShin\tThigh\nHips\tGLOBAL\nThigh\tHips\n\
        [BasePosition]\nHips 0 0 0 0 0 90 10\nThigh 0 10 0 0 0 0 40\nShin 0 40 0 0 0 0 45\n";

    fn open(text: &str) -> Result<Loaded, ParseError> {
        read(text.as_bytes(), "walk", &Limits::default())
    }

    fn near(a: Vec3, b: [f64; 3]) -> bool {
        (a - Vec3::from(b)).norm() < 1e-9
    }

    /// By hand: the hips are turned from Y to -X, so the thigh hangs at -X, and turns on about its own axes.
    #[test]
    fn segments_turn_on_from_their_base_position() {
        let by_segment = format!(
            "{HEAD}#Beginning of Data\n[Hips]\n1 5 900 0 0 0 0 1\n2 6 900 0 0 0 0 1\n[Thigh]\n1 0 0 0 0 0 0 1\n2 0 0 1 90 0 90 1\n\
             [Shin]\n1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n[EndOfFile]\n"
        );
        let by_frame = format!(
            "{HEAD}[Frame 1]\nHips 5 900 0 0 0 0 1\nThigh 0 0 0 0 0 0 1\nShin 0 0 0 0 0 0 1\n[Frame 2]\nHips 6 900 0 0 0 0 1\n\
             Thigh 0 0 1 90 0 90 1\nShin 0 0 0 0 0 0 1\n[EndOfFile]\n"
        );
        for text in [by_segment, by_frame] {
            let loaded = open(&text).unwrap();
            let clip = &loaded.clips[0];
            assert_eq!((clip.frames, clip.rate_hz), (2, 50.0));
            let names: Vec<&str> = clip
                .skeleton
                .joints()
                .iter()
                .map(|joint| joint.name.as_str())
                .collect();
            assert_eq!(names, ["Hips", "Thigh", "Shin"]);
            let pose = WorldPose::of(clip, 0);
            assert!(near(pose.positions[1], [-5.0, 900.0, 0.0]));
            assert!(near(pose.positions[2], [-45.0, 900.0, 0.0]));
            // R_z · R_x takes Y first to Z, which Z leaves alone; and so do the hips.
            let pose = WorldPose::of(clip, 1);
            assert!(near(pose.positions[1], [-4.0, 900.0, 1.0]));
            assert!(near(pose.positions[2], [-4.0, 900.0, 41.0]));
            assert_eq!(
                clip.skeleton.joints()[2].tip,
                Some(Vec3::new(0.0, 45.0, 0.0))
            );
            assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
        }
    }

    #[test]
    fn what_was_not_tracked_is_interpolated() {
        let text = format!(
            "{HEAD}[Hips]\n1 0 0 0 0 0 0 1\n2 9999999 9999999 9999999 0 0 0 1\n3 2 0 0 0 0 0 1\n5 4 0 0 0 0 0 1\n"
        );
        let loaded = open(&text).unwrap();
        let clip = &loaded.clips[0];
        assert_eq!(clip.frames, 5);
        for frame in 0..5 {
            assert!((clip.local_position(frame, 0).x - frame as f64).abs() < 1e-9);
        }
        assert_eq!(clip.repaired, [1..2, 3..4]);
        assert_eq!(loaded.warnings.len(), 2, "{:?}", loaded.warnings);
    }

    #[test]
    fn what_cannot_be_read_is_said_with_its_line() {
        for (text, place, expected) in [
            ("[Header]\nDataFrameRate x\n".to_owned(), "line 2", "a rate"),
            (
                "[Header]\nEulerRotationOrder ZY\n".into(),
                "line 2",
                "order",
            ),
            ("[Header]\nFileType htr\n".into(), "file", "GLOBAL"),
            (
                format!("{HEAD}[Hips]\n1 2 3\n"),
                "line 24",
                "a frame's number",
            ),
            (
                format!("{HEAD}Foot 0 0 0 0 0 0 1\n"),
                "line 23",
                "hierarchy",
            ),
            (HEAD.to_owned(), "file", "rows of frames"),
            (
                HEAD.replace("Thigh\tHips", "Thigh\tHip"),
                "file",
                "a parent",
            ),
            (HEAD.replace("Hips\tGLOBAL", "Hips\tShin"), "file", "GLOBAL"),
            (
                format!("{HEAD}[Hips]\n1 0 0 0 0 0 0 1\n900000 0 0 0 0 0 0 1\n"),
                "file",
                "one by one",
            ),
        ] {
            let error = open(&text).unwrap_err();
            assert_eq!(error.at.to_string(), place, "{error}");
            assert!(error.expected.contains(expected), "{error}");
        }
    }

    #[test]
    fn cut_and_altered_files_never_panic() {
        let text =
            format!("{HEAD}[Hips]\n1 0 0 0 0 0 0 1\n2 1 0 0 3 4 5 1\n[Thigh]\n1 0 0 0 1 2 3 1\n");
        mangle::each(text.as_bytes(), 600, |bytes| {
            if let Ok(loaded) = read(bytes, "a", &Limits::default()) {
                mangle::check(&loaded);
            }
        });
    }

    /// A synthetic walk, written in each order of rotations.
    #[test]
    fn a_clip_comes_back_in_every_order() {
        let turn = |f: usize, j: usize| {
            Axis::X.rotation(0.3 * (f + j) as f64)
                * Axis::Y.rotation(0.2 * f as f64)
                * Axis::Z.rotation(-0.1 * (f * j) as f64)
        };
        for order in ["XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"] {
            let axes: Vec<Axis> = order.chars().filter_map(Axis::from_letter).collect();
            let head = HEAD.replace("ZYX", order).replace("0 0 90 10", "0 0 0 10");
            let mut text = head;
            for (j, name) in ["Hips", "Thigh", "Shin"].iter().enumerate() {
                text += &format!("[{name}]\n");
                for f in 0..4 {
                    let xyz = angles(&turn(f, j), [axes[0], axes[1], axes[2]]);
                    let [x, y, z] = xyz.map(f64::to_degrees);
                    text += &format!("{} {} 0 0 {x} {y} {z} 1\n", f + 1, f as f64);
                }
            }
            let clip = &open(&text).unwrap().clips[0];
            for f in 0..4 {
                for j in 0..3 {
                    let apart = clip.frame_rotations(f)[j].angle_to(&turn(f, j));
                    assert!(apart < 1e-6, "{order}: {apart}");
                }
            }
        }
    }

    /// Angles about x, y and z whose turns in `order` make `q`, by descent: no formula of the reader's.
    fn angles(q: &Quat, order: [Axis; 3]) -> [f64; 3] {
        let mut best = [0.0; 3];
        let apart = |xyz: [f64; 3]| {
            let turns = order.iter().map(|axis| axis.rotation(xyz[axis.index()]));
            turns
                .fold(Quat::identity(), |all, turn| all * turn)
                .angle_to(q)
        };
        let mut step = 1.0;
        while step > 1e-9 {
            let mut moved = false;
            for at in 0..3 {
                for by in [step, -step] {
                    let mut tried = best;
                    tried[at] += by;
                    if apart(tried) < apart(best) {
                        (best, moved) = (tried, true);
                    }
                }
            }
            if !moved {
                step *= 0.5;
            }
        }
        best
    }
}
