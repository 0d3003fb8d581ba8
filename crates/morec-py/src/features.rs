//! Feature rows and positions of body parts as arrays.

use morec::features::{
    ALL_BONES, BoneSet, FeatureParams, KeyPose, bones_of_clip, for_each_pose, rows_of_clip,
};
use morec::roles::Role;
use pyo3::prelude::*;

use crate::arrays::owned;
use crate::clip::PyClip;
use crate::errors::value_error;

/// Names of the parts of the body, in the order in which arrays have them.
pub fn role_names() -> Vec<&'static str> {
    Role::ALL.into_iter().map(Role::name).collect()
}

/// The bones of these names, in the order of columns; those that `clip` shows if no names are given.
fn bones(clip: &PyClip, names: Option<Vec<String>>) -> PyResult<BoneSet> {
    let data = &clip.data;
    match names {
        Some(names) => BoneSet::try_from(names).map_err(value_error),
        None => Ok(bones_of_clip(&data.clip, &data.roles, &data.rest)),
    }
}

/// Values, names of the columns, names of the bones, rows a second.
type FeatureTable<'py> = (Bound<'py, PyAny>, Vec<String>, Vec<String>, f64);

/// Feature rows, float32 of shape (ticks, 6 bones + 4); names of the columns, names of the bones, rows a second.
#[pyfunction]
#[pyo3(signature = (clip, bones=None))]
pub fn features<'py>(
    py: Python<'py>,
    clip: &PyClip,
    bones: Option<Vec<String>>,
) -> PyResult<FeatureTable<'py>> {
    let bones = self::bones(clip, bones)?;
    if bones.is_empty() {
        let name = &clip.data.clip.name;
        return Err(value_error(format!(
            "{name}: no joint has a role, so no features can be computed; see Clip.roles"
        )));
    }
    let params = FeatureParams::default();
    let data = clip.data.clone();
    let rows = py.detach(|| rows_of_clip(&data.clip, &data.roles, &data.rest, bones, &params));
    let names: Vec<String> = bones.into();
    let shape = [rows.len(), rows.dim()];
    let values = owned(py, rows.into_values(), &shape)?.into_any();
    Ok((values, columns(bones), names, params.tick_hz()))
}

/// Names of the columns of feature rows over `bones`.
fn columns(bones: BoneSet) -> Vec<String> {
    let of = |suffix: &str, axes: [&str; 3]| -> Vec<String> {
        let bones = bones.indices().map(|bone| ALL_BONES[bone].name);
        bones
            .flat_map(|bone| axes.map(|axis| format!("{bone}{suffix}.{axis}")))
            .collect()
    };
    let axes = ["lateral", "up", "forward"];
    let root = ["lateral", "up", "forward", "turning"].map(|axis| format!("root.velocity.{axis}"));
    let mut columns = of(".direction", axes);
    columns.extend(of(".velocity", axes));
    columns.extend(root);
    columns
}

/// Positions of the parts of the body, frame by frame: float64 of shape (frames, 18, 3), NaN where unknown; (frames, 60, 3) with the
/// points of hands where the clip shows any; (frames, 84, 3) of a custom skeleton.
#[pyfunction]
pub fn key_positions<'py>(py: Python<'py>, clip: &PyClip) -> PyResult<Bound<'py, PyAny>> {
    let data = clip.data.clone();
    let shows = |of: fn(Role) -> bool| data.roles.played().any(|(role, _)| of(role));
    let roles = match (shows(Role::is_custom), shows(Role::is_of_hand)) {
        (true, _) => &Role::ALL[..Role::Face.index()],
        (false, true) => &Role::ALL[..Role::HUMAN_COUNT],
        (false, false) => &Role::BODY[..],
    };
    let values = py.detach(|| {
        let mut values = Vec::with_capacity(data.clip.frames * roles.len() * 3);
        for_each_pose(&data.clip, &data.roles, &data.rest, |_, pose: &KeyPose| {
            for role in roles {
                match pose.get(*role) {
                    Some(p) => values.extend([p.x, p.y, p.z]),
                    None => values.extend([f64::NAN; 3]),
                }
            }
        });
        values
    });
    Ok(owned(py, values, &[clip.data.clip.frames, roles.len(), 3])?.into_any())
}
