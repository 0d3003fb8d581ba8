//! Poses as lines of JSON, from standard input or over TCP: for trackers that speak nothing else.
//!
//! The format of a line is described in [`json_line`](super::json_line).

use std::net::IpAddr;
use std::sync::Arc;
use std::time::Duration;

use morec::features::Hand;
use morec::live::{
    Arrival, Frame, MAX_PERFORMERS, PerformerId, PerformerTable, Rig, Source, SourceCounts,
    SourceEvent, largest_holder, wall_now_secs,
};
use morec::roles::{Role, RoleMap};

use crate::address::openness;
use crate::lines::{Came, Lines};
use crate::unnamed::UnnamedPoints;
use crate::{Address, LiveError, Notices, PoseLine};

/// Performers of one connection over TCP; others shall find places, too.
const NAMES: usize = 8;
/// A performer over TCP of whom nothing has come for so long has gone.
const GONE_SECS: f64 = 5.0;

const WAIT: Duration = Duration::from_millis(20);

/// A performer: the connection, the number there, and the hand if lines are about one. Each hand of one number is a performer of its own.
type PerformerKey = (u64, u16, Option<Hand>);

/// What lines have shown of a performer.
#[derive(Debug, Clone, Default)]
struct KnownPoints {
    /// Bit `r` for role `r`.
    roles: u128,
    unnamed: UnnamedPoints,
}

