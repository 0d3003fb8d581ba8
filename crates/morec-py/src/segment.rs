//! Cuts where behaviour changes, without labels.

use morec::pivots::{PivotMap, PivotSet, PoseParams, pose_rows_of_clip};
use morec::segment::{Directions, HPoint, PpcaParams, segment};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::owned;
use crate::clip::PyClip;
use crate::errors::{morec_error, value_error};

/// Where a clip's behaviour changes, and the misfit over time.
#[pyfunction]
#[pyo3(signature = (clip, rise=None, quality=None, direction="both"))]
pub fn cut<'py>(
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
            "forward" => Directions::Forward,
            "backward" => Directions::Backward,
            "both" => Directions::Both,
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
    let curve = |points: &[HPoint]| {
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
