//! Motions of the SMPL family of body models in NumPy archives, as AMASS has them: axis-angle rotations of the joints.
//!
//! Keys after the AMASS notebooks: `poses` (frames × 66, 72, 156 or 165) or `root_orient` and `pose_body`, `trans`,
//! `mocap_framerate` or `mocap_frame_rate`. Rotations are those of the file. The body is one of our own, since the
//! models' shapes may not be shipped: joints lie in the right directions, at lengths of an average person.

mod body;

use std::collections::BTreeMap;

use super::builder::{ClipBuilder, check_size};
use super::descriptor::FormatDescriptor;
use super::head::Head;
use super::npy::{self, Array};
use super::{Limits, Loaded, ParseError, Place, Warning, container};
use crate::math::{Quat, Vec3};

pub(super) const FORMAT: FormatDescriptor = FormatDescriptor {
    name: "smpl",
    title: "SMPL poses (npz)",
    noun: "an archive of SMPL poses",
    endings: &["npz"],
    looks_so: begins_with_array,
    up: None,
    read: |file| Ok(file.at_rate(read(file.bytes, file.name, file.limits)?)),
};

/// A zip archive whose first file is an array.
fn begins_with_array(head: &Head) -> bool {
    let name = || {
        let length = u16::from_le_bytes([*head.bytes.get(26)?, *head.bytes.get(27)?]);
        head.bytes.get(30..30 + usize::from(length))
    };
    head.bytes.starts_with(b"PK\x03\x04") && name().is_some_and(|name| name.ends_with(b".npy"))
}

/// Rate if a file has none; that of most of AMASS.
const ASSUMED_HZ: f64 = 120.0;

const POSES: [&str; 8] = [
    "poses",
    "pose",
    "fullpose",
    "full_pose",
    "smpl_poses",
    "pred_pose",
    "pred_poses",
    "theta",
];
const ROOT: [&str; 3] = ["root_orient", "global_orient", "global_orient_aa"];
const BODY: [&str; 2] = ["pose_body", "body_pose"];
const PLACE: [&str; 8] = [
    "trans",
    "pred_trans",
    "cam_trans",
    "transl",
    "translation",
    "root_trans",
    "smpl_trans",
    "root_translation",
];
const RATE: [&str; 6] = [
    "mocap_framerate",
    "mocap_frame_rate",
    "framerate",
    "frame_rate",
    "fps",
    "mocap_fps",
];

/// What `smpl_trans` of AIST++ is to be divided by for metres.
const SCALING: [&str; 3] = ["smpl_scaling", "scaling", "smpl_scale"];

/// Reads an archive of one motion, called `name`.
///
/// # Errors
/// The place and the cause: no archive, no poses in it (with the arrays that are), arrays of other shapes, more than `limits`
/// allow. O(bytes).
pub fn read(bytes: &[u8], name: &str, limits: &Limits) -> Result<Loaded, ParseError> {
    let wanted = |path: &str| {
        let key = key_of(path);
        [&POSES[..], &ROOT, &BODY, &PLACE, &RATE, &SCALING]
            .iter()
            .any(|keys| keys.contains(&key))
    };
    let mut limits = limits.of_packed(bytes.len());
    let members = container::unzip(bytes, &wanted, limits.memory)?;
    let mut arrays = BTreeMap::new();
    for member in &members {
        let key = key_of(&member.path);
        limits = limits.without(member.bytes.len() + npy::memory(&member.bytes))?;
        let array = npy::read(&member.bytes).map_err(|error| ParseError {
            expected: format!("{} in `{key}`", error.expected),
            ..error
        })?;
        arrays.insert(key, array);
    }
    let find = |keys: &[&str]| keys.iter().find_map(|key| arrays.get(*key));
    let mut warnings = Vec::new();
    let frames = match (find(&POSES), find(&ROOT), find(&BODY)) {
        (Some(poses), ..) => SmplFrames::of_whole(poses)?,
        (None, Some(root), Some(body)) => SmplFrames::of_parts(root, body)?,
        _ => return Err(no_poses(bytes)),
    };
    check_size(frames.count, body::JOINTS, 0, bytes.len(), &limits)?;
    if frames.joints > body::JOINTS {
        let text = format!(
            "{} joints are read, the other {} (hands, fingers, face) left out",
            body::JOINTS,
            frames.joints - body::JOINTS
        );
        warnings.push(Warning::new(Place::File, text));
    }
    let rate_hz = rate(find(&RATE), &mut warnings);
    let mut places = places(find(&PLACE), frames.count, &mut warnings)?;
    let scaling = find(&SCALING).and_then(|array| array.values.first().copied());
    if let Some(scaling) =
        scaling.filter(|scale| scale.is_finite() && *scale > 0.0 && *scale != 1.0)
    {
        places.iter_mut().for_each(|place| *place /= scaling);
        let text = format!("positions are divided by {scaling} (`smpl_scaling`)");
        warnings.push(Warning::new(Place::File, text));
    }
    let note = "rotations are exact, but bone lengths are those of an average person of 1.70 m, not of the person recorded, and \
        the hips are at `trans`, up to 0.3 m from their position in the body model";
    warnings.push(Warning::new(Place::File, note));
    let clip = clip(&frames, &places).finish(name.to_owned(), rate_hz)?;
    Ok(Loaded {
        clips: vec![clip],
        warnings,
    })
}

