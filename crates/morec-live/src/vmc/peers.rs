//! Identifies senders by their addresses, including a sender whose address changes.

use core::net::SocketAddr;

/// A port that has been heard for so long is where its sender stays.
const SETTLED_SECS: f64 = 0.25;
/// Ports that are remembered.
const EARLIER: usize = 8;

/// Address of a sender.
pub trait Peer: Copy + PartialEq {
    /// True if both are on one machine, at different ports perhaps.
    fn same_host(&self, other: &Self) -> bool;
}

/// An address is a value; sockets are others' business.
impl Peer for SocketAddr {
    fn same_host(&self, other: &Self) -> bool {
        self.ip() == other.ip()
    }
}

/// There is only one sender.
impl Peer for () {
    fn same_host(&self, _: &Self) -> bool {
        true
    }
}

/// Senders by number; each has a machine to itself.
impl Peer for u8 {
    fn same_host(&self, other: &Self) -> bool {
        self == other
    }
}

/// The port of one sender, or the ports: some open a new socket for every packet, and are one performer all the same.
///
/// A port that was heard for [`SETTLED_SECS`] is where its sender stays; another one on the same machine is another
/// sender. Before that a new port is taken for the same sender at a new place. If an earlier port is heard again, they
/// were two after all.
#[derive(Debug, Clone)]
pub(super) struct Ports<P> {
    now: P,
    since_secs: f64,
    heard_secs: f64,
    earlier: [Option<P>; EARLIER],
    next: usize,
}

impl<P: Peer> Ports<P> {
    pub(super) fn new(now: P, now_secs: f64) -> Self {
        Self {
            now,
            since_secs: now_secs,
            heard_secs: now_secs,
            earlier: [None; EARLIER],
            next: 0,
        }
    }

    /// True if the sender is at `peer`.
    pub(super) fn is_at(&self, peer: P) -> bool {
        self.now == peer
    }

    /// A packet came from where the sender is.
    pub(super) fn hear(&mut self, now_secs: f64) {
        self.heard_secs = now_secs;
    }

    /// Follows the sender to `peer`, if it may have gone there.
    pub(super) fn follow(&mut self, peer: P, now_secs: f64) -> bool {
        if !self.now.same_host(&peer) || self.heard_secs - self.since_secs >= SETTLED_SECS {
            return false;
        }
        self.earlier[self.next] = Some(self.now);
        self.next = (self.next + 1) % EARLIER;
        (self.now, self.since_secs, self.heard_secs) = (peer, now_secs, now_secs);
        true
    }

    /// Present address of the sender.
    pub(super) fn now(&self) -> P {
        self.now
    }

    /// Forgets `peer`, if it was here earlier: it is another sender, and this one stays where it is. Says whether it was.
    pub(super) fn part_with(&mut self, peer: P) -> bool {
        let earlier = self
            .earlier
            .iter_mut()
            .find(|earlier| **earlier == Some(peer));
        let parted = earlier.is_some_and(|earlier| earlier.take().is_some());
        if parted {
            // Two that send from one machine must not be taken for one that roams, back and forth without end.
            self.since_secs = f64::NEG_INFINITY;
        }
        parted
    }
}
