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

use std::sync::Arc;

use super::clock::SenderClock;
use super::datagram::Datagram;
use super::message::{VmcMessage, mirror, seen_in_mirror};
use super::peers::{Peer, Ports};
use super::receiver_options::VmcOptions;
use super::rest::is_t_pose;
use super::skeleton::{AssumedNeck, assumed_neck, bones_of, local_position, place, rig_of};
use crate::ready::ReadyItems;
use morec::humanoid::{BoneMask, HUMANOID_BONES, is_body, parent_among};
use morec::live::{Frame, PerformerId, Rig, SourceCounts, SourceItem};
use morec::math::{Quat, Vec3};

/// A bone that has been missing for so long is stale.
const STALE_SECS: f64 = 0.25;
/// Observation time before a sender's skeleton, or a new bone, is accepted.
const LEARN_SECS: f64 = 0.25;
/// A bone that has been missing for so long is no longer part of the skeleton.
const FORGET_SECS: f64 = 2.0;
/// A time stamp that lies back by less than this is a packet that was overtaken; by more, a sender begun anew.
const LATE_SECS: f64 = 1.0;

#[derive(Debug, Clone, Copy)]
struct BoneState {
    position: Vec3,
    rotation: Quat,
    seen_secs: f64,
}

/// A sender: its bones as they came last, its clock and its skeleton.
#[derive(Debug)]
pub(super) struct Sender<P> {
    pub(super) serial: u64,
    pub(super) ports: Ports<P>,
    /// Its place; none before it has shown a body.
    pub(super) actor: Option<PerformerId>,
    bones: [BoneState; HUMANOID_BONES],
    root: (Vec3, Quat),
    /// Bones that the open frame holds.
    pub(super) fresh: BoneMask,
    pub(super) last_bone_secs: f64,
    /// The open frame's time, by its sender.
    sent_secs: Option<f64>,
    clock: SenderClock,
    pub(super) heard_secs: f64,
    /// No performer to be seen, it says.
    bad: bool,
    rig: Option<(BoneMask, Arc<Rig>)>,
    /// Since when the bones that come are not the rig's.
    changed_secs: Option<f64>,
}

impl<P: Peer> Sender<P> {
    pub(super) fn new(serial: u64, peer: P, now_secs: f64) -> Self {
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
    pub(super) fn alive(&self, now_secs: f64) -> BoneMask {
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
pub(super) struct Taking<'a, P> {
    pub(super) sender: &'a mut Sender<P>,
    pub(super) ready: &'a mut ReadyItems,
    pub(super) counts: &'a mut SourceCounts,
    pub(super) options: &'a VmcOptions,
    pub(super) now_secs: f64,
    pub(super) begun_secs: f64,
    /// A place, if it has none and shows a body.
    pub(super) place: Option<PerformerId>,
    /// It had gone before this packet.
    pub(super) gone: bool,
    /// It shows a body.
    pub(super) shown: bool,
    /// It shows a body, and there is no place.
    pub(super) crowded: bool,
}

impl<P: Peer> Taking<'_, P> {
    /// Takes all that a datagram says.
    pub(super) fn datagram(&mut self, datagram: &Datagram) {
        if self.was_overtaken(datagram) {
            self.counts.late += 1;
            return;
        }
        let mut bones = 0;
        for said in datagram.said() {
            self.take(*said, &mut bones);
        }
        self.counts.malformed += u64::from(datagram.is_malformed());
        if bones > 0 && self.sender.is_complete(self.now_secs) {
            self.close();
        }
    }

    /// True if the sender stamped this packet earlier than one before it.
    fn was_overtaken(&self, datagram: &Datagram) -> bool {
        if self.gone {
            // Whoever comes back may have begun its clock anew.
            return false;
        }
        let newest = self.sender.sent_secs.or(self.sender.clock.sent_secs());
        datagram
            .sent_secs()
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
    pub(super) fn close(&mut self) {
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
        let mut frame = self.ready.spare();
        self.pose(mask, &mut frame);
        frame.time_secs = time_secs;
        frame.wall_secs = arrival_secs;
        frame.actor = actor;
        if self.options.skip_t_pose && is_t_pose(|role| frame.position(&rig, role)) {
            self.counts.not_motion += 1;
            self.ready.give_back(frame);
        } else {
            self.ready.push(SourceItem::Frame(frame));
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

    /// Learns which bones there are, and announces the skeleton when they change.
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
            self.ready.push(SourceItem::Rig(actor, rig.clone()));
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
