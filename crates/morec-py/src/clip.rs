//! `morec.Clip`: a clip in metres and Y up, as Python sees it.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use morec::clip::{Clip, Gap, JointTrack, Points};
use morec::formats::{Limits, bvh, c3d, from_positions, jsonl, trc};
use morec::import::{normalize, points_by_role};
use morec::kinematics::WorldPose;
use morec::math::Vec3;
use morec::roles::Role;
use morec::smooth::{SmoothParams, compress};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PySlice};

use crate::arrays::{motion, owned, shared, wrong_shape};
use crate::clip_data::ClipData;
use crate::errors::{MorecError, io_error, morec_error, value_error};
use crate::options::import_options;
use crate::tables::plain;

/// A motion-capture clip in metres, Y up: a skeleton, its frames, and the body parts of its joints (roles).
#[pyclass(frozen, name = "Clip", module = "morec")]
pub struct PyClip {
    pub data: Arc<ClipData>,
    positions: PyOnceLock<Py<PyAny>>,
    rotations: PyOnceLock<Py<PyAny>>,
}

impl From<ClipData> for PyClip {
    fn from(data: ClipData) -> Self {
        Self {
            data: Arc::new(data),
            positions: PyOnceLock::new(),
            rotations: PyOnceLock::new(),
        }
    }
}

#[pymethods]
impl PyClip {
    /// A clip of points: where the joints of one performer are, frame by frame.
    #[staticmethod]
    #[pyo3(name = "from_positions", signature = (positions, names, rate_hz, *, name="clip", unit=None, up=None, roles=None))]
    fn of_positions(
        positions: &Bound<'_, PyAny>,
        names: Vec<String>,
        rate_hz: f64,
        name: &str,
        unit: Option<f64>,
        up: Option<&str>,
        roles: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let (values, frames, joints) = motion(positions)?;
        if joints != names.len() {
            let expected = format!(
                "(frames, {}, 3), as there are {} names",
                names.len(),
                names.len()
            );
            return Err(wrong_shape(&expected, &[frames, joints, 3]));
        }
        if !(rate_hz.is_finite() && rate_hz > 0.0) {
            return Err(value_error(format!(
                "rate_hz: expected a rate in Hz above 0, found {rate_hz}"
            )));
        }
        let options = import_options(up, unit, roles)?;
        let point = |joint: usize| -> Vec<Vec3> {
            (0..frames).map(|f| values[f * joints + joint]).collect()
        };
        let points = names.into_iter().enumerate();
        let points = points.map(|(joint, name)| (name, point(joint))).collect();
        let loaded =
            from_positions(name, rate_hz, points, unit, &Limits::default()).map_err(morec_error)?;
        let clip = loaded.clips.into_iter().next();
        let clip = clip.ok_or_else(|| morec_error("these positions contain no performer"))?;
        let mut data = ClipData::from(normalize(clip, &options).map_err(morec_error)?);
        data.warnings = loaded.warnings.iter().map(|w| w.text.clone()).collect();
        Ok(data.into())
    }

    /// Name of the clip: its file's stem, by default.
    #[getter]
    fn name(&self) -> &str {
        &self.data.clip.name
    }

    /// The file it was read from, or `None`.
    #[getter]
    fn path(&self) -> Option<&PathBuf> {
        self.data.path.as_ref()
    }

    /// The file's format, `"bvh"`; empty for clips that come from no file.
    #[getter]
    fn format(&self) -> &str {
        &self.data.format
    }

    /// Frames a second.
    #[getter]
    fn rate_hz(&self) -> f64 {
        self.data.clip.rate_hz
    }

    /// Number of frames.
    #[getter]
    fn frames(&self) -> usize {
        self.data.clip.frames
    }

    /// Length in seconds: frames over rate.
    #[getter]
    fn duration_secs(&self) -> f64 {
        self.data.clip.duration_secs()
    }

    /// Names of the joints, parents first.
    #[getter]
    fn names(&self) -> Vec<&str> {
        let joints = self.data.clip.skeleton.joints().iter();
        joints.map(|joint| joint.name.as_str()).collect()
    }