fn clip(frames: &SmplFrames<'_>, places: &[Vec3]) -> ClipBuilder {
    let joints = body::joints();
    let offsets: Vec<Vec3> = joints.iter().map(|joint| joint.offset).collect();
    let mut builder = ClipBuilder::new(joints);
    for (frame, place) in places.iter().enumerate() {
        let rotations: Option<Vec<Quat>> = (0..body::JOINTS)
            .map(|j| frames.rotation(frame, j))
            .collect();
        match rotations.filter(|_| place.iter().all(|v| v.is_finite())) {
            Some(rotations) => {
                let positions = std::iter::once(*place).chain(offsets[1..].iter().copied());
                builder.push_local(rotations, positions);
            }
            None => builder.push_missing(),
        }
    }
    builder
}

/// True if an archive with these paths has poses.
pub(super) fn has_poses(paths: &[String]) -> bool {
    let has = |keys: &[&str]| paths.iter().any(|path| keys.contains(&key_of(path)));
    has(&POSES) || has(&ROOT) && has(&BODY)
}

/// True if an archive with these paths may hold such a motion: NumPy's have arrays only.
pub fn is_numpy_archive(paths: &[String]) -> bool {
    paths.iter().any(|path| path.ends_with(".npy"))
}

fn key_of(path: &str) -> &str {
    path.strip_suffix(".npy").unwrap_or(path)
}

fn no_poses(bytes: &[u8]) -> ParseError {
    let paths = container::zip_paths(bytes).unwrap_or_default();
    let mut keys: Vec<&str> = paths.iter().map(|path| key_of(path)).collect();
    keys.sort_unstable();
    keys.truncate(12);
    let found = format!("a NumPy archive without them, of {}", keys.join(", "));
    ParseError::new(
        Place::File,
        "poses of SMPL, SMPL-H or SMPL-X as AMASS has them (`poses`, or `root_orient` and `pose_body`)",
        found,
    )
}

