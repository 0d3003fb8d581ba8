//! Turns frames of the broadcast into poses, for each performer.

use std::sync::Arc;

use super::clock::FrameClock;
use super::decoder::{AxisDecoder, AxisError, AxisFrame};
use super::{AXIS_BONE_COUNT, AxisSkeleton};
use crate::ready::ReadyItems;
use morec::live::{
    Arrival, Frame, PerformerTable, Rig, SourceCounts, SourceEvent, SourceItem, largest_holder,
};
use morec::math::{Axis, Quat, Vec3};

/// An avatar that has been silent for so long has stopped, for now.
const GONE_SECS: f64 = 1.0;
/// Shorter is no bone: the sender has no lengths to give.
const LEAST_BONE_M: f64 = 1e-4;
/// A frame whose number lies back by less than this came late; by more, the sender has begun anew.
const LATE_FRAMES: u32 = 100;

/// Options of a receiver.
#[derive(Debug, Clone, PartialEq)]
pub struct AxisOptions {
    /// Parents of the bones, and their lengths where frames have none.
    pub skeleton: AxisSkeleton,
    /// Performers that are followed at once, at most [`MAX_PERFORMERS`](morec::live::MAX_PERFORMERS); frames of others are counted and left.
    pub actors: usize,
}

impl Default for AxisOptions {
    fn default() -> Self {
        Self {
            skeleton: AxisSkeleton::default(),
            actors: 4,
        }
    }
}

/// Makes poses of a broadcast's bytes, for several avatars at once.
///
/// Times are seconds on one clock of the caller's that never goes back. Takes no memory once every avatar has been seen.
#[derive(Debug)]
pub struct AxisReceiver {
    decoder: AxisDecoder,
    followed: Followed,
    last_error: Option<AxisError>,
}

/// Everything but the decoder, which lends out its frames.
#[derive(Debug)]
struct Followed {
    rig: Arc<Rig>,
    /// By their machines and the numbers of their avatars.
    performers: PerformerTable<(u128, u32)>,
    /// For each place.
    avatars: Vec<Avatar>,
    ready: ReadyItems,
    counts: SourceCounts,
    begun_secs: Option<f64>,
}

#[derive(Debug, Default)]
struct Avatar {
    /// Number of its last frame.
    frame: Option<u32>,
    clock: FrameClock,
}

impl AxisReceiver {
    /// A receiver that has heard nothing yet.
    pub fn new(options: &AxisOptions) -> Self {
        let AxisSkeleton { skeleton, roles } = options.skeleton.clone();
        let followed = Followed {
            rig: Arc::new(Rig { skeleton, roles }),
            performers: PerformerTable::new(options.actors),
            avatars: Vec::new(),
            ready: ReadyItems::default(),
            counts: SourceCounts::default(),
            begun_secs: None,
        };
        Self {
            decoder: AxisDecoder::new(),
            followed,
            last_error: None,
        }
    }

    /// Counts of packets since the beginning; packets are frames.
    pub fn counts(&self) -> SourceCounts {
        self.followed.counts
    }

    /// Takes the last error, once.
    pub fn take_error(&mut self) -> Option<AxisError> {
        self.last_error.take()
    }

    /// Takes bytes that came at `now_secs` over a connection. Any bytes will do.
    pub fn bytes(&mut self, now_secs: f64, bytes: &[u8]) {
        self.bytes_from(0, now_secs, bytes);
    }

    /// The same of a datagram from one of several machines, distinguished by their numbers: avatars of two are two, and a machine that
    /// holds the most places, at least two more than another, gives one to it.
    pub fn bytes_from(&mut self, machine: u128, now_secs: f64, bytes: &[u8]) {
        let Self {
            decoder,
            followed,
            last_error,
        } = self;
        decoder.push(bytes, &mut |found| match found {
            Ok(frame) => followed.frame(machine, now_secs, &frame),
            Err(error) => {
                followed.counts.malformed += 1;
                *last_error = Some(error);
            }
        });
    }

    /// The connection has ended, or a datagram has: what comes next begins with a frame.
    pub fn cut(&mut self) {
        let Self {
            decoder,
            followed,
            last_error,
        } = self;
        decoder.finish(&mut |found| {
            if let Err(error) = found {
                followed.counts.malformed += 1;
                *last_error = Some(error);
            }
        });
    }

