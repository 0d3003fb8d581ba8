//! Times of frames, from the sender's time stamps and the times of their arrival.

/// Share of the difference between the sender's clock and the arrival that each frame corrects: networks
/// delay packets unevenly, clocks only drift.
const PULL: f64 = 0.02;
/// A difference of more than this is no jitter: somebody paused, or a clock was set.
const JUMP_SECS: f64 = 0.25;
/// After this many jumps the sender's clock is no longer believed.
const PATIENCE: u32 = 5;

/// Times of one sender's frames, on the receiver's clock but with the sender's evenness.
#[derive(Debug, Clone, Default)]
pub struct SenderClock {
    last_secs: Option<f64>,
    last_arrival_secs: f64,
    /// The sender's time of a frame, and the time it was given.
    anchor: Option<(f64, f64)>,
    jumps: u32,
}

impl SenderClock {
    /// The time of a frame that arrived at `arrival_secs`, stamped `sent_secs` by its sender if it was stamped. Always
    /// later than that of the frame before it.
    pub fn stamp(&mut self, sent_secs: Option<f64>, arrival_secs: f64) -> f64 {
        let time_secs = match self.last_secs {
            None => arrival_secs,
            Some(last_secs) => self.next(last_secs, sent_secs, arrival_secs),
        };
        self.last_secs = Some(time_secs);
        self.last_arrival_secs = arrival_secs;
        self.anchor = sent_secs.map(|sent| (sent, time_secs)).or(self.anchor);
        time_secs
    }

    fn next(&mut self, last_secs: f64, sent_secs: Option<f64>, arrival_secs: f64) -> f64 {
        let believed = sent_secs.filter(|_| self.jumps < PATIENCE);
        let by_sender = believed
            .zip(self.anchor)
            .map(|(sent, (anchor, at))| at + (sent - anchor));
        let by_arrival = last_secs + (arrival_secs - self.last_arrival_secs);
        let predicted = by_sender.filter(|t| *t > last_secs).unwrap_or(by_arrival);
        let late_secs = arrival_secs - predicted;
        let time_secs = if late_secs.abs() > JUMP_SECS {
            self.jumps += u32::from(by_sender.is_some());
            self.anchor = None;
            arrival_secs
        } else {
            predicted + PULL * late_secs
        };
        // Two frames at one time would be one to everybody after this.
        time_secs.max(last_secs + 1e-4)
    }

    /// The sender's last stamp.
    pub fn sent_secs(&self) -> Option<f64> {
        self.anchor.map(|(sent, _)| sent)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Times given to frames at 60 Hz whose packets take `delay(i)` seconds.
    fn times(delay: impl Fn(usize) -> f64, sent: impl Fn(f64) -> Option<f64>) -> Vec<f64> {
        let mut clock = SenderClock::default();
        (0..600)
            .map(|i| i as f64 / 60.0)
            .enumerate()
            .map(|(i, t)| clock.stamp(sent(t), t + delay(i)))
            .collect()
    }

    fn jitter_secs(times: &[f64]) -> f64 {
        times
            .windows(2)
            .skip(100)
            .map(|w| (w[1] - w[0] - 1.0 / 60.0).abs())
            .fold(0.0, f64::max)
    }

    #[test]
    fn a_sender_s_clock_takes_the_jitter_out_of_arrivals() {
        let delay = |i: usize| if i.is_multiple_of(3) { 0.012 } else { 0.001 };
        assert!(jitter_secs(&times(delay, |_| None)) > 0.01);
        assert!(jitter_secs(&times(delay, |t| Some(t + 77.0))) < 0.0005);
    }

    #[test]
    fn clocks_that_stand_run_wrong_or_backwards_do_no_harm() {
        let clocks: [fn(f64) -> Option<f64>; 4] = [
            |_| Some(5.0),
            |t| Some(t * 1000.0),
            |t| Some(-t),
            |t| Some(t * 0.5),
        ];
        for sent in clocks {
            let times = times(|_| 0.001, sent);
            assert!(times.windows(2).all(|w| w[1] > w[0]));
            assert!((times[599] - 599.0 / 60.0).abs() < 0.1, "{}", times[599]);
        }
    }

    #[test]
    fn a_pause_of_the_sender_is_a_pause() {
        let mut clock = SenderClock::default();
        clock.stamp(Some(10.0), 1.0);
        clock.stamp(Some(10.1), 1.1);
        assert!((clock.stamp(Some(0.0), 5.0) - 5.0).abs() < 1e-9);
    }
}
