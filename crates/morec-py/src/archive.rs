//! The native part of `morec.archive`: clips kept in tables are recognised, cut and searched.

use std::path::PathBuf;

use morec::formats::{Limits, mclip};
use morec::import::Take;
use morec::index::MotionIndex;
use morec::live::{Detection, RecognizerCache};
use morec::segment::KernelParams;
use morec_db::{
    ClipId, Cutter, ImportOutcome, KeptClip, KeptFile, MotionDb, StoredClip, clip_rows,
    rows_recipe, stored_clip,
};
use numpy::PyArrayDyn;
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use rayon::prelude::*;

use crate::arrays::owned;
use crate::clip::PyClip;
use crate::clip_data::ClipData;
use crate::errors::db_error;
use crate::errors::{MorecError, value_error};
use crate::index::PyIndex;
use crate::options::reader;

/// A kept clip as a row of an archive's table of clips.
fn row<'py>(py: Python<'py>, clip: &KeptClip) -> PyResult<Bound<'py, PyDict>> {
    let row = PyDict::new(py);
    row.set_item("name", &clip.name)?;
    row.set_item("character", clip.character)?;
    row.set_item("subject", &clip.subject)?;
    row.set_item("source", &clip.source)?;
    row.set_item("licence", &clip.licence)?;
    row.set_item("tags", &clip.tags)?;
    row.set_item("frames", clip.frames)?;
    row.set_item("rate_hz", clip.rate_hz)?;
    row.set_item("secs", clip.frames as f64 / clip.rate_hz)?;
    row.set_item("rest_frames", clip.rest_frames)?;
    row.set_item("repaired_frames", clip.repaired_frames)?;
    row.set_item("joints", clip.joints)?;
    row.set_item("skeleton", PyBytes::new(py, &clip.skeleton_hash))?;
    row.set_item("roles", &clip.roles)?;
    row.set_item("facts", &clip.facts)?;
    row.set_item("max_angle_rad", clip.max_angle_rad)?;
    row.set_item("max_position_metres", clip.max_position_metres)?;
    row.set_item("motion", PyBytes::new(py, &clip.motion))?;
    row.set_item("rows_recipe", &clip.recipe)?;
    row.set_item("bones", clip.bones)?;
    row.set_item("rows", PyBytes::new(py, &clip.rows))?;
    row.set_item("file_hash", PyBytes::new(py, &clip.file.hash))?;
    row.set_item("file_path", &clip.file.path)?;
    row.set_item("file_format", &clip.file.format)?;
    row.set_item("file_bytes", clip.file.bytes)?;
    row.set_item("file_skeleton", &clip.file.skeleton)?;
    row.set_item("warnings", &clip.file.warnings)?;
    Ok(row)
}

fn kept(row: &Bound<'_, PyDict>) -> PyResult<KeptClip> {
    let get = |name: &str| -> PyResult<Bound<'_, PyAny>> {
        let value = row.get_item(name)?;
        value.ok_or_else(|| value_error(format!("a row of clips lacks the column {name}")))
    };
    let hash = |name: &str| -> PyResult<[u8; 32]> {
        let bytes: Vec<u8> = get(name)?.extract()?;
        <[u8; 32]>::try_from(bytes.as_slice())
            .map_err(|_| value_error(format!("{name}: expected 32 bytes, found {}", bytes.len())))
    };
    Ok(KeptClip {
        name: get("name")?.extract()?,
        file: KeptFile {
            hash: hash("file_hash")?,
            path: get("file_path")?.extract()?,
            format: get("file_format")?.extract()?,
            bytes: get("file_bytes")?.extract()?,
            skeleton: get("file_skeleton")?.extract()?,
            warnings: get("warnings")?.extract()?,
        },
        character: get("character")?.extract()?,
        subject: get("subject")?.extract()?,
        source: get("source")?.extract()?,
        licence: get("licence")?.extract()?,
        tags: get("tags")?.extract()?,
        frames: get("frames")?.extract()?,
        rate_hz: get("rate_hz")?.extract()?,
        rest_frames: get("rest_frames")?.extract()?,
        repaired_frames: get("repaired_frames")?.extract()?,
        joints: get("joints")?.extract()?,
        skeleton_hash: hash("skeleton")?,
        roles: get("roles")?.extract()?,
        facts: get("facts")?.extract()?,
        max_angle_rad: get("max_angle_rad")?.extract()?,
        max_position_metres: get("max_position_metres")?.extract()?,
        motion: get("motion")?.extract()?,
        recipe: get("rows_recipe")?.extract()?,
        bones: get("bones")?.extract()?,
        rows: get("rows")?.extract()?,
    })
}

