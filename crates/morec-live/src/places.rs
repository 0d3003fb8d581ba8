//! Places of connections over TCP, and the rule by which one is given up when all are taken.

use std::net::{Shutdown, TcpStream};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Connections at once.
pub const CONNECTIONS: usize = 16;
/// A connection that has shown no body so long after it was opened makes room for another, if all places are taken.
const UNKNOWN: Duration = Duration::from_secs(1);
/// Likewise one that has shown a body, so long after the last.
const SILENT: Duration = Duration::from_secs(5);

/// A connection that is open.
struct OpenConnection {
    number: u64,
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
    /// that has, and among them of the one for which that is longest. False if none has to give its place up.
    pub fn take(&self, number: u64, stream: TcpStream, now: Instant) -> bool {
        let mut open = self.open();
        if open.len() >= CONNECTIONS {
            let candidates = (0..open.len()).filter(|at| open[*at].gives_way(now));
            let key = |at: &usize| (open[*at].body, open[*at].opened);
            let Some(at) = candidates.min_by_key(key) else {
                return false;
            };
            // Its thread wakes and ends; if it has ended already, all the better.
            let _ = open.swap_remove(at).stream.shutdown(Shutdown::Both);
        }
        open.push(OpenConnection {
            number,
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

    /// Connection `number` has ended.
    pub fn leave(&self, number: u64) {
        self.open().retain(|open| open.number != number);
    }
}

#[cfg(test)]
mod tests {
    use std::net::TcpListener;

    use super::*;

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
            assert!(places.take(number, listener.accept().unwrap().0, now));
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
            places.take(number, listener.accept().unwrap().0, now)
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
}
