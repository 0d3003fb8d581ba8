//! `morec.Recognizer`: a live stream of one performer, array by array.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use morec::index::MotionIndex;
use morec::live::{Event, PerformerStream, StreamError, StreamOptions, wall_now_secs};
use morec::math::Vec3;
use morec::roles::Role;
use morec::roles::points::{PointJoint, places_of};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::arrays::{doubles, motion, pose, wrong_shape};
use crate::clip::PyClip;
use crate::errors::{morec_error, value_error};
use crate::tables::events;

/// Recognises motions in one performer's stream of joint positions. Returned by `Index.recognizer`.
///
/// Any thread may push; simultaneous calls wait for each other.
#[pyclass(frozen, name = "Recognizer", module = "morec")]
pub struct PyRecognizer {
    state: Mutex<RecognizerState>,
    joints: Vec<String>,
    index: Arc<MotionIndex>,
    latency_secs: f64,
}

struct RecognizerState {
    stream: PerformerStream,
    positions: Vec<Vec3>,
}

/// The part of the body that each point of an array plays.
pub struct PointLayout {
    joints: Vec<String>,
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

    /// Points of these names: a published set (MediaPipe, COCO, Kinect, marker sets), usual joint names, names of roles.
    pub fn of_names(joints: Vec<String>) -> Self {
        let names: Vec<&str> = joints.iter().map(String::as_str).collect();
        let places = places_of(&names);
        Self { joints, places }
    }
}

/// Options of a stream from keywords.
///
/// # Errors
/// An option that does not exist, or that cannot have its value.
pub fn stream_options(given: Option<&Bound<'_, PyDict>>) -> PyResult<StreamOptions> {
    let Some(given) = given else {
        return Ok(StreamOptions::default());
    };
    let json = given.py().import("json")?.call_method1("dumps", (given,))?;
    StreamOptions::from_json(&json.extract::<String>()?).map_err(value_error)
}

fn stream_error(error: StreamError) -> PyErr {
    match error {
        StreamError::Option(_) | StreamError::Roles(_) | StreamError::NoParts => value_error(error),
        StreamError::NoRotations { .. } => {
            morec_error(format!("{error}; Index.recognize recognises whole clips"))
        }
        error => morec_error(error),
    }
}

impl PyRecognizer {
    /// For poses laid out as `layout`.
    ///
    /// # Errors
    /// A model that needs joint rotations, or that has no bone in common with the layout; an option that cannot be.
    pub fn new(
        index: &Arc<MotionIndex>,
        layout: PointLayout,
        options: &StreamOptions,
    ) -> PyResult<Self> {
        let names: Vec<&str> = layout.joints.iter().map(String::as_str).collect();
        let stream = PerformerStream::of_places(index, &names, layout.places, options);
        let stream = stream.map_err(stream_error)?;
        Ok(Self {
            index: index.clone(),
            latency_secs: stream.latency_secs().unwrap_or_default(),
            state: Mutex::new(RecognizerState {
                stream,
                positions: Vec::with_capacity(layout.joints.len()),
            }),
            joints: layout.joints,
        })
    }

    fn state(&self) -> MutexGuard<'_, RecognizerState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn rows<'py>(&self, py: Python<'py>, found: &[Event]) -> PyResult<Bound<'py, PyList>> {
        events(py, &self.index.model, found)
    }
}

#[pymethods]
impl PyRecognizer {
    /// Takes the pose at `time_secs` on the stream's clock; the events that it settled, mostly none.
    fn push<'py>(
        &self,
        py: Python<'py>,
        time_secs: f64,
        positions: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyList>> {
        let found = {
            let RecognizerState {
                stream,
                positions: places,
            } = &mut *self.state();
            pose(positions, self.joints.len(), places)?;
            push(stream, time_secs, places).to_vec()
        };
        self.rows(py, &found)
    }

    /// Takes many poses: times of shape (frames,), positions of shape (frames, joints, 3); all events they settled.
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
            let mut state = self.state();
            let mut found = Vec::new();
            for (frame, time_secs) in times.into_iter().enumerate() {
                let of_frame = &values[frame * joints..(frame + 1) * joints];
                found.extend_from_slice(push(&mut state.stream, time_secs, of_frame));
            }
            found
        });
        self.rows(py, &found)
    }

    /// Ends the stream: the events that its last moments still hold. The next push begins a new stream.
    fn finish<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let found = self.state().stream.finish().to_vec();
        self.rows(py, &found)
    }

    /// What is wrong with the stream of the last seconds for the index, a sentence each.
    fn diagnosis(&self) -> Vec<String> {
        self.state().stream.findings()
    }

    /// Names of the points of a pose, in the order of its rows.
    #[getter]
    fn joints(&self) -> Vec<String> {
        self.joints.clone()
    }

    /// Shortest time from the end of a motion to its report, seconds.
    #[getter]
    fn latency_secs(&self) -> f64 {
        self.latency_secs
    }

    fn __repr__(&self) -> String {
        format!(
            "<morec.Recognizer: {} joints, {} classes, {:.2} s behind>",
            self.joints.len(),
            self.index.model.classes().len(),
            self.latency_secs
        )
    }
}

/// Takes the pose whose points are at `places`.
fn push<'s>(stream: &'s mut PerformerStream, time_secs: f64, places: &[Vec3]) -> &'s [Event] {
    for (value, place) in stream.values().chunks_exact_mut(3).zip(places) {
        value.copy_from_slice(place.as_slice());
    }
    stream.push_values(time_secs, wall_now_secs())
}
