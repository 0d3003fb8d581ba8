//! Turns a clip in its file's units and axes into a take: metres, Y up, with roles.

use crate::clip::Clip;
use crate::formats::bvh::{self, BvhOptions};
use crate::formats::{Limits, ParseError, Place, Warning};
use crate::kinematics::WorldPose;
use crate::math::Vec3;
use crate::roles::{self, JointNames, RoleMap};

use super::body::BodyMeasures;
use super::options::ImportOptions;
use super::report::ImportReport;
use super::rest::rest_frames;
use super::take::Take;
use super::{axes, points, travel, units};

/// Infers what `clip` is and makes it Y-up in metres. Where a role is played by a place between joints (in a clip of
/// points, or by a mapping), the clip gets a joint there. O(frames · joints).
///
/// # Errors
/// A mapping in `options` that names a joint which `clip` does not have.
pub fn normalize(mut clip: Clip, options: &ImportOptions) -> Result<Take, ParseError> {
    let mut notes = Vec::new();
    let mut names = JointNames::of(&clip.skeleton);
    let mut posed = Vec::new();
    let (map, point_set) = match clip.has_rotations() {
        true => {
            posed = poses(&clip);
            (find_roles(&clip, &names, &posed, &mut notes), None)
        }
        false => points::find_roles(&mut clip),
    };
    let map = match &options.mapping {
        Some(mapping) => points::apply(mapping, &mut clip, map)?,
        None => map,
    };
    let body = BodyMeasures::measure(&clip, &map);
    let up = options
        .up
        .unwrap_or_else(|| axes::choose(&clip, &body, options.stated, &mut notes));
    let metres_per_unit = options
        .metres_per_unit
        .unwrap_or_else(|| units::choose(&clip, &body, up, options.stated, &mut notes));
    let unknown = !clip.has_rotations() && point_set.is_none() && options.mapping.is_none();
    let mut doubts = match unknown {
        true => vec![points::UNKNOWN.to_owned()],
        false => {
            names.extend(&clip.skeleton);
            // A mapping adds joints in places between others.
            if posed.first().map(Vec::len) != Some(clip.skeleton.len()) {
                posed = poses(&clip);
            }
            roles::check_named(&clip.skeleton, &names, &map, &posed)
        }
    };
    doubts.extend(units::doubt(&body, metres_per_unit));
    axes::turn_up(&mut clip, up);
    units::scale(&mut clip, metres_per_unit);
    let rest = match options.rest_frames {
        Some(frames) => 0..frames.min(clip.frames),
        None => rest_frames(&clip, &map),
    };
    let report = ImportReport {
        up,
        metres_per_unit,
        unit: units::name(metres_per_unit),
        body_height: body.height(up).map(|height| height * metres_per_unit),
        leg_length: body.leg.map(|leg| leg * metres_per_unit),
        travels: travel::travels(&clip, &map, &rest),
        rest_frames: rest,
        has_rotations: clip.has_rotations(),
        point_set,
        notes,
        doubts,
    };
    Ok(Take {
        clip,
        roles: map,
        report,
        warnings: Vec::new(),
    })
}

/// The roles, judged in frames spread over the clip.
fn find_roles(
    clip: &Clip,
    names: &JointNames,
    posed: &[Vec<Vec3>],
    notes: &mut Vec<String>,
) -> RoleMap {
    let found = match posed {
        [] => roles::find_named(&clip.skeleton, names, &[roles::zero_pose(&clip.skeleton)]),
        posed => roles::find_named(&clip.skeleton, names, posed),
    };
    notes.extend(found.notes);
    found.map
}

/// World positions of every joint in some frames spread over the clip.
fn poses(clip: &Clip) -> Vec<Vec<Vec3>> {
    const FRAMES: usize = 12;
    // The first frame may be a rest pose or spoiled.
    let first = 1.min(clip.frames.saturating_sub(1));
    let step = (clip.frames - first).div_ceil(FRAMES).max(1);
    (first..clip.frames)
        .step_by(step)
        .map(|frame| WorldPose::of(clip, frame).positions)
        .collect()
}

impl Take {
    /// Infers what `clip` is and makes it ready, as [`normalize`] with its defaults.
    ///
    /// # Errors
    /// None at present: only a mapping of roles, which the defaults lack, can be wrong.
    pub fn new(clip: Clip) -> Result<Self, ParseError> {
        normalize(clip, &ImportOptions::default())
    }

    /// The first clip in the bytes of a BVH file; further characters are named in [`warnings`](Self::warnings). Its name
    /// is `clip`: see [`named`](Self::named).
    ///
    /// # Errors
    /// Bytes that are no BVH, or too damaged to be read.
    pub fn from_bvh(bytes: &[u8]) -> Result<Self, ParseError> {
        let loaded = bvh::read(bytes, "clip", &BvhOptions::default(), &Limits::default())?;
        let mut clips = loaded.clips.into_iter();
        let none = || ParseError::new(Place::File, "a character", "none");
        let mut take = normalize(clips.next().ok_or_else(none)?, &ImportOptions::default())?;
        take.warnings = loaded.warnings;
        for other in clips {
            let text = format!("a second character, {}, left out", other.name);
            take.warnings.push(Warning::new(Place::File, text));
        }
        Ok(take.named("clip"))
    }
}
