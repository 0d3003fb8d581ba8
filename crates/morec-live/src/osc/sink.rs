//! Events as OSC messages over UDP.

use std::net::UdpSocket;

use super::packet::{Arg, write_message};

use crate::error::Context;
use crate::{Address, LiveError, NamedEvent, Sink};

/// Sends two messages an event, each in a packet of its own:
///
/// - `/morec/event s s f f f i`: class, phase (start, update, cancel, end), score, start and stop (seconds of the
///   stream), actor; after these, for who wants more: progress (f), motion number and sequence number (i), of an activity
///   its repetitions so far (i) and the seconds of one (f), 0 where nothing is counted.
/// - `/morec/deviation s i i f f s f`, where the event has one: class, performer, motion, degrees off the nearest sample, pace, worst bone and its
///   degrees;
/// - `/VMC/Thru/morec/event s f`, for ends only: class and score; it passes through a chain of VMC programs.
pub struct OscSink {
    socket: UdpSocket,
    packet: Vec<u8>,
}

impl OscSink {
    /// Opens `osc://HOST:PORT`.
    ///
    /// # Errors
    /// An address with options or without a port; a socket that cannot be opened.
    pub fn open(address: &Address) -> Result<Self, LiveError> {
        address.allow(&[])?;
        let to = address.socket()?;
        let here = if to.is_ipv4() { "0.0.0.0:0" } else { "[::]:0" };
        let socket = UdpSocket::bind(here).context("UDP socket")?;
        socket.connect(to).with_context(|| address.to_string())?;
        // An event that does not go at once must not hold up the others.
        socket.set_nonblocking(true).context("UDP socket")?;
        Ok(Self {
            socket,
            packet: Vec::new(),
        })
    }

    fn send(&mut self, address: &str, args: &[Arg]) -> std::io::Result<()> {
        self.packet.clear();
        write_message(&mut self.packet, address, args);
        match self.socket.send(&self.packet) {
            // The system reports that an earlier packet had no receiver, which may still start.
            Err(error) if error.kind() == std::io::ErrorKind::ConnectionRefused => {
                self.socket.send(&self.packet).map(drop).or(Ok(()))
            }
            sent => sent.map(drop),
        }
    }
}

impl Sink for OscSink {
    fn emit(&mut self, event: &NamedEvent<'_>) -> std::io::Result<()> {
        let e = event.event;
        let args = [
            Arg::Text(event.class),
            Arg::Text(e.phase.name()),
            Arg::Float(e.score as f32),
            Arg::Float(e.span.start_secs as f32),
            Arg::Float(e.span.stop_secs as f32),
            Arg::Int(e.actor.0.into()),
            Arg::Float(e.progress as f32),
            Arg::Int(e.motion as i32),
            Arg::Int(e.sequence as i32),
            Arg::Int(e.repetitions.map_or(0, |r| r.count as i32)),
            Arg::Float(e.repetitions.map_or(0.0, |r| r.period_secs as f32)),
        ];
        self.send("/morec/event", &args)?;
        if let Some(deviation) = e.deviation {
            let args = [
                Arg::Text(event.class),
                Arg::Int(e.actor.0.into()),
                Arg::Int(e.motion as i32),
                Arg::Float(deviation.off_degrees as f32),
                Arg::Float(deviation.pace as f32),
                Arg::Text(deviation.worst_bone),
                Arg::Float(deviation.worst_degrees as f32),
            ];
            self.send("/morec/deviation", &args)?;
        }
        if event.is_final() {
            self.send("/VMC/Thru/morec/event", &[args[0], args[2]])?;
        }
        Ok(())
    }
}
