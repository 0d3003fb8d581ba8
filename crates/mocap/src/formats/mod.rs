//! Motion-capture files: reading, writing, and telling them apart.
//!
//! Readers take bytes, never paths. What can be saved is loaded with a [`Warning`] that names the place; what
//! cannot is refused with a [`ParseError`] that says where, what was expected and what was found.

pub mod acclaim;
mod builder;
pub mod bvh;
pub mod c3d;
mod cells;
pub mod container;
pub mod csm;
pub mod deepmimic;
#[cfg(feature = "fbx")]
pub mod fbx;
pub mod gltf;
pub mod htr;
mod json;
pub mod jsonl;
mod keys;
pub mod landmarks;
mod loaded;
#[cfg(test)]
pub(crate) mod mangle;
pub mod mclip;
pub mod mocopi;
pub mod mvnx;
mod npy;
pub mod ntu;
pub mod numpy;
pub mod opensim;
mod points;
pub mod probe;
mod scene;
pub mod smd;
pub mod smpl;
pub mod table;
mod timing;
pub mod trc;
mod xml;

use crate::math::Vec3;
pub use crate::parse_error::{ParseError, Place, Warning};
pub use loaded::{Limits, Loaded};
use timing::rate_not_used;

/// Reads the formats of whole scenes and suits: [MVNX](mvnx), [glTF](gltf), FBX (feature `fbx`), [SMPL](smpl), [SMD](smd),
/// [HTR](htr), [DeepMimic](deepmimic) and [mocopi], and of points that need nothing but the file ([CSM](csm), [NTU](ntu), [landmarks], [NumPy](numpy)). `rate_hz` replaces the rate where the file holds frames; keys in seconds keep theirs. `None` for
/// other formats.
pub fn read_scene(
    format: probe::Format,
    bytes: &[u8],
    name: &str,
    rate_hz: Option<f64>,
    beside: gltf::Beside<'_>,
    limits: &Limits,
) -> Option<Result<Loaded, ParseError>> {
    use probe::Format;
    let loaded = match format {
        Format::Mvnx => mvnx::read(bytes, name, limits),
        Format::Smpl => smpl::read(bytes, name, limits),
        Format::Smd => smd::read(bytes, name, limits),
        Format::Htr => htr::read(bytes, name, limits),
        Format::Csm => csm::read(bytes, name, rate_hz, limits),
        Format::DeepMimic => deepmimic::read(bytes, name, limits),
        Format::Numpy => numpy::read(bytes, name, rate_hz, limits),
        Format::Mocopi => mocopi::read(bytes, name, limits),
        Format::Gltf => gltf::read(bytes, name, beside, limits),
        Format::NtuSkeleton => ntu::read(bytes, name, rate_hz, limits),
        Format::Landmarks => landmarks::read(bytes, name, rate_hz, limits),
        Format::Fbx => read_fbx(bytes, name, limits),
        _ => return None,
    };
    let timed = matches!(format, Format::Gltf | Format::Fbx);
    Some(loaded.map(|mut loaded| {
        match rate_hz {
            Some(_) if timed => loaded.warnings.push(rate_not_used()),
            Some(rate_hz) => loaded.clips.iter_mut().for_each(|c| c.rate_hz = rate_hz),
            None => {}
        }
        loaded
    }))
}

/// Clips of points whose positions are at hand: one, or one for each subject (`Anna:LFHD`) whose points make a body. For
/// each point its name and a position for each frame; one that is not finite was not seen. `metres_per_unit` is what is
/// known of the unit. O(points × frames).
///
/// # Errors
/// No point was ever seen, points with different numbers of positions, or more than `limits` allow.
pub fn from_positions(
    name: &str,
    rate_hz: f64,
    points: Vec<(String, Vec<Vec3>)>,
    metres_per_unit: Option<f64>,
    limits: &Limits,
) -> Result<Loaded, ParseError> {
    let frames = points.first().map_or(0, |(_, positions)| positions.len());
    let other = points
        .iter()
        .find(|(_, positions)| positions.len() != frames);
    if let Some((point, positions)) = other {
        let expected = format!("{frames} positions of each point");
        let found = format!("{} of {point}", positions.len());
        return Err(ParseError::new(Place::File, expected, found));
    }
    let point = |(name, positions)| points::Point { name, positions };
    let table = points::PointTable {
        points: points.into_iter().map(point).collect(),
        rate_hz,
        metres_per_unit,
        zero_is_missing: false,
    };
    table.into_loaded(name, Vec::new(), limits)
}

#[cfg(feature = "fbx")]
fn read_fbx(bytes: &[u8], name: &str, limits: &Limits) -> Result<Loaded, ParseError> {
    fbx::read(bytes, name, limits)
}

#[cfg(not(feature = "fbx"))]
fn read_fbx(_: &[u8], _: &str, _: &Limits) -> Result<Loaded, ParseError> {
    Err(ParseError::new(
        Place::File,
        "a format that this build reads",
        "FBX, which needs the feature `fbx`",
    ))
}
