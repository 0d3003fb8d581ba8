//! Events for whoever connects with a WebSocket: browsers, engines, scripts.

use std::io::ErrorKind;
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TrySendError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use anyhow::{Context, Result};
use tungstenite::{Error, Message, WebSocket};

use super::address::Address;
use super::{Said, Sink};

/// Events that may wait for one listener; one that is slower than this is let go.
const WAITING: usize = 256;
/// Listeners at once.
const LISTENERS: usize = 32;
/// How long a listener may take to say hello, or to take a packet.
const PATIENCE: Duration = Duration::from_secs(2);

type Listeners = Arc<Mutex<Vec<SyncSender<String>>>>;

/// Serves events as JSON, one text message each, to every listener.
pub struct WebSocketSink {
    listeners: Listeners,
}

impl WebSocketSink {
    /// Opens `ws://HOST:PORT`: listens there.
    pub fn open(address: &Address) -> Result<Self> {
        address.allow(&[])?;
        let (sink, at) = Self::listen(address.socket()?)?;
        eprintln!("morec: events at ws://{at}");
        Ok(sink)
    }

    fn listen(at: SocketAddr) -> Result<(Self, SocketAddr)> {
        let listener =
            TcpListener::bind(at).with_context(|| format!("cannot listen at {at} (TCP)"))?;
        let at = listener.local_addr()?;
        let listeners = Listeners::default();
        let open = listeners.clone();
        thread::Builder::new()
            .name("listeners".to_owned())
            .spawn(move || accept(&listener, &open))
            .context("no thread for listeners")?;
        Ok((Self { listeners }, at))
    }
}

impl Sink for WebSocketSink {
    fn tell(&mut self, said: &Said) -> Result<()> {
        let text = said.json();
        let mut listeners = self
            .listeners
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        listeners.retain(|listener| match listener.try_send(text.clone()) {
            Ok(()) => true,
            Err(TrySendError::Full(_) | TrySendError::Disconnected(_)) => false,
        });
        Ok(())
    }
}

fn accept(listener: &TcpListener, listeners: &Listeners) {
    for stream in listener.incoming() {
        let Ok(stream) = stream else {
            thread::sleep(Duration::from_millis(100));
            continue;
        };
        let (sender, events) = sync_channel(WAITING);
        let named = thread::Builder::new().name("a listener".to_owned());
        let known = listeners.clone();
        // Saying hello takes as long as the other side likes: not here.
        let job = move || {
            let Some(socket) = greet(stream) else { return };
            {
                let mut known = known.lock().unwrap_or_else(PoisonError::into_inner);
                if known.len() >= LISTENERS {
                    return;
                }
                known.push(sender);
            }
            serve(socket, &events);
        };
        // Out of threads: this one goes without.
        let _ = named.spawn(job);
    }
}

fn greet(stream: TcpStream) -> Option<WebSocket<TcpStream>> {
    stream.set_read_timeout(Some(PATIENCE)).ok()?;
    stream.set_write_timeout(Some(PATIENCE)).ok()?;
    stream.set_nodelay(true).ok()?;
    let socket = tungstenite::accept(stream).ok()?;
    // From here on reading is only for pings and goodbyes.
    socket
        .get_ref()
        .set_read_timeout(Some(Duration::from_millis(1)))
        .ok()?;
    Some(socket)
}

/// Sends events until the listener leaves or the sink is gone.
fn serve(mut socket: WebSocket<TcpStream>, events: &Receiver<String>) {
    loop {
        match events.recv_timeout(Duration::from_millis(200)) {
            Ok(text) => {
                if socket.send(Message::text(text)).is_err() {
                    return;
                }
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => {
                // Goodbye; whoever does not hear it finds out.
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

#[cfg(test)]
mod tests {
    use super::*;
    use morec::classes::ClassId;
    use morec::live::{Actor, Event, Phase};

    #[test]
    fn a_listener_hears_every_event() {
        let (mut sink, at) = WebSocketSink::listen("127.0.0.1:0".parse().unwrap()).unwrap();
        let (mut socket, _) = tungstenite::connect(format!("ws://{at}")).unwrap();
        while sink.listeners.lock().unwrap().is_empty() {
            thread::sleep(Duration::from_millis(5));
        }
        for sequence in 1..=3 {
            let event = Event {
                phase: Phase::End,
                motion: sequence,
                sequence,
                actor: Actor(0),
                class: ClassId(0),
                score: 0.5,
                progress: 1.0,
                start_secs: 1.0,
                stop_secs: 2.0,
                reported_secs: 2.1,
                wall_secs: 1.0e9,
            };
            sink.tell(&Said {
                event: &event,
                class: "wave",
                source: "test",
            })
            .unwrap();
        }
        for sequence in 1..=3 {
            let text = socket.read().unwrap().into_text().unwrap();
            let told: serde_json::Value = serde_json::from_str(&text).unwrap();
            assert_eq!(
                (told["class"].as_str(), told["seq"].as_u64()),
                (Some("wave"), Some(sequence))
            );
        }
    }
}
