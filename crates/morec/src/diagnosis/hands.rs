//! Losses and exchanges of hands in a stream.

use crate::features::{Hand, KeyPose, MAX_GAP_SECS};
use crate::math::Vec3;

use super::shape::Mean;

/// Both hands have changed places if they do within this time.
const AT_ONCE_SECS: f64 = 0.2;
/// A longer time without a frame is a pause of the stream, not one of a hand.
const MOST_SECS: f64 = 20.0;
/// Of a live stream, losses fade this many times slower than everything else: they are rare.
const SLOWER: f64 = 12.0;

/// Where a hand was seen last.
#[derive(Debug, Clone, Copy)]
struct Sighting {
    secs: f64,
    place: Vec3,
}

/// What a stream shows of hands.
#[derive(Debug, Clone, Default)]
pub(super) struct HandsWatch {
    /// Length of a hand, in the stream's unit.
    pub(super) length: Mean,
    /// Looks at which each hand was seen.
    seen: [f64; 2],
    last: [Option<Sighting>; 2],
    last_secs: Option<f64>,
    secs: f64,
    losses: f64,
    swaps: f64,
}

impl HandsWatch {
    /// Takes the pose at `time_secs`.
    pub(super) fn push(&mut self, time_secs: f64, pose: &KeyPose) {
        let passed = time_secs - self.last_secs.replace(time_secs).unwrap_or(time_secs);
        if !(0.0..MOST_SECS).contains(&passed) {
            self.last = [None; 2];
            return;
        }
        self.secs += passed;
        let now = Hand::BOTH.map(|hand| hand.root(pose).filter(|_| hand.is_seen(pose)));
        for (hand, seen) in Hand::BOTH.into_iter().zip(&mut self.seen) {
            if hand.is_seen(pose) {
                *seen += 1.0;
                self.length.add_known(hand.length(pose));
            }
        }
        if self.have_changed_places(time_secs, &now) {
            self.swaps += 1.0;
            self.last = [None; 2];
        }
        for (last, place) in self.last.iter_mut().zip(now) {
            let Some(place) = place else { continue };
            let gone = |last: Sighting| time_secs - last.secs > MAX_GAP_SECS;
            self.losses += f64::from(u8::from(last.is_some_and(gone)));
            *last = Some(Sighting {
                secs: time_secs,
                place,
            });
        }
    }

    /// True if each hand that is seen is where the other was a moment ago.
    fn have_changed_places(&self, time_secs: f64, now: &[Option<Vec3>; 2]) -> bool {
        let recent = |last: Option<Sighting>| {
            let last = last.filter(|last| time_secs - last.secs <= AT_ONCE_SECS)?;
            Some(last.place)
        };
        let before = self.last.map(recent);
        let far = |a: Option<Vec3>, b: Option<Vec3>| Some((a? - b?).norm());
        match *now {
            [Some(_), Some(_)] => {
                let crossed = [far(now[0], before[1]), far(now[1], before[0])];
                let straight = [far(now[0], before[0]), far(now[1], before[1])];
                match (crossed, straight) {
                    ([Some(a), Some(b)], [Some(c), Some(d)]) => a + b < 0.5 * (c + d),
                    _ => false,
                }
            }
            // One hand that is called the other, while the other is gone.
            [Some(_), None] | [None, Some(_)] => {
                let (own, other) = if now[0].is_some() { (0, 1) } else { (1, 0) };
                let near = far(now[own], before[other]).zip(self.length.get());
                before[own].is_none() && near.is_some_and(|(far, length)| far < 0.5 * length)
            }
            [None, None] => false,
        }
    }

    pub(super) fn fade(&mut self, factor: f64) {
        self.length.fade(factor);
        self.seen.iter_mut().for_each(|seen| *seen *= factor);
        let slow = factor.powf(1.0 / SLOWER);
        for value in [&mut self.secs, &mut self.losses, &mut self.swaps] {
            *value *= slow;
        }
    }

    /// Looks at which `hand` was seen.
    pub(super) fn seen(&self, hand: Hand) -> f64 {
        self.seen[usize::from(hand == Hand::Right)]
    }

    /// How often a minute a hand was away for longer than recognition bridges; 0 if it was once.
    pub(super) fn losses_per_minute(&self) -> f64 {
        self.per_minute(self.losses)
    }

    /// How often a minute left and right changed places; 0 if they did once.
    pub(super) fn swaps_per_minute(&self) -> f64 {
        self.per_minute(self.swaps)
    }

    fn per_minute(&self, count: f64) -> f64 {
        match count > 1.5 && self.secs > 0.0 {
            true => 60.0 * count / self.secs,
            false => 0.0,
        }
    }
}