/// Poses as lines of JSON.
pub struct JsonSource {
    lines: Lines,
    /// True if the end of the lines is the end of the source.
    ends: bool,
    performers: PerformerTable<PerformerKey>,
    /// For each performer, what was seen.
    known: Vec<KnownPoints>,
    /// A pose whose skeleton was announced first.
    waiting: Option<(PerformerId, PoseLine)>,
    /// A connection and its pose for which a place was freed. The end of the performer that had the place is announced first.
    newcomer: Option<(u64, PoseLine)>,
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
        let notices = Notices::default();
        let (lines, at) = Lines::listen(address.socket()?, &notices)?;
        openness(at).into_iter().for_each(|text| notices.tell(text));
        Ok((Self::of_connections(lines, notices), at))
    }

    /// Lines of all connections; faults of connections are in `notices`.
    pub(crate) fn of_connections(lines: Lines, notices: Notices) -> Self {
        Self {
            notices,
            ..Self::new(lines, false)
        }
    }

    fn new(lines: Lines, ends: bool) -> Self {
        Self {
            lines,
            ends,
            performers: PerformerTable::new(MAX_PERFORMERS),
            known: Vec::new(),
            waiting: None,
            newcomer: None,
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

    /// The performer of this key, a new one if there is room.
    fn performer(&mut self, key: PerformerKey) -> Option<PerformerId> {
        let of_connection = |other: &&PerformerKey| other.0 == key.0;
        let is_full = || self.performers.present().filter(of_connection).count() >= NAMES;
        if !self.ends && self.performers.find(&key).is_none() && is_full() {
            return None;
        }
        let (actor, arrival) = self.performers.arrive(key, wall_now_secs())?;
        match arrival {
            Arrival::Known => {}
            Arrival::New => self.known.push(KnownPoints::default()),
            Arrival::Returned | Arrival::Replaced => {
                self.counts.interruptions += 1;
                // The skeleton is announced anew.
                self.known[actor.index()] = KnownPoints::default();
            }
        }
        Some(actor)
    }

    /// Frees the newest place of the machine that holds the most performers, if all places are taken and it holds at least two more
    /// than the machine of `connection`. Gives the performer that had the place.
    fn free_place_for(&mut self, connection: u64) -> Option<PerformerId> {
        if self.performers.vacant().is_some() {
            return None;
        }
        let machine_of = |key: &PerformerKey| self.lines.machine(key.0);
        let held: Vec<IpAddr> = self.performers.present().filter_map(machine_of).collect();
        let largest = largest_holder(&held, self.lines.machine(connection)?)?;
        let its = |key: &&PerformerKey| machine_of(key) == Some(largest);
        let newest = *self.performers.present().filter(its).max()?;
        let mut gone = None;
        self.performers
            .leave_if(|key| *key == newest, |actor| gone = Some(actor));
        gone
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
        if let Some(said) = pose.left_out() {
            self.notices.add(|| format!("line {number}"), said);
        }
        if pose.shows_body() {
            self.lines.showed_body(connection);
        }
        self.pose(connection, pose, frame)
    }

    fn pose(&mut self, connection: u64, mut pose: PoseLine, frame: &mut Frame) -> SourceEvent {
        let Some(actor) = self.performer((connection, pose.actor, pose.hand)) else {
            if pose.shows_body()
                && let Some(gone) = self.free_place_for(connection)
            {
                self.newcomer = Some((connection, pose));
                return SourceEvent::Gone(gone);
            }
            self.counts.refused += 1;
            return SourceEvent::Quiet;
        };
        let known = &mut self.known[actor.index()];
        if let Err(error) = known.unnamed.name(&mut pose) {
            self.counts.malformed += 1;
            self.notices.add(|| format!("performer {}", actor.0), error);
            return SourceEvent::Quiet;
        }
        let seen = pose.known();
        if seen & !known.roles != 0 {
            known.roles |= seen;
            let rig = rig_of(known.roles);
            self.waiting = Some((actor, pose));
            return SourceEvent::Rig(actor, Arc::new(rig));
        }
        self.counts.incomplete += u64::from(seen != known.roles);
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
        if let Some((connection, pose)) = self.newcomer.take() {
            return self.pose(connection, pose, frame);
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
                let leaves = |key: &PerformerKey| key.0 == connection;
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
fn rig_of(known: u128) -> Rig {
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
    use std::io::Write;
    use std::net::TcpStream;
    use std::sync::atomic::{AtomicBool, Ordering};

    use crate::places::CONNECTIONS;

    use super::*;

    /// One connection cannot take every place, and a place of whom nothing comes is free again.
    #[test]
    fn one_connection_does_not_take_all_places() {
        let address: Address = "json+tcp://127.0.0.1:0".parse().unwrap();
        let mut source = JsonSource::listen(&address).unwrap().0;
        let taken = (0..40)
            .filter_map(|number| source.performer((1, number, None)))
            .count();
        assert_eq!(taken, NAMES);
        assert!(source.performer((2, 0, None)).is_some());
        source.forget_silent(wall_now_secs() + 2.0 * GONE_SECS);
        assert_eq!(source.leaving.len(), NAMES + 1);
        assert!(
            source.performer((1, 39, None)).is_some() && source.performer((1, 0, None)).is_some()
        );
    }

    /// Two connections of one machine can show sixteen performers; another machine finds a place all the same.
    #[test]
    fn one_machine_does_not_take_the_places_of_all_performers() {
        let address: Address = "json+tcp://127.0.0.1:0".parse().unwrap();
        let (mut source, at) = JsonSource::listen(&address).unwrap();
        let (far, mut frame) = (TcpStream::connect(at).unwrap(), Frame::default());
        for (connection, machine) in [(101, "192.0.2.1"), (102, "192.0.2.1"), (103, "192.0.2.2")] {
            let (stream, from) = (far.try_clone().unwrap(), machine.parse().unwrap());
            source.lines.place(connection, stream, from);
        }
        let body = |actor| PoseLine::of_line(&body_line(actor)).unwrap();
        for connection in [101, 102] {
            for actor in 0..NAMES as u16 {
                source.pose(connection, body(actor), &mut frame);
            }
        }
        source.waiting = None;
        assert_eq!(source.performers.present().count(), MAX_PERFORMERS);
        let Some(victim) = source.performers.find(&(102, NAMES as u16 - 1, None)) else {
            panic!("everybody has a place");
        };
        let gone = source.pose(103, body(0), &mut frame);
        assert!(matches!(gone, SourceEvent::Gone(actor) if actor == victim));
        let rig = source.next(&mut frame);
        assert!(matches!(rig, SourceEvent::Rig(actor, _) if actor == victim));
        assert!(matches!(source.next(&mut frame), SourceEvent::Frame));
        assert_eq!(frame.actor, victim);
        // Whoever had the place before does not come back to it.
        let refused = source.pose(102, body(NAMES as u16 - 1), &mut frame);
        assert!(matches!(refused, SourceEvent::Quiet));
        assert_eq!(source.counts.refused, 1);
    }

    /// A line that shows a whole body.
    fn body_line(actor: u16) -> String {
        let names = "hips left_thigh left_shin left_foot right_thigh right_shin right_foot";
        let places: Vec<String> = (names.split(' '))
            .map(|name| format!("\"{name}\": [0, 1, 0]"))
            .collect();
        let places = places.join(", ");
        format!("{{\"actor\": {actor}, \"positions\": {{{places}}}}}\n")
    }

    /// Sends `line` over and over, and connects anew when it is turned away, until it is stopped.
    fn busy(at: std::net::SocketAddr, line: &str, stop: &AtomicBool) {
        while !stop.load(Ordering::Relaxed) {
            let Ok(mut stream) = TcpStream::connect(at) else {
                continue;
            };
            while !stop.load(Ordering::Relaxed) && stream.write_all(line.as_bytes()).is_ok() {
                std::thread::sleep(Duration::from_millis(1));
            }
        }
    }

    /// Connections that are busy with what is no body do not keep out for ever who shows one, and who shows one stays.
    #[test]
    fn busy_connections_that_show_no_body_make_room_for_one_that_does() {
        let address: Address = "json+tcp://127.0.0.1:0".parse().unwrap();
        let (mut source, at) = JsonSource::listen(&address).unwrap();
        let stop = AtomicBool::new(false);
        let rubbish = ["rubbish\n", "{\"positions\": {\"head\": [0, 1, 0]}}\n"];
        let body = body_line(0);
        let mut shown = 0;
        std::thread::scope(|scope| {
            for number in 0..2 * CONNECTIONS {
                let (line, stop) = (rubbish[number % 2], &stop);
                scope.spawn(move || busy(at, line, stop));
            }
            scope.spawn(|| busy(at, &body, &stop));
            let mut frame = Frame::default();
            while shown < 100 {
                if let SourceEvent::Frame = source.next(&mut frame) {
                    let hips = frame.pose.positions[Role::Hips.index()];
                    shown += u32::from(hips.x.is_finite());
                }
            }
            stop.store(true, Ordering::Relaxed);
            // Lines that wait are taken, or their senders would not end.
            while !matches!(source.lines.next(WAIT), Came::Nothing) {}
        });
        let told = source.notices().take().join("\n");
        assert!(
            told.contains("a connection from 127.0.0.1 is refused"),
            "{told}"
        );
    }
}
