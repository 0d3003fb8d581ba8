//! Lines of text from standard input or from whoever connects, each on a thread of its own.

use std::io::{BufRead, BufReader, ErrorKind, Read};
use std::net::{Shutdown, SocketAddr, TcpListener, TcpStream};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use crate::LiveError;
use crate::error::Context;

/// A longer line is no pose.
pub const LONGEST: u64 = 1 << 16;
/// Lines that may wait, half a second of four senders; then whoever sends them does.
const WAITING: usize = 128;
/// However long they are, they take little memory.
const _: () = assert!(WAITING as u64 * LONGEST <= 8 << 20);
/// Connections at once.
const CONNECTIONS: usize = 16;
/// A connection over which no whole line has come for so long is closed.
const SILENCE: Duration = Duration::from_secs(30);
/// A connection over which none has come for so long makes room for another, if all places are taken.
const IDLE: Duration = Duration::from_secs(1);

/// Something that came.
pub enum Came {
    /// A line.
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

/// A source of lines.
pub struct Lines {
    came: Receiver<Came>,
}

impl Lines {
    /// Standard input.
    pub fn stdin() -> Result<Self, LiveError> {
        let (sender, came) = sync_channel(WAITING);
        spawn("standard input", move || {
            forward(0, std::io::stdin().lock(), &sender)
        })?;
        Ok(Self { came })
    }

    /// Whoever connects to `address` over TCP. Returns where it listens, too.
    pub fn listen(address: SocketAddr) -> Result<(Self, SocketAddr), LiveError> {
        let listener = TcpListener::bind(address)
            .with_context(|| format!("cannot listen at {address} (TCP)"))?;
        let at = listener.local_addr().context("TCP socket")?;
        let (sender, came) = sync_channel(WAITING);
        spawn("connections", move || accept(&listener, &sender))?;
        Ok((Self { came }, at))
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
        .with_context(|| format!("no thread for {name}"))?;
    Ok(())
}

/// A connection that is open.
struct OpenConnection {
    number: u64,
    stream: TcpStream,
    since: Since,
}

/// When the line under way began to be waited for.
type Since = Arc<Mutex<Instant>>;

fn lock<T>(shared: &Mutex<T>) -> MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

fn accept(listener: &TcpListener, sender: &SyncSender<Came>) {
    let open: Arc<Mutex<Vec<OpenConnection>>> = Arc::default();
    for (number, stream) in (1..).zip(listener.incoming()) {
        let Ok(stream) = stream else {
            // Out of files, most likely; others may close theirs.
            thread::sleep(Duration::from_millis(100));
            continue;
        };
        let since = Arc::new(Mutex::new(Instant::now()));
        let Ok(copy) = stream.try_clone() else {
            continue;
        };
        if !make_room(&mut lock(&open)) {
            continue;
        }
        lock(&open).push(OpenConnection {
            number,
            stream: copy,
            since: since.clone(),
        });
        let (sender, others) = (sender.clone(), open.clone());
        let leave = move || lock(&others).retain(|held| held.number != number);
        let left = leave.clone();
        let job = move || {
            let patient = Patient {
                stream,
                since,
                silence: SILENCE,
            };
            forward(number, BufReader::new(patient), &sender);
            left();
        };
        if spawn("a connection", job).is_err() {
            leave();
        }
    }
}

/// True if there is a place: if need be that of the connection that has brought no line for longest.
fn make_room(open: &mut Vec<OpenConnection>) -> bool {
    if open.len() < CONNECTIONS {
        return true;
    }
    let since = |held: &OpenConnection| *lock(&held.since);
    let idle = (0..open.len()).min_by_key(|at| since(&open[*at]));
    let Some(idle) = idle.filter(|at| since(&open[*at]).elapsed() > IDLE) else {
        return false;
    };
    // Its thread wakes and ends; if it has ended already, all the better.
    let _ = open.swap_remove(idle).stream.shutdown(Shutdown::Both);
    true
}

/// A connection that must bring a whole line in time: one that sends nothing, or a byte now and then, holds no place.
struct Patient {
    stream: TcpStream,
    since: Since,
    silence: Duration,
}

impl Read for Patient {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let waited = lock(&self.since).elapsed();
        let left = self.silence.saturating_sub(waited);
        if left.is_zero() {
            return Err(ErrorKind::TimedOut.into());
        }
        self.stream.set_read_timeout(Some(left))?;
        let count = self.stream.read(buffer)?;
        if buffer[..count].contains(&b'\n') {
            *lock(&self.since) = Instant::now();
        }
        Ok(count)
    }
}

/// Sends every line until the end of `reader`, or until nobody takes them.
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
    // If nobody takes it, nobody needs to know.
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
            since: Arc::new(Mutex::new(Instant::now())),
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
            *lock(&patient.since) = before;
            client.write_all(text.as_bytes()).unwrap();
            assert_eq!(patient.read(&mut byte).unwrap(), text.len());
            assert_eq!(*lock(&patient.since) > before, buys, "{text:?}");
        }
        patient.silence = Duration::from_millis(1);
        assert!(patient.read(&mut byte).is_err(), "nothing came in time");
    }

    /// Whoever holds every place and brings nothing does not keep out who has something to say.
    #[test]
    fn idle_connections_make_room() {
        let (mut lines, at) = Lines::listen("127.0.0.1:0".parse().unwrap()).unwrap();
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