    /// The connection was lost: everybody has gone for now.
    pub fn lost(&mut self) {
        self.cut();
        let Followed {
            performers, ready, ..
        } = &mut self.followed;
        performers.leave_if(|_| true, |actor| ready.push(SourceItem::Gone(actor)));
    }

    /// Time passes: says who has gone.
    pub fn tick(&mut self, now_secs: f64) {
        let Followed {
            performers, ready, ..
        } = &mut self.followed;
        performers.leave_silent(now_secs, GONE_SECS, |actor| {
            ready.push(SourceItem::Gone(actor));
        });
    }

    /// The next complete event, oldest first; fills `frame` for [`SourceEvent::Frame`].
    pub fn next(&mut self, frame: &mut Frame) -> Option<SourceEvent> {
        self.followed.ready.next(frame)
    }
}

impl Followed {
    /// Takes the last place of the machine that holds too many beside `newcomer`, if one does.
    fn make_room(&mut self, newcomer: u128) {
        let held: Vec<u128> = (self.performers.present())
            .map(|(machine, _)| *machine)
            .collect();
        let Some(largest) = largest_holder(&held, newcomer) else {
            return;
        };
        let present = self.performers.present().copied();
        if let Some(last) = present.filter(|(machine, _)| *machine == largest).last() {
            let ready = &mut self.ready;
            let gone = |actor| ready.push(SourceItem::Gone(actor));
            self.performers.leave_if(|key| *key == last, gone);
        }
    }

    fn frame(&mut self, machine: u128, now_secs: f64, frame: &AxisFrame<'_>) {
        self.counts.packets += 1;
        let begun_secs = *self.begun_secs.get_or_insert(now_secs);
        let key = (machine, frame.avatar);
        if self.performers.find(&key).is_none() && self.performers.vacant().is_none() {
            self.make_room(machine);
        }
        let Some((actor, arrival)) = self.performers.arrive(key, now_secs) else {
            self.counts.refused += 1;
            return;
        };
        match arrival {
            Arrival::Known => {}
            Arrival::Returned | Arrival::Replaced => {
                self.avatars[actor.index()] = Avatar::default();
            }
            Arrival::New => self.avatars.push(Avatar::default()),
        }
        if matches!(arrival, Arrival::New | Arrival::Replaced) {
            self.ready.push(SourceItem::Rig(actor, self.rig.clone()));
        }
        if matches!(arrival, Arrival::Returned | Arrival::Replaced) {
            self.counts.interruptions += 1;
        }
        let avatar = &mut self.avatars[actor.index()];
        let is_late = |last: u32| (1..LATE_FRAMES).contains(&last.wrapping_sub(frame.number));
        if avatar.frame.is_some_and(is_late) {
            self.counts.late += 1;
            return;
        }
        avatar.frame = Some(frame.number);
        let mut full = self.ready.spare();
        full.time_secs = avatar.clock.stamp(frame.number, now_secs - begun_secs);
        full.wall_secs = now_secs;
        full.actor = actor;
        pose(&self.rig, frame, &mut full);
        self.ready.push(SourceItem::Frame(full));
    }
}

/// Positions and rotations of the bones.
fn pose(rig: &Rig, frame: &AxisFrame<'_>, full: &mut Frame) {
    full.pose.positions.clear();
    full.pose.rotations.clear();
    let values = |at: usize| {
        std::array::from_fn(|i| frame.values.get(at + i).map_or(0.0, |v| f64::from(*v)))
    };
    for (b, joint) in rig
        .skeleton
        .joints()
        .iter()
        .take(AXIS_BONE_COUNT)
        .enumerate()
    {
        let (place, turn): ([f64; 3], [f64; 3]) = match (frame.positions, b) {
            (true, _) => (values(6 * b), values(6 * b + 3)),
            (false, 0) => (values(0), values(3)),
            (false, _) => ([0.0; 3], values(3 + 3 * b)),
        };
        let sent = Vec3::from(place) / 100.0;
        let known = joint.parent.is_none() || sent.norm() > LEAST_BONE_M;
        let position = if known { sent } else { joint.offset };
        full.pose.add(joint.parent, position, rotation(turn));
    }
}

/// `R_y · R_x · R_z` of angles in degrees, in that order.
fn rotation([y, x, z]: [f64; 3]) -> Quat {
    let rad = f64::to_radians;
    Axis::Y.rotation(rad(y)) * Axis::X.rotation(rad(x)) * Axis::Z.rotation(rad(z))
}
