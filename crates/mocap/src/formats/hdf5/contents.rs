//! The groups and arrays of an HDF5 file, within limits.

use hdf5_pure::{AttrValue, Dataset, File, Group, VlenStringReadOptions};

use crate::formats::npy::Array;
use crate::formats::{Limits, ParseError, Place};

/// The groups and arrays of a file.
pub(super) struct Hdf5Contents {
    file: File,
    /// Paths without the first slash; the root is empty.
    pub(super) groups: Vec<String>,
    pub(super) arrays: Vec<String>,
    pub(super) limits: Limits,
}

/// More groups and arrays are no recording of poses.
const MOST_OBJECTS: usize = 20_000;
/// Groups within groups.
const DEEPEST: usize = 12;
/// Texts of an array, of this many bytes in all.
const MOST_TEXT: usize = 1 << 24;

impl Hdf5Contents {
    pub(super) fn of(file: File, limits: Limits) -> Result<Self, ParseError> {
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

    pub(super) fn group(&self, path: &str) -> Result<Group, ParseError> {
        group_at(&self.file, path)
    }

    /// The array at a path; `None` if the path names no array.
    pub(super) fn array(&self, path: &str) -> Option<Dataset> {
        self.file.dataset(path).ok()
    }

    /// Numbers and shape of the array at a path; `None` if the path names no array.
    pub(super) fn numbers(&self, path: &str) -> Result<Option<Array>, ParseError> {
        let Some(dataset) = self.array(path) else {
            return Ok(None);
        };
        let shape = self.affordable(&dataset)?;
        let values = dataset.read_f64().map_err(damaged)?;
        Ok(Some(Array { shape, values }))
    }

    /// The bytes of an array as they are stored.
    pub(super) fn raw(&self, dataset: &Dataset) -> Result<Vec<u8>, ParseError> {
        self.affordable(dataset)?;
        dataset.read_raw().map_err(damaged)
    }

    /// Strings of the array at a path; `None` if the path names no array, or an array of another type.
    pub(super) fn texts(&self, path: &str) -> Option<Vec<String>> {
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

pub(super) fn damaged(error: hdf5_pure::Error) -> ParseError {
    ParseError::new(Place::File, "an HDF5 file that is whole", error.to_string())
}

/// The text of an attribute.
pub(super) fn text_of(value: Option<&AttrValue>) -> Option<&str> {
    value?.as_str().map(|text| text.trim_end_matches('\0'))
}
