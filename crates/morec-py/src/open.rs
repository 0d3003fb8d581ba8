//! Clip files: from what Python names to clips.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use morec::files::{ClipFile, FileError, FileErrorKind, FileReader, list};
use morec::formats::bvh::PositionChannels;
use morec::import::ImportOptions;
use morec::roles::mapping::Mapping;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::prelude::*;

use crate::clip::{ClipData, PyClip};
use crate::errors::{file_error, value_error};
use crate::job;

/// How to read, as the keyword arguments of `morec.read` say.
///
/// # Errors
/// A value that says nothing: another word for `positions`, an axis that is none, roles that are none.
pub fn reader(options: &Bound<'_, PyDict>) -> PyResult<FileReader> {
    let mut reader = FileReader::default();
    let (mut up, mut unit, mut roles) = (None::<String>, None, None);
    for (key, value) in options.iter() {
        match key.extract::<String>()?.as_str() {
            "skeleton" => reader.skeleton = Some(value.extract()?),
            "file_rate" => reader.rate_hz = Some(rate("file_rate", value.extract()?)?),
            "positions" => reader.positions = Some(channels(&value.extract::<String>()?)?),
            "up" => up = Some(value.extract()?),
            "unit" => unit = Some(value.extract()?),
            "roles" => roles = Some(value),
            other => return Err(value_error(format!("no option is called {other}"))),
        }
    }
    reader.import = import_options(up.as_deref(), unit, roles.as_ref())?;
    Ok(reader)
}

/// The clips of a file that was parsed, `path` being where it lies if it lies anywhere.
fn clips(
    reader: &FileReader,
    path: &Path,
    parsed: ClipFile,
    is_file: bool,
) -> Result<Vec<ClipData>, FileError> {
    let format = parsed.format.name();
    let takes = parsed.into_takes(&reader.import);
    let takes = takes.map_err(|error| FileErrorKind::Parse(error).at(path))?;
    let ready = |take| ClipData {
        path: is_file.then(|| path.to_owned()),
        format: format.to_owned(),
        ..ClipData::from(take)
    };
    Ok(takes.into_iter().map(ready).collect())
}

fn open(reader: &FileReader, path: &Path) -> Result<Vec<ClipData>, FileError> {
    clips(reader, path, reader.read(path)?, true)
}

fn rate(name: &str, rate_hz: f64) -> PyResult<f64> {
    match rate_hz.is_finite() && rate_hz > 0.0 && rate_hz <= 100_000.0 {
        true => Ok(rate_hz),
        false => Err(value_error(format!(
            "{name}: expected a rate in Hz, above 0 and at most 100000, found {rate_hz}"
        ))),
    }
}

fn channels(word: &str) -> PyResult<PositionChannels> {
    match word {
        "replace" => Ok(PositionChannels::Replace),
        "add" => Ok(PositionChannels::Add),
        _ => Err(value_error(format!(
            "positions: expected \"replace\" or \"add\", found {word:?}"
        ))),
    }
}

/// What a person knows better than inference: the axis that is up, metres in a unit, and roles, as the text of a mapping
/// file or a dictionary of role to joint (`"LKNE+LKNM"` for the middle of two, `None` for nobody).
///
/// # Errors
/// An axis or a unit that is none, a role that is not known.
pub fn import_options(
    up: Option<&str>,
    unit: Option<f64>,
    roles: Option<&Bound<'_, PyAny>>,
) -> PyResult<ImportOptions> {
    if let Some(unit) = unit.filter(|unit| !(unit.is_finite() && *unit > 0.0)) {
        return Err(value_error(format!(
            "unit: expected metres above 0, found {unit}"
        )));
    }
    Ok(ImportOptions {
        up: up
            .map(|axis| axis.parse().map_err(|e| value_error(format!("up: {e}"))))
            .transpose()?,
        metres_per_unit: unit,
        mapping: roles.map(mapping).transpose()?,
        ..ImportOptions::default()
    })
}

/// Roles as a dictionary or as the text of a mapping file.
pub fn mapping(roles: &Bound<'_, PyAny>) -> PyResult<Mapping> {
    let text = match roles.cast::<PyDict>() {
        Ok(dict) => {
            let mut text = String::new();
            for (role, joint) in dict.iter() {
                let joint: Option<String> = joint.extract()?;
                let role: String = role.extract()?;
                text += &format!("{role}\t{}\n", joint.as_deref().unwrap_or("-"));
            }
            text
        }
        Err(_) => roles.extract()?,
    };
    Mapping::read(text.as_bytes()).map_err(|error| value_error(format!("roles: {error}")))
}

/// All clips in the file at `path`.
#[pyfunction]
pub fn read_path(
    py: Python<'_>,
    path: PathBuf,
    options: &Bound<'_, PyDict>,
) -> PyResult<Vec<PyClip>> {
    let reader = reader(options)?;
    let clips = py.detach(|| open(&reader, &path));
    let clips = clips.map_err(|error| file_error(&error))?;
    Ok(clips.into_iter().map(PyClip::from).collect())
}

/// All clips in bytes that are a file's called `name`.
#[pyfunction]
pub fn read_bytes(
    py: Python<'_>,
    bytes: &[u8],
    name: PathBuf,
    options: &Bound<'_, PyDict>,
) -> PyResult<Vec<PyClip>> {
    let reader = reader(options)?;
    let read = || clips(&reader, &name, reader.parse(&name, bytes)?, false);
    let clips = py.detach(read).map_err(|error| file_error(&error))?;
    Ok(clips.into_iter().map(PyClip::from).collect())
}

/// The clips of files and folders, and a sentence for each file that was left out.
#[pyfunction]
#[pyo3(signature = (paths, options, progress=None))]
pub fn read_folder(
    py: Python<'_>,
    paths: Vec<PathBuf>,
    options: &Bound<'_, PyDict>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<(Vec<PyClip>, Vec<String>)> {
    let reader = reader(options)?;
    let listing = list(&paths).map_err(|error| file_error(&error))?;
    let files = &listing.clips;
    let read = job::run(py, progress, |progress| {
        let done = AtomicUsize::new(0);
        let one = |path: &PathBuf| {
            if progress.cancelled() {
                return Ok(Vec::new());
            }
            let read = open(&reader, path);
            let done = done.fetch_add(1, Ordering::Relaxed) + 1;
            progress.report("reading clips", done, files.len());
            read
        };
        files.par_iter().map(one).collect::<Vec<_>>()
    })?;
    let mut clips = Vec::new();
    let mut left_out: Vec<String> = listing.left_out.iter().map(ToString::to_string).collect();
    let mut first = None;
    for result in read {
        match result {
            Ok(of_file) => clips.extend(of_file.into_iter().map(PyClip::from)),
            Err(error) => {
                left_out.push(error.to_string());
                first.get_or_insert(error);
            }
        }
    }
    match first.filter(|_| clips.is_empty()) {
        Some(error) => Err(file_error(&error)),
        None => Ok((clips, left_out)),
    }
}
