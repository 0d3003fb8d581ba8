//! The senders on a port: tells them apart and gives each a place among the performers.

use super::assembly::{Sender, Taking};
use super::datagram::Datagram;
use super::peers::Peer;
use super::receiver_options::VmcOptions;
use crate::ready::ReadyItems;
use morec::humanoid::is_body;
use morec::live::{Arrival, Frame, PerformerTable, SourceCounts, SourceEvent, SourceItem};

/// (d) of the rules.
const QUIET_SECS: f64 = 0.005;
/// A sender that has been silent for so long has stopped, for now.
const GONE_SECS: f64 = 1.0;
/// Senders that are watched until they show a body; a place is theirs only then.
const NEWCOMERS: usize = 16;

/// Makes frames of VMC packets, for several senders at once, distinguished by where they send from (`P`: an address).
///
/// Times are seconds on one clock of the caller's that never goes back; frames are stamped on the same clock, steadied by
/// the sender's where it sends one. Takes no memory once every sender has been seen for a while.
///
/// A performer's place is given to a sender that has shown a body (its hips and limbs) for a quarter of a second, and is
/// free again a second after the last body: packets of another kind neither take nor keep one.
#[derive(Debug)]
pub struct VmcReceiver<P> {
    options: VmcOptions,
    senders: Vec<Sender<P>>,
    /// Senders that show a body, by their serial numbers.
    performers: PerformerTable<u64>,
    /// Serial number of the next sender.
    serial: u64,
    ready: ReadyItems,
    /// The datagram that came last.
    datagram: Datagram,
    counts: SourceCounts,
    begun_secs: Option<f64>,
    refused: Option<P>,
}

impl<P: Peer> VmcReceiver<P> {
    /// A receiver that has heard nothing yet.
    pub fn new(options: &VmcOptions) -> Self {
        Self {
            options: options.clone(),
            senders: Vec::new(),
            performers: PerformerTable::new(options.actors),
            serial: 0,
            ready: ReadyItems::default(),
            datagram: Datagram::default(),
            counts: SourceCounts::default(),
            begun_secs: None,
            refused: None,
        }
    }

    /// A sender that showed a body lately and has no place, as all are taken.
    pub fn take_refused(&mut self) -> Option<P> {
        self.refused.take()
    }

    /// Counts since the beginning.
    pub fn counts(&self) -> SourceCounts {
        self.counts
    }

    /// True if a frame is open that [`tick`](Self::tick) would close soon.
    pub fn is_open(&self) -> bool {
        self.senders.iter().any(|sender| sender.fresh != 0)
    }

    /// Takes a datagram that came from `peer` at `now_secs`. Any bytes will do.
    pub fn packet(&mut self, peer: P, now_secs: f64, bytes: &[u8]) {
        self.counts.packets += 1;
        self.begun_secs.get_or_insert(now_secs);
        let Some(at) = self.sender(peer, now_secs) else {
            self.counts.refused += 1;
            return;
        };
        let sender = &mut self.senders[at];
        sender.heard_secs = now_secs;
        sender.ports.hear(now_secs);
        let mut datagram = std::mem::take(&mut self.datagram);
        datagram.read(bytes);
        self.with(at, now_secs, |taking| taking.datagram(&datagram));
        self.datagram = datagram;
    }

    /// Lets a sender take what came; it may get a place by that.
    fn with(&mut self, at: usize, now_secs: f64, take: impl FnOnce(&mut Taking<'_, P>)) {
        let sender = &mut self.senders[at];
        let newcomer = sender.actor.is_none();
        let performers = &self.performers;
        let gone = sender.actor.is_some_and(|actor| performers.is_gone(actor));
        let mut taking = Taking {
            sender,
            ready: &mut self.ready,
            counts: &mut self.counts,
            options: &self.options,
            now_secs,
            begun_secs: self.begun_secs.unwrap_or(now_secs),
            place: if newcomer { performers.vacant() } else { None },
            gone,
            shown: false,
            crowded: false,
        };
        take(&mut taking);
        let shown = taking.shown;
        if taking.crowded {
            self.counts.refused += 1;
            self.refused = Some(self.senders[at].ports.now());
        }
        let sender = &self.senders[at];
        let (serial, Some(actor)) = (sender.serial, sender.actor) else {
            return;
        };
        if !newcomer {
            if shown {
                self.performers.hear(actor, now_secs);
            }
            return;
        }
        if let Some((_, Arrival::Replaced)) = self.performers.arrive(serial, now_secs) {
            // Whoever had the place before has gone.
            self.senders
                .retain(|other| other.serial == serial || other.actor != Some(actor));
            self.counts.interruptions += 1;
        }
    }

    /// Time passes: closes frames after a silence, and says who has gone.
    pub fn tick(&mut self, now_secs: f64) {
        let mut at = 0;
        while at < self.senders.len() {
            let sender = &self.senders[at];
            if sender.fresh != 0 && now_secs - sender.last_bone_secs >= QUIET_SECS {
                self.with(at, now_secs, |taking| taking.close());
            }
            at += 1;
        }
        let ready = &mut self.ready;
        self.performers.leave_silent(now_secs, GONE_SECS, |actor| {
            ready.push(SourceItem::Gone(actor));
        });
        let silent = |sender: &Sender<P>| now_secs - sender.heard_secs > GONE_SECS;
        self.senders
            .retain(|sender| sender.actor.is_some() || !silent(sender));
    }

    /// The next complete event, oldest first; fills `frame` for [`SourceEvent::Frame`].
    pub fn next(&mut self, frame: &mut Frame) -> Option<SourceEvent> {
        self.ready.next(frame)
    }

    /// The sender at `peer`, a new one without a place if need be.
    fn sender(&mut self, peer: P, now_secs: f64) -> Option<usize> {
        if let Some(at) = self
            .senders
            .iter()
            .position(|sender| sender.ports.is_at(peer))
        {
            return Some(at);
        }
        // One that has been here before and was taken for a sender that changes its port is one of its own.
        let parted = self
            .senders
            .iter_mut()
            .any(|sender| sender.ports.part_with(peer));
        let performers = &self.performers;
        let gone = |sender: &Sender<P>| sender.actor.is_some_and(|a| performers.is_gone(a));
        let roams = |sender: &mut Sender<P>| !gone(sender) && sender.ports.follow(peer, now_secs);
        if !parted && let Some(at) = self.senders.iter_mut().position(roams) {
            return Some(at);
        }
        let newcomers = || {
            let all = self.senders.iter().enumerate();
            all.filter(|(_, sender)| sender.actor.is_none())
        };
        if newcomers().count() < NEWCOMERS {
            let serial = self.next_serial();
            self.senders.push(Sender::new(serial, peer, now_secs));
            return Some(self.senders.len() - 1);
        }
        // Whoever shows least makes room; those who are about to show a body do not.
        let bones = |sender: &Sender<P>| sender.alive(now_secs).count_ones();
        let (least, sender) = newcomers().min_by_key(|(_, sender)| bones(sender))?;
        if is_body(sender.alive(now_secs)) {
            return None;
        }
        let serial = self.next_serial();
        self.senders[least] = Sender::new(serial, peer, now_secs);
        Some(least)
    }

    fn next_serial(&mut self) -> u64 {
        self.serial += 1;
        self.serial
    }
}
