//! A session on a live source, event by event.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use morec::index::MotionIndex;
use morec::live::{EventReader, MAX_PERFORMERS, Session, SessionOptions, Status};
use morec_live::{
    Address, Advice, LiveError, Notices, SourceOptions, advice_of_status, open_source,
};
use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::{file_error, morec_error, value_error};
use crate::index::PyIndex;
use crate::recognizer::stream_options;
use crate::tables::event;

/// A session that listens; `morec.listen` is made of it.
#[pyclass(frozen, module = "morec")]
pub struct LiveSession {
    /// Ended by being dropped.
    open: Mutex<Option<Session>>,
    reader: Mutex<EventReader>,
    index: Arc<MotionIndex>,
    address: String,
    notices: Notices,
    advice: Mutex<Advice>,
}

fn held<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Why a source cannot be opened, as Python's own exceptions where it has one.
fn live_error(error: LiveError) -> PyErr {
    match error {
        LiveError::Address(text) => value_error(format!("address: {text}")),
        LiveError::Io { what, why } => PyOSError::new_err(format!("{what}: {why}")),
        LiveError::File(error) => file_error(&error),
        other => morec_error(other),
    }
}

#[pymethods]
impl LiveSession {
    #[new]
    fn new(
        address: &str,
        index: &PyIndex,
        actors: usize,
        mirror: bool,
        options: &Bound<'_, PyDict>,
    ) -> PyResult<Self> {
        let given = stream_options(Some(options))?;
        let model = given
            .tuned(index.index.model.clone())
            .map_err(value_error)?;
        if !(1..=MAX_PERFORMERS).contains(&actors) {
            return Err(value_error(format!(
                "actors: expected 1 to {MAX_PERFORMERS}, found {actors}"
            )));
        }
        let how = SourceOptions {
            mirrored: mirror,
            actors,
            roles: (!given.roles.is_empty()).then(|| given.roles.clone()),
            index: Some(&index.index),
            ..SourceOptions::default()
        };
        let parsed: Address = address
            .parse()
            .map_err(|e| value_error(format!("address: {e}")))?;
        let opened = open_source(&parsed, &how).map_err(live_error)?;
        let options = SessionOptions {
            overload: opened.overload,
            events: given.events().map_err(value_error)?,
            ..SessionOptions::default()
        };
        let index = index.index.clone();
        let (session, readers) =
            Session::start(&model, opened.source, &options).map_err(morec_error)?;
        let reader = readers.into_iter().next();
        Ok(Self {
            open: Mutex::new(Some(session)),
            reader: Mutex::new(reader.ok_or_else(|| morec_error("no events are being read"))?),
            index,
            advice: Mutex::new(Advice::new([opened.name.clone()])),
            address: opened.name,
            notices: opened.notices,
        })
    }

    #[getter]
    fn address(&self) -> &str {
        &self.address
    }

    /// The next event within this many seconds.
    fn wait<'py>(&self, py: Python<'py>, secs: f64) -> PyResult<Option<Bound<'py, PyDict>>> {
        let most = Duration::from_secs_f64(secs.clamp(0.0, 3600.0));
        let next = py.detach(|| held(&self.reader).wait(most));
        next.map(|e| event(py, &self.index.model, &e)).transpose()
    }

    /// Faults of the data that the source received since the last call, and what is newly found wrong with the stream for the
    /// index, a sentence each.
    fn notices(&self, py: Python<'_>) -> Vec<String> {
        let mut notices = self.notices.take();
        if let Some(status) = self.counts(py) {
            notices.extend(held(&self.advice).look(&[status], &self.index));
        }
        notices
    }

    /// True if nothing more can come.
    fn is_ended(&self, py: Python<'_>) -> bool {
        py.detach(|| held(&self.open).is_none() || held(&self.reader).is_ended())
    }

    /// Counts so far.
    fn status<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        if let Some(status) = self.counts(py) {
            dict.set_item("frames", status.frames)?;
            dict.set_item("dropped_frames", status.dropped_frames)?;
            dict.set_item("unusable_frames", status.unusable_frames)?;
            dict.set_item("events", status.events)?;
            dict.set_item("dropped_events", status.dropped_events)?;
            dict.set_item("motions", status.motions)?;
            dict.set_item("actors", status.actors.len())?;
            dict.set_item("findings", advice_of_status(&status, &self.index))?;
        }
        Ok(dict)
    }

    /// Stops listening and frees the port.
    fn close(&self, py: Python<'_>) {
        let session = held(&self.open).take();
        py.detach(|| drop(session));
    }
}

impl LiveSession {
    fn counts(&self, py: Python<'_>) -> Option<Status> {
        py.detach(|| held(&self.open).as_ref().map(Session::status))
    }
}
