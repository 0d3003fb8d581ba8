//! VMC senders on a UDP port.

use std::io::ErrorKind;
use std::net::{SocketAddr, UdpSocket};
use std::time::Duration;

use super::receiver::VmcReceiver;
use super::receiver_options::VmcOptions;
use morec::live::{Frame, Source, SourceCounts, SourceEvent, wall_now_secs};

use crate::address::openness;
use crate::error::Context;
use crate::{LiveError, Notices};

/// The socket is asked this long at a time: the quiet that closes a frame.
const WAIT: Duration = Duration::from_millis(5);
/// The largest datagram there is.
const LARGEST: usize = 65_536;

/// A UDP port on which VMC senders are heard.
pub struct VmcSource {
    socket: UdpSocket,
    receiver: VmcReceiver<SocketAddr>,
    buffer: Vec<u8>,
    notices: Notices,
    places: usize,
}

impl VmcSource {
    /// Listens at `address`; port 0 takes any that is free.
    ///
    /// # Errors
    /// A port that is taken.
    pub fn bind(address: SocketAddr, options: &VmcOptions) -> Result<Self, LiveError> {
        let socket = UdpSocket::bind(address).with_context(|| {
            format!(
                "cannot listen at {address} (UDP): is another program, or another morec, listening there?"
            )
        })?;
        socket.set_read_timeout(Some(WAIT)).context("UDP socket")?;
        let notices = Notices::default();
        openness(address)
            .into_iter()
            .for_each(|text| notices.tell(text));
        Ok(Self {
            socket,
            receiver: VmcReceiver::new(options),
            buffer: vec![0; LARGEST],
            notices,
            places: options.actors,
        })
    }

    /// Says once of each sender that it shows a performer for whom there is no place.
    fn name_refused(&mut self) {
        let Some(peer) = self.receiver.take_refused() else {
            return;
        };
        self.notices.tell(format!(
            "{peer} sends another performer, but the limit of {} is reached (raise it with --actors)",
            self.places
        ));
    }

    /// Address that it listens at.
    ///
    /// # Errors
    /// The system does not say.
    pub fn address(&self) -> Result<SocketAddr, LiveError> {
        self.socket.local_addr().context("UDP socket")
    }

    /// Notices about received data.
    pub fn notices(&self) -> Notices {
        self.notices.clone()
    }
}

impl Source for VmcSource {
    fn next(&mut self, frame: &mut Frame) -> SourceEvent {
        if let Some(next) = self.receiver.next(frame) {
            return next;
        }
        match self.socket.recv_from(&mut self.buffer) {
            Ok((length, peer)) => {
                self.receiver
                    .packet(peer, wall_now_secs(), &self.buffer[..length]);
                self.name_refused();
            }
            Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {}
            // A sender's port that is closed may be reported here; it concerns packets that were never sent by us.
            Err(_) => std::thread::sleep(WAIT),
        }
        self.receiver.tick(wall_now_secs());
        self.receiver.next(frame).unwrap_or(SourceEvent::Quiet)
    }

    fn counts(&self) -> SourceCounts {
        self.receiver.counts()
    }
}
