//! The native part of the Python package `morec`. Parts that are simpler in Python are in `python/morec`.

mod archive;
mod archive_search;
mod arrays;
mod clip;
mod clip_data;
mod crossval;
mod database;
mod discover;
mod divided;
mod errors;
mod evaluate;
mod features;
mod index;
mod job;
mod labels;
mod live;
mod material;
mod open;
mod options;
mod parts;
mod recognizer;
mod segment;
mod state;
mod synth;
mod tables;
mod train;

use pyo3::prelude::*;

/// The native part of the package `morec`.
#[pymodule]
fn _morec(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("ROLES", features::role_names())?;
    errors::register(module)?;
    module.add_class::<clip::PyClip>()?;
    module.add_class::<index::PyIndex>()?;
    module.add_class::<live::LiveSession>()?;
    module.add_class::<recognizer::PyRecognizer>()?;
    module.add_class::<crossval::PyCrossval>()?;
    module.add_class::<database::PyDatabase>()?;
    module.add_function(wrap_pyfunction!(open::read_path, module)?)?;
    module.add_function(wrap_pyfunction!(open::read_bytes, module)?)?;
    module.add_function(wrap_pyfunction!(open::read_folder, module)?)?;
    module.add_function(wrap_pyfunction!(clip::from_state, module)?)?;
    module.add_function(wrap_pyfunction!(features::features, module)?)?;
    module.add_function(wrap_pyfunction!(features::key_positions, module)?)?;
    module.add_function(wrap_pyfunction!(index::load, module)?)?;
    module.add_function(wrap_pyfunction!(index::index_from_bytes, module)?)?;
    module.add_function(wrap_pyfunction!(train::train, module)?)?;
    module.add_function(wrap_pyfunction!(material::resolve_labels, module)?)?;
    module.add_function(wrap_pyfunction!(material::rows_of_table, module)?)?;
    archive::register(module)?;
    archive_search::register(module)?;
    module.add_function(wrap_pyfunction!(divided::match_kept, module)?)?;
    module.add_function(wrap_pyfunction!(divided::recognize_matched_kept, module)?)?;
    module.add_function(wrap_pyfunction!(crossval::crossval, module)?)?;
    module.add_function(wrap_pyfunction!(crossval::learning_curve, module)?)?;
    module.add_function(wrap_pyfunction!(evaluate::evaluate, module)?)?;
    module.add_function(wrap_pyfunction!(labels::agree, module)?)?;
    module.add_function(wrap_pyfunction!(labels::budget, module)?)?;
    module.add_function(wrap_pyfunction!(segment::cut, module)?)?;
    module.add_function(wrap_pyfunction!(discover::discover, module)?)?;
    module.add_function(wrap_pyfunction!(discover::discover_stored, module)?)?;
    module.add_function(wrap_pyfunction!(synth::synth_database, module)?)?;
    module.add_function(wrap_pyfunction!(synth::synth_everyday, module)?)?;
    module.add_function(wrap_pyfunction!(synth::synth_motions, module)?)?;
    Ok(())
}
