//! The player: clip, position, speed, loop.

use std::sync::Arc;

use crate::body::ClipMotion;

/// A frame that took longer than this was not one: the window was hidden or the machine slept, seconds.
pub const LONGEST_FRAME: f64 = 0.25;

/// Speeds that can be chosen.
pub const SPEEDS: [f64; 9] = [0.05, 0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 6.0, 8.0];

/// The clip that is looked at.
#[derive(Default)]
pub struct Player {
    pub motion: Option<Arc<ClipMotion>>,
    pub at_secs: f64,
    pub playing: bool,
    /// Speed as a multiple of the performance; below 0 backwards.
    pub speed: f64,
    /// The stretch that is repeated.
    pub looped: Option<(f64, f64)>,
}

/// Commands for the player.
#[derive(Debug, Clone, PartialEq)]
pub enum PlayCommand {
    Toggle,
    Pause,
    /// To a moment, seconds.
    Seek(f64),
    /// By this many frames.
    Step(i64),
    Speed(f64),
    /// J and L: backwards, forwards; again is twice as fast.
    Shuttle(f64),
    Loop(Option<(f64, f64)>),
    /// A stretch, from its start, in a loop.
    Stretch(f64, f64),
}

impl Player {
    pub fn new() -> Self {
        Self {
            speed: 1.0,
            ..Self::default()
        }
    }

    pub fn secs(&self) -> f64 {
        self.motion.as_ref().map_or(0.0, |m| m.secs())
    }

    pub fn rate_hz(&self) -> f64 {
        self.motion.as_ref().map_or(60.0, |m| m.clip.rate_hz)
    }

    /// Shows a clip from its beginning.
    pub fn show(&mut self, motion: Arc<ClipMotion>) {
        *self = Self {
            motion: Some(motion),
            speed: self.speed.abs().max(SPEEDS[0]),
            ..Self::default()
        };
    }

    /// Time passes: `dt` seconds on the wall. Gives how much of the clip passed.
    pub fn tick(&mut self, dt: f64) {
        if !self.playing || self.motion.is_none() {
            return;
        }
        let end = self.secs();
        self.at_secs += dt * self.speed;
        match self.looped {
            Some((start, stop)) if stop > start => {
                if self.at_secs >= stop || self.at_secs < start {
                    self.at_secs = match self.speed >= 0.0 {
                        true => start,
                        false => stop - 1.0 / self.rate_hz(),
                    };
                }
            }
            _ => {
                if self.at_secs >= end || self.at_secs < 0.0 {
                    self.at_secs = self.at_secs.clamp(0.0, self.last());
                    self.playing = false;
                }
            }
        }
    }

    /// Time until another frame of the clip is shown, seconds; `None` while nothing plays.
    pub fn next_frame_secs(&self) -> Option<f64> {
        if !self.playing || self.motion.is_none() {
            return None;
        }
        let place = self.at_secs * self.rate_hz();
        // A little over: the next frame is shown once its time has come.
        let left = match self.speed >= 0.0 {
            true => place.floor() + 1.0 - place,
            false => place - place.ceil() + 1.0,
        };
        Some((left + 1e-6) / (self.rate_hz() * self.speed.abs().max(1e-6)))
    }

    /// The time of the last frame.
    fn last(&self) -> f64 {
        (self.secs() - 1.0 / self.rate_hz()).max(0.0)
    }

    pub fn apply(&mut self, command: &PlayCommand) {
        match *command {
            PlayCommand::Toggle => {
                if !self.playing {
                    self.speed = self.speed.abs();
                    // At the end, playing begins anew.
                    if self.at_secs >= self.last() - 1e-6 && self.looped.is_none() {
                        self.at_secs = 0.0;
                    }
                }
                self.playing = !self.playing && self.motion.is_some();
            }
            PlayCommand::Pause => self.playing = false,
            PlayCommand::Seek(secs) => self.seek(secs),
            PlayCommand::Step(frames) => {
                self.playing = false;
                let rate = self.rate_hz();
                let frame = (self.at_secs * rate).round() as i64 + frames;
                self.seek(frame as f64 / rate);
            }
            PlayCommand::Speed(speed) => {
                self.speed = speed.clamp(SPEEDS[0], SPEEDS[SPEEDS.len() - 1]);
            }
            PlayCommand::Shuttle(way) => {
                let faster = self.playing && self.speed.signum() == way.signum();
                let speed = if faster { self.speed.abs() * 2.0 } else { 1.0 };
                self.speed = way.signum() * speed.min(SPEEDS[SPEEDS.len() - 1]);
                self.playing = self.motion.is_some();
            }
            PlayCommand::Loop(stretch) => self.looped = stretch,
            PlayCommand::Stretch(start, stop) => {
                self.looped = Some((start, stop));
                self.at_secs = start;
                self.playing = self.motion.is_some();
            }
        }
    }

    fn seek(&mut self, secs: f64) {
        if secs.is_finite() {
            self.at_secs = secs.clamp(0.0, self.last());
        }
        if self
            .looped
            .is_some_and(|(start, stop)| self.at_secs < start || self.at_secs > stop)
        {
            self.looped = None;
        }
    }
}
