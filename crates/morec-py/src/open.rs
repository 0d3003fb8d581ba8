//! Reads clips from paths, bytes and open files of Python.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use morec::files::{ClipFile, FileError, FileErrorKind, FileReader, list};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::prelude::*;

use crate::clip::PyClip;
use crate::clip_data::ClipData;
use crate::errors::file_error;
use crate::job;
use crate::options::reader;

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
