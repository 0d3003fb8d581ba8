//! Events over a WebSocket, for browsers, engines and scripts.
//!
//! Limits are there for those who mean no good, or hang: of listeners, of connections that say hello at once, and of how long
//! for it, messages of a few kilobytes, slow listeners let go. A page in a browser is served only if it comes from this
//! machine, or from the origin that `?origin=` names: any page that somebody looks at could listen otherwise.

pub(crate) mod greet;
#[cfg(test)]
mod tests;

use std::io::ErrorKind;
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TrySendError, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use tungstenite::{Error, Message};

use self::greet::{LISTENER, Socket, greet};
use crate::error::Context;
use crate::{Address, LiveError, NamedEvent, Sink};

/// Events that may wait for one listener; one that is slower than this is let go.
const WAITING: usize = 256;
/// Listeners at once.
const LISTENERS: usize = 32;
/// Connections at once that have not said hello.
const GREETING: usize = 16;
/// Limit of saying goodbye to all listeners.
const GOODBYE: Duration = Duration::from_millis(500);

/// A listener by number.
type Listener = (u64, SyncSender<String>);

#[derive(Default)]
struct Hall {
    listeners: Vec<Listener>,
    /// Connections that have not said hello.
    greeting: usize,
    /// Threads that serve a listener.
    serving: usize,
    /// The sink was dropped: no connection is accepted.
    closed: bool,
}

#[derive(Clone, Default)]
struct SharedHall(Arc<Mutex<Hall>>);

impl SharedHall {
    fn lock(&self) -> MutexGuard<'_, Hall> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Serves events as JSON, one text message each, to every listener.
pub struct WebSocketSink {
    hall: SharedHall,
}

impl WebSocketSink {
    /// Opens `ws://HOST:PORT`: listens there. Returns where, too.
    ///
    /// # Errors
    /// An address without a port or with another option; a port that is taken.
    pub fn open(address: &Address) -> Result<(Self, SocketAddr), LiveError> {
        address.allow(&["origin"])?;
        let origin = address.text("origin").map(str::to_owned);
        Self::listen(address.socket()?, origin)
    }

    fn listen(at: SocketAddr, origin: Option<String>) -> Result<(Self, SocketAddr), LiveError> {
        let listener =
            TcpListener::bind(at).with_context(|| format!("cannot listen at {at} (TCP)"))?;
        let at = listener.local_addr().context("TCP socket")?;
        let hall = SharedHall::default();
        let open = hall.clone();
        thread::Builder::new()
            .name("listeners".to_owned())
            .spawn(move || accept(&listener, &open, origin.as_deref()))
            .context("cannot start a thread for listeners")?;
        Ok((Self { hall }, at))
    }
}

impl Sink for WebSocketSink {
    fn emit(&mut self, event: &NamedEvent<'_>) -> std::io::Result<()> {
        let text = event.json();
        let mut hall = self.hall.lock();
        hall.listeners
            .retain(|(_, listener)| match listener.try_send(text.clone()) {
                Ok(()) => true,
                Err(TrySendError::Full(_) | TrySendError::Disconnected(_)) => false,
            });
        Ok(())
    }
}

impl Drop for WebSocketSink {
    /// Every listener gets a close frame, if it takes one in time.
    fn drop(&mut self) {
        let begun = Instant::now();
        {
            let mut hall = self.hall.lock();
            hall.closed = true;
            hall.listeners.clear();
        }
        while self.hall.lock().serving > 0 && begun.elapsed() < GOODBYE {
            thread::sleep(Duration::from_millis(5));
        }
    }
}

fn accept(listener: &TcpListener, hall: &SharedHall, origin: Option<&str>) {
    for (number, stream) in (0..).zip(listener.incoming()) {
        let Ok(stream) = stream else {
            thread::sleep(Duration::from_millis(100));
            continue;
        };
        {
            let mut hall = hall.lock();
            if hall.closed {
                return;
            }
            if hall.greeting >= GREETING || hall.listeners.len() >= LISTENERS {
                continue;
            }
            hall.greeting += 1;
        }
        let (known, origin) = (hall.clone(), origin.map(str::to_owned));
        let named = thread::Builder::new().name("a listener".to_owned());
        // Saying hello takes as long as the other side likes: not here.
        let job = move || attend(number, stream, &known, origin.as_deref());
        if named.spawn(job).is_err() {
            // Out of threads: this one goes without.
            hall.lock().greeting -= 1;
        }
    }
}

/// A listener from its hello to its end.
fn attend(number: u64, stream: TcpStream, hall: &SharedHall, origin: Option<&str>) {
    let socket = greet(stream, origin, LISTENER);
    let (sender, events) = sync_channel(WAITING);
    {
        let mut hall = hall.lock();
        hall.greeting -= 1;
        if socket.is_none() || hall.closed || hall.listeners.len() >= LISTENERS {
            return;
        }
        hall.listeners.push((number, sender));
        hall.serving += 1;
    }
    if let Some(socket) = socket {
        serve(socket, &events);
    }
    // The place of a closed connection is free at once, not at the next event.
    let mut hall = hall.lock();
    hall.listeners.retain(|(other, _)| *other != number);
    hall.serving -= 1;
}

/// Sends events until the listener leaves or the sink is gone.
fn serve(mut socket: Socket, events: &Receiver<String>) {
    loop {
        match events.recv_timeout(Duration::from_millis(200)) {
            Ok(text) => {
                if socket.send(Message::text(text)).is_err() {
                    return;
                }
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => {
                // A close frame; if it is lost, the other end notices the closed socket.
                let _ = socket.close(None);
                let _ = socket.flush();
                return;
            }
        }
        match socket.read() {
            Ok(_) => {}
            Err(Error::Io(error))
                if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {}
            Err(_) => return,
        }
    }
}
