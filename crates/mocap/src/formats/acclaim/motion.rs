//! Turns the rows of a motion file into a clip, with a rotation of every joint in every frame.

use super::skeleton::{AmcChannel, Asf, composed};
use crate::clip::{Clip, JointTrack, Span};
use crate::formats::loaded::room;
use crate::formats::{ParseError, Place, Warning};
use crate::math::{Quat, Vec3, same_hemisphere, slerp};

/// A row that could be read: its frame, and where its numbers begin in [`AmcRows::values`].
#[derive(Debug, Clone, Copy)]
pub(super) struct AmcRow {
    pub(super) frame: usize,
    pub(super) start: usize,
}

/// All rows of a file, for each slot (0 the root, `b + 1` bone `b`) in the order of frames.
pub(super) struct AmcRows {
    pub(super) frames: usize,
    pub(super) values: Vec<f64>,
    of_slot: Vec<Vec<AmcRow>>,
    /// Degrees to radians, or 1; the file may say at any time.
    pub(super) degrees: bool,
}

impl AmcRows {
    pub(super) fn new(skeleton: &Asf) -> Self {
        let of_slot = vec![Vec::new(); skeleton.bones.len() + 1];
        Self {
            frames: 0,
            values: Vec::new(),
            of_slot,
            degrees: true,
        }
    }

    /// Bytes of memory that they take.
    pub(super) fn memory(&self) -> usize {
        let rows = self.of_slot.iter().map(Vec::len).sum::<usize>();
        rows * size_of::<AmcRow>() + self.values.len() * size_of::<f64>()
    }

    /// Adds a row of the latest frame; true if that frame already had one of this slot, which it replaces.
    pub(super) fn add(&mut self, slot: usize, row: AmcRow) -> bool {
        let rows = &mut self.of_slot[slot];
        match rows.last_mut().filter(|last| last.frame == row.frame) {
            Some(last) => {
                *last = row;
                true
            }
            None => {
                rows.push(row);
                false
            }
        }
    }

    /// Takes the last frame away if it lacks a row that the frame before it has.
    pub(super) fn drop_unfinished_frame(&mut self) -> bool {
        if self.frames < 2 {
            return false;
        }
        let last = self.frames - 1;
        let in_frame =
            |rows: &[AmcRow], frame| rows.iter().rev().take(2).any(|row| row.frame == frame);
        let unfinished = self
            .of_slot
            .iter()
            .any(|rows| in_frame(rows, last - 1) && !in_frame(rows, last));
        if unfinished {
            for rows in &mut self.of_slot {
                rows.pop_if(|row| row.frame == last);
            }
            self.frames = last;
        }
        unfinished
    }
}

/// The numbers of a slot's row.
pub(super) fn channels(skeleton: &Asf, slot: usize) -> &[AmcChannel] {
    match slot {
        0 => &skeleton.root.channels,
        slot => &skeleton.bones[slot - 1].channels,
    }
}

/// Builds the clip. O(frames · joints).
pub(super) fn assemble(
    name: &str,
    asf: &Asf,
    rows: AmcRows,
    rate_hz: f64,
    warnings: &mut Vec<Warning>,
) -> Result<Clip, ParseError> {
    let spoiled = missing_frames(asf, &rows, warnings)?;
    let skeleton = asf.skeleton();
    let count = rows.frames * skeleton.len();
    let mut rotations = room(count)?;
    rotations.resize(count, Quat::identity());
    let mut clip = Clip {
        name: name.to_owned(),
        rotations,
        skeleton,
        rate_hz,
        tracks: Vec::new(),
        frames: rows.frames,
        repaired: spans(&spoiled),
        points: None,
    };
    for slot in 0..clip.skeleton.len() {
        place_slot(&mut clip, asf, &rows, slot);
    }
    clip.tracks.sort_by_key(|track| track.joint);
    Ok(clip)
}

/// Frames that lack a row which the file otherwise has; an error if that is most of them.
fn missing_frames(
    asf: &Asf,
    rows: &AmcRows,
    warnings: &mut Vec<Warning>,
) -> Result<Vec<bool>, ParseError> {
    let mut spoiled = vec![false; rows.frames];
    let (mut missing, mut expected) = (0usize, 0usize);
    for (slot, present) in rows.of_slot.iter().enumerate() {
        if channels(asf, slot).is_empty() {
            continue;
        }
        if present.is_empty() {
            let name = slot
                .checked_sub(1)
                .map_or(Asf::ROOT, |bone| asf.bones[bone].name.as_str());
            warnings.push(Warning::new(
                Place::File,
                format!("no row of bone {name}; it stays at rest"),
            ));
            continue;
        }
        expected += rows.frames;
        missing += rows.frames - present.len();
        let mut next = present.iter().peekable();
        for (frame, spoiled) in spoiled.iter_mut().enumerate() {
            *spoiled |= next.next_if(|row| row.frame == frame).is_none();
        }
    }
    // This also bounds the memory that a small file can ask for.
    if missing > expected / 2 {
        let found = format!("{missing} of {expected} missing or unreadable");
        return Err(ParseError::new(
            Place::File,
            "a row of each bone in each frame",
            found,
        ));
    }
    if missing > 0 {
        let frames = spoiled.iter().filter(|&&s| s).count();
        let note =
            format!("{missing} of {expected} rows, in {frames} frames, are missing; interpolated");
        warnings.push(Warning::new(Place::File, note));
    }
    Ok(spoiled)
}

