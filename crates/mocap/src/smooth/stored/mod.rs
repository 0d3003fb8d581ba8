//! The stored form of a compressed clip: a header, plain fields, and the curves through an adaptive range coder.
//!
//! | bytes | hold |
//! |---|---|
//! | 0 to 5 | `MCLIP` and a line end |
//! | 6, 7 | version |
//! | 8 to 15 | bytes that follow the header |
//! | 16 to 19 | CRC-32 of these |
//! | 20 on | name, frames, rate, thresholds, measured errors, repaired spans, skeleton; then the curves |
//!
//! Version 2 is for clips of points: gaps and the stated unit stand behind the repaired spans. Clips with rotations
//! are written as version 1.
//!
//! Whole numbers are little-endian. Control points are whole steps of a size given for each channel, so what is read
//! is to the bit what was written, on every machine.

mod motion;
mod words;

use super::lattice::{Lattice, StepSize};
use super::{ChannelKind, CompressedClip, Curve, Errors, SmoothParams};
use crate::clip::{Gap, Joint, Points, Skeleton, Span};
use crate::coder::{Coder, Reader, Writer};
use crate::formats::{Limits, ParseError, Place};
use crate::math::Vec3;
use motion::{Fault, MotionCoder, Stored};
use words::{Fields, Words};

/// First bytes of every file.
pub const MAGIC: &[u8; 6] = b"MCLIP\n";
/// The newest version that is read: that of clips of points.
pub const VERSION: u16 = 2;
/// The version of clips with rotations.
const ROTATIONS: u16 = 1;

const HEADER: usize = 20;
/// A file has at most this many curves for each byte: what takes less than four bits is made up, and a curve takes two hundred
/// bytes of memory.
const CURVES_A_BYTE: usize = 2;
/// And this many, however short it is.
const FREE_CURVES: usize = 1 << 14;

impl CompressedClip {
    /// The stored form. O(control points).
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut words = Words::default();
        self.write_facts(&mut words);
        write_skeleton(&mut words, &self.skeleton);
        words.natural(self.positions.len() as u64);
        for curve in &self.positions {
            words.natural(curve.joint as u64);
        }
        let curves: usize = self.curves().map(|curve| curve.pieces.len()).sum();
        let mut motion = self.motion();
        motion.resize(
            motion
                .len()
                .max(curves.saturating_sub(FREE_CURVES).div_ceil(CURVES_A_BYTE)),
            0,
        );
        let mut body = words.bytes;
        body.append(&mut motion);
        let mut bytes = Vec::with_capacity(HEADER + body.len());
        bytes.extend_from_slice(MAGIC);
        let version = if self.points.is_some() {
            VERSION
        } else {
            ROTATIONS
        };
        bytes.extend_from_slice(&version.to_le_bytes());
        bytes.extend_from_slice(&(body.len() as u64).to_le_bytes());
        bytes.extend_from_slice(&crc32fast::hash(&body).to_le_bytes());
        bytes.append(&mut body);
        bytes
    }

    fn write_facts(&self, words: &mut Words) {
        words.text(&self.name);
        words.natural(self.frames as u64);
        words.number(self.rate_hz);
        let p = &self.params;
        // 0 is no bound: a bound of 0 cannot be.
        let bound = p.joint_position_metres.unwrap_or(0.0);
        for value in [p.metres_per_unit, p.angle_rad, p.position_metres, bound] {
            words.number(value);
        }
        for value in self.errors.as_array() {
            words.number(value);
        }
        words.natural(self.repaired.len() as u64);
        for span in &self.repaired {
            words.natural(span.start as u64);
            words.natural(span.end as u64);
        }
        if let Some(points) = &self.points {
            // 0 is no stated unit.
            words.number(points.metres_per_unit.unwrap_or(0.0));
            words.natural(points.gaps.len() as u64);
            for gap in &points.gaps {
                words.natural(gap.joint as u64);
                words.natural(gap.frames.start as u64);
                words.natural(gap.frames.end as u64);
            }
        }
    }

    fn motion(&self) -> Vec<u8> {
        let (mut writer, mut motion) = (Writer::new(), MotionCoder::default());
        for curve in self.curves() {
            let stored = Stored {
                lattice: curve.lattice,
                first: curve.first,
                pieces: curve.pieces.clone(),
            };
            // Writing cannot fail: what is given is what is found.
            let _ = motion.channel(&mut writer, curve.kind(), &stored, self.frames, usize::MAX);
        }
        writer.finish()
    }

    /// Reads the stored form, with the usual [`Limits`]. O(control points).
    ///
    /// # Errors
    /// Bytes that are something else, of a newer version, cut short or altered.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, ParseError> {
        Self::from_bytes_within(bytes, &Limits::default())
    }

    /// Reads the stored form, believing it only within `limits`. Memory is in proportion to the bytes given; the
    /// frames that [`sample`](Self::sample) makes of them are not.
    ///
    /// # Errors
    /// As [`from_bytes`](Self::from_bytes).
    pub fn from_bytes_within(bytes: &[u8], limits: &Limits) -> Result<Self, ParseError> {
        let version = check_header(bytes)?;
        let mut fields = Fields::new(bytes, HEADER);
        let mut clip = read_facts(&mut fields, limits)?;
        if version > ROTATIONS {
            clip.points = Some(read_points(&mut fields, clip.frames, limits)?);
        }
        clip.skeleton = read_skeleton(&mut fields, limits)?;
        let tracks = read_tracks(&mut fields, clip.skeleton.len())?;
        let at = fields.at();
        let fault = |fault: Fault| {
            let found = match fault {
                Fault::Cut => "the end of the file",
                Fault::TooMany => "more curves than its bytes can hold",
                Fault::Number => "a number beyond its range",
            };
            ParseError::new(Place::Byte(at as u64), "the curves of all channels", found)
        };
        let (mut reader, mut motion) = (Reader::new(fields.rest()), MotionCoder::default());
        let mut most = FREE_CURVES + fields.rest().len() * CURVES_A_BYTE;
        let nothing = Stored {
            lattice: NO_STEPS,
            first: [0; 3],
            pieces: Vec::new(),
        };
        let mut channel = |kind: ChannelKind, joint: usize| -> Result<Curve, ParseError> {
            let stored = motion
                .channel(&mut reader, kind, &nothing, clip.frames, most)
                .map_err(fault)?;
            most -= stored.pieces.len();
            Ok(Curve::new(
                joint,
                stored.lattice,
                stored.first,
                stored.pieces,
            ))
        };
        for joint in 0..clip.skeleton.len() {
            clip.rotations.push(channel(ChannelKind::Rotation, joint)?);
        }
        for joint in tracks {
            clip.positions.push(channel(ChannelKind::Position, joint)?);
        }
        if reader.is_beyond_end() {
            return Err(fault(Fault::Cut));
        }
        Ok(clip)
    }
}

