//! Events as OSC messages over UDP.

use std::net::UdpSocket;

use morec::live::Phase;

use super::packet::{Arg, write_message};

use crate::error::Context;
use crate::{Address, LiveError, NamedEvent, Sink};

/// Sends two messages an event, each in a packet of its own; of the phase progress one:
///
/// - `/morec/event s s f f f i`: class, phase (start, update, cancel, end), score, start and stop (seconds of the
///   stream), actor; after these, for who wants more: progress (f), motion number and sequence number (i), of an activity
///   its repetitions so far (i) and the seconds of one (f), 0 where nothing is counted.
/// - `/morec/deviation s i i f f s f`, where the event has one: class, performer, motion, degrees off the nearest sample, pace, worst bone and its
///   degrees;
/// - `/morec/progress/CLASS f f f i`, of the phase progress alone: how far (0 to 1), how like (0 to 1), pace, performer. What OSC does not
///   allow in an address is `_` in the class;
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

    fn send_progress(&mut self, event: &NamedEvent<'_>) -> std::io::Result<()> {
        let e = event.event;
        let reserved = |c: char| c.is_whitespace() || c.is_control() || " #*,/?[]{}".contains(c);
        let address = format!("/morec/progress/{}", event.class.replace(reserved, "_"));
        let args = [
            Arg::Float(e.progress as f32),
            Arg::Float(e.score as f32),
            Arg::Float(e.pace.unwrap_or_default() as f32),
            Arg::Int(e.actor.0.into()),
        ];
        self.send(&address, &args)
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
        if e.phase == Phase::Progress {
            return self.send_progress(event);
        }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::osc::packet::read;
    use morec::TimeSpan;
    use morec::classes::ClassId;
    use morec::live::{Event, PerformerId};

    #[test]
    fn progress_is_one_message_with_the_class_in_its_address() {
        let here = UdpSocket::bind("127.0.0.1:0").unwrap();
        let address = format!("osc://{}", here.local_addr().unwrap());
        let mut sink = OscSink::open(&address.parse().unwrap()).unwrap();
        let event = Event {
            phase: Phase::Progress,
            motion: 0,
            sequence: 1,
            actor: PerformerId(2),
            class: ClassId(0),
            score: 0.5,
            progress: 0.25,
            span: TimeSpan::new(1.0, 2.0),
            reported_secs: 2.0,
            wall_secs: 0.0,
            repetitions: None,
            pace: Some(1.5),
            deviation: None,
        };
        let said = NamedEvent {
            event: &event,
            class: "wave left/high",
            source: "clip",
        };
        sink.emit(&said).unwrap();
        let mut bytes = [0; 512];
        let count = here.recv(&mut bytes).unwrap();
        let mut messages = Vec::new();
        read(&bytes[..count], &mut |message| {
            let args: Vec<Option<f64>> = message.args().map(|arg| arg.number()).collect();
            messages.push((message.address.to_owned(), args));
        });
        let expected = [0.25, 0.5, 1.5, 2.0].map(Some).to_vec();
        assert_eq!(
            messages,
            [("/morec/progress/wave_left_high".to_owned(), expected)]
        );
        here.set_nonblocking(true).unwrap();
        assert!(here.recv(&mut bytes).is_err(), "only one message");
    }
}
