//! Lines of text from standard input or TCP connections, with a thread for each. Limits of length, time and number of connections
//! are enforced here.

use std::io::{BufRead, BufReader, ErrorKind, Read};
use std::net::{IpAddr, SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

use crate::error::Context;
use crate::places::{CONNECTIONS, ConnectionPlaces};
use crate::{LiveError, Notices};

/// A longer line is no pose.
pub const LONGEST: u64 = 1 << 16;
/// Lines that may wait, half a second of four senders; then the sender waits.
const WAITING: usize = 128;
/// However long they are, they take little memory.
const _: () = assert!(WAITING as u64 * LONGEST <= 8 << 20);
/// A connection over which no whole line has come for so long is closed.
pub const SILENCE: Duration = Duration::from_secs(30);

/// Something that came.
pub enum Came {
    /// A line was read whole.
    Line {
        /// Whose it is.
        connection: u64,
        /// Number of the connection's line, from 1.
        number: u64,
        /// It without its end; `None` if it was too long or no text.
        text: Option<String>,
    },
    /// This connection has ended.
    Closed(u64),
    /// Nothing came in a while.
    Nothing,
    /// Nothing will come.
    Ended,
}

/// Serves a connection, by its number, to its end, on a thread of its own; lines go to the sender.
pub type Attend = dyn Fn(u64, TcpStream, &SyncSender<Came>) + Send + Sync;

/// A source of lines.
pub struct Lines {
    came: Receiver<Came>,
    places: ConnectionPlaces,
}

impl Lines {
    /// Lines from standard input.
    ///
    /// # Errors
    /// The thread that reads them cannot be started.
    pub fn stdin() -> Result<Self, LiveError> {
        let (sender, came) = sync_channel(WAITING);
        spawn("standard input", move || {
            forward(0, std::io::stdin().lock(), &sender)
        })?;
        let places = ConnectionPlaces::default();
        Ok(Self { came, places })
    }

    /// Lines from every program that connects to `address` over TCP. Also returns the actual address, with the port if
    /// `address` has port 0. Refused connections are reported in `notices`.
    ///
    /// # Errors
    /// The address cannot be listened at, for instance because another program uses it.
    pub fn listen(address: SocketAddr, notices: &Notices) -> Result<(Self, SocketAddr), LiveError> {
        Self::serve(address, notices, Arc::new(read))
    }

    /// Like [`listen`](Self::listen), for connections whose lines `attend` reads in another way, such as the webcam's page.
    ///
    /// # Errors
    /// As [`listen`](Self::listen).
    pub fn serve(
        address: SocketAddr,
        notices: &Notices,
        attend: Arc<Attend>,
    ) -> Result<(Self, SocketAddr), LiveError> {
        let listener = TcpListener::bind(address)
            .with_context(|| format!("cannot listen at {address} (TCP)"))?;
        let at = listener.local_addr().context("TCP socket")?;
        let (sender, came) = sync_channel(WAITING);
        let places = ConnectionPlaces::default();
        let (open, notices) = (places.clone(), notices.clone());
        spawn("connections", move || {
            accept(&listener, &sender, &open, &notices, &attend)
        })?;
        Ok((Self { came, places }, at))
    }

    /// Notes that a line of `connection` showed a body: it keeps its place by that.
    pub fn showed_body(&self, connection: u64) {
        self.places.keep(connection, Instant::now());
    }

    /// The machine of a connection, if it is open.
    pub fn machine(&self, connection: u64) -> Option<IpAddr> {
        self.places.machine(connection)
    }

    /// Gives a connection a place without listening for its lines.
    #[cfg(test)]
    pub fn place(&self, connection: u64, stream: TcpStream, from: IpAddr) {
        assert!(self.places.take(connection, stream, from, Instant::now()));
    }

    /// The next arrival; waits for it a little.
    pub fn next(&mut self, most: Duration) -> Came {
        match self.came.recv_timeout(most) {
            Ok(came) => came,
            Err(RecvTimeoutError::Timeout) => Came::Nothing,
            Err(RecvTimeoutError::Disconnected) => Came::Ended,
        }
    }
}

fn spawn(name: &str, job: impl FnOnce() + Send + 'static) -> Result<(), LiveError> {
    thread::Builder::new()
        .name(name.to_owned())
        .spawn(job)
        .with_context(|| format!("cannot start a thread for {name}"))?;
    Ok(())
}

fn accept(
    listener: &TcpListener,
    sender: &SyncSender<Came>,
    places: &ConnectionPlaces,
    notices: &Notices,
    attend: &Arc<Attend>,
) {
    for (number, stream) in (1..).zip(listener.incoming()) {
        let Ok(stream) = stream else {
            // Out of files, most likely; others may close theirs.
            thread::sleep(Duration::from_millis(100));
            continue;
        };
        let (Ok(copy), Ok(from)) = (stream.try_clone(), stream.peer_addr()) else {
            continue;
        };
        if !places.take(number, copy, from.ip(), Instant::now()) {
            notices.tell(format!(
                "a connection from {} is refused: {CONNECTIONS} others are in use",
                from.ip()
            ));
            continue;
        }
        let (sender, open, attend) = (sender.clone(), places.clone(), attend.clone());
        let job = move || {
            attend(number, stream, &sender);
            open.leave(number);
        };
        if spawn("a connection", job).is_err() {
            places.leave(number);
        }
    }
}

/// A connection that brings nothing but lines.
fn read(number: u64, stream: TcpStream, sender: &SyncSender<Came>) {
    let patient = Patient {
        stream,
        since: Instant::now(),
        silence: SILENCE,
    };
    forward(number, BufReader::new(patient), sender);
}

/// A connection that must bring a whole line in time: one that sends nothing, or a byte now and then, holds no place.
struct Patient {
    stream: TcpStream,
    /// When the line under way began to be waited for.
    since: Instant,
    silence: Duration,
}

impl Read for Patient {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let waited = self.since.elapsed();
        let left = self.silence.saturating_sub(waited);
        if left.is_zero() {
            return Err(ErrorKind::TimedOut.into());
        }
        self.stream.set_read_timeout(Some(left))?;
        let count = self.stream.read(buffer)?;
        if buffer[..count].contains(&b'\n') {
            self.since = Instant::now();
        }
        Ok(count)
    }
}

