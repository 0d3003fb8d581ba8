//! Recognition with an index that is divided by classes among workers.

use morec::live::{match_clip, recognize_matched};
use morec::templates::ClassMatches;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use rayon::prelude::*;

use crate::archive::{EventTuple, MotionColumns, events, stored_motion, values_or_errors};
use crate::index::PyIndex;
use crate::parts::templates;

/// Matches of a part of an index in kept clips, in parallel: for each clip their bytes, or why there are none.
#[pyfunction]
pub fn match_kept<'py>(
    py: Python<'py>,
    part: &PyIndex,
    clips: Vec<MotionColumns>,
) -> PyResult<Vec<Bound<'py, PyAny>>> {
    let index = &part.index;
    let model = templates(index)?;
    let one = |clip: &MotionColumns| {
        let stored = stored_motion(index, clip)?;
        let matches = match_clip(model, &stored.clip, &stored.roles, &stored.rest);
        Ok(matches.map_err(|error| error.to_string())?.to_bytes())
    };
    let found: Vec<Result<Vec<u8>, String>> = py.detach(|| clips.par_iter().map(one).collect());
    let found = found.into_iter();
    let bytes = found.map(|one| one.map(|bytes| PyBytes::new(py, &bytes).unbind()));
    values_or_errors(py, bytes.collect())
}

/// Detections of an index in kept clips, decided between the matches of all its parts; `first` is the first part. For
/// each the class, start, stop, score and report of its motions, or why there is nothing to recognise.
#[pyfunction]
pub fn recognize_matched_kept<'py>(
    py: Python<'py>,
    first: &PyIndex,
    clips: Vec<(MotionColumns, Vec<Vec<u8>>)>,
) -> PyResult<Vec<Bound<'py, PyAny>>> {
    let index = &first.index;
    let model = templates(index)?;
    let one = |(clip, matches): &(MotionColumns, Vec<Vec<u8>>)| {
        let parts = matches.iter().map(|bytes| ClassMatches::from_bytes(bytes));
        let parts = parts.collect::<Result<Vec<_>, _>>();
        let merged = parts.and_then(ClassMatches::merge);
        let merged = merged.map_err(|error| error.to_string())?;
        let stored = stored_motion(index, clip)?;
        let found = recognize_matched(model, merged, &stored.clip, &stored.roles, &stored.rest);
        Ok(events(index, found.map_err(|error| error.to_string())?))
    };
    let found: Vec<Result<Vec<EventTuple>, String>> =
        py.detach(|| clips.par_iter().map(one).collect());
    values_or_errors(py, found)
}
