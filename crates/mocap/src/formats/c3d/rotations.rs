//! Segments of a body instead of points, with position and rotation, as Theia and Visual3D write them.
//!
//! After C-Motion's description of the group ROTATION: for each segment of each frame the 16 numbers of a matrix by columns, whose
//! fourth holds the place, and a residual, which is negative if the segment was not seen.

use super::header::C3dHeader;
use super::layout::frame_counts;
use super::params::{BLOCK, Parameters};
use crate::formats::points::{Point, UNSEEN, check_size};
use crate::formats::{Limits, ParseError, Place, Warning};
use crate::math::Vec3;

/// Numbers of a segment in a frame.
const NUMBERS: usize = 17;
/// The first number of a segment's place.
const PLACE: usize = 12;

/// Where the segments of each frame begin, as points, and how many frames there are for each of the points'; `None` of a file without
/// segments. How segments are turned is not read.
///
/// # Errors
/// No frames, or more than `limits` allow.
pub(super) fn origins(
    bytes: &[u8],
    header: &C3dHeader,
    parameters: &Parameters,
    limits: &Limits,
    warnings: &mut Vec<Warning>,
) -> Result<Option<(Vec<Point>, f64)>, ParseError> {
    let number = |name| parameters.number("ROTATION", name).unwrap_or(0.0);
    let count = |name| number(name).clamp(0.0, 1e6) as usize;
    let (segments, block) = (count("USED"), count("DATA_START"));
    if segments == 0 || block < 2 {
        return Ok(None);
    }
    let ratio = count("RATIO").max(1);
    let data = bytes.get((block - 1) * BLOCK..).unwrap_or_default();
    let frame_bytes = 4 * NUMBERS * segments;
    let stated = frame_counts(header, parameters)[0].saturating_mul(ratio);
    let most = data.len() / frame_bytes;
    let frames = if stated == 0 { most } else { stated.min(most) };
    if frames < stated {
        let text = format!("the file ends after {frames} of {stated} frames");
        warnings.push(Warning::new(Place::Byte(bytes.len() as u64), text));
    }
    if frames == 0 {
        let at = Place::Byte(((block - 1) * BLOCK) as u64);
        return Err(ParseError::new(at, "frames of segments", "none"));
    }
    check_size(segments, frames, bytes.len(), limits)?;
    let labels = parameters.all_texts("ROTATION", "LABELS");
    let name = |segment: usize| {
        let label = labels.get(segment).filter(|label| !label.is_empty());
        let bare = |label: &String| {
            let cut = label.len().saturating_sub("_4X4".len());
            let is_kind = label
                .get(cut..)
                .is_some_and(|end| end.eq_ignore_ascii_case("_4X4"));
            label[..if is_kind { cut } else { label.len() }].to_owned()
        };
        label.map_or_else(|| format!("segment {}", segment + 1), bare)
    };
    let place = |frame: usize, segment: usize| {
        let at = |number: usize| {
            let at = frame * frame_bytes + 4 * (NUMBERS * segment + number);
            match data.get(at..at + 4) {
                Some(&[a, b, c, d]) => parameters.processor.f32([a, b, c, d]),
                _ => f64::NAN,
            }
        };
        match at(NUMBERS - 1) < 0.0 {
            true => UNSEEN,
            false => Vec3::new(at(PLACE), at(PLACE + 1), at(PLACE + 2)),
        }
    };
    let point = |segment: usize| Point {
        name: name(segment),
        positions: (0..frames).map(|frame| place(frame, segment)).collect(),
    };
    let text = format!(
        "no points, but {segments} segments, of which the origins are read and the rotations are not"
    );
    warnings.push(Warning::new(Place::File, text));
    Ok(Some(((0..segments).map(point).collect(), ratio as f64)))
}
