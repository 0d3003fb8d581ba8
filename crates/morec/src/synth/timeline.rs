//! Schedule of a body's movements: a set of channels, each a sum of smooth movements.
//!
//! A movement adds a minimum-jerk course from the channel's last goal to the next. Movements may overlap: human
//! reaches superpose in the same way (Flash and Henis, J. Cogn. Neurosci. 3, 1991), and a sum of smooth courses
//! is smooth, whatever starts when.

use super::smooth::{min_jerk, sin_cos};

/// One limb of a pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LimbSide {
    /// The left one, at +X when facing +Z.
    Left,
    /// At −X when facing +Z.
    Right,
}

impl LimbSide {
    /// Both, left first.
    pub const BOTH: [LimbSide; 2] = [LimbSide::Left, LimbSide::Right];

    /// 0 for left, 1 for right.
    pub fn index(self) -> usize {
        self as usize
    }

    /// `Left` or `Right`, as names of joints begin.
    pub fn name(self) -> &'static str {
        match self {
            LimbSide::Left => "Left",
            LimbSide::Right => "Right",
        }
    }

    /// The limb on the opposite side.
    pub fn other(self) -> LimbSide {
        match self {
            LimbSide::Left => LimbSide::Right,
            LimbSide::Right => LimbSide::Left,
        }
    }

    /// +1 for left, -1 for right: the direction of "outward" along X.
    pub fn sign(self) -> f64 {
        match self {
            LimbSide::Left => 1.0,
            LimbSide::Right => -1.0,
        }
    }
}

/// Hips in the world: x and z in metres; y from standing height, in leg lengths.
pub const HIPS: usize = 0;
/// Hips' pitch (forward positive), yaw (to the left positive), roll, in radians.
pub const HIPS_TURN: usize = 3;
/// Pitch, yaw, roll of the chest over the hips, in radians.
pub const SPINE: usize = 6;
/// Pitch, yaw, roll of the head over the chest, in radians.
pub const HEAD: usize = 9;
/// For each side: the wrist from the shoulder in the chest's frame, x outward, y up, z forward, in arm lengths.
pub const HAND: [usize; 2] = [12, 15];
/// For each side: bending and twisting of the wrist, in radians.
pub const WRIST: [usize; 2] = [18, 20];
/// For each side: how far the elbow is turned outward about the line from shoulder to wrist, in radians.
pub const SWIVEL: [usize; 2] = [22, 23];
/// For each side: foot on the ground in the world, x, height, z in metres; yaw, pitch (toes down positive).
pub const FOOT: [usize; 2] = [24, 29];
/// Number of channels.
pub const CHANNELS: usize = 34;

/// The values of all channels at one moment.
pub type Controls = [f64; CHANNELS];

#[derive(Debug, Clone)]
struct Move {
    start_secs: f64,
    secs: f64,
    delta: f64,
}

#[derive(Debug, Clone)]
struct Wave {
    start_secs: f64,
    secs: f64,
    hz: f64,
    phase_rad: f64,
    size: f64,
    fade_secs: f64,
}

#[derive(Debug, Clone, Default)]
struct Track {
    first: f64,
    goal: f64,
    moves: Vec<Move>,
    waves: Vec<Wave>,
}

/// All channels over time.
#[derive(Debug, Clone)]
pub struct PoseTimeline {
    tracks: Vec<Track>,
}

impl PoseTimeline {
    /// Every channel holds its value in `first` until it is moved.
    pub fn new(first: &Controls) -> Self {
        let tracks = first
            .iter()
            .map(|&v| Track {
                first: v,
                goal: v,
                ..Track::default()
            })
            .collect();
        Self { tracks }
    }

    /// Final value of `channel`, when all its movements so far have ended.
    pub fn goal(&self, channel: usize) -> f64 {
        self.tracks[channel].goal
    }

    /// Moves `channel` from its goal so far to `target`.
    pub fn to(&mut self, channel: usize, start_secs: f64, secs: f64, target: f64) {
        let track = &mut self.tracks[channel];
        let delta = target - track.goal;
        track.goal = target;
        track.moves.push(Move {
            start_secs,
            secs: secs.max(1e-3),
            delta,
        });
    }

