//! Packets to frames.
//!
//! VMC marks no frames. One is taken to be complete
//!
//! - (a) at the end of a datagram after which it holds every bone that its sender usually sends,
//! - (b) at the next time stamp or state message,
//! - (c) when a bone comes that it already holds,
//! - (d) when nothing has come for 5 ms.
//!
//! A bone that a frame lacks keeps its rotation; one that has been missing for a quarter of a second is stale, and the
//! joints that hang on it are unknown until it comes again.

use std::collections::VecDeque;
use std::sync::Arc;

use super::clock::SenderClock;
use super::message::{VmcMessage, mirror, seen_in_mirror, understand};
use super::peers::{Peer, Ports};
use super::rest::is_t_pose;
use super::skeleton::{AssumedNeck, assumed_neck, bones_of, local_position, place, rig_of};
use crate::osc::{self, Message};
use morec::humanoid::{BoneMask, HUMANOID_BONES, is_body, parent_among};
use morec::live::{Arrival, Frame, PerformerId, PerformerTable, Rig, SourceCounts, SourceEvent};
use morec::math::{Quat, Vec3};

/// (d) of the rules.
const QUIET_SECS: f64 = 0.005;
/// A bone that has been missing for so long is stale.
const STALE_SECS: f64 = 0.25;
/// So long a sender is watched before its skeleton is believed, and a new bone before it becomes part of it.
const LEARN_SECS: f64 = 0.25;
/// A bone that has been missing for so long is no longer part of the skeleton.
const FORGET_SECS: f64 = 2.0;
/// A sender that has been silent for so long has stopped, for now.
const GONE_SECS: f64 = 1.0;
/// Senders that are watched until they show a body; a place is theirs only then.
const NEWCOMERS: usize = 16;
/// A time stamp that lies back by less than this is a packet that was overtaken; by more, a sender begun anew.
const LATE_SECS: f64 = 1.0;

/// Options of a receiver.
#[derive(Debug, Clone, PartialEq)]
pub struct VmcOptions {
    /// Exchange left and right: for senders that show their performer as a mirror would.
    pub mirrored: bool,
    /// Performers that are followed at once, at most [`MAX_PERFORMERS`](morec::live::MAX_PERFORMERS); packets of others are counted and left.
    pub actors: usize,
    /// Leave out frames that show a T-pose too exact to be a person's.
    pub skip_t_pose: bool,
}

impl Default for VmcOptions {
    fn default() -> Self {
        Self {
            mirrored: false,
            actors: 4,
            skip_t_pose: true,
        }
    }
}

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
    ready: Ready,
    counts: SourceCounts,
    begun_secs: Option<f64>,
    refused: Option<P>,
}

/// A complete frame that waits to be taken.
#[derive(Debug, Default)]
struct Ready {
    items: VecDeque<VmcItem>,
    spare: Vec<Frame>,
}

#[derive(Debug)]
enum VmcItem {
    Frame(Frame),
    Rig(PerformerId, Arc<Rig>),
    Gone(PerformerId),
}

#[derive(Debug, Clone, Copy)]
struct BoneState {
    position: Vec3,
    rotation: Quat,
    seen_secs: f64,
}

#[derive(Debug)]
struct Sender<P> {
    serial: u64,
    ports: Ports<P>,
    /// Its place; none before it has shown a body.
    actor: Option<PerformerId>,
    bones: [BoneState; HUMANOID_BONES],
    root: (Vec3, Quat),
    /// Bones that the open frame holds.
    fresh: BoneMask,
    last_bone_secs: f64,
    /// The open frame's time, by its sender.
    sent_secs: Option<f64>,
    clock: SenderClock,
    heard_secs: f64,
    /// No performer to be seen, it says.
    bad: bool,
    rig: Option<(BoneMask, Arc<Rig>)>,
    /// Since when the bones that come are not the rig's.
    changed_secs: Option<f64>,
}

