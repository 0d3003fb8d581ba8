//! Places of TCP connections: how many are accepted, and which connection is dropped when all are taken.

use std::net::{IpAddr, Ipv6Addr, Shutdown, TcpStream};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use morec::live::largest_holder;

/// Connections at once.
pub const CONNECTIONS: usize = 16;
/// A connection that has shown no body so long after it was opened makes room for another, if all places are taken.
const UNKNOWN: Duration = Duration::from_secs(1);
/// Likewise one that has shown a body, so long after the last.
const SILENT: Duration = Duration::from_secs(5);

struct OpenConnection {
    number: u64,
    machine: IpAddr,
    stream: TcpStream,
    opened: Instant,
    /// When it showed a body last.
    body: Option<Instant>,
}

impl OpenConnection {
    /// True if it may have to make room.
    fn gives_way(&self, now: Instant) -> bool {
        let since = |then: Instant| now.saturating_duration_since(then);
        match self.body {
            None => since(self.opened) > UNKNOWN,
            Some(body) => since(body) > SILENT,
        }
    }
}

/// The machine at an address. One machine has as many IPv6 addresses as it likes that share the first 64 bits.
fn machine_at(address: IpAddr) -> IpAddr {
    match address.to_canonical() {
        IpAddr::V6(v6) => Ipv6Addr::from_bits(v6.to_bits() >> 64 << 64).into(),
        v4 => v4,
    }
}

/// A number by which connections of one machine are counted together; for IPv6, of its network.
pub fn machine_number(address: IpAddr) -> u128 {
    match machine_at(address) {
        IpAddr::V4(v4) => v4.to_ipv6_mapped().to_bits(),
        IpAddr::V6(v6) => v6.to_bits(),
    }
}

/// The connections that are open; copies share them.
#[derive(Clone, Default)]
pub struct ConnectionPlaces {
    open: Arc<Mutex<Vec<OpenConnection>>>,
}

impl ConnectionPlaces {
    fn open(&self) -> MutexGuard<'_, Vec<OpenConnection>> {
        self.open.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Gives connection `number` a place, if need be that of another: of one that has shown no body before that of one
    /// that has, and among them of the one for which that is longest; else of the newest of the machine that holds the most,
    /// at least two more than `from` does. False if none has to give its place up.
    pub fn take(&self, number: u64, stream: TcpStream, from: IpAddr, now: Instant) -> bool {
        let machine = machine_at(from);
        let mut open = self.open();
        if open.len() >= CONNECTIONS {
            let candidates = (0..open.len()).filter(|at| open[*at].gives_way(now));
            let key = |at: &usize| (open[*at].body, open[*at].opened);
            let at = candidates.min_by_key(key);
            let Some(at) = at.or_else(|| newest_of_largest(&open, machine)) else {
                return false;
            };
            // Its thread wakes and ends; if it has ended already, all the better.
            let _ = open.swap_remove(at).stream.shutdown(Shutdown::Both);
        }
        open.push(OpenConnection {
            number,
            machine,
            stream,
            opened: now,
            body: None,
        });
        true
    }

    /// Connection `number` has shown a body.
    pub fn keep(&self, number: u64, now: Instant) {
        let mut open = self.open();
        if let Some(connection) = open.iter_mut().find(|open| open.number == number) {
            connection.body = Some(now);
        }
    }

    /// The machine of connection `number`, if it is open.
    pub fn machine(&self, number: u64) -> Option<IpAddr> {
        let open = self.open();
        let connection = open.iter().find(|open| open.number == number)?;
        Some(connection.machine)
    }

    /// Connection `number` has ended.
    pub fn leave(&self, number: u64) {
        self.open().retain(|open| open.number != number);
    }
}

/// The newest connection of the machine that holds too many beside `newcomer`, if one does.
fn newest_of_largest(open: &[OpenConnection], newcomer: IpAddr) -> Option<usize> {
    let held: Vec<IpAddr> = open.iter().map(|open| open.machine).collect();
    let largest = largest_holder(&held, newcomer)?;
    let its = (0..open.len()).filter(|at| open[*at].machine == largest);
    its.max_by_key(|at| open[*at].opened)
}

