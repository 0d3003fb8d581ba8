//! The BVH broadcast of Axis Neuron and Axis Studio: from the program that broadcasts, over TCP or UDP.

use std::io::{ErrorKind, Read};
use std::net::{SocketAddr, TcpStream, UdpSocket};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::thread;
use std::time::Duration;

use super::bones::AxisSkeleton;
use super::receiver::{AxisOptions, AxisReceiver};
use morec::files;
use morec::live::{Frame, Source, SourceCounts, SourceEvent, wall_now_secs};

use crate::error::Context;
use crate::places::machine_number;
use crate::{Address, LiveError, Notices};

/// A source must not wait longer than this.
const WAIT: Duration = Duration::from_millis(10);
/// Between one try to connect and the next.
const AGAIN: Duration = Duration::from_millis(500);
/// Limit of connecting, and interval between looks at a silent connection.
const PATIENCE: Duration = Duration::from_secs(2);
/// Pieces of a connection's bytes that may wait; then the sender does.
const WAITING: usize = 64;

/// Something that a connection gave.
enum Received {
    Bytes(Vec<u8>, f64),
    Lost,
}

enum From {
    /// Connected to whenever it is there, by a thread of its own.
    Tcp(Receiver<Received>),
    Udp(UdpSocket, Vec<u8>),
}

/// A broadcast.
pub struct AxisSource {
    from: From,
    receiver: AxisReceiver,
    closed: Arc<AtomicBool>,
    /// True once the fault was reported; further ones are counted only.
    complained: bool,
    notices: Notices,
}

impl AxisSource {
    /// Opens `axis://HOST:PORT`, a program that broadcasts there over TCP, or `axis+udp://HOST:PORT`, a port here that
    /// it sends to. It need not be there yet. Returns the name to call it by, too.
    ///
    /// # Errors
    /// An address without a port, a port that is taken.
    pub fn open(address: &Address, options: &AxisOptions) -> Result<(Self, String), LiveError> {
        address.allow(&[])?;
        let closed = Arc::new(AtomicBool::new(false));
        let at = address.socket()?;
        let (from, name) = match address.kind.as_str() {
            "axis+udp" => {
                let socket = UdpSocket::bind(at).with_context(|| {
                    format!("cannot listen at {at} (UDP): is another program listening there?")
                })?;
                socket.set_read_timeout(Some(WAIT)).context("UDP socket")?;
                let name = format!("axis+udp://{}", socket.local_addr().context("UDP socket")?);
                (From::Udp(socket, vec![0; 65_536]), name)
            }
            _ => {
                let (sender, came) = sync_channel(WAITING);
                let closed = closed.clone();
                let named = thread::Builder::new().name("axis".to_owned());
                named
                    .spawn(move || connect(at, &sender, &closed))
                    .context("cannot start a thread for a connection")?;
                (From::Tcp(came), address.to_string())
            }
        };
        let receiver = AxisReceiver::new(options);
        Ok((
            Self {
                from,
                receiver,
                closed,
                complained: false,
                notices: Notices::default(),
            },
            name,
        ))
    }

    fn complain(&mut self) {
        if let Some(error) = self.receiver.take_error().filter(|_| !self.complained) {
            self.complained = true;
            self.notices
                .tell(format!("{error}; continuing with the next frame"));
        }
    }

    /// Notices about received data.
    pub fn notices(&self) -> Notices {
        self.notices.clone()
    }
}

impl Drop for AxisSource {
    fn drop(&mut self) {
        self.closed.store(true, Relaxed);
    }
}

impl Source for AxisSource {
    fn next(&mut self, frame: &mut Frame) -> SourceEvent {
        if let Some(next) = self.receiver.next(frame) {
            return next;
        }
        match &mut self.from {
            From::Tcp(came) => match came.recv_timeout(WAIT) {
                Ok(Received::Bytes(bytes, at_secs)) => self.receiver.bytes(at_secs, &bytes),
                Ok(Received::Lost) => self.receiver.lost(),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => thread::sleep(WAIT),
            },
            From::Udp(socket, buffer) => match socket.recv_from(buffer) {
                Ok((length, from)) => {
                    let machine = machine_number(from.ip());
                    let bytes = &buffer[..length];
                    self.receiver.bytes_from(machine, wall_now_secs(), bytes);
                    self.receiver.cut();
                }
                Err(error)
                    if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {}
                Err(_) => thread::sleep(WAIT),
            },
        }
        self.receiver.tick(wall_now_secs());
        self.complain();
        self.receiver.next(frame).unwrap_or(SourceEvent::Quiet)
    }

    fn counts(&self) -> SourceCounts {
        self.receiver.counts()
    }
}

/// Connects again and again, and passes on what comes.
fn connect(at: SocketAddr, to: &SyncSender<Received>, closed: &AtomicBool) {
    while !closed.load(Relaxed) {
        if let Ok(stream) = TcpStream::connect_timeout(&at, PATIENCE) {
            // Without it a source that is no longer wanted is noticed late, no more.
            let _ = stream.set_read_timeout(Some(PATIENCE));
            if !pass_on(stream, to, closed) || to.send(Received::Lost).is_err() {
                return;
            }
        }
        thread::sleep(AGAIN);
    }
}

/// Reads until the other end goes; says whether anybody still wants to hear.
fn pass_on(mut stream: TcpStream, to: &SyncSender<Received>, closed: &AtomicBool) -> bool {
    let mut bytes = vec![0; 16_384];
    while !closed.load(Relaxed) {
        match stream.read(&mut bytes) {
            Ok(0) => return true,
            Ok(length) => {
                if to
                    .send(Received::Bytes(bytes[..length].to_vec(), wall_now_secs()))
                    .is_err()
                {
                    return false;
                }
            }
            Err(error)
                if matches!(
                    error.kind(),
                    ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted
                ) => {}
            Err(_) => return true,
        }
    }
    false
}

/// The skeleton of a BVH file that the broadcasting program wrote.
///
/// # Errors
/// A file that cannot be read, or whose joints are not those of a broadcast.
pub fn axis_skeleton(path: &Path) -> Result<AxisSkeleton, LiveError> {
    let shown = path.display();
    let takes = files::open(path)?;
    let none = || LiveError::Clip(format!("{shown}: contains no skeleton"));
    let take = takes.first().ok_or_else(none)?;
    AxisSkeleton::of_clip(&take.clip.skeleton, &take.roles)
        .map_err(|error| LiveError::Clip(format!("{shown}: {error}")))
}