/// Stands in a reader for the channel that a writer gives.
const NO_STEPS: Lattice = Lattice {
    kind: ChannelKind::Rotation,
    key: StepSize(0),
    tangent: StepSize(0),
};

/// The version, of bytes that are whole.
fn check_header(bytes: &[u8]) -> Result<u16, ParseError> {
    let wrong = |at: u64, expected: String, found: String| {
        Err(ParseError::new(Place::Byte(at), expected, found))
    };
    if !bytes.starts_with(MAGIC) {
        return wrong(
            0,
            "a stored clip, which begins with MCLIP".into(),
            "something else".into(),
        );
    }
    let Some((header, body)) = bytes.split_at_checked(HEADER) else {
        return wrong(
            6,
            format!("a header of {HEADER} bytes"),
            format!("{} bytes", bytes.len()),
        );
    };
    let version = u16::from_le_bytes([header[6], header[7]]);
    if version == 0 || version > VERSION {
        let expected = format!("a version up to {VERSION}; newer ones need a newer morec");
        return wrong(6, expected, format!("version {version}"));
    }
    let mut fields = Fields::new(header, 8);
    let (length, checksum) = (fields.word::<8>()?, fields.word::<4>()?);
    if length != body.len() as u64 {
        return wrong(
            8,
            format!("{length} bytes after the header"),
            body.len().to_string(),
        );
    }
    let found = u64::from(crc32fast::hash(body));
    if found != checksum {
        return wrong(
            16,
            format!("bytes with the checksum {checksum:08x}"),
            format!("{found:08x}: damaged"),
        );
    }
    Ok(version)
}

/// Everything but skeleton and curves.
fn read_facts(fields: &mut Fields, limits: &Limits) -> Result<CompressedClip, ParseError> {
    let name = fields.text(limits.line_bytes, "the clip's name")?;
    let frames = fields.up_to(limits.frames.min(u32::MAX as usize / 2), "frames")?;
    let rate_hz = fields.number("frames a second")?;
    if !(1e-3..=1e5).contains(&rate_hz) {
        return Err(fields.wrong("frames a second, 0.001 to 100000", rate_hz.to_string()));
    }
    let mut number = |what| fields.number(what);
    let metres_per_unit = number("metres in a unit")?;
    let angle_rad = number("the threshold of angles")?;
    let position_metres = number("the threshold of positions")?;
    let joint_position_metres = Some(number("the bound on joints")?).filter(|&bound| bound != 0.0);
    let params = SmoothParams {
        angle_rad,
        position_metres,
        joint_position_metres,
        metres_per_unit,
    };
    params
        .check()
        .map_err(|error| fields.wrong("thresholds within their ranges", error.to_string()))?;
    let mut errors = [0.0; 6];
    for error in &mut errors {
        *error = fields.number("a measured error")?;
    }
    let repaired = read_spans(fields, frames)?;
    let errors = Errors::from_array(errors);
    let (skeleton, rotations, positions) = (Skeleton::default(), Vec::new(), Vec::new());
    Ok(CompressedClip {
        name,
        skeleton,
        rate_hz,
        frames,
        repaired,
        points: None,
        params,
        errors,
        rotations,
        positions,
    })
}

