//! Contents of a pickled clip: every number to the bit.

use std::path::PathBuf;

use morec::clip::{Clip, Gap, Joint, JointTrack, Points, Skeleton};
use morec::math::{Quat, Vec3};
use morec::roles::{Role, RoleMap};
use nalgebra::Quaternion;
use numpy::PyArrayMethods;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{doubles, owned};
use crate::clip_data::ClipData;
use crate::errors::value_error;

type JointState = (String, Option<usize>, [f64; 3], Option<[f64; 3]>);
type GapState = (usize, usize, usize);

/// Version of the dictionary.
const VERSION: u32 = 1;

/// A take as a dictionary of plain values and arrays.
pub fn state<'py>(py: Python<'py>, take: &ClipData) -> PyResult<Bound<'py, PyDict>> {
    let clip = &take.clip;
    let dict = PyDict::new(py);
    let joints = clip.skeleton.joints().iter().map(|joint| -> JointState {
        let tip = joint.tip.map(Into::into);
        (joint.name.clone(), joint.parent, joint.offset.into(), tip)
    });
    let rotations = clip.rotations.iter().flat_map(|q| [q.i, q.j, q.k, q.w]);
    let tracks = clip.tracks.iter().flat_map(|t| &t.positions);
    let tracks: Vec<f64> = tracks.flat_map(|p| [p.x, p.y, p.z]).collect();
    let shape = [clip.tracks.len(), clip.frames, 3];
    dict.set_item("version", VERSION)?;
    dict.set_item("name", &clip.name)?;
    dict.set_item("rate_hz", clip.rate_hz)?;
    dict.set_item("frames", clip.frames)?;
    dict.set_item("joints", joints.collect::<Vec<_>>())?;
    let turned: Vec<f64> = match clip.has_rotations() {
        true => rotations.collect(),
        false => Vec::new(),
    };
    let turned_shape = [turned.len() / 4, 4];
    dict.set_item("rotations", owned(py, turned, &turned_shape)?)?;
    let moved: Vec<usize> = clip.tracks.iter().map(|t| t.joint).collect();
    dict.set_item("moved", moved)?;
    dict.set_item("tracks", owned(py, tracks, &shape)?)?;
    let repaired: Vec<(usize, usize)> = clip.repaired.iter().map(|s| (s.start, s.end)).collect();
    dict.set_item("repaired", repaired)?;
    let points = clip.points.as_ref().map(|points| {
        let gap = |gap: &Gap| -> GapState { (gap.joint, gap.frames.start, gap.frames.end) };
        let gaps: Vec<GapState> = points.gaps.iter().map(gap).collect();
        (gaps, points.metres_per_unit)
    });
    dict.set_item("points", points)?;
    let roles: Vec<Option<usize>> = Role::ALL.iter().map(|r| take.roles.joint(*r)).collect();
    dict.set_item("roles", roles)?;
    dict.set_item("rest", (take.rest.start, take.rest.end))?;
    dict.set_item("facts", &take.facts)?;
    dict.set_item("warnings", &take.warnings)?;
    dict.set_item(
        "path",
        take.path.as_ref().map(|p| p.to_string_lossy().into_owned()),
    )?;
    dict.set_item("format", &take.format)?;
    Ok(dict)
}

/// The clip of a pickled state.
pub fn restored(state: &Bound<'_, PyDict>) -> PyResult<ClipData> {
    let get = |name: &str| -> PyResult<Bound<'_, PyAny>> {
        let value = state.get_item(name)?;
        value.ok_or_else(|| PyKeyError::new_err(format!("the pickled clip lacks {name}")))
    };
    let version: u32 = get("version")?.extract()?;
    if version != VERSION {
        return Err(value_error(format!(
            "the clip was pickled in version {version}; this morec reads version {VERSION}"
        )));
    }
    let frames: usize = get("frames")?.extract()?;
    let joints: Vec<JointState> = get("joints")?.extract()?;
    let joints = joints.into_iter().map(|(name, parent, offset, tip)| Joint {
        name,
        parent,
        offset: offset.into(),
        tip: tip.map(Vec3::from),
    });
    let skeleton = Skeleton::new(joints.collect()).map_err(value_error)?;
    let points: Option<(Vec<GapState>, Option<f64>)> = get("points")?.extract()?;
    let moved: Vec<usize> = get("moved")?.extract()?;
    let tracks = doubles(&get("tracks")?)?.to_vec()?;
    let turned = doubles(&get("rotations")?)?.to_vec()?;
    let count = frames.saturating_mul(skeleton.len());
    let rotations: Vec<Quat> = match points {
        Some(_) => vec![Quat::identity(); count],
        None => turned
            .chunks_exact(4)
            .map(|q| Quat::new_unchecked(Quaternion::new(q[3], q[0], q[1], q[2])))
            .collect(),
    };
    let inside = moved.iter().all(|joint| *joint < skeleton.len());
    if rotations.len() != count || tracks.len() != moved.len() * frames * 3 || !inside {
        return Err(value_error(
            "the arrays of the pickled clip do not fit together",
        ));
    }
    let track = |(number, joint): (usize, usize)| JointTrack {
        joint,
        positions: tracks[number * frames * 3..(number + 1) * frames * 3]
            .chunks_exact(3)
            .map(|p| Vec3::new(p[0], p[1], p[2]))
            .collect(),
    };
    let repaired: Vec<(usize, usize)> = get("repaired")?.extract()?;
    let gap = |(joint, start, stop): GapState| Gap {
        joint,
        frames: start..stop,
    };
    let mut roles = RoleMap::default();
    let played: Vec<Option<usize>> = get("roles")?.extract()?;
    for (role, joint) in Role::ALL.into_iter().zip(played) {
        roles.set(role, joint.filter(|j| *j < skeleton.len()));
    }
    let (rest, rest_stop): (usize, usize) = get("rest")?.extract()?;
    let clip = Clip {
        name: get("name")?.extract()?,
        skeleton,
        rate_hz: get("rate_hz")?.extract()?,
        rotations,
        tracks: moved.into_iter().enumerate().map(track).collect(),
        frames,
        repaired: repaired.into_iter().map(|(a, b)| a..b).collect(),
        points: points.map(|(gaps, metres_per_unit)| Points {
            gaps: gaps.into_iter().map(gap).collect(),
            metres_per_unit,
        }),
    };
    let path: Option<String> = get("path")?.extract()?;
    Ok(ClipData {
        clip,
        roles,
        rest: rest..rest_stop,
        facts: get("facts")?.extract()?,
        warnings: get("warnings")?.extract()?,
        path: path.map(PathBuf::from),
        format: get("format")?.extract()?,
    })
}