    /// Moves `channel` by `height` and back, the peak in the middle.
    pub fn pulse(&mut self, channel: usize, start_secs: f64, secs: f64, height: f64) {
        let half = (secs / 2.0).max(1e-3);
        let moves = &mut self.tracks[channel].moves;
        moves.push(Move {
            start_secs,
            secs: half,
            delta: height,
        });
        moves.push(Move {
            start_secs: start_secs + half,
            secs: half,
            delta: -height,
        });
    }

    /// Adds `size * sin(2 pi hz t + phase)`, faded in and out.
    pub fn wave(
        &mut self,
        channel: usize,
        start_secs: f64,
        secs: f64,
        (hz, phase_rad): (f64, f64),
        size: f64,
    ) {
        let fade_secs = (secs / 3.0).min(0.25);
        self.tracks[channel].waves.push(Wave {
            start_secs,
            secs,
            hz,
            phase_rad,
            size,
            fade_secs,
        });
    }

    /// The channels at `frames` moments, `rate_hz` a second. O(frames x channels + lengths of all movements).
    pub fn render(&self, frames: usize, rate_hz: f64) -> Vec<Controls> {
        let mut rows = vec![[0.0; CHANNELS]; frames];
        for (channel, track) in self.tracks.iter().enumerate() {
            for (row, value) in rows.iter_mut().zip(track.render(frames, rate_hz)) {
                row[channel] = value;
            }
        }
        rows
    }
}

impl Track {
    fn render(&self, frames: usize, rate_hz: f64) -> Vec<f64> {
        let mut values = vec![0.0; frames];
        // What ended movements have added, noted at the frame from which it counts.
        let mut settled = vec![0.0; frames + 1];
        for m in &self.moves {
            let stop = frame_from(m.start_secs + m.secs, rate_hz, frames);
            for f in frame_from(m.start_secs, rate_hz, frames)..stop {
                values[f] += m.delta * min_jerk((f as f64 / rate_hz - m.start_secs) / m.secs);
            }
            settled[stop] += m.delta;
        }
        for w in &self.waves {
            let stop = frame_from(w.start_secs + w.secs, rate_hz, frames);
            for f in frame_from(w.start_secs, rate_hz, frames)..stop {
                values[f] += w.at(f as f64 / rate_hz - w.start_secs);
            }
        }
        let mut base = self.first;
        for (value, step) in values.iter_mut().zip(&settled) {
            base += step;
            *value += base;
        }
        values
    }
}

impl Wave {
    fn at(&self, t: f64) -> f64 {
        let envelope = min_jerk(t / self.fade_secs) * min_jerk((self.secs - t) / self.fade_secs);
        self.size * envelope * sin_cos(std::f64::consts::TAU * self.hz * t + self.phase_rad).0
    }
}

/// First frame at or after `secs`, at most `frames`.
fn frame_from(secs: f64, rate_hz: f64, frames: usize) -> usize {
    ((secs.max(0.0) * rate_hz).ceil() as usize).min(frames)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn overlapping_movements_end_at_the_last_goal() {
        let mut timeline = PoseTimeline::new(&[1.0; CHANNELS]);
        timeline.to(0, 0.1, 1.0, 4.0);
        timeline.to(0, 0.6, 1.0, -2.0);
        timeline.pulse(0, 0.2, 0.7, 5.0);
        timeline.wave(0, 0.3, 1.0, (2.0, 0.0), 1.0);
        let rows = timeline.render(200, 100.0);
        assert_eq!(rows[0][0], 1.0);
        assert!((rows[199][0] + 2.0).abs() < 1e-12);
        assert_eq!(rows[199][1], 1.0);
    }

    #[test]
    fn velocity_has_no_steps() {
        let mut timeline = PoseTimeline::new(&[0.0; CHANNELS]);
        timeline.to(0, 0.103, 0.5, 1.0);
        timeline.to(0, 0.351, 0.4, 0.0);
        timeline.wave(0, 0.2, 0.6, (3.0, 0.0), 0.1);
        let rate_hz = 2000.0;
        let x: Vec<f64> = timeline
            .render(3000, rate_hz)
            .iter()
            .map(|row| row[0])
            .collect();
        let worst = x
            .windows(3)
            .map(|w| (w[2] - 2.0 * w[1] + w[0]).abs() * rate_hz * rate_hz)
            .fold(0.0, f64::max);
        // The sum of the three courses' largest accelerations; a step of velocity would show as thousands.
        assert!(worst < 120.0, "acceleration {worst}");
    }
}
