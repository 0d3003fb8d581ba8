//! Cuts where behaviour changes, without labels.

use morec::features::{FeatureParams, bones_of_clip, rows_of_clip};
use morec::pivots::{PivotMap, PivotSet, PoseParams, pose_rows_of_clip};
use morec::segment::{
    KernelParams, MisfitSample, PassDirections, PpcaParams, kernel_cuts, segment,
};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::owned;
use crate::clip::PyClip;
use crate::errors::{morec_error, value_error};

/// Changes of behaviour in a clip, and the misfit over time.
#[pyfunction]
#[pyo3(signature = (clip, rise=None, quality=None, direction="both"))]
pub fn cut_ppca<'py>(
    py: Python<'py>,
    clip: &PyClip,
    rise: Option<f64>,
    quality: Option<f64>,
    direction: &str,
) -> PyResult<Bound<'py, PyDict>> {
    let default = PpcaParams::default();
    let params = PpcaParams {
        rise: rise.unwrap_or(default.rise),
        quality: quality.unwrap_or(default.quality),
        directions: match direction {
            "forward" => PassDirections::Forward,
            "backward" => PassDirections::Backward,
            "both" => PassDirections::Both,
            other => {
                return Err(value_error(format!(
                    "direction: expected \"forward\", \"backward\" or \"both\", found {other:?}"
                )));
            }
        },
        ..default
    };
    params.check().map_err(value_error)?;
    let data = clip.data.clone();
    let found = py.detach(|| {
        let (set, poses) = (PivotSet::thesis(), PoseParams::default());
        let map = PivotMap::of_clip(&set, &data.clip, &data.roles).map_err(|e| e.to_string())?;
        let rows = pose_rows_of_clip(&data.clip, &set, &map, &data.rest, &poses);
        segment(&rows, poses.rate_hz, &params).map_err(|e| e.to_string())
    });
    let found = found.map_err(|error| morec_error(format!("{}: {error}", data.clip.name)))?;
    let curve = |points: &[MisfitSample]| {
        let values: Vec<f64> = points.iter().flat_map(|p| [p.secs, p.value]).collect();
        owned(py, values, &[points.len(), 2])
    };
    let dict = PyDict::new(py);
    let cuts: Vec<f64> = found.cuts.iter().map(|cut| cut.secs).collect();
    let shape = [cuts.len()];
    dict.set_item("cuts_secs", owned(py, cuts, &shape)?)?;
    dict.set_item("forward", curve(&found.forward)?)?;
    dict.set_item("backward", curve(&found.backward)?)?;
    Ok(dict)
}

/// Seconds at which a clip is cut by kernel change points.
#[pyfunction]
#[pyo3(signature = (clip, window=None, penalty=None, least=None))]
pub fn cut_kernel(
    py: Python<'_>,
    clip: &PyClip,
    window: Option<f64>,
    penalty: Option<f64>,
    least: Option<f64>,
) -> PyResult<Py<PyAny>> {
    let default = KernelParams::default();
    let params = KernelParams {
        window_secs: window.unwrap_or(default.window_secs),
        penalty: penalty.unwrap_or(default.penalty),
        least_secs: least.unwrap_or(default.least_secs),
        ..default
    };
    params.check().map_err(value_error)?;
    let data = clip.data.clone();
    let cuts = py.detach(|| {
        let features = FeatureParams::default();
        let bones = bones_of_clip(&data.clip, &data.roles, &data.rest);
        let rows = rows_of_clip(&data.clip, &data.roles, &data.rest, bones, &features);
        kernel_cuts(&rows, &features, &params).map_err(|e| e.to_string())
    });
    let cuts = cuts.map_err(|error| morec_error(format!("{}: {error}", data.clip.name)))?;
    let shape = [cuts.len()];
    Ok(owned(py, cuts, &shape)?.into_any().unbind())
}
