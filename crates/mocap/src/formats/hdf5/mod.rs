//! Poses in HDF5: tables of pandas, as DeepLabCut and Anipose write them, series of poses in NWB, and arrays of positions, as
//! SLEAP's users write them.
//!
//! A pandas table is converted to CSV and read by the reader of tables, so that both have one meaning. Arrays are read as those of
//! [`numpy`]. Links out of the file are not followed.

mod contents;
mod nwb;
mod pandas;

use hdf5_pure::File;

use self::contents::{Hdf5Contents, damaged};
use super::descriptor::FormatInput;
use super::npy::Array;
use super::numpy::{self, ArrayArchive};
use super::{Limits, Loaded, ParseError, Place, table};

/// Reads the poses of an HDF5 file: clips of points called `name`. `rate_hz` replaces the rate in the file. O(bytes).
///
/// # Errors
/// The cause: no HDF5 file, no poses in it, points in two dimensions, more than `limits` allow.
pub fn read(
    bytes: &[u8],
    name: &str,
    rate_hz: Option<f64>,
    limits: &Limits,
) -> Result<Loaded, ParseError> {
    read_as(&FormatInput::alone(bytes, name, rate_hz, limits))
}

/// [`read`]; of points in two dimensions too if `planar` is set, whose z is 0.
pub(super) fn read_as(input: &FormatInput<'_>) -> Result<Loaded, ParseError> {
    let size = input.bytes.len();
    let limits = input.limits.of_packed(size).without(size)?;
    let file = File::from_bytes(input.bytes.to_vec()).map_err(damaged)?;
    let tree = Hdf5Contents::of(file, limits)?;
    if let Some(text) = pandas::as_csv(&tree)? {
        let limits = tree.limits.without(text.len())?;
        return table::read_as(&FormatInput {
            bytes: text.as_bytes(),
            limits: &limits,
            ..*input
        });
    }
    if let Some(timed) = nwb::series(&tree, input.rate_hz)? {
        return timed.into_loaded(input.name, Vec::new(), &tree.limits);
    }
    let archive = arrays(&tree)?;
    if !archive.numbers.contains_key(numpy::POSITION) {
        return Err(no_poses(&tree));
    }
    numpy::of_arrays(&archive, input, &tree.limits)
}

/// Arrays by the keys that [`numpy`] knows: positions, names, times and rates wherever they are.
fn arrays(tree: &Hdf5Contents) -> Result<ArrayArchive, ParseError> {
    /// What SLEAP and programs around it call them.
    const POSITIONS: [&str; 5] = ["tracks", "points3d", "points_3d", "pose_3d", "coords"];
    const NAMES: [&str; 3] = ["node_names", "nodes", "bodyparts"];
    let mut archive = ArrayArchive::default();
    for path in &tree.arrays {
        let key = path.rsplit('/').next().unwrap_or(path).to_lowercase();
        let is = |keys: &[&str]| keys.contains(&key.as_str());
        if (is(&NAMES) || numpy::is_name(&key))
            && let Some(texts) = tree.texts(path)
        {
            archive.texts.entry(numpy::NAME.to_owned()).or_insert(texts);
        } else if (is(&POSITIONS) || numpy::is_number(&key))
            && let Some(array) = tree.numbers(path)?
        {
            // Rates and times have one axis at most.
            let is_place = array.shape.len() > 1;
            let key = if is_place {
                numpy::POSITION.to_owned()
            } else {
                key
            };
            archive.numbers.entry(key).or_insert(points_last(array));
        }
    }
    Ok(archive)
}

/// SLEAP's order of (tracks, axes, nodes, frames) as (frames, tracks, nodes, axes).
fn points_last(array: Array) -> Array {
    let [tracks, axes @ 2..=3, nodes, frames] = array.shape[..] else {
        return array;
    };
    if (2..=3).contains(&frames) && frames != axes
        || tracks * axes * nodes * frames != array.values.len()
    {
        return array;
    }
    let mut values = Vec::with_capacity(array.values.len());
    for frame in 0..frames {
        for track in 0..tracks {
            for node in 0..nodes {
                let at = |axis: usize| ((track * axes + axis) * nodes + node) * frames + frame;
                values.extend((0..axes).map(|axis| array.values[at(axis)]));
            }
        }
    }
    Array {
        shape: vec![frames, tracks, nodes, axes],
        values,
    }
}

fn no_poses(tree: &Hdf5Contents) -> ParseError {
    const SHOWN: usize = 6;
    let expected = "a table of pandas (DeepLabCut, Anipose), poses of NWB or an array of positions (`tracks`, `positions`)";
    let ends = |name: &str| tree.arrays.iter().any(|path| path == name);
    let found = if ends("instances") && ends("frames") {
        "labels of SLEAP, whose points are image coordinates: triangulate them (sleap-anipose), or export the analysis".to_owned()
    } else if tree.arrays.is_empty() {
        "no array".to_owned()
    } else {
        let shown: Vec<&str> = tree.arrays.iter().take(SHOWN).map(String::as_str).collect();
        let more = if tree.arrays.len() > SHOWN {
            ", …"
        } else {
            ""
        };
        format!(
            "`{}{more}`: save positions as a table or in an .npz",
            shown.join("`, `")
        )
    };
    ParseError::new(Place::File, expected, found)
}

#[cfg(test)]
mod tests;
