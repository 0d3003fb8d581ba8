//! Times of frames, from their numbers and the times of their arrival.

/// Share of the difference between prediction and arrival that each frame corrects, in time and in period.
const PULL: f64 = 0.1;
const PULL_PERIOD: f64 = 0.01;
/// A difference of more than this is no jitter: somebody paused.
const JUMP_SECS: f64 = 0.25;
/// Periods that can be: 5 to 250 frames a second.
const PERIODS_SECS: std::ops::RangeInclusive<f64> = 0.004..=0.2;
/// More numbers left out than this are a sender begun anew.
const MOST_STEPS: u32 = 1000;

/// Times of one sender's frames, which come numbered but not stamped: a loop that follows arrivals and smooths what
/// the network, and the reading of several frames at once, do to them.
#[derive(Debug, Clone)]
pub struct FrameClock {
    period_secs: f64,
    /// Number and time of the last frame.
    last: Option<(u32, f64)>,
}

impl Default for FrameClock {
    fn default() -> Self {
        Self {
            period_secs: 1.0 / 60.0,
            last: None,
        }
    }
}

impl FrameClock {
    /// The time of frame `number`, which arrived at `arrival_secs`: always later than that of the frame before it.
    pub fn stamp(&mut self, number: u32, arrival_secs: f64) -> f64 {
        let time_secs = match self.last {
            None => arrival_secs,
            Some((before, last_secs)) => {
                let steps = number.wrapping_sub(before);
                let steps = if (1..=MOST_STEPS).contains(&steps) {
                    f64::from(steps)
                } else {
                    1.0
                };
                self.next(steps, last_secs, arrival_secs)
            }
        };
        self.last = Some((number, time_secs));
        time_secs
    }

    fn next(&mut self, steps: f64, last_secs: f64, arrival_secs: f64) -> f64 {
        let predicted = last_secs + steps * self.period_secs;
        let late_secs = arrival_secs - predicted;
        if late_secs.abs() > JUMP_SECS {
            return arrival_secs.max(last_secs + 1e-4);
        }
        let period_secs = self.period_secs + PULL_PERIOD * late_secs / steps;
        self.period_secs = period_secs.clamp(*PERIODS_SECS.start(), *PERIODS_SECS.end());
        (predicted + PULL * late_secs).max(last_secs + 1e-4)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The largest difference of the step from one frame to the next from its period, after a second.
    fn unevenness(rate_hz: f64, arrival: impl Fn(u32) -> f64) -> f64 {
        let mut clock = FrameClock::default();
        let times: Vec<f64> = (0..600).map(|n| clock.stamp(n, arrival(n))).collect();
        let steps = times
            .windows(2)
            .skip(2 * rate_hz as usize)
            .map(|w| w[1] - w[0] - 1.0 / rate_hz);
        steps.map(f64::abs).fold(0.0, f64::max)
    }

    #[test]
    fn frames_are_even_though_they_arrive_several_at_once_or_unevenly() {
        for rate_hz in [60.0, 96.0, 120.0] {
            let due = |n: u32| f64::from(n) / rate_hz;
            assert!(unevenness(rate_hz, due) < 1e-3);
            assert!(unevenness(rate_hz, |n| due(n / 3 * 3 + 2)) < 0.004);
            assert!(unevenness(rate_hz, |n| due(n) + f64::from(n * 7919 % 11) * 1e-3) < 0.004);
        }
    }

    #[test]
    fn time_goes_forward_whatever_comes_and_follows_pauses_and_new_beginnings() {
        let mut clock = FrameClock::default();
        let mut last = f64::NEG_INFINITY;
        let arrivals = [
            (5, 0.0),
            (6, 0.0),
            (7, 0.0),
            (100, 3.0),
            (1, 3.1),
            (2, 3.1),
            (0, 2.0),
            (u32::MAX, 9.0),
        ];
        for (number, arrival_secs) in arrivals {
            let time_secs = clock.stamp(number, arrival_secs);
            assert!(
                time_secs > last,
                "{number} at {arrival_secs}: {time_secs} after {last}"
            );
            last = time_secs;
        }
        assert!((last - 9.0).abs() < 0.1, "{last}");
    }
}