    /// Index of each joint's parent, -1 for a root; int64 of shape (joints,).
    #[getter]
    fn parents<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let joints = self.data.clip.skeleton.joints().iter();
        let parents: Vec<i64> = joints.map(|j| j.parent.map_or(-1, |p| p as i64)).collect();
        let shape = [parents.len()];
        Ok(owned(py, parents, &shape)?.into_any())
    }

    /// Position of each joint in its parent's frame when nothing moves it, metres; shape (joints, 3).
    #[getter]
    fn offsets<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let joints = self.data.clip.skeleton.joints().iter();
        let offsets: Vec<f64> = joints
            .flat_map(|joint| [joint.offset.x, joint.offset.y, joint.offset.z])
            .collect();
        let shape = [offsets.len() / 3, 3];
        Ok(owned(py, offsets, &shape)?.into_any())
    }

    /// Index of the joint of each body part that was found.
    #[getter]
    fn roles<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        for role in Role::ALL {
            if let Some(joint) = self.data.roles.joint(role) {
                dict.set_item(role.name(), joint)?;
            }
        }
        Ok(dict)
    }

    /// Repairs and doubts of reading, one sentence each, with the place in the file.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.data.warnings.clone()
    }

    /// Inferred properties: the file's up axis and unit, body height, rest pose and doubts.
    #[getter]
    fn facts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let facts: serde_json::Value = serde_json::from_str(&self.data.facts).unwrap_or_default();
        plain(py, &facts)
    }

    /// Number of frames at the start that show a rest pose instead of the motion.
    #[getter]
    fn rest_frames(&self) -> usize {
        self.data.rest.len()
    }

    /// True if joints are known to turn; a clip of points has positions alone.
    #[getter]
    fn has_rotations(&self) -> bool {
        self.data.clip.has_rotations()
    }

    /// Position of each joint in the world, metres, Y up; float64 of shape (frames, joints, 3), read-only.
    #[getter]
    fn positions(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        let made = self.positions.get_or_try_init(py, || {
            let take = self.data.clone();
            let values = py.detach(move || world_positions(&take.clip));
            let clip = &self.data.clip;
            shared(py, values, &[clip.frames, clip.skeleton.len(), 3])
        })?;
        Ok(made.clone_ref(py))
    }

    /// Rotation of each joint in its parent's frame, quaternions x, y, z, w; float64 of shape (frames, joints, 4),
    /// read-only. `None` for a clip of points.
    #[getter]
    fn rotations(&self, py: Python<'_>) -> PyResult<Option<Py<PyAny>>> {
        let clip = &self.data.clip;
        if !clip.has_rotations() {
            return Ok(None);
        }
        let made = self.rotations.get_or_try_init(py, || {
            let values = clip.rotations.iter().flat_map(|q| [q.i, q.j, q.k, q.w]);
            shared(py, values.collect(), &[clip.frames, clip.skeleton.len(), 4])
        })?;
        Ok(Some(made.clone_ref(py)))
    }

    /// The same motion at another rate.
    fn resampled(&self, rate_hz: f64) -> PyResult<Self> {
        let clip = self.data.clip.resampled(rate_hz).map_err(value_error)?;
        let scale = rate_hz / self.data.clip.rate_hz;
        let rest = (self.data.rest.len() as f64 * scale).ceil() as usize;
        Ok(ClipData {
            rest: 0..rest.min(clip.frames),
            clip,
            ..(*self.data).clone()
        }
        .into())
    }

    /// The same clip with another name, by which labels refer to it.
    fn renamed(&self, name: &str) -> Self {
        let mut take = (*self.data).clone();
        take.clip.name = name.to_owned();
        take.into()
    }

    /// Writes the clip in the format that the ending names: .bvh, .mclip, or its points as .trc, .c3d, .jsonl.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let data = self.data.clone();
        let written = py.detach(|| written(&data, &path));
        let bytes = written.map_err(|e| MorecError::new_err(format!("{}: {e}", path.display())))?;
        std::fs::write(&path, bytes).map_err(|error| io_error(&path, &error))
    }

    fn __len__(&self) -> usize {
        self.data.clip.frames
    }

    fn __getitem__(&self, key: &Bound<'_, PyAny>) -> PyResult<Self> {
        let slice = key.cast::<PySlice>().map_err(|_| {
            PyTypeError::new_err(
                "clips are sliced by seconds, as clip[1.0:2.5]; frames are clip.positions[3]",
            )
        })?;
        if !slice.getattr("step")?.is_none() {
            return Err(value_error(
                "a slice of a clip cannot have a step; use Clip.resampled",
            ));
        }
        let clip = &self.data.clip;
        let frame = |name: &str, default: usize| -> PyResult<usize> {
            let secs = slice.getattr(name)?;
            if secs.is_none() {
                return Ok(default);
            }
            let mut secs: f64 = secs.extract()?;
            if secs.is_nan() {
                return Err(value_error("a clip is sliced by seconds, found nan"));
            }
            // As with lists, what is negative counts from the end.
            if secs < 0.0 {
                secs += clip.duration_secs();
            }
            Ok(((secs * clip.rate_hz).round().max(0.0) as usize).min(clip.frames))
        };
        let (start, stop) = (frame("start", 0)?, frame("stop", clip.frames)?);
        Ok(stretch(&self.data, start..stop.max(start)).into())
    }

    fn __repr__(&self) -> String {
        let clip = &self.data.clip;
        format!(
            "<morec.Clip {:?}: {:.2} s, {} frames at {} Hz, {} joints>",
            clip.name,
            clip.duration_secs(),
            clip.frames,
            (clip.rate_hz * 1000.0).round() / 1000.0,
            clip.skeleton.len()
        )
    }

    fn _repr_html_<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let module = slf.py().import("morec._drawing")?;
        module.call_method1("html", (slf,))
    }

    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyDict>,))> {
        let restore = py.import("morec._morec")?.getattr("from_state")?;
        Ok((restore, (crate::state::state(py, &self.data)?,)))
    }
}

