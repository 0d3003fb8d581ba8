//! Poses in HDF5: tables of pandas, as DeepLabCut and Anipose write them, series of poses in NWB, and arrays of positions, as
//! SLEAP's users write them.
//!
//! Tables become the text that pandas would write as CSV, and are read as such: one meaning for both. Arrays are read as those of
//! [`numpy`](super::numpy). Links out of the file are not followed.

mod nwb;
mod pandas;

use hdf5_pure::{AttrValue, Dataset, File, Group, VlenStringReadOptions};

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
    read_as(bytes, name, rate_hz, limits, false)
}

/// [`read`]; with `planar`, of points in two dimensions too, whose z is 0.
pub(super) fn read_as(
    bytes: &[u8],
    name: &str,
    rate_hz: Option<f64>,
    limits: &Limits,
    planar: bool,
) -> Result<Loaded, ParseError> {
    let limits = limits.of_packed(bytes.len()).without(bytes.len())?;
    let file = File::from_bytes(bytes.to_vec()).map_err(damaged)?;
    let tree = Tree::of(file, limits)?;
    if let Some(text) = pandas::as_csv(&tree)? {
        let limits = tree.limits.without(text.len())?;
        return table::read_as(text.as_bytes(), name, rate_hz, &limits, planar);
    }
    if let Some(timed) = nwb::series(&tree, rate_hz)? {
        return timed.into_loaded(name, Vec::new(), &tree.limits);
    }
    let archive = arrays(&tree)?;
    if !archive.numbers.contains_key(numpy::POSITION) {
        return Err(no_poses(&tree));
    }
    numpy::of_arrays(&archive, bytes.len(), name, rate_hz, &tree.limits, planar)
}

/// The groups and arrays of a file.
struct Tree {
    file: File,
    /// Paths without the first slash; the root is empty.
    groups: Vec<String>,
    arrays: Vec<String>,
    limits: Limits,
}

/// More groups and arrays are no recording of poses.
const MOST_OBJECTS: usize = 20_000;
/// Groups within groups.
const DEEPEST: usize = 12;
/// Texts of an array, of this many bytes in all.
const MOST_TEXT: usize = 1 << 24;

impl Tree {
    fn of(file: File, limits: Limits) -> Result<Self, ParseError> {
        let (mut groups, mut arrays) = (vec![String::new()], Vec::new());
        let mut at = 0;
        while let Some(path) = groups.get(at).cloned() {
            at += 1;
            let group = group_at(&file, &path)?;
            let below = |name: String| match path.as_str() {
                "" => name,
                path => format!("{path}/{name}"),
            };
            // A group whose links cannot be read keeps nothing from the others.
            arrays.extend(group.datasets().unwrap_or_default().into_iter().map(below));
            if path.matches('/').count() < DEEPEST {
                let inner = group.groups().unwrap_or_default();
                // Indexes of PyTables are no data.
                let inner = inner.into_iter().filter(|name| !name.starts_with("_i_"));
                groups.extend(inner.map(below));
            }
            if groups.len() + arrays.len() > MOST_OBJECTS {
                let expected = format!("at most {MOST_OBJECTS} groups and arrays");
                return Err(ParseError::new(Place::File, expected, "more"));
            }
        }
        Ok(Self {
            file,
            groups,
            arrays,
            limits,
        })
    }

    fn group(&self, path: &str) -> Result<Group, ParseError> {
        group_at(&self.file, path)
    }

    /// The array at a path; `None` if there is none.
    fn array(&self, path: &str) -> Option<Dataset> {
        self.file.dataset(path).ok()
    }

    /// The numbers of an array with its shape; `None` if there is none.
    fn numbers(&self, path: &str) -> Result<Option<Array>, ParseError> {
        let Some(dataset) = self.array(path) else {
            return Ok(None);
        };
        let shape = self.affordable(&dataset)?;
        let values = dataset.read_f64().map_err(damaged)?;
        Ok(Some(Array { shape, values }))
    }

    /// The bytes of an array as they are stored.
    fn raw(&self, dataset: &Dataset) -> Result<Vec<u8>, ParseError> {
        self.affordable(dataset)?;
        dataset.read_raw().map_err(damaged)
    }

    /// The texts of an array; `None` if there is none, or of something else.
    fn texts(&self, path: &str) -> Option<Vec<String>> {
        let dataset = self.array(path)?;
        self.affordable(&dataset).ok()?;
        let options = VlenStringReadOptions::default();
        let texts = match dataset.vlen_string_payload_size() {
            Ok(bytes) if bytes > MOST_TEXT as u64 => return None,
            Ok(_) => dataset.read_vlen_strings(options).ok()?,
            Err(_) => dataset.read_string().ok()?,
        };
        let bare = |text: String| text.trim_matches(['\0', ' ']).to_owned();
        Some(texts.into_iter().map(bare).collect())
    }

    /// The shape of an array that memory is there for, its packed pieces among it.
    fn affordable(&self, dataset: &Dataset) -> Result<Vec<usize>, ParseError> {
        let shape = dataset.shape().map_err(damaged)?;
        let each = dataset.element_size().map_err(damaged)? as usize;
        let count = |shape: &[u64]| {
            let sizes = shape
                .iter()
                .map(|&size| usize::try_from(size).unwrap_or(usize::MAX));
            sizes.fold(1, usize::saturating_mul)
        };
        let piece = dataset.chunk_shape().map_err(damaged)?.unwrap_or_default();
        let values = count(&shape).max(count(&piece));
        self.limits.afford(values, 2 * each.max(size_of::<f64>()))?;
        Ok(shape.iter().map(|&size| size as usize).collect())
    }
}

fn group_at(file: &File, path: &str) -> Result<Group, ParseError> {
    match path {
        "" => Ok(file.root()),
        path => file.group(path).map_err(damaged),
    }
}

fn damaged(error: hdf5_pure::Error) -> ParseError {
    ParseError::new(Place::File, "an HDF5 file that is whole", error.to_string())
}

/// The text of an attribute.
fn text_of(value: Option<&AttrValue>) -> Option<&str> {
    value?.as_str().map(|text| text.trim_end_matches('\0'))
}

/// Arrays by the keys that [`numpy`] knows: positions, names, times and rates wherever they are.
fn arrays(tree: &Tree) -> Result<ArrayArchive, ParseError> {
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

fn no_poses(tree: &Tree) -> ParseError {
    const SHOWN: usize = 6;
    let expected = "a table of pandas (DeepLabCut, Anipose), poses of NWB or an array of positions (`tracks`, `positions`)";
    let ends = |name: &str| tree.arrays.iter().any(|path| path == name);
    let found = if ends("instances") && ends("frames") {
        "labels of SLEAP, whose points lie in pictures: triangulate them (sleap-anipose), or export the analysis".to_owned()
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