#[cfg(test)]
mod tests {
    use std::net::TcpListener;

    use super::*;

    const NEAR: IpAddr = IpAddr::V4(std::net::Ipv4Addr::LOCALHOST);

    /// Takes places for connections of these numbers; gives the far ends, too.
    fn fill(
        places: &ConnectionPlaces,
        numbers: std::ops::Range<u64>,
        now: Instant,
    ) -> Vec<TcpStream> {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let at = listener.local_addr().unwrap();
        let connect = |number| {
            let far = TcpStream::connect(at).unwrap();
            assert!(places.take(number, listener.accept().unwrap().0, NEAR, now));
            far
        };
        numbers.map(connect).collect()
    }

    fn numbers(places: &ConnectionPlaces) -> Vec<u64> {
        let mut numbers: Vec<u64> = places.open().iter().map(|open| open.number).collect();
        numbers.sort_unstable();
        numbers
    }

    #[test]
    fn who_shows_no_body_makes_room_first_and_who_shows_one_stays() {
        let (places, begun) = (ConnectionPlaces::default(), Instant::now());
        let secs = |secs: f64| begun + Duration::from_secs_f64(secs);
        let _open = fill(&places, 0..16, secs(0.0));
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let mut far = Vec::new();
        let mut comes = |number, now| {
            far.push(TcpStream::connect(listener.local_addr().unwrap()).unwrap());
            places.take(number, listener.accept().unwrap().0, NEAR, now)
        };
        assert!(!comes(16, secs(0.9)), "each may still show one");
        (0..15).for_each(|number| places.keep(number, secs(0.9)));
        assert!(comes(17, secs(1.1)));
        assert!(!numbers(&places).contains(&15), "it has shown none");
        places.keep(17, secs(1.2));
        // All show bodies now, and the last of 3 was before those of the others.
        for number in (0..15).chain([17]).filter(|number| *number != 3) {
            places.keep(number, secs(2.0));
        }
        assert!(!comes(18, secs(5.8)), "nobody is silent for long enough");
        assert!(comes(19, secs(6.0)));
        assert!(!numbers(&places).contains(&3));
        places.leave(0);
        assert!(comes(20, secs(6.0)), "a place is free");
        assert_eq!(numbers(&places).len(), CONNECTIONS);
    }

    #[test]
    fn a_place_that_is_lost_is_a_connection_that_is_closed() {
        use std::io::Read;
        let (places, begun) = (ConnectionPlaces::default(), Instant::now());
        let mut first = fill(&places, 0..16, begun);
        let _next = fill(&places, 16..17, begun + 2 * UNKNOWN);
        assert_eq!(first[0].read(&mut [0]).unwrap(), 0);
    }

    /// However many bodies one machine shows, others get their share of the places, and no more.
    #[test]
    fn a_machine_that_holds_most_places_makes_room_for_others() {
        let (places, begun) = (ConnectionPlaces::default(), Instant::now());
        let _open = fill(&places, 0..16, begun);
        (0..16).for_each(|number| places.keep(number, begun));
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let mut far = Vec::new();
        let mut comes = |number, from: &str| {
            far.push(TcpStream::connect(listener.local_addr().unwrap()).unwrap());
            let near = listener.accept().unwrap().0;
            let taken = places.take(number, near, from.parse().unwrap(), begun);
            places.keep(number, begun);
            taken
        };
        assert!(!comes(16, "127.0.0.1"), "it holds them all already");
        let shared = (17..40).filter(|number| comes(*number, &format!("2001:db8::{number}")));
        assert_eq!(
            shared.count(),
            CONNECTIONS / 2,
            "one machine by its first 64 bits"
        );
        assert!(comes(40, "192.0.2.1"), "a third one has a share as well");
        assert_eq!(numbers(&places).len(), CONNECTIONS);
        assert_eq!(places.machine(0), Some(NEAR), "the first of all stays");
    }
}