/// The bytes of a clip's file.
fn written(data: &ClipData, path: &Path) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    let ending = path
        .extension()
        .unwrap_or_default()
        .to_string_lossy()
        .to_lowercase();
    // Files of points name their unit.
    let points = || data.clip.to_points(Some(1.0));
    let done = match ending.as_str() {
        "bvh" => bvh::write(&data.clip, &mut bytes),
        "trc" => trc::write(&points(), &mut bytes),
        "c3d" => c3d::write(&points(), &mut bytes),
        "jsonl" => jsonl::write(&points_by_role(&data.clip, &data.roles), &mut bytes),
        "mclip" => {
            let stored = compress(&data.clip, &SmoothParams::database(), &());
            return stored
                .map(|s| s.to_bytes())
                .map_err(|error| error.to_string());
        }
        _ => return Err("expected a file .bvh, .mclip, .trc, .c3d or .jsonl".to_owned()),
    };
    done.map(|()| bytes).map_err(|error| error.to_string())
}

/// World positions of all joints, frame by frame. Points in long gaps are nowhere: NaN.
pub fn world_positions(clip: &Clip) -> Vec<f64> {
    let joints = clip.skeleton.len();
    let mut values = Vec::with_capacity(clip.frames * joints * 3);
    let mut pose = WorldPose::default();
    for frame in 0..clip.frames {
        pose.set(clip, frame);
        values.extend(pose.positions.iter().flat_map(|p| [p.x, p.y, p.z]));
    }
    for gap in clip.points.iter().flat_map(|points| &points.gaps) {
        for frame in gap.frames.clone() {
            let at = (frame * joints + gap.joint) * 3;
            if let Some(position) = values.get_mut(at..at + 3) {
                position.fill(f64::NAN);
            }
        }
    }
    values
}

/// The frames `span` of a take, as a take of its own.
fn stretch(take: &ClipData, span: Range<usize>) -> ClipData {
    let clip = &take.clip;
    let joints = clip.skeleton.len();
    let within = |frames: &Range<usize>| {
        let start = frames.start.max(span.start);
        let stop = frames.end.min(span.end);
        (start < stop).then(|| start - span.start..stop - span.start)
    };
    let track = |track: &JointTrack| JointTrack {
        joint: track.joint,
        positions: track.positions[span.clone()].to_vec(),
    };
    let points = clip.points.as_ref().map(|points| Points {
        gaps: points
            .gaps
            .iter()
            .filter_map(|gap| {
                let joint = gap.joint;
                within(&gap.frames).map(|frames| Gap { joint, frames })
            })
            .collect(),
        metres_per_unit: points.metres_per_unit,
    });
    let cut = Clip {
        name: clip.name.clone(),
        skeleton: clip.skeleton.clone(),
        rate_hz: clip.rate_hz,
        rotations: clip.rotations[span.start * joints..span.end * joints].to_vec(),
        tracks: clip.tracks.iter().map(track).collect(),
        frames: span.len(),
        repaired: clip.repaired.iter().filter_map(within).collect(),
        points,
    };
    ClipData {
        clip: cut,
        rest: within(&take.rest).unwrap_or(0..0),
        ..take.clone()
    }
}

/// The clip of a pickled state.
#[pyfunction]
pub fn from_state(state: &Bound<'_, PyDict>) -> PyResult<PyClip> {
    Ok(crate::state::restored(state)?.into())
}