/// Stretches where `flags` is set, as half-open ranges.
fn spans(flags: &[bool]) -> Vec<Span> {
    let mut spans: Vec<Span> = Vec::new();
    for (frame, _) in flags.iter().enumerate().filter(|(_, set)| **set) {
        match spans.last_mut().filter(|span| span.end == frame) {
            Some(span) => span.end = frame + 1,
            None => spans.push(frame..frame + 1),
        }
    }
    spans
}

/// Writes one slot's rotations and movements into the clip.
fn place_slot(clip: &mut Clip, asf: &Asf, rows: &AmcRows, slot: usize) {
    let channels = channels(asf, slot);
    let present = &rows.of_slot[slot];
    if present.is_empty() || channels.is_empty() {
        return;
    }
    let moves = |c: &AmcChannel| matches!(c, AmcChannel::Translation(_));
    let mut positions = (slot == 0 || channels.iter().any(moves)).then(Vec::new);
    let mut lengths = (slot > 0 && channels.contains(&AmcChannel::Length)).then(Vec::new);
    let joints = clip.skeleton.len();
    let mut before: Option<BoneMotion> = None;
    let mut next = present.iter().peekable();
    for frame in 0..clip.frames {
        let here = match next.next_if(|row| row.frame == frame) {
            Some(row) => {
                let motion = BoneMotion {
                    frame,
                    ..motion(asf, rows, slot, *row)
                };
                before = Some(motion);
                motion
            }
            None => {
                let after = next.peek().map(|row| BoneMotion {
                    frame: row.frame,
                    ..motion(asf, rows, slot, **row)
                });
                between(before, after, frame)
            }
        };
        let at = frame * joints + slot;
        let previous = if frame == 0 {
            Quat::identity()
        } else {
            clip.rotations[at - joints]
        };
        clip.rotations[at] = same_hemisphere(&previous, here.rotation);
        if let Some(positions) = &mut positions {
            positions.push(clip.skeleton.joints()[slot].offset + here.translation);
        }
        if let Some(lengths) = &mut lengths {
            lengths.push(here.length);
        }
    }
    if let Some(positions) = positions {
        add_to_track(clip, slot, &positions);
    }
    if let Some(lengths) = lengths {
        stretch(clip, asf, slot, &lengths);
    }
}

/// One row: rotation and movement in the parent's frame, and the addition to the length.
#[derive(Debug, Clone, Copy)]
struct BoneMotion {
    frame: usize,
    rotation: Quat,
    translation: Vec3,
    length: f64,
}

fn motion(asf: &Asf, rows: &AmcRows, slot: usize, row: AmcRow) -> BoneMotion {
    let channels = channels(asf, slot);
    let values = &rows.values[row.start..row.start + channels.len()];
    let mut translation = Vec3::zeros();
    let mut length = 0.0;
    for (channel, &value) in channels.iter().zip(values) {
        match channel {
            AmcChannel::Translation(axis) => translation[axis.index()] = value,
            AmcChannel::Length => length = value,
            AmcChannel::Rotation(_) => {}
        }
    }
    let turn = composed(channels.iter().zip(values).filter_map(
        |(channel, &value)| match channel {
            AmcChannel::Rotation(axis) => Some((
                *axis,
                if rows.degrees {
                    value.to_radians()
                } else {
                    value
                },
            )),
            _ => None,
        },
    ));
    let (rotation, translation) = match slot {
        0 => (
            asf.root.orientation * turn,
            asf.root.position + asf.root.orientation * translation,
        ),
        slot => {
            let axes = asf.bones[slot - 1].axes;
            (axes * turn * axes.inverse(), axes * translation)
        }
    };
    BoneMotion {
        frame: row.frame,
        rotation,
        translation,
        length,
    }
}

/// The motion at `frame`, which has no row, from its neighbours with one. At least one of them is there.
fn between(before: Option<BoneMotion>, after: Option<BoneMotion>, frame: usize) -> BoneMotion {
    match (before, after) {
        (Some(a), Some(b)) => {
            let t = (frame - a.frame) as f64 / (b.frame - a.frame) as f64;
            BoneMotion {
                frame,
                rotation: slerp(&a.rotation, &b.rotation, t),
                translation: a.translation.lerp(&b.translation, t),
                length: a.length + t * (b.length - a.length),
            }
        }
        (Some(only), None) | (None, Some(only)) => only,
        (None, None) => BoneMotion {
            frame,
            rotation: Quat::identity(),
            translation: Vec3::zeros(),
            length: 0.0,
        },
    }
}

/// A bone that grows carries its children away along its own direction.
fn stretch(clip: &mut Clip, asf: &Asf, slot: usize, lengths: &[f64]) {
    let vector = asf.bones[slot - 1].vector;
    let direction = vector.try_normalize(0.0).unwrap_or_else(Vec3::zeros);
    let children: Vec<usize> = clip.skeleton.children(slot).collect();
    for child in children {
        let positions: Vec<Vec3> = lengths
            .iter()
            .map(|added| vector + direction * *added)
            .collect();
        add_to_track(clip, child, &positions);
    }
}

/// Adds a movement to what a joint has already: each is given as the joint's whole position, so that its offset
/// counts once.
fn add_to_track(clip: &mut Clip, joint: usize, positions: &[Vec3]) {
    let offset = clip.skeleton.joints()[joint].offset;
    match clip.tracks.iter_mut().find(|track| track.joint == joint) {
        Some(track) => {
            for (sum, position) in track.positions.iter_mut().zip(positions) {
                *sum += position - offset;
            }
        }
        None => clip.tracks.push(JointTrack {
            joint,
            positions: positions.to_vec(),
        }),
    }
}
