//! `morec.Recognizer`: a live stream of one performer, array by array.

use std::sync::{Mutex, PoisonError};

use morec::features::{BoneSet, KeyPose};
use morec::import::SignedAxis;
use morec::live::{Detection, Model, Recognizer, ShownBones};
use morec::math::{Quat, Vec3};
use morec::roles::points::{PointJoint, places_of};
use morec::roles::{Role, RoleMap};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyString};

use crate::arrays::{doubles, motion, pose, wrong_shape};
use crate::clip::PyClip;
use crate::errors::{morec_error, value_error};
use crate::options::mapping;
use crate::tables::set_repetitions;

/// Recognises motions in one performer's stream of joint positions. Made by `Index.recognizer`.
///
/// Any thread may push; two at once wait for each other.
#[pyclass(frozen, name = "Recognizer", module = "morec")]
pub struct PyRecognizer {
    state: Mutex<RecognizerState>,
    joints: Vec<String>,
    classes: Vec<Py<PyString>>,
    latency_secs: f64,
}

struct RecognizerState {
    model: Model,
    recognizer: Recognizer,
    shown: ShownBones,
    places: Vec<(Role, PointJoint)>,
    /// Takes coordinates of the stream to Y up; `None` if they are.
    turn: Option<Quat>,
    positions: Vec<Vec3>,
    key: KeyPose,
}

/// The part of the body that each point of an array plays.
pub struct PointLayout {
    /// Names of the points.
    pub joints: Vec<String>,
    places: Vec<(Role, PointJoint)>,
}

impl PointLayout {
    /// The joints of a clip, in its order.
    pub fn of_clip(clip: &PyClip) -> Self {
        let data = &clip.data;
        let played = |role: Role| Some((role, PointJoint::Point(data.roles.joint(role)?)));
        let joints = data.clip.skeleton.joints().iter();
        Self {
            joints: joints.map(|joint| joint.name.clone()).collect(),
            places: Role::ALL.into_iter().filter_map(played).collect(),
        }
    }

    /// Points of these names: a published set (MediaPipe, COCO, Kinect, marker sets), usual joint names, names of roles;
    /// `roles` overrides what is found.
    pub fn of_names(joints: Vec<String>, roles: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let names: Vec<&str> = joints.iter().map(String::as_str).collect();
        let mut places = places_of(&names);
        if let Some(roles) = roles {
            let said = mapping(roles)?.places(&names);
            for (role, place) in said.map_err(|e| value_error(format!("roles: {e}")))? {
                places.retain(|(known, _)| *known != role);
                places.extend(place.map(|place| (role, place)));
            }
        }
        if places.is_empty() {
            return Err(value_error(
                "joints: no known set of points; say with roles which of them are parts of the body, as in \
                 {\"left_hand\": \"LWrist\", \"hips\": \"LHip+RHip\"}",
            ));
        }
        Ok(Self { joints, places })
    }
}

impl PyRecognizer {
    /// For poses laid out as `layout`, `up` being up in them.
    ///
    /// # Errors
    /// A model that needs joint rotations, or that has no bone in common with the layout.
    pub fn new(
        py: Python<'_>,
        model: &Model,
        layout: PointLayout,
        up: SignedAxis,
    ) -> PyResult<Self> {
        if model.needs_rotations() {
            return Err(morec_error(format!(
                "an index of the method {} looks at joint rotations, which a stream of positions does not have; \
                 Index.recognize plays whole clips through it",
                model.method()
            )));
        }
        let mut roles = RoleMap::default();
        for (number, (role, _)) in layout.places.iter().enumerate() {
            roles.set(*role, Some(number));
        }
        let recognizer = Recognizer::new(model, BoneSet::of_roles(&roles)).map_err(morec_error)?;
        let classes = model.classes().iter();
        Ok(Self {
            latency_secs: recognizer.latency_secs(),
            classes: classes
                .map(|c| PyString::new(py, &c.name).unbind())
                .collect(),
            state: Mutex::new(RecognizerState {
                model: model.clone(),
                recognizer,
                shown: ShownBones::new(model.bones()),
                places: layout.places,
                turn: (up != SignedAxis::Y).then(|| up.to_y()),
                positions: Vec::with_capacity(layout.joints.len()),
                key: KeyPose::default(),
            }),
            joints: layout.joints,
        })
    }

