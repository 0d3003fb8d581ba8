//! A session on a live source, event by event.

use std::io::ErrorKind;
use std::net::{SocketAddr, ToSocketAddrs, UdpSocket};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use morec::live::vmc::{VmcOptions, VmcReceiver};
use morec::live::{
    Event, EventOptions, EventReader, Frame, MAX_ACTORS, Model, Next, Overload, Session,
    SessionOptions, Source, SourceCounts, wall_now_secs,
};
use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::{morec_error, value_error};
use crate::index::PyIndex;

/// The socket is asked this long at a time: the quiet that closes a frame.
const WAIT: Duration = Duration::from_millis(5);
/// The largest datagram there is.
const LARGEST: usize = 65_536;

/// VMC senders on a UDP port.
struct VmcSource {
    socket: UdpSocket,
    receiver: VmcReceiver<SocketAddr>,
    buffer: Vec<u8>,
}

impl Source for VmcSource {
    fn next(&mut self, frame: &mut Frame) -> Next {
        if let Some(next) = self.receiver.next(frame) {
            return next;
        }
        match self.socket.recv_from(&mut self.buffer) {
            Ok((length, peer)) => {
                let packet = &self.buffer[..length];
                self.receiver.packet(peer, wall_now_secs(), packet);
            }
            Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {}
            // A sender's port that is closed may be told here; it concerns nothing that we sent.
            Err(_) => std::thread::sleep(WAIT),
        }
        self.receiver.tick(wall_now_secs());
        self.receiver.next(frame).unwrap_or(Next::Quiet)
    }

    fn counts(&self) -> SourceCounts {
        self.receiver.counts()
    }
}

/// A session that listens; `morec.listen` is made of it.
#[pyclass(frozen, module = "morec")]
pub struct LiveSession {
    /// Ended by being dropped.
    open: Mutex<Option<Session>>,
    reader: Mutex<EventReader>,
    model: Model,
    address: String,
}

fn held<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

fn bind(address: &str, options: &VmcOptions) -> PyResult<(VmcSource, String)> {
    let place = address.strip_prefix("vmc://").ok_or_else(|| {
        value_error(format!(
            "address: expected vmc://HOST:PORT, as vmc://127.0.0.1:39539, found {address}"
        ))
    })?;
    let found = place.to_socket_addrs().ok().and_then(|mut all| all.next());
    let at =
        found.ok_or_else(|| value_error(format!("address: expected HOST:PORT, found {place}")))?;
    let refused = |error: std::io::Error| {
        PyOSError::new_err(format!(
            "cannot listen at {at} (UDP): {error}; is another program listening there?"
        ))
    };
    let socket = UdpSocket::bind(at).map_err(refused)?;
    socket.set_read_timeout(Some(WAIT))?;
    let shown = format!("vmc://{}", socket.local_addr()?);
    let source = VmcSource {
        socket,
        receiver: VmcReceiver::new(options),
        buffer: vec![0; LARGEST],
    };
    Ok((source, shown))
}

#[pymethods]
impl LiveSession {
    #[new]
    fn new(
        address: &str,
        index: &PyIndex,
        actors: usize,
        mirror: bool,
        tentative: bool,
    ) -> PyResult<Self> {
        if !(1..=MAX_ACTORS).contains(&actors) {
            return Err(value_error(format!(
                "actors: expected 1 to {MAX_ACTORS}, found {actors}"
            )));
        }
        let vmc = VmcOptions {
            mirrored: mirror,
            actors,
            ..VmcOptions::default()
        };
        let (source, address) = bind(address, &vmc)?;
        let options = SessionOptions {
            overload: Overload::Drop,
            events: EventOptions {
                early: tentative,
                ..EventOptions::default()
            },
            ..SessionOptions::default()
        };
        let model = index.index.model.clone();
        let (session, readers) =
            Session::start(&model, Box::new(source), &options).map_err(morec_error)?;
        let reader = readers.into_iter().next();
        Ok(Self {
            open: Mutex::new(Some(session)),
            reader: Mutex::new(reader.ok_or_else(|| morec_error("no reader of events"))?),
            model,
            address,
        })
    }

    #[getter]
    fn address(&self) -> &str {
        &self.address
    }

    /// The next event within so many seconds.
    fn wait<'py>(&self, py: Python<'py>, secs: f64) -> PyResult<Option<Bound<'py, PyDict>>> {
        let most = Duration::from_secs_f64(secs.clamp(0.0, 3600.0));
        let event = py.detach(|| held(&self.reader).wait(most));
        event.map(|event| self.row(py, &event)).transpose()
    }

    /// Whether nothing more can come.
    fn is_ended(&self, py: Python<'_>) -> bool {
        py.detach(|| held(&self.open).is_none() || held(&self.reader).is_ended())
    }

    /// Counts so far.
    fn status<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let status = py.detach(|| held(&self.open).as_ref().map(Session::status));
        let dict = PyDict::new(py);
        if let Some(status) = status {
            dict.set_item("frames", status.frames)?;
            dict.set_item("dropped_frames", status.dropped_frames)?;
            dict.set_item("unusable_frames", status.unusable_frames)?;
            dict.set_item("events", status.events)?;
            dict.set_item("dropped_events", status.dropped_events)?;
            dict.set_item("motions", status.motions)?;
            dict.set_item("actors", status.actors.len())?;
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
    fn row<'py>(&self, py: Python<'py>, event: &Event) -> PyResult<Bound<'py, PyDict>> {
        let row = PyDict::new(py);
        row.set_item("phase", event.phase.name())?;
        row.set_item("class", self.model.class_name(event.class))?;
        row.set_item("start_secs", event.start_secs)?;
        row.set_item("stop_secs", event.stop_secs)?;
        row.set_item("score", event.score)?;
        row.set_item("progress", event.progress)?;
        row.set_item("reported_secs", event.reported_secs)?;
        row.set_item("actor", event.actor.0)?;
        row.set_item("motion", event.motion)?;
        row.set_item("sequence", event.sequence)?;
        row.set_item("wall_secs", event.wall_secs)?;
        Ok(row)
    }
}
