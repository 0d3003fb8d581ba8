//! The handshake of a WebSocket: limits of time and size, and the check of the page's origin.

use std::io::{self, ErrorKind, Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

use tungstenite::handshake::server::{ErrorResponse, Request, Response};
use tungstenite::http::StatusCode;
use tungstenite::protocol::WebSocketConfig;
use tungstenite::{WebSocket, accept_hdr_with_config};

/// Limit for a whole handshake, or for taking a packet.
pub const PATIENCE: Duration = Duration::from_secs(2);
/// A listener says pings and goodbyes; nothing that it sends is read.
const LARGEST_MESSAGE: usize = 4096;

pub type Socket = WebSocket<Timed>;

/// A stream whose reading must be done by a moment, however slowly bytes come.
pub struct Timed {
    stream: TcpStream,
    until: Option<Instant>,
}

impl Read for Timed {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if let Some(until) = self.until {
            let left = until.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return Err(ErrorKind::ConnectionAborted.into());
            }
            self.stream.set_read_timeout(Some(left))?;
        }
        self.stream.read(buffer)
    }
}

impl Write for Timed {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.stream.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.stream.flush()
    }
}

/// What the other side may do after the handshake.
#[derive(Debug, Clone, Copy)]
pub struct Manners {
    /// Bytes of a message.
    pub largest: usize,
    /// How long reading waits for one.
    pub wait: Duration,
}

/// Whoever only listens.
pub const LISTENER: Manners = Manners {
    largest: LARGEST_MESSAGE,
    wait: Duration::from_millis(1),
};

/// Says hello; `None` if the other side does not, in time, or may not connect: a page of neither this machine nor `origin`.
pub fn greet(stream: TcpStream, origin: Option<&str>, manners: Manners) -> Option<Socket> {
    stream.set_write_timeout(Some(PATIENCE)).ok()?;
    stream.set_nodelay(true).ok()?;
    let timed = Timed {
        stream,
        until: Some(Instant::now() + PATIENCE),
    };
    let mut socket = shake_hands(timed, origin, manners.largest)?;
    let timed = socket.get_mut();
    timed.until = None;
    timed.stream.set_read_timeout(Some(manners.wait)).ok()?;
    Some(socket)
}

/// The handshake over any stream; `None` if it fails.
fn shake_hands<S: Read + Write>(
    stream: S,
    origin: Option<&str>,
    largest: usize,
) -> Option<WebSocket<S>> {
    let config = WebSocketConfig::default()
        .max_message_size(Some(largest))
        .max_frame_size(Some(largest));
    #[allow(clippy::result_large_err)] // The handshake's own type.
    let check = |request: &Request, response: Response| match may_listen(request, origin) {
        true => Ok(response),
        false => {
            let why = "this page may not connect: start morec with ?origin=… of the page";
            let mut refusal = ErrorResponse::new(Some(why.to_owned()));
            *refusal.status_mut() = StatusCode::FORBIDDEN;
            Err(refusal)
        }
    };
    accept_hdr_with_config(stream, check, Some(config)).ok()
}

/// Lengths of the messages that a listener sent, up to the first fault or the end; without a network.
#[doc(hidden)] // For fuzzing.
pub fn heard(bytes: &[u8]) -> Vec<usize> {
    /// Reads what is there, forgets what is written.
    struct Said<'a>(&'a [u8]);
    impl Read for Said<'_> {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            self.0.read(buffer)
        }
    }
    impl Write for Said<'_> {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            Ok(bytes.len())
        }
        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }
    let origin = Some("https://studio.example");
    let Some(mut socket) = shake_hands(Said(bytes), origin, LARGEST_MESSAGE) else {
        return Vec::new();
    };
    std::iter::from_fn(|| Some(socket.read().ok()?.len())).collect()
}

/// Browsers name the page's origin, other programs none.
fn may_listen(request: &Request, allowed: Option<&str>) -> bool {
    let Some(origin) = request.headers().get("Origin") else {
        return true;
    };
    let Ok(origin) = origin.to_str() else {
        return false;
    };
    allowed == Some(origin) || is_of_this_machine(origin)
}

fn is_of_this_machine(origin: &str) -> bool {
    let Some((_, host)) = origin.split_once("://") else {
        return false;
    };
    let host = match host.strip_prefix("[::1]") {
        Some(port) if port.is_empty() || port.starts_with(':') => return true,
        _ => host.split(':').next().unwrap_or_default(),
    };
    host.eq_ignore_ascii_case("localhost") || host == "127.0.0.1"
}

#[cfg(test)]
mod tests {
    use super::is_of_this_machine;

    #[test]
    fn origins_of_this_machine_are_told_from_others() {
        for origin in [
            "http://localhost",
            "http://127.0.0.1:8000",
            "https://[::1]:3",
            "http://LOCALHOST:1",
        ] {
            assert!(is_of_this_machine(origin), "{origin}");
        }
        for origin in [
            "null",
            "https://example.org",
            "http://localhost.example.org",
            "http://[::1].org",
            "",
        ] {
            assert!(!is_of_this_machine(origin), "{origin}");
        }
    }
}
