//! A simulated Axis program: sends every frame to each TCP connection. Used by `morec send`.

use std::io::Write;
use std::net::{SocketAddr, TcpListener, TcpStream, UdpSocket};
use std::time::Duration;

use crate::error::Context;
use crate::{Address, LiveError};

/// A listener that takes no bytes for so long is let go.
const PATIENCE: Duration = Duration::from_millis(500);
/// Listeners at once.
const LISTENERS: usize = 16;

/// Output for frames.
pub enum Broadcast {
    /// To everybody who has connected.
    Tcp(TcpListener, Vec<TcpStream>),
    /// To one address.
    Udp(UdpSocket, SocketAddr),
}

impl Broadcast {
    /// `axis://HOST:PORT` listens there; `axis+udp://HOST:PORT` sends there.
    ///
    /// # Errors
    /// An address without a port, or one that is taken.
    pub fn open(address: &Address) -> Result<Self, LiveError> {
        let at = address.socket()?;
        if address.kind == "axis+udp" {
            let here = if at.is_ipv4() { "0.0.0.0:0" } else { "[::]:0" };
            return Ok(Broadcast::Udp(
                UdpSocket::bind(here).context("UDP socket")?,
                at,
            ));
        }
        let listener = TcpListener::bind(at).with_context(|| {
            format!("cannot listen at {at} (TCP): is another program listening there?")
        })?;
        listener.set_nonblocking(true).context("TCP socket")?;
        Ok(Broadcast::Tcp(listener, Vec::new()))
    }

    /// Address that it listens at, if it does.
    pub fn address(&self) -> Option<SocketAddr> {
        match self {
            Broadcast::Tcp(listener, _) => listener.local_addr().ok(),
            Broadcast::Udp(..) => None,
        }
    }

    /// Takes in who has connected; says how many there are.
    pub fn accept(&mut self) -> usize {
        let Broadcast::Tcp(listener, listeners) = self else {
            return 1;
        };
        while let Ok((stream, _)) = listener.accept() {
            let ready = stream.set_nonblocking(false).is_ok()
                && stream.set_write_timeout(Some(PATIENCE)).is_ok()
                && stream.set_nodelay(true).is_ok();
            if ready && listeners.len() < LISTENERS {
                listeners.push(stream);
            }
        }
        listeners.len()
    }

    /// Sends a frame to everybody who is there; those who have gone are forgotten.
    pub fn send(&mut self, bytes: &[u8]) {
        self.accept();
        match self {
            Broadcast::Tcp(_, listeners) => {
                listeners.retain_mut(|stream| stream.write_all(bytes).is_ok())
            }
            // Nobody listens there yet; they may come.
            Broadcast::Udp(socket, to) => _ = socket.send_to(bytes, *to),
        }
    }
}