impl<P: Peer> VmcReceiver<P> {
    /// A receiver that has heard nothing yet.
    pub fn new(options: &VmcOptions) -> Self {
        Self {
            options: options.clone(),
            senders: Vec::new(),
            performers: PerformerTable::new(options.actors),
            serial: 0,
            ready: Ready::default(),
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
        self.with(at, now_secs, |taking| taking.datagram(bytes));
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
        let items = &mut self.ready.items;
        self.performers.leave_silent(now_secs, GONE_SECS, |actor| {
            items.push_back(VmcItem::Gone(actor));
        });
        let silent = |sender: &Sender<P>| now_secs - sender.heard_secs > GONE_SECS;
        self.senders
            .retain(|sender| sender.actor.is_some() || !silent(sender));
    }

    /// The next complete event, oldest first; fills `frame` for [`SourceEvent::Frame`].
    pub fn next(&mut self, frame: &mut Frame) -> Option<SourceEvent> {
        Some(match self.ready.items.pop_front()? {
            VmcItem::Frame(mut full) => {
                std::mem::swap(frame, &mut full);
                self.ready.spare.push(full);
                SourceEvent::Frame
            }
            VmcItem::Rig(actor, rig) => SourceEvent::Rig(actor, rig),
            VmcItem::Gone(actor) => SourceEvent::Gone(actor),
        })
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

impl<P: Peer> Sender<P> {
    fn new(serial: u64, peer: P, now_secs: f64) -> Self {
        let bone = BoneState {
            position: Vec3::zeros(),
            rotation: Quat::identity(),
            seen_secs: f64::NEG_INFINITY,
        };
        Self {
            serial,
            ports: Ports::new(peer, now_secs),
            actor: None,
            bones: [bone; HUMANOID_BONES],
            root: (Vec3::zeros(), Quat::identity()),
            fresh: 0,
            last_bone_secs: now_secs,
            sent_secs: None,
            clock: SenderClock::default(),
            heard_secs: now_secs,
            bad: false,
            rig: None,
            changed_secs: None,
        }
    }

    /// Bones that came lately.
    fn alive(&self, now_secs: f64) -> BoneMask {
        let is = |b: &usize| now_secs - self.bones[*b].seen_secs < STALE_SECS;
        (0..HUMANOID_BONES)
            .filter(is)
            .fold(0, |mask, b| mask | 1 << b)
    }

    /// True if the open frame holds all there usually is.
    fn is_complete(&self, now_secs: f64) -> bool {
        // As long as it is not known what usually comes, the other rules must do.
        let expected = self
            .rig
            .as_ref()
            .map_or(0, |(mask, _)| mask & self.alive(now_secs));
        expected != 0 && self.fresh & expected == expected
    }
}

/// One sender's packet on its way in.
struct Taking<'a, P> {
    sender: &'a mut Sender<P>,
    ready: &'a mut Ready,
    counts: &'a mut SourceCounts,
    options: &'a VmcOptions,
    now_secs: f64,
    begun_secs: f64,
    /// A place, if it has none and shows a body.
    place: Option<PerformerId>,
    /// It had gone before this packet.
    gone: bool,
    /// It shows a body.
    shown: bool,
    /// It shows a body, and there is no place.
    crowded: bool,
}

impl<P: Peer> Taking<'_, P> {
    fn datagram(&mut self, bytes: &[u8]) {
        if self.was_overtaken(bytes) {
            self.counts.late += 1;
            return;
        }
        let mut bones = 0;
        let mut spoiled = 0;
        let malformed = osc::read(bytes, &mut |message| match understand(&message) {
            Some(said) => self.take(said, &mut bones),
            None => spoiled += 1,
        });
        self.counts.malformed += u64::from(malformed + spoiled > 0);
        if bones > 0 && self.sender.is_complete(self.now_secs) {
            self.close();
        }
    }

    /// True if the sender stamped this packet earlier than one before it.
    fn was_overtaken(&self, bytes: &[u8]) -> bool {
        if self.gone {
            // Whoever comes back may have begun its clock anew.
            return false;
        }
        let mut stamp = None;
        osc::read(bytes, &mut |message: Message| {
            if message.address == "/VMC/Ext/T"
                && let Some(VmcMessage::Time(secs)) = understand(&message)
            {
                stamp = Some(secs);
            }
        });
        let newest = self.sender.sent_secs.or(self.sender.clock.sent_secs());
        stamp
            .zip(newest)
            .is_some_and(|(sent, newest)| sent < newest && newest - sent < LATE_SECS)
    }

    /// Takes a message; `bones` counts those of its datagram.
    fn take(&mut self, said: VmcMessage, bones: &mut usize) {
        match said {
            VmcMessage::State { good } => {
                self.close();
                self.sender.bad = !good;
            }
            VmcMessage::Time(secs) => {
                let news = self.sender.sent_secs != Some(secs);
                if news && *bones > 0 {
                    // It ends the datagram of its frame.
                    self.sender.sent_secs = Some(secs);
                    self.close();
                } else if news {
                    self.close();
                    self.sender.sent_secs = Some(secs);
                }
            }
            VmcMessage::Root(position, rotation) => {
                let mirrored = self.options.mirrored;
                self.sender.root = if mirrored {
                    mirror(position, rotation)
                } else {
                    (position, rotation)
                };
            }
            VmcMessage::Bone(bone, position, rotation) => {
                *bones += 1;
                let seen = if self.options.mirrored {
                    seen_in_mirror(bone, position, rotation)
                } else {
                    (bone, position, rotation)
                };
                self.bone(seen);
            }
            VmcMessage::Other => self.counts.ignored += 1,
        }
    }

    fn bone(&mut self, (bone, position, rotation): (usize, Vec3, Quat)) {
        if self.sender.fresh >> bone & 1 == 1 {
            self.close();
        }
        self.sender.bones[bone] = BoneState {
            position,
            rotation,
            seen_secs: self.now_secs,
        };
        self.sender.fresh |= 1 << bone;
        self.sender.last_bone_secs = self.now_secs;
    }

    /// Ends the open frame, if there is one.
    fn close(&mut self) {
        let fresh = std::mem::take(&mut self.sender.fresh);
        let sent_secs = self.sender.sent_secs.take();
        if fresh == 0 {
            // A stamp waits for its frame.
            self.sender.sent_secs = sent_secs;
            return;
        }
        self.show();
        if self.gone {
            self.counts.incomplete += 1;
            return;
        }
        let arrival_secs = self.sender.last_bone_secs;
        let time_secs = self
            .sender
            .clock
            .stamp(sent_secs, arrival_secs - self.begun_secs);
        if self.sender.bad {
            self.counts.not_motion += 1;
            return;
        }
        self.learn();
        let (Some((mask, rig)), Some(actor)) = (self.sender.rig.clone(), self.sender.actor) else {
            self.counts.incomplete += u64::from(!self.is_watched());
            return;
        };
        self.counts.incomplete += u64::from(fresh & mask != mask);
        let mut frame = self.ready.spare.pop().unwrap_or_default();
        self.pose(mask, &mut frame);
        frame.time_secs = time_secs;
        frame.wall_secs = arrival_secs;
        frame.actor = actor;
        if self.options.skip_t_pose && is_t_pose(&frame.key_pose(&rig)) {
            self.counts.not_motion += 1;
            self.ready.spare.push(frame);
        } else {
            self.ready.items.push_back(VmcItem::Frame(frame));
        }
    }

    /// Notes that a body is seen, if one is; who was gone is back by that.
    fn show(&mut self) {
        if !is_body(self.sender.alive(self.now_secs)) {
            return;
        }
        self.shown = true;
        if std::mem::take(&mut self.gone) {
            self.sender.clock = SenderClock::default();
            self.counts.interruptions += 1;
        }
    }

    /// True while it is watched before its skeleton is believed: nothing is wrong with such frames.
    fn is_watched(&self) -> bool {
        let since_secs = self.sender.changed_secs;
        since_secs.is_some_and(|since_secs| self.now_secs - since_secs < LEARN_SECS)
    }

    /// Learns which bones there are, and says so when it has changed.
    fn learn(&mut self) {
        let alive = self.sender.alive(self.now_secs);
        let known = self.sender.rig.as_ref().map_or(0, |(mask, _)| *mask);
        if alive == known {
            self.sender.changed_secs = None;
            return;
        }
        let since_secs = *self.sender.changed_secs.get_or_insert(self.now_secs);
        let patience_secs = if alive & !known != 0 {
            LEARN_SECS
        } else {
            FORGET_SECS
        };
        if self.now_secs - since_secs >= patience_secs {
            let place = self.sender.actor.or(self.place);
            let Some(actor) = place.filter(|_| self.sender.actor.is_some() || is_body(alive))
            else {
                self.crowded = is_body(alive);
                return;
            };
            self.sender.actor = Some(actor);
            let rig = Arc::new(rig_of(alive, |bone| self.sender.bones[bone].position));
            self.ready.items.push_back(VmcItem::Rig(actor, rig.clone()));
            self.sender.rig = Some((alive, rig));
            self.sender.changed_secs = None;
        }
    }

    /// Joints of the rig in the world, one for each bone of `mask` in the table's order.
    fn pose(&self, mask: BoneMask, frame: &mut Frame) {
        let alive = self.sender.alive(self.now_secs);
        let (root_position, root_rotation) = self.sender.root;
        let neck = assumed_neck(mask);
        frame.clear(mask.count_ones() as usize + usize::from(neck.is_some()));
        for (joint, bone) in bones_of(mask).enumerate() {
            let BoneState {
                position, rotation, ..
            } = self.sender.bones[bone];
            let parent = parent_among(bone, mask);
            let (world, turned, known) = match parent {
                Some(parent) => {
                    let at = place(mask, parent);
                    let known = alive >> parent & 1 == 1;
                    (frame.pose.positions[at], frame.pose.rotations[at], known)
                }
                None => (root_position, root_rotation, alive >> bone & 1 == 1),
            };
            let local = local_position(bone, parent, position);
            let unknown = Vec3::repeat(f64::NAN);
            // Not a number spreads to everything that hangs on it.
            frame.pose.positions[joint] = if known {
                world + turned * local
            } else {
                unknown
            };
            frame.pose.rotations[joint] = turned * rotation;
        }
        if let Some((head, AssumedNeck { parent, share })) = neck {
            let (pose, joint) = (&mut frame.pose, mask.count_ones() as usize);
            let (above, head) = (place(mask, parent), place(mask, head));
            pose.positions[joint] = pose.positions[above].lerp(&pose.positions[head], share);
            pose.rotations[joint] = pose.rotations[above];
        }
    }
}
