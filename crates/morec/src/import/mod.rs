//! Making clips alike: metres, Y up, the parts of the body found, and what kind of clip it is.
//!
//! Everything is inferred from the motion itself, never from the zero pose, which need not be a pose that anybody
//! ever stood in; and everything inferred can be overridden in [`ImportOptions`].

mod axes;
mod body;
mod points;
mod rest;
mod take;
mod travel;
mod units;

pub use axes::SignedAxis;
pub use rest::rest_frames;
pub use take::Take;

use crate::clip::{Clip, Span};
use crate::formats::ParseError;
use crate::formats::probe::Format;
use crate::kinematics::WorldPose;
use crate::math::{Axis, Vec3};
use crate::roles::mapping::Mapping;
use crate::roles::{self, RoleMap};
use body::BodyMeasures;

/// What a person knows better than inference.
#[derive(Debug, Clone, Default)]
pub struct ImportOptions {
    /// Which way is up in the file.
    pub up: Option<SignedAxis>,
    /// Metres in one of the file's units of length.
    pub metres_per_unit: Option<f64>,
    /// Frames at the start that show a rest pose and not the motion.
    pub rest_frames: Option<usize>,
    /// Roles that override those found.
    pub mapping: Option<Mapping>,
    /// What the file's format states; believed where the body does not say otherwise.
    pub stated: Option<Stated>,
}

/// What the specification of a format, or a file itself, states about lengths and axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stated {
    /// Which way is up.
    pub up: SignedAxis,
    /// Metres in one unit of length.
    pub metres_per_unit: f64,
}

impl Stated {
    /// What files of `format` state by its specification; `None` for those that leave it to the writer.
    pub fn of(format: Format) -> Option<Self> {
        let up = match format {
            Format::Gltf | Format::Mocopi | Format::OpenSimMotion => SignedAxis::Y,
            Format::Mvnx => SignedAxis {
                axis: Axis::Z,
                negative: false,
            },
            _ => return None,
        };
        Some(Self {
            up,
            metres_per_unit: 1.0,
        })
    }
}

/// What was inferred about a clip, or given in the options.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct ImportReport {
    /// Which way was up in the file; it is Y in the imported clip.
    pub up: SignedAxis,
    /// Metres in one of the file's units.
    pub metres_per_unit: f64,
    /// The unit's name, if it is a known one.
    pub unit: Option<&'static str>,
    /// Frames at the start that show a rest pose: `0..1`, or `0..0` if there is none.
    pub rest_frames: Span,
    /// From the soles to the top of the head, metres, as far as the joints tell.
    pub body_height: Option<f64>,
    /// Thigh and shin together, metres.
    pub leg_length: Option<f64>,
    /// True if the hips travel along the floor; without it, root motion says nothing.
    pub travels: bool,
    /// True if joints are known to turn; a clip of points has positions alone.
    pub has_rotations: bool,
    /// The published set of points, of a clip of points that was recognised.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub point_set: Option<&'static str>,
    /// Guesses worth doubting, each in a sentence.
    pub notes: Vec<String>,
    /// What cannot be true of a person's body: recognition would be misled. Each a sentence with what to do.
    pub doubts: Vec<String>,
}

/// Infers what `clip` is and makes it Y-up in metres. Where a role is played by a place between joints (in a clip of
/// points, or by a mapping), the clip gets a joint there. O(frames · joints).
///
/// # Errors
/// A mapping in `options` that names a joint which `clip` does not have.
pub fn normalize(mut clip: Clip, options: &ImportOptions) -> Result<Take, ParseError> {
    let mut notes = Vec::new();
    let (map, point_set) = match clip.has_rotations() {
        true => (find_roles(&clip, &mut notes), None),
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
        false => roles::check(&clip.skeleton, &map, &poses(&clip)),
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
fn find_roles(clip: &Clip, notes: &mut Vec<String>) -> RoleMap {
    let found = match clip.frames {
        0 => roles::find(&clip.skeleton),
        _ => roles::find_moving(&clip.skeleton, &poses(clip)),
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

#[cfg(test)]
mod tests;
