//! Poses as lines of JSON, from standard input or over TCP: for trackers that speak nothing else.
//!
//! The format of a line is described in [`json_line`](super::json_line).

use std::sync::Arc;
use std::time::Duration;

use morec::live::{
    Arrival, Frame, MAX_PERFORMERS, PerformerId, PerformerTable, Rig, Source, SourceCounts,
    SourceEvent, wall_now_secs,
};
use morec::roles::{Role, RoleMap};

use crate::address::openness;
use crate::lines::{Came, Lines};
use crate::{Address, LiveError, Notices, PoseLine};

/// Performers of one connection over TCP; others shall find places, too.
const NAMES: usize = 8;
/// A performer over TCP of whom nothing has come for so long has gone.
const GONE_SECS: f64 = 5.0;

const WAIT: Duration = Duration::from_millis(20);

/// Poses as lines of JSON.
pub struct JsonSource {
    lines: Lines,
    /// True if the end of the lines is the end of the source.
    ends: bool,
    /// By their connections, and their numbers in these.
    performers: PerformerTable<(u64, u16)>,
    /// For each performer, the roles that were seen.
    known: Vec<u32>,
    /// A pose whose skeleton was announced first.
    waiting: Option<(PerformerId, PoseLine)>,
    leaving: Vec<PerformerId>,
    begun_secs: f64,
    counts: SourceCounts,
    notices: Notices,
}

impl JsonSource {
    /// `json:-` is standard input.
    ///
    /// # Errors
    /// Another address.
    pub fn open(address: &Address) -> Result<Self, LiveError> {
        address.allow(&[])?;
        if address.place != "-" {
            return Err(LiveError::Address(format!(
                "{address}: expected json:- (standard input) or json+tcp://HOST:PORT"
            )));
        }
        Ok(Self::new(Lines::stdin()?, true))
    }

    /// `json+tcp://HOST:PORT` listens there. Returns where, too.
    ///
    /// # Errors
    /// An address without a port, a port that is taken.
    pub fn listen(address: &Address) -> Result<(Self, std::net::SocketAddr), LiveError> {
        address.allow(&[])?;
        let (lines, at) = Lines::listen(address.socket()?)?;
        let source = Self::new(lines, false);
        openness(at)
            .into_iter()
            .for_each(|text| source.notices.tell(text));
        Ok((source, at))
    }

    fn new(lines: Lines, ends: bool) -> Self {
        Self {
            lines,
            ends,
            performers: PerformerTable::new(MAX_PERFORMERS),
            known: Vec::new(),
            waiting: None,
            leaving: Vec::new(),
            begun_secs: wall_now_secs(),
            counts: SourceCounts::default(),
            notices: Notices::default(),
        }
    }

    /// Notices about lines that are no poses, with the reason.
    pub fn notices(&self) -> Notices {
        self.notices.clone()
    }

    /// The performer `number` of `connection`, a new one if there is room.
    fn performer(&mut self, connection: u64, number: u16) -> Option<PerformerId> {
        let key = (connection, number);
        let of_connection = |key: &&(u64, u16)| key.0 == connection;
        let is_full = || self.performers.present().filter(of_connection).count() >= NAMES;
        if !self.ends && self.performers.find(&key).is_none() && is_full() {
            return None;
        }
        let (actor, arrival) = self.performers.arrive(key, wall_now_secs())?;
        match arrival {
            Arrival::Known => {}
            Arrival::New => self.known.push(0),
            Arrival::Returned | Arrival::Replaced => {
                self.counts.interruptions += 1;
                // The skeleton is announced anew.
                self.known[actor.index()] = 0;
            }
        }
        Some(actor)
    }

    /// Performers of whom nothing comes any more make room; a file on standard input may take its time.
    fn forget_silent(&mut self, now_secs: f64) {
        if !self.ends {
            let leaving = &mut self.leaving;
            self.performers
                .leave_silent(now_secs, GONE_SECS, |actor| leaving.push(actor));
        }
    }

