//! Measures of time: frame rate, regularity of arrivals, lost and repeated frames.

use crate::features::MAX_GAP_SECS;

/// Intervals that are remembered.
const RING: usize = 64;
/// Intervals after which the usual one is looked for again.
const RENEW: u64 = 32;
/// More frames than this cannot be missing between two that came: the stream has stopped for a while.
const MOST_LOST: f64 = 20.0;

/// The last intervals, in any order.
#[derive(Debug, Clone)]
struct Ring {
    secs: [f64; RING],
    count: u64,
}

impl Ring {
    fn new() -> Self {
        Self {
            secs: [0.0; RING],
            count: 0,
        }
    }

    fn add(&mut self, secs: f64) {
        self.secs[(self.count % RING as u64) as usize] = secs;
        self.count += 1;
    }

    /// The intervals that shares `shares` of them do not exceed; `None` before there are eight.
    fn quantiles<const N: usize>(&self, shares: [f64; N]) -> Option<[f64; N]> {
        let len = self.count.min(RING as u64) as usize;
        if len < 8 {
            return None;
        }
        let mut sorted = self.secs;
        let sorted = &mut sorted[..len];
        sorted.sort_unstable_by(f64::total_cmp);
        Some(shares.map(|share| sorted[(share * (len - 1) as f64).round() as usize]))
    }
}

/// Times of the frames of one performer.
#[derive(Debug, Clone)]
pub(super) struct Timing {
    pub(super) frames: u64,
    /// Frames at a time that was not after the one before.
    pub(super) late: u64,
    first_secs: f64,
    pub(super) last_secs: f64,
    last_arrived: f64,
    sent: Ring,
    arrived: Ring,
    /// The usual interval by the frames' own times.
    pub(super) usual_secs: Option<f64>,
    taken: f64,
    lost: f64,
    repeated: f64,
}

/// Statistics of a stream's times.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rhythm {
    pub(super) secs: f64,
    pub(super) interval_secs: Option<f64>,
    pub(super) jitter_secs: Option<f64>,
    pub(super) lost_share: f64,
    pub(super) repeated_share: f64,
}

impl Timing {
    pub(super) fn new() -> Self {
        Self {
            frames: 0,
            late: 0,
            first_secs: f64::NAN,
            last_secs: f64::NAN,
            last_arrived: f64::NAN,
            sent: Ring::new(),
            arrived: Ring::new(),
            usual_secs: None,
            taken: 0.0,
            lost: 0.0,
            repeated: 0.0,
        }
    }

    /// Takes the times of a frame; returns the interval to the one before (0 for the first), or `None` if the frame is
    /// late or has no time.
    pub(super) fn push(&mut self, time_secs: f64, arrived_secs: f64) -> Option<f64> {
        self.frames += 1;
        let first = self.last_secs.is_nan();
        let interval = if first {
            0.0
        } else {
            time_secs - self.last_secs
        };
        if !time_secs.is_finite() || (!first && interval <= 0.0) {
            self.late += 1;
            // A clock that was set back begins anew, as it does in recognition.
            if interval < -MAX_GAP_SECS {
                (self.first_secs, self.last_secs) = (time_secs, time_secs);
            }
            return None;
        }
        self.taken += 1.0;
        if first {
            self.first_secs = time_secs;
        } else {
            self.sent.add(interval);
            self.arrived.add(arrived_secs - self.last_arrived);
            self.count_lost(interval);
        }
        (self.last_secs, self.last_arrived) = (time_secs, arrived_secs);
        Some(interval)
    }

    /// Frames that are missing between two: intervals of whole multiples of the usual one.
    fn count_lost(&mut self, interval: f64) {
        if self.usual_secs.is_none() || self.sent.count.is_multiple_of(RENEW) {
            self.usual_secs = self.sent.quantiles([0.5]).map(|[median]| median);
        }
        let Some(usual) = self.usual_secs.filter(|usual| *usual > 0.0) else {
            return;
        };
        let steps = interval / usual;
        let whole = (1.5..MOST_LOST).contains(&steps) && (steps - steps.round()).abs() < 0.25;
        if whole {
            self.lost += steps.round() - 1.0;
        }
    }

    /// True if a frame at this time that shows the same as the one before is the same packet, come twice: no sender is so
    /// fast. What lies between the two is no interval of the stream.
    pub(super) fn is_copy(&self, time_secs: f64) -> bool {
        const LEAST_SECS: f64 = 1e-3;
        let interval = time_secs - self.last_secs;
        interval > 0.0 && interval < LEAST_SECS
    }

    /// Counts such a frame.
    pub(super) fn copy(&mut self) {
        self.frames += 1;
        self.taken += 1.0;
        self.repeat();
    }

    /// The frame just taken shows the same as the one before.
    pub(super) fn repeat(&mut self) {
        self.repeated += 1.0;
    }

    pub(super) fn fade(&mut self, factor: f64) {
        self.taken *= factor;
        self.lost *= factor;
        self.repeated *= factor;
    }

    pub(super) fn rhythm(&self) -> Rhythm {
        let spread = |ring: &Ring| {
            ring.quantiles([0.05, 0.95])
                .map(|[least, most]| 0.5 * (most - least))
        };
        let all = self.taken + self.lost;
        let share = |count: f64, of: f64| if of > 0.0 { count / of } else { 0.0 };
        Rhythm {
            secs: if self.first_secs.is_nan() {
                0.0
            } else {
                self.last_secs - self.first_secs
            },
            interval_secs: self.sent.quantiles([0.5]).map(|[median]| median),
            jitter_secs: spread(&self.arrived),
            lost_share: share(self.lost, all),
            repeated_share: share(self.repeated, self.taken),
        }
    }
}