/// Sends every line until the end of `reader`, or until the receiver is dropped.
fn forward(number: u64, mut reader: impl BufRead, sender: &SyncSender<Came>) {
    let (mut bytes, mut lines) = (Vec::new(), 0);
    loop {
        bytes.clear();
        match reader.by_ref().take(LONGEST).read_until(b'\n', &mut bytes) {
            Ok(0) => break,
            Ok(_) => {}
            Err(error) if error.kind() == ErrorKind::Interrupted => continue,
            Err(_) => break,
        }
        // What follows a part of a line that is too long still belongs to it.
        let ended = bytes.ends_with(b"\n");
        let line = lines + 1;
        lines += u64::from(ended);
        let whole = ended || (bytes.len() as u64) < LONGEST;
        let text = std::str::from_utf8(&bytes).ok().filter(|_| whole);
        if text.is_some_and(|text| text.trim().is_empty()) {
            continue;
        }
        let came = Came::Line {
            connection: number,
            number: line,
            text: text.map(|text| text.trim_end().to_owned()),
        };
        if sender.send(came).is_err() {
            return;
        }
    }
    // A dropped receiver is no fault.
    let _ = sender.send(Came::Closed(number));
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;

    /// A connection that sends bytes but no line is closed; a line buys time for the next.
    #[test]
    fn a_connection_without_lines_is_closed() {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let mut client = TcpStream::connect(listener.local_addr().unwrap()).unwrap();
        let mut patient = Patient {
            stream: listener.accept().unwrap().0,
            since: Instant::now(),
            silence: SILENCE,
        };
        let hour = Duration::from_secs(3600);
        let mut byte = [0; 16];
        for (text, buys) in [("x", false), ("y\n", true)] {
            patient.silence = 2 * hour;
            let Some(before) = Instant::now().checked_sub(hour) else {
                // The machine has been up for less than an hour, and its clock began then.
                return;
            };
            patient.since = before;
            client.write_all(text.as_bytes()).unwrap();
            assert_eq!(patient.read(&mut byte).unwrap(), text.len());
            assert_eq!(patient.since > before, buys, "{text:?}");
        }
        patient.silence = Duration::from_millis(1);
        assert!(patient.read(&mut byte).is_err(), "nothing came in time");
    }

    /// Whoever holds every place and brings nothing does not keep out who has something to say.
    #[test]
    fn idle_connections_make_room() {
        let (address, notices) = ("127.0.0.1:0".parse().unwrap(), Notices::default());
        let (mut lines, at) = Lines::listen(address, &notices).unwrap();
        let _idle: Vec<TcpStream> = (0..2 * CONNECTIONS)
            .map(|_| TcpStream::connect(at).unwrap())
            .collect();
        loop {
            // As long as the others may still bring a line it is refused, and tries again, as senders do.
            let mut sender = TcpStream::connect(at).unwrap();
            let _ = sender.write_all(b"hello\n");
            if let Came::Line { text, .. } = lines.next(Duration::from_millis(100)) {
                assert_eq!(text.as_deref(), Some("hello"));
                return;
            }
        }
    }
}