    fn rows<'py>(&self, py: Python<'py>, found: &[Detection]) -> PyResult<Bound<'py, PyList>> {
        let list = PyList::empty(py);
        for d in found {
            let row = PyDict::new(py);
            if let Some(class) = self.classes.get(d.class.index()) {
                row.set_item(intern!(py, "class"), class)?;
            }
            row.set_item(intern!(py, "start_secs"), d.span.start_secs)?;
            row.set_item(intern!(py, "stop_secs"), d.span.stop_secs)?;
            row.set_item(intern!(py, "score"), d.score)?;
            row.set_item(intern!(py, "reported_secs"), d.reported_secs)?;
            set_repetitions(&row, d.repetitions)?;
            list.append(row)?;
        }
        Ok(list)
    }
}

impl RecognizerState {
    /// Takes the pose that `positions` hold, and adds what it settled to `found`.
    fn push(&mut self, time_secs: f64, found: &mut Vec<Detection>) {
        let positions = &self.positions;
        for (role, place) in &self.places {
            let at = place.at(|joint| positions[joint]);
            let at = at.unwrap_or_else(|| Vec3::repeat(f64::NAN));
            self.key.set(*role, self.turn.map_or(at, |turn| turn * at));
        }
        let used = self.recognizer.model().bones();
        let others = self.shown.take(used, time_secs, &self.key);
        if let Some(Ok(new)) = others.map(|bones| Recognizer::new(&self.model, bones)) {
            found.extend_from_slice(self.recognizer.finish());
            self.recognizer = new;
        }
        found.extend_from_slice(self.recognizer.push(time_secs, &self.key));
    }

    fn finish(&mut self) -> &[Detection] {
        self.shown.reset();
        self.recognizer.finish()
    }
}

#[pymethods]
impl PyRecognizer {
    /// Takes the pose at `time_secs` on the stream's clock; the detections that it settled, mostly none.
    fn push<'py>(
        &self,
        py: Python<'py>,
        time_secs: f64,
        positions: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyList>> {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        pose(positions, self.joints.len(), &mut state.positions)?;
        let mut found = Vec::new();
        state.push(time_secs, &mut found);
        drop(state);
        self.rows(py, &found)
    }

    /// Takes many poses: times of shape (frames,), positions of shape (frames, joints, 3); all detections they settled.
    /// Other Python threads run meanwhile.
    fn push_all<'py>(
        &self,
        py: Python<'py>,
        times_secs: &Bound<'py, PyAny>,
        positions: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyList>> {
        let times = doubles(times_secs)?
            .as_array()
            .iter()
            .copied()
            .collect::<Vec<f64>>();
        let (values, frames, joints) = motion(positions)?;
        if joints != self.joints.len() || frames != times.len() {
            let expected = format!("({}, {}, 3)", times.len(), self.joints.len());
            return Err(wrong_shape(&expected, &[frames, joints, 3]));
        }
        let found = py.detach(|| {
            let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
            let mut found = Vec::new();
            for (frame, time_secs) in times.into_iter().enumerate() {
                state.positions.clear();
                let of_frame = &values[frame * joints..(frame + 1) * joints];
                state.positions.extend_from_slice(of_frame);
                state.push(time_secs, &mut found);
            }
            found
        });
        self.rows(py, &found)
    }

    /// Ends the stream: the detections that its last moments still hold. The next push begins a new stream.
    fn finish<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let found = {
            let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
            state.finish().to_vec()
        };
        self.rows(py, &found)
    }

    /// The motion that seems to be under way after the last push, or `None`. Tentative.
    fn early_detection<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let early = {
            let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
            state.recognizer.early_detection()
        };
        let Some(early) = early else { return Ok(None) };
        let row = PyDict::new(py);
        if let Some(class) = self.classes.get(early.class.index()) {
            row.set_item("class", class)?;
        }
        row.set_item("score", early.score)?;
        row.set_item("progress", early.progress)?;
        row.set_item("start_secs", early.start_secs)?;
        row.set_item("seen_secs", early.seen_secs)?;
        set_repetitions(&row, early.repetitions)?;
        Ok(Some(row))
    }

    /// Names of the points of a pose, in the order of its rows.
    #[getter]
    fn joints(&self) -> Vec<String> {
        self.joints.clone()
    }

    /// Seconds from the end of a motion to its report at the earliest.
    #[getter]
    fn latency_secs(&self) -> f64 {
        self.latency_secs
    }

    fn __enter__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    #[pyo3(signature = (*_args))]
    fn __exit__(&self, _args: &Bound<'_, PyAny>) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        state.finish();
    }

    fn __repr__(&self) -> String {
        format!(
            "<morec.Recognizer: {} joints, {} classes, {:.2} s behind>",
            self.joints.len(),
            self.classes.len(),
            self.latency_secs
        )
    }
}