    fn line(
        &mut self,
        connection: u64,
        number: u64,
        text: Option<&str>,
        frame: &mut Frame,
    ) -> SourceEvent {
        self.counts.packets += 1;
        let pose = text
            .ok_or_else(|| "no text, or longer than 65536 bytes".to_owned())
            .and_then(PoseLine::of_line);
        let pose = match pose {
            Ok(pose) => pose,
            Err(error) => {
                self.counts.malformed += 1;
                self.notices.add(|| format!("line {number}"), error);
                return SourceEvent::Quiet;
            }
        };
        let Some(actor) = self.performer(connection, pose.actor) else {
            self.counts.refused += 1;
            return SourceEvent::Quiet;
        };
        let known = &mut self.known[actor.index()];
        let seen = pose.known();
        if seen & !*known != 0 {
            *known |= seen;
            let rig = rig_of(*known);
            self.waiting = Some((actor, pose));
            return SourceEvent::Rig(actor, Arc::new(rig));
        }
        self.counts.incomplete += u64::from(seen != *known);
        self.fill(actor, &pose, frame)
    }

    fn fill(&self, actor: PerformerId, pose: &PoseLine, frame: &mut Frame) -> SourceEvent {
        frame.wall_secs = wall_now_secs();
        frame.time_secs = pose.time_secs.unwrap_or(frame.wall_secs - self.begun_secs);
        frame.actor = actor;
        frame.pose.positions.clear();
        frame.pose.positions.extend(pose.positions);
        frame.pose.rotations.clone_from(&pose.rotations);
        SourceEvent::Frame
    }
}

impl Source for JsonSource {
    fn next(&mut self, frame: &mut Frame) -> SourceEvent {
        if let Some((actor, pose)) = self.waiting.take() {
            return self.fill(actor, &pose, frame);
        }
        self.forget_silent(wall_now_secs());
        if let Some(actor) = self.leaving.pop() {
            return SourceEvent::Gone(actor);
        }
        match self.lines.next(WAIT) {
            Came::Line {
                connection,
                number,
                text,
            } => self.line(connection, number, text.as_deref(), frame),
            Came::Closed(connection) => {
                let leaving = &mut self.leaving;
                let leaves = |key: &(u64, u16)| key.0 == connection;
                self.performers
                    .leave_if(leaves, |actor| leaving.push(actor));
                SourceEvent::Quiet
            }
            Came::Nothing => SourceEvent::Quiet,
            Came::Ended if self.ends => SourceEvent::Ended,
            Came::Ended => {
                std::thread::sleep(WAIT);
                SourceEvent::Quiet
            }
        }
    }

    fn counts(&self) -> SourceCounts {
        self.counts
    }
}

/// A skeleton of the roles in `known`.
fn rig_of(known: u32) -> Rig {
    let mut rig = Rig::of_roles();
    let mut roles = RoleMap::default();
    for role in Role::ALL
        .into_iter()
        .filter(|r| known >> r.index() & 1 == 1)
    {
        roles.set(role, Some(role.index()));
    }
    rig.roles = roles;
    rig
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One connection cannot take every place, and a place of whom nothing comes is free again.
    #[test]
    fn one_connection_does_not_take_all_places() {
        let lines = Lines::listen("127.0.0.1:0".parse().unwrap()).unwrap().0;
        let mut source = JsonSource::new(lines, false);
        let taken = (0..40)
            .filter_map(|number| source.performer(1, number))
            .count();
        assert_eq!(taken, NAMES);
        assert!(source.performer(2, 0).is_some());
        source.forget_silent(wall_now_secs() + 2.0 * GONE_SECS);
        assert_eq!(source.leaving.len(), NAMES + 1);
        assert!(source.performer(1, 39).is_some() && source.performer(1, 0).is_some());
    }
}
