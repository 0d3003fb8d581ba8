//! Frames to poses, performer by performer.

use std::collections::VecDeque;
use std::sync::Arc;

use super::clock::FrameClock;
use super::decoder::{AxisDecoder, AxisError, AxisFrame};
use super::{AXIS_BONE_COUNT, AxisSkeleton};
use crate::live::{Frame, MAX_ACTORS, PerformerId, Rig, SourceCounts, SourceEvent};
use crate::math::{Axis, Quat, Vec3};

/// An avatar that has been silent for so long has stopped, for now.
const GONE_SECS: f64 = 1.0;
/// Shorter is no bone: the sender has no lengths to give.
const LEAST_BONE_M: f64 = 1e-4;
/// A frame whose number lies back by less than this came late; by more, the sender has begun anew.
const LATE_FRAMES: u32 = 100;

/// How a receiver takes what it is sent.
#[derive(Debug, Clone, PartialEq)]
pub struct AxisOptions {
    /// How bones hang together; and their lengths, where frames have none.
    pub skeleton: AxisSkeleton,
    /// Performers that are followed at once, at most [`MAX_ACTORS`]; frames of others are counted and left.
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
    actors: usize,
    avatars: Vec<Avatar>,
    items: VecDeque<AxisItem>,
    spare: Vec<Frame>,
    counts: SourceCounts,
    begun_secs: Option<f64>,
}

#[derive(Debug)]
struct Avatar {
    number: u32,
    /// Number of its last frame.
    frame: Option<u32>,
    clock: FrameClock,
    heard_secs: f64,
    gone: bool,
}

#[derive(Debug)]
enum AxisItem {
    Frame(Frame),
    Rig(PerformerId),
    Gone(PerformerId),
}

impl AxisReceiver {
    /// A receiver that has heard nothing yet.
    pub fn new(options: &AxisOptions) -> Self {
        let AxisSkeleton { skeleton, roles } = options.skeleton.clone();
        let followed = Followed {
            rig: Arc::new(Rig { skeleton, roles }),
            actors: options.actors.clamp(1, MAX_ACTORS),
            avatars: Vec::new(),
            items: VecDeque::new(),
            spare: Vec::new(),
            counts: SourceCounts::default(),
            begun_secs: None,
        };
        Self {
            decoder: AxisDecoder::new(),
            followed,
            last_error: None,
        }
    }

    /// What it has seen so far; packets are frames.
    pub fn counts(&self) -> SourceCounts {
        self.followed.counts
    }

    /// What was wrong last, once.
    pub fn take_error(&mut self) -> Option<AxisError> {
        self.last_error.take()
    }

    /// Takes bytes that came at `now_secs`. Any bytes will do.
    pub fn bytes(&mut self, now_secs: f64, bytes: &[u8]) {
        let Self {
            decoder,
            followed,
            last_error,
        } = self;
        decoder.push(bytes, &mut |found| match found {
            Ok(frame) => followed.frame(now_secs, &frame),
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
        let Followed { avatars, items, .. } = &mut self.followed;
        for (at, avatar) in avatars
            .iter_mut()
            .enumerate()
            .filter(|(_, avatar)| !avatar.gone)
        {
            avatar.gone = true;
            items.push_back(AxisItem::Gone(PerformerId(at as u16)));
        }
    }

    /// Time passes: says who has gone.
    pub fn tick(&mut self, now_secs: f64) {
        let Followed { avatars, items, .. } = &mut self.followed;
        for (at, avatar) in avatars.iter_mut().enumerate() {
            if !avatar.gone && now_secs - avatar.heard_secs > GONE_SECS {
                avatar.gone = true;
                items.push_back(AxisItem::Gone(PerformerId(at as u16)));
            }
        }
    }

    /// What is complete, oldest first; fills `frame` for [`SourceEvent::Frame`].
    pub fn next(&mut self, frame: &mut Frame) -> Option<SourceEvent> {
        Some(match self.followed.items.pop_front()? {
            AxisItem::Frame(mut full) => {
                std::mem::swap(frame, &mut full);
                self.followed.spare.push(full);
                SourceEvent::Frame
            }
            AxisItem::Rig(actor) => SourceEvent::Rig(actor, self.followed.rig.clone()),
            AxisItem::Gone(actor) => SourceEvent::Gone(actor),
        })
    }
}

impl Followed {
    fn frame(&mut self, now_secs: f64, frame: &AxisFrame<'_>) {
        self.counts.packets += 1;
        let begun_secs = *self.begun_secs.get_or_insert(now_secs);
        let Some(at) = self.avatar(frame.avatar) else {
            self.counts.refused += 1;
            return;
        };
        let avatar = &mut self.avatars[at];
        avatar.heard_secs = now_secs;
        if std::mem::take(&mut avatar.gone) {
            avatar.clock = FrameClock::default();
            self.counts.interruptions += 1;
        } else if avatar
            .frame
            .is_some_and(|last| (1..LATE_FRAMES).contains(&last.wrapping_sub(frame.number)))
        {
            self.counts.late += 1;
            return;
        }
        avatar.frame = Some(frame.number);
        let mut full = self.spare.pop().unwrap_or_default();
        full.time_secs = avatar.clock.stamp(frame.number, now_secs - begun_secs);
        full.wall_secs = now_secs;
        full.actor = PerformerId(at as u16);
        pose(&self.rig, frame, &mut full);
        self.items.push_back(AxisItem::Frame(full));
    }

    /// The place of avatar `number`, a new one if there is room; one that has gone makes room.
    fn avatar(&mut self, number: u32) -> Option<usize> {
        if let Some(at) = self
            .avatars
            .iter()
            .position(|avatar| avatar.number == number)
        {
            return Some(at);
        }
        let new = Avatar {
            number,
            frame: None,
            clock: FrameClock::default(),
            heard_secs: 0.0,
            gone: true,
        };
        let place = if self.avatars.len() < self.actors {
            self.avatars.push(Avatar { gone: false, ..new });
            self.avatars.len() - 1
        } else {
            let place = self.avatars.iter().position(|avatar| avatar.gone)?;
            self.avatars[place] = new;
            place
        };
        self.items
            .push_back(AxisItem::Rig(PerformerId(place as u16)));
        Some(place)
    }
}

/// Where the bones are and how they are turned.
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
