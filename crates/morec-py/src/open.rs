//! Clip files: from what Python names to clips.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use morec::formats::bvh::PositionChannels;
use morec::formats::probe::format_of_name;
use morec::import::ImportOptions;
use morec::roles::mapping::Mapping;
use morec_db::{FileReader, read_file, split_choice};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::prelude::*;

use crate::clip::{ClipData, PyClip};
use crate::errors::{MorecError, io_error, morec_error, value_error};
use crate::job;

/// Why a file gives no clip.
pub enum OpenError {
    /// The system does not give its bytes.
    Io(PathBuf, std::io::Error),
    /// Its bytes are not what they should be; the text names it.
    Content(String),
}

impl From<OpenError> for PyErr {
    fn from(error: OpenError) -> Self {
        match error {
            OpenError::Io(path, error) => io_error(&path, &error),
            OpenError::Content(text) => MorecError::new_err(text),
        }
    }
}

impl std::fmt::Display for OpenError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Io(path, error) => write!(f, "{}: {error}", path.display()),
            Self::Content(text) => f.write_str(text),
        }
    }
}

/// How to read, as the keyword arguments of `morec.read` say.
pub struct Reading {
    reader: FileReader,
    import: ImportOptions,
}

impl Reading {
    /// # Errors
    /// A value that says nothing: another word for `positions`, an axis that is none, roles that are none.
    pub fn new(options: &Bound<'_, PyDict>) -> PyResult<Self> {
        let (mut reader, mut up, mut unit, mut roles) =
            (FileReader::default(), None::<String>, None, None);
        for (key, value) in options.iter() {
            if value.is_none() {
                continue;
            }
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
        Ok(Self {
            reader,
            import: import_options(up.as_deref(), unit, roles.as_ref())?,
        })
    }

    /// The clips in the file at `path`.
    pub fn path(&self, path: &Path) -> Result<Vec<ClipData>, OpenError> {
        let (file, _) = split_choice(path);
        let bytes = read_file(&file).map_err(|error| OpenError::Io(file, error))?;
        self.bytes(path, &bytes, true)
    }

    /// The clips in `bytes`, which are a file's called `path`; `is_file` if it lies there.
    pub fn bytes(
        &self,
        path: &Path,
        bytes: &[u8],
        is_file: bool,
    ) -> Result<Vec<ClipData>, OpenError> {
        let wrong = |error: String| OpenError::Content(format!("{}: {error}", path.display()));
        let opened = self.reader.open(path, bytes).map_err(|e| wrong(e.to_string()))?;
        let warnings: Vec<String> = opened.warnings.iter().map(ToString::to_string).collect();
        let format = format!("{:?}", opened.format).to_lowercase();
        let ready = |clip| {
            let data = ClipData::of(clip, &self.import).map_err(|e| wrong(e.to_string()))?;
            Ok(ClipData {
                warnings: warnings.clone(),
                path: is_file.then(|| path.to_owned()),
                format: format.clone(),
                ..data
            })
        };
        opened.clips.into_iter().map(ready).collect()
    }
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
    let reading = Reading::new(options)?;
    let clips = py.detach(|| reading.path(&path))?;
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
    let reading = Reading::new(options)?;
    let clips = py.detach(|| reading.bytes(&name, bytes, false))?;
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
    let reading = Reading::new(options)?;
    let (files, mut left_out) = list(&paths)?;
    let read = job::run(py, progress, |progress| {
        let done = AtomicUsize::new(0);
        let one = |path: &PathBuf| {
            if progress.cancelled() {
                return Ok(Vec::new());
            }
            let read = reading.path(path);
            let done = done.fetch_add(1, Ordering::Relaxed) + 1;
            progress.report("reading clips", done, files.len());
            read
        };
        let read: Vec<_> = files.par_iter().map(one).collect();
        read
    })?;
    let mut clips = Vec::new();
    for result in read {
        match result {
            Ok(of_file) => clips.extend(of_file.into_iter().map(PyClip::from)),
            Err(error) => left_out.push(error.to_string()),
        }
    }
    if clips.is_empty() {
        let first = left_out.first().map_or("", String::as_str);
        return Err(morec_error(format!("no clip that can be read: {first}")));
    }
    Ok((clips, left_out))
}

/// The clip files that paths stand for.
pub fn list(paths: &[PathBuf]) -> PyResult<(Vec<PathBuf>, Vec<String>)> {
    let mut files = Vec::new();
    for path in paths {
        if !path.is_dir() {
            files.push(path.clone());
            continue;
        }
        let mut inside: Vec<PathBuf> = std::fs::read_dir(path)
            .map_err(|error| io_error(path, &error))?
            .filter_map(|entry| Some(entry.ok()?.path()))
            .filter(|path| format_of_name(&path.to_string_lossy()).is_some())
            .collect();
        inside.sort();
        files.extend(inside);
    }
    Ok((files, Vec::new()))
}