/// The clips in the bytes of a file, as rows.
#[pyfunction]
pub fn keep_file<'py>(
    py: Python<'py>,
    path: PathBuf,
    bytes: &[u8],
    options: &Bound<'py, PyDict>,
) -> PyResult<Vec<Bound<'py, PyDict>>> {
    let reader = reader(options)?;
    let clips = py.detach(|| KeptClip::of_file(&path, bytes, &reader));
    clips
        .map_err(|refused| MorecError::new_err(refused.to_string()))?
        .iter()
        .map(|clip| row(py, clip))
        .collect()
}

/// Every clip of a database, as rows.
#[pyfunction]
pub fn kept_of_database<'py>(py: Python<'py>, path: PathBuf) -> PyResult<Vec<Bound<'py, PyDict>>> {
    let clips = py.detach(|| MotionDb::open(&path).and_then(|db| db.kept_clips()));
    clips
        .map_err(db_error)?
        .iter()
        .map(|clip| row(py, clip))
        .collect()
}

/// Adds rows to a database, which is made if there is none; how many clips were new.
#[pyfunction]
pub fn kept_to_database(
    py: Python<'_>,
    path: PathBuf,
    rows: Vec<Bound<'_, PyDict>>,
) -> PyResult<usize> {
    let clips: Vec<KeptClip> = rows.iter().map(kept).collect::<PyResult<_>>()?;
    let log = py.detach(|| {
        let mut db = match path.exists() {
            true => MotionDb::open(&path)?,
            false => MotionDb::create(&path)?,
        };
        db.add_kept(&clips)
    });
    let files = log.map_err(db_error)?.files;
    let new = files.iter().map(|(_, outcome)| match outcome {
        ImportOutcome::Imported { clips, .. } => clips.len(),
        _ => 0,
    });
    Ok(new.sum())
}

/// For each clip of a database the hash of its file, which of the file's clips it is, and its name.
#[pyfunction]
pub fn names_in_database<'py>(
    py: Python<'py>,
    path: PathBuf,
) -> PyResult<Vec<(Bound<'py, PyBytes>, usize, String)>> {
    let contents = py.detach(|| MotionDb::open(&path).and_then(|db| db.contents()));
    let told = |(hash, character, name): ([u8; 32], usize, String)| {
        (PyBytes::new(py, &hash), character, name)
    };
    Ok(contents.map_err(db_error)?.into_iter().map(told).collect())
}

/// A kept clip decoded.
#[pyfunction]
pub fn kept_clip(
    py: Python<'_>,
    name: &str,
    motion: &[u8],
    roles: &str,
    rest_frames: usize,
    facts: &str,
) -> PyResult<PyClip> {
    let stored = py.detach(|| stored_clip(name, motion, roles, rest_frames));
    let StoredClip { clip, roles, rest } = stored.map_err(db_error)?;
    Ok(ClipData {
        clip,
        roles,
        rest,
        facts: facts.to_owned(),
        warnings: Vec::new(),
        path: None,
        format: "mclip".to_owned(),
    }
    .into())
}

pub(crate) type EventTuple = (String, f64, f64, f64, f64);

/// A clip as rows of a table give it: motion, roles and frames of rest; without roles all is inferred.
pub(crate) type MotionColumns = (Option<Vec<u8>>, Option<String>, Option<usize>);

/// Detections of an index in kept clips, in parallel: for each clip the class, start, stop, score and report of its motions,
/// or why there is nothing to recognise.
#[pyfunction]
pub fn recognize_kept<'py>(
    py: Python<'py>,
    index: &PyIndex,
    clips: Vec<MotionColumns>,
) -> PyResult<Vec<Bound<'py, PyAny>>> {
    let index = &index.index;
    let found: Vec<Result<Vec<EventTuple>, String>> = py.detach(|| {
        let recognizers = RecognizerCache::new(&index.model);
        let one = |clip: &MotionColumns| recognized(index, &recognizers, clip);
        clips.par_iter().map(one).collect()
    });
    values_or_errors(py, found)
}

