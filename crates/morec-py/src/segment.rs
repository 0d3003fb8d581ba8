//! Cuts where behaviour changes, without labels.

use morec::discover::{DiscoverParams, discover};
use morec::features::{FeatureParams, bones_of_clip, rows_of_clip};
use morec::pivots::{PivotMap, PivotSet, PoseParams, pose_rows_of_clip};
use morec::segment::{KernelParams, MisfitSample, PpcaParams, Segmentation, kernel_cuts, segment};
use morec_db::Cutter;
use morec_ops::CutSettings;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::owned;
use crate::clip::PyClip;
use crate::clip_data::ClipData;
use crate::errors::{morec_error, operation_error};
use crate::material::keywords;

/// Changes of behaviour in a clip, and the misfit over time where the method has one.
#[pyfunction]
#[pyo3(signature = (clip, **settings))]
pub fn cut<'py>(
    py: Python<'py>,
    clip: &PyClip,
    settings: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyDict>> {
    let settings: CutSettings = keywords(settings)?;
    let cutter = settings.cutter(PivotSet::thesis());
    let data = clip.data.clone();
    let dict = PyDict::new(py);
    let named = |error: String| morec_error(format!("{}: {error}", data.clip.name));
    let cuts: Vec<f64> = match cutter.map_err(operation_error)? {
        Cutter::Repeats(params) => py.detach(|| by_repeats(&data, &params)).map_err(named)?,
        Cutter::Kernel(params) => py.detach(|| by_kernel(&data, &params)).map_err(named)?,
        Cutter::Ppca(params, set) => {
            let found = py.detach(|| by_ppca(&data, &params, &set)).map_err(named)?;
            let curve = |points: &[MisfitSample]| {
                let values: Vec<f64> = points.iter().flat_map(|p| [p.secs, p.value]).collect();
                owned(py, values, &[points.len(), 2])
            };
            dict.set_item("forward", curve(&found.forward)?)?;
            dict.set_item("backward", curve(&found.backward)?)?;
            found.cuts.iter().map(|cut| cut.secs).collect()
        }
    };
    let shape = [cuts.len()];
    dict.set_item("cuts_secs", owned(py, cuts, &shape)?)?;
    Ok(dict)
}

fn by_kernel(data: &ClipData, params: &KernelParams) -> Result<Vec<f64>, String> {
    let features = FeatureParams::default();
    let bones = bones_of_clip(&data.clip, &data.roles, &data.rest);
    let rows = rows_of_clip(&data.clip, &data.roles, &data.rest, bones, &features);
    kernel_cuts(&rows, &features, params).map_err(|e| e.to_string())
}

fn by_repeats(data: &ClipData, params: &DiscoverParams) -> Result<Vec<f64>, String> {
    let features = FeatureParams::default();
    let bones = bones_of_clip(&data.clip, &data.roles, &data.rest);
    let rows = rows_of_clip(&data.clip, &data.roles, &data.rest, bones, &features);
    let sets = discover(&[rows], features.tick_hz(), params, &()).map_err(|e| e.to_string())?;
    Ok(sets.cuts_of(0, data.clip.frames as f64 / data.clip.rate_hz))
}

fn by_ppca(data: &ClipData, params: &PpcaParams, set: &PivotSet) -> Result<Segmentation, String> {
    let poses = PoseParams::default();
    let map = PivotMap::of_clip(set, &data.clip, &data.roles).map_err(|e| e.to_string())?;
    let rows = pose_rows_of_clip(&data.clip, set, &map, &data.rest, &poses);
    segment(&rows, poses.rate_hz, params).map_err(|e| e.to_string())
}