/// Reads the part of a clip of points. Joints are looked at where they are used.
fn read_points(fields: &mut Fields, frames: usize, limits: &Limits) -> Result<Points, ParseError> {
    let metres = fields.number("metres in the stated unit")?;
    if metres < 0.0 {
        return Err(fields.wrong("metres in the stated unit", metres.to_string()));
    }
    let count = fields.up_to(frames.saturating_mul(limits.joints), "gaps")?;
    let mut gaps: Vec<Gap> = Vec::new();
    for _ in 0..count {
        let joint = fields.up_to(limits.joints, "the joint of a gap")?;
        let start = fields.up_to(frames, "the first frame of a gap")?;
        let end = fields.up_to(frames, "the end of a gap")?;
        let after = gaps
            .last()
            .map_or((0, 0), |gap| (gap.joint, gap.frames.end));
        if end <= start || (joint, start) < after {
            return Err(fields.wrong("gaps in order", format!("{start}..{end} of joint {joint}")));
        }
        let frames = start..end;
        gaps.push(Gap { joint, frames });
    }
    Ok(Points {
        gaps,
        metres_per_unit: Some(metres).filter(|&metres| metres > 0.0),
    })
}

fn read_spans(fields: &mut Fields, frames: usize) -> Result<Vec<Span>, ParseError> {
    let count = fields.up_to(frames, "repaired spans")?;
    let mut spans: Vec<Span> = Vec::new();
    for _ in 0..count {
        let start = fields.up_to(frames, "the first frame of a repaired span")?;
        let end = fields.up_to(frames, "the end of a repaired span")?;
        let after = spans.last().map_or(0, |span| span.end);
        if start < after || end <= start {
            return Err(fields.wrong(
                "repaired spans in order",
                format!("{start}..{end} after frame {after}"),
            ));
        }
        spans.push(start..end);
    }
    Ok(spans)
}

fn write_skeleton(words: &mut Words, skeleton: &Skeleton) {
    words.natural(skeleton.len() as u64);
    for (j, joint) in skeleton.joints().iter().enumerate() {
        words.text(&joint.name);
        // Twice how far back the parent stands (0 for a root), and whether there is a tip.
        let back = joint.parent.map_or(0, |parent| j - parent);
        words.natural((back << 1 | usize::from(joint.tip.is_some())) as u64);
        for value in joint.offset.iter().chain(joint.tip.iter().flatten()) {
            words.number(*value);
        }
    }
}

fn read_skeleton(fields: &mut Fields, limits: &Limits) -> Result<Skeleton, ParseError> {
    let count = fields.up_to(limits.joints, "joints")?;
    let (mut joints, mut depths) = (Vec::new(), Vec::new());
    for j in 0..count {
        let name = fields.text(limits.line_bytes, "a joint's name")?;
        let link = fields.up_to(2 * count + 1, "a joint's parent")?;
        let back = link >> 1;
        let parent = j.checked_sub(back).filter(|_| back > 0);
        if back > j {
            return Err(fields.wrong(
                "a parent before its child",
                format!("{back} joints before joint {j}"),
            ));
        }
        let depth = parent.map_or(1, |parent| depths[parent] + 1);
        if depth > limits.depth {
            return Err(fields.wrong(
                format!("chains of up to {} joints", limits.depth),
                "a longer one",
            ));
        }
        depths.push(depth);
        let offset = read_vector(fields, "a joint's offset")?;
        let tip = if link & 1 == 1 {
            Some(read_vector(fields, "a bone's end")?)
        } else {
            None
        };
        joints.push(Joint {
            name,
            parent,
            offset,
            tip,
        });
    }
    Skeleton::new(joints)
        .map_err(|error| fields.wrong("parents before children", error.to_string()))
}

fn read_vector(fields: &mut Fields, what: &str) -> Result<Vec3, ParseError> {
    Ok(Vec3::new(
        fields.number(what)?,
        fields.number(what)?,
        fields.number(what)?,
    ))
}

/// The joints that move in their parent's frame.
fn read_tracks(fields: &mut Fields, joints: usize) -> Result<Vec<usize>, ParseError> {
    let count = fields.up_to(joints, "joints that move")?;
    let mut tracks: Vec<usize> = Vec::new();
    for _ in 0..count {
        let joint = fields.up_to(joints.saturating_sub(1), "a joint that moves")?;
        if tracks.last().is_some_and(|&last| last >= joint) {
            return Err(fields.wrong("joints in increasing order", joint.to_string()));
        }
        tracks.push(joint);
    }
    Ok(tracks)
}