/// A list with the value of each clip, or in its place the error as text.
pub(crate) fn values_or_errors<'py, T: IntoPyObjectExt<'py>>(
    py: Python<'py>,
    found: Vec<Result<T, String>>,
) -> PyResult<Vec<Bound<'py, PyAny>>> {
    let object = |one: Result<T, String>| match one {
        Ok(value) => value.into_bound_py_any(py),
        Err(error) => error.into_bound_py_any(py),
    };
    found.into_iter().map(object).collect()
}

fn recognized(
    index: &MotionIndex,
    recognizers: &RecognizerCache,
    clip: &MotionColumns,
) -> Result<Vec<EventTuple>, String> {
    let stored = stored_motion(index, clip)?;
    let found = recognizers.recognize_clip(&stored.clip, &stored.roles, &stored.rest);
    Ok(events(index, found.map_err(|error| error.to_string())?))
}

/// The clip of a row, with the roles that `index` knows by name.
pub(crate) fn stored_motion(
    index: &MotionIndex,
    clip: &MotionColumns,
) -> Result<StoredClip, String> {
    let (motion, roles, rest_frames) = clip;
    let motion = motion.as_ref().ok_or("no motion")?;
    let mut stored = match roles {
        Some(roles) => stored_clip("clip", motion, roles, rest_frames.unwrap_or(0))
            .map_err(|error| error.to_string())?,
        None => {
            let loaded = mclip::read(motion, "clip", &Limits::default());
            let clip = loaded.map_err(|error| error.to_string())?.clips.remove(0);
            let take = Take::new(clip).map_err(|error| error.to_string())?;
            StoredClip {
                rest: take.rest().clone(),
                clip: take.clip,
                roles: take.roles,
            }
        }
    };
    index.complete_roles(&mut stored.roles, &stored.clip.skeleton);
    Ok(stored)
}

/// Detections as rows of a table hold them.
pub(crate) fn events(index: &MotionIndex, found: Vec<Detection>) -> Vec<EventTuple> {
    let event = |d: Detection| {
        let class = index.model.class_name(d.class).to_owned();
        (
            class,
            d.span.start_secs,
            d.span.stop_secs,
            d.score,
            d.reported_secs,
        )
    };
    found.into_iter().map(event).collect()
}

/// Seconds at which a kept clip is cut by kernel change points, as `morec db cut` cuts it.
#[pyfunction]
#[pyo3(signature = (bones, rows, window=None, penalty=None, least=None))]
pub fn cut_kept(
    py: Python<'_>,
    bones: i64,
    rows: &[u8],
    window: Option<f64>,
    penalty: Option<f64>,
    least: Option<f64>,
) -> PyResult<Vec<f64>> {
    let default = KernelParams::default();
    let cutter = Cutter::Kernel(KernelParams {
        window_secs: window.unwrap_or(default.window_secs),
        penalty: penalty.unwrap_or(default.penalty),
        least_secs: least.unwrap_or(default.least_secs),
        ..default
    });
    let cuts = py.detach(|| match clip_rows(ClipId(0), bones, rows) {
        Some(rows) => cutter.cuts(&rows, || Err(morec_db::DbError::Cancelled)),
        None => Ok(Vec::new()),
    });
    cuts.map_err(db_error)
}

/// The feature rows of a kept clip, float32 of shape (ticks, columns); no column if it shows no bone.
#[pyfunction]
pub fn rows_kept<'py>(
    py: Python<'py>,
    bones: i64,
    rows: &[u8],
) -> PyResult<Bound<'py, PyArrayDyn<f32>>> {
    match clip_rows(ClipId(0), bones, rows) {
        Some(rows) => {
            let shape = [rows.rows.len(), rows.rows.dim()];
            owned(py, rows.rows.into_values(), &shape)
        }
        None => owned(py, Vec::new(), &[0, 0]),
    }
}

/// The present recipe of feature rows.
#[pyfunction]
pub fn present_recipe() -> String {
    rows_recipe()
}

/// Adds what this module has.
pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(keep_file, module)?)?;
    module.add_function(wrap_pyfunction!(kept_of_database, module)?)?;
    module.add_function(wrap_pyfunction!(kept_to_database, module)?)?;
    module.add_function(wrap_pyfunction!(kept_clip, module)?)?;
    module.add_function(wrap_pyfunction!(names_in_database, module)?)?;
    module.add_function(wrap_pyfunction!(recognize_kept, module)?)?;
    module.add_function(wrap_pyfunction!(cut_kept, module)?)?;
    module.add_function(wrap_pyfunction!(rows_kept, module)?)?;
    module.add_function(wrap_pyfunction!(present_recipe, module)?)?;
    Ok(())
}