/// Rotations of joints in one or two arrays.
struct SmplFrames<'a> {
    count: usize,
    joints: usize,
    parts: [(&'a Array, SmplLayout); 2],
}

/// Places of the numbers of a frame.
#[derive(Clone, Copy)]
struct SmplLayout {
    joints: usize,
    /// 3 for axis-angle, 9 for matrices.
    width: usize,
}

impl SmplLayout {
    fn of(array: &Array, what: &str) -> Result<Self, ParseError> {
        let (joints, width) = match array.shape[..] {
            [_, 3, 3] => (1, 9),
            [_, joints, 3, 3] => (joints, 9),
            [_, joints, 3] => (joints, 3),
            [_, numbers] if numbers % 3 == 0 && numbers > 0 => (numbers / 3, 3),
            _ => {
                let expected = format!("{what} of shape (frames, 3 × joints)");
                let found = format!("{:?}", array.shape);
                return Err(ParseError::new(Place::File, expected, found));
            }
        };
        Ok(Self { joints, width })
    }
}

impl<'a> SmplFrames<'a> {
    fn of_whole(poses: &'a Array) -> Result<Self, ParseError> {
        // (frames, joints, 3): the same numbers in the same order.
        let layout = SmplLayout::of(poses, "poses")?;
        Self::checked(
            poses.shape[0],
            (poses, layout),
            (
                poses,
                SmplLayout {
                    joints: 0,
                    ..layout
                },
            ),
        )
    }

    fn of_parts(root: &'a Array, body: &'a Array) -> Result<Self, ParseError> {
        let (first, second) = (
            SmplLayout::of(root, "root_orient")?,
            SmplLayout::of(body, "pose_body")?,
        );
        if root.shape[0] != body.shape[0] {
            let found = format!("{} and {}", root.shape[0], body.shape[0]);
            let expected = "as many frames in root_orient as in pose_body";
            return Err(ParseError::new(Place::File, expected, found));
        }
        Self::checked(root.shape[0], (root, first), (body, second))
    }

    fn checked(
        count: usize,
        first: (&'a Array, SmplLayout),
        second: (&'a Array, SmplLayout),
    ) -> Result<Self, ParseError> {
        let joints = first.1.joints + second.1.joints;
        if joints < body::JOINTS {
            let expected = format!("rotations of at least {} joints", body::JOINTS);
            return Err(ParseError::new(Place::File, expected, joints.to_string()));
        }
        if count == 0 {
            return Err(ParseError::new(Place::File, "frames in the poses", "none"));
        }
        Ok(Self {
            count,
            joints,
            parts: [first, second],
        })
    }

    /// `parent_from_joint`; `None` of numbers that are no rotation.
    fn rotation(&self, frame: usize, joint: usize) -> Option<Quat> {
        let [(first, layout), (second, other)] = self.parts;
        let (array, layout, joint) = match joint.checked_sub(layout.joints) {
            None => (first, layout, joint),
            Some(rest) => (second, other, rest),
        };
        let begin = (frame * layout.joints + joint) * layout.width;
        let numbers = array.values.get(begin..begin + layout.width)?;
        if !numbers.iter().all(|v| v.abs() < 1e6) {
            return None;
        }
        match numbers {
            [x, y, z] => Some(Quat::from_scaled_axis(Vec3::new(*x, *y, *z))),
            _ => {
                let matrix = nalgebra::Matrix3::from_row_slice(numbers);
                let turned = nalgebra::Rotation3::from_matrix_unchecked(matrix);
                let near = (matrix.determinant() - 1.0).abs() < 1e-2;
                near.then(|| Quat::new_normalize(Quat::from_rotation_matrix(&turned).into_inner()))
            }
        }
    }
}

fn rate(stated: Option<&Array>, warnings: &mut Vec<Warning>) -> f64 {
    let stated = stated
        .and_then(|array| array.values.first().copied())
        .filter(|rate| rate.is_finite() && *rate > 0.0 && *rate <= 100_000.0);
    stated.unwrap_or_else(|| {
        let text = format!("no mocap_framerate; {ASSUMED_HZ} Hz assumed");
        warnings.push(Warning::new(Place::File, text));
        ASSUMED_HZ
    })
}

/// Positions of the hips.
fn places(
    trans: Option<&Array>,
    frames: usize,
    warnings: &mut Vec<Warning>,
) -> Result<Vec<Vec3>, ParseError> {
    let Some(trans) = trans else {
        let text = "no `trans`: the hips stay at one position";
        warnings.push(Warning::new(Place::File, text));
        return Ok(vec![Vec3::zeros(); frames]);
    };
    if trans.values.len() != 3 * frames {
        let expected = format!("3 numbers of `trans` for each of {frames} frames");
        let found = format!("{:?}", trans.shape);
        return Err(ParseError::new(Place::File, expected, found));
    }
    Ok(trans
        .values
        .chunks_exact(3)
        .map(Vec3::from_column_slice)
        .collect())
}

#[cfg(test)]
mod tests;
