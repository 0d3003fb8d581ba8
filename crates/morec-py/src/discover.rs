//! Sets of the same motion in clips without labels.

use morec::features::{FeatureParams, bones_of_clip, rows_of_clip};
use morec_db::ClipFilter;
use morec_ops::{DiscoverClip, DiscoverSettings, DiscoveredSets};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::clip::PyClip;
use crate::clip_data::ClipData;
use crate::database::PyDatabase;
use crate::errors::{operation_error, warn};
use crate::job;
use crate::material::keywords;
use crate::tables::table;

/// Sets in clips; a row for each repetition.
#[pyfunction]
#[pyo3(signature = (clips, progress=None, **settings))]
pub fn discover<'py>(
    py: Python<'py>,
    clips: Vec<Bound<'py, PyClip>>,
    progress: Option<&Bound<'py, PyAny>>,
    settings: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let settings: DiscoverSettings = keywords(settings)?;
    let clips: Vec<_> = clips.iter().map(|clip| clip.get().data.clone()).collect();
    let found = job::run(py, progress, |progress| {
        let clips: Vec<DiscoverClip> = clips.iter().map(|data| rowed(data)).collect();
        settings.of_clips(&clips, progress)
    })?;
    rows(py, &found.map_err(operation_error)?)
}

/// Sets in the clips of a database; a row for each repetition.
#[pyfunction]
#[pyo3(signature = (database, clip=None, progress=None, **settings))]
pub fn discover_stored<'py>(
    py: Python<'py>,
    database: &PyDatabase,
    clip: Option<String>,
    progress: Option<&Bound<'py, PyAny>>,
    settings: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let settings: DiscoverSettings = keywords(settings)?;
    let filter = ClipFilter {
        name: clip,
        ..ClipFilter::default()
    };
    let found = database.run(py, progress, |db, progress| {
        let found = settings.of_database(db, &filter, progress);
        found.map_err(operation_error)
    })?;
    rows(py, &found)
}

fn rowed(data: &ClipData) -> DiscoverClip {
    let bones = bones_of_clip(&data.clip, &data.roles, &data.rest);
    let features = FeatureParams::default();
    DiscoverClip {
        name: data.clip.name.clone(),
        id: None,
        person: None,
        bones,
        rows: rows_of_clip(&data.clip, &data.roles, &data.rest, bones, &features),
    }
}

fn rows<'py>(py: Python<'py>, found: &DiscoveredSets) -> PyResult<Bound<'py, PyAny>> {
    let mut rows = Vec::new();
    for set in &found.sets {
        for of in &set.instances {
            let row = PyDict::new(py);
            row.set_item("set", set.set)?;
            row.set_item("clip", &of.clip)?;
            row.set_item("start_secs", of.span.start_secs)?;
            row.set_item("stop_secs", of.span.stop_secs)?;
            row.set_item("distance", of.distance)?;
            rows.push(row);
        }
    }
    warn(py, found.left_out())?;
    let columns = ["set", "clip", "start_secs", "stop_secs", "distance"];
    table(py, &columns, rows)
}
