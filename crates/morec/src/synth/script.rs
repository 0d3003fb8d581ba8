//! Scripted clips: named motions at given times, with the labels a recogniser should find.

use super::SyntheticTake;
use super::actor::Actor;
use super::film::film;
use super::motion::{MotionKind, SyntheticMotion, all};
use super::person::Person;
use crate::labels::Mark;
use crate::rng::Rng;

/// A line of a script that cannot be performed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("line {line} of the script: expected one of {expected}, found \"{found}\"")]
pub struct UnknownMotion {
    /// Line of the script, from 1.
    pub line: usize,
    /// The names there are.
    pub expected: String,
    /// The word that names no motion.
    pub found: String,
}

/// Builds a clip from a sequence of motions and rests.
///
/// ```
/// use morec::synth::{Person, Script};
/// let take = Script::new(1, Person::draw(1, 0)).rest(1.0).play("wave").rest(1.0).film("two", 60.0)?;
/// assert_eq!(take.labels[0].class, "wave");
/// # Ok::<(), morec::synth::UnknownMotion>(())
/// ```
#[derive(Debug, Clone)]
pub struct Script {
    seed: u64,
    person: Person,
    lines: Vec<Line>,
}

#[derive(Debug, Clone)]
enum Line {
    Rest(f64),
    RestUntil(f64),
    Play(String, f64),
}

impl Script {
    /// An empty script for `person`; `seed` decides how the motions vary.
    pub fn new(seed: u64, person: Person) -> Self {
        Self {
            seed,
            person,
            lines: Vec::new(),
        }
    }

    /// Stands for `secs`.
    pub fn rest(self, secs: f64) -> Self {
        self.line(Line::Rest(secs))
    }

    /// Stands until `secs` from the start, or not at all if that is past.
    pub fn rest_until(self, secs: f64) -> Self {
        self.line(Line::RestUntil(secs))
    }

    /// Performs the motion `name` of any [`MotionKind`].
    pub fn play(self, name: &str) -> Self {
        self.play_at_speed(name, 1.0)
    }

    /// Performs the motion `name`, `speed` times as fast as this person usually does.
    pub fn play_at_speed(self, name: &str, speed: f64) -> Self {
        self.line(Line::Play(name.to_owned(), speed))
    }

    fn line(mut self, line: Line) -> Self {
        self.lines.push(line);
        self
    }

    /// Films the script. Every motion is labelled, of whatever kind; see [`SyntheticTake::keep`].
    ///
    /// # Errors
    /// The first motion whose name is not known, with its line.
    pub fn film(&self, name: &str, rate_hz: f64) -> Result<SyntheticTake, UnknownMotion> {
        let mut person = self.person.clone();
        let mut labels = Vec::new();
        let mut actor = Actor::new(&person, Rng::for_part(self.seed, 0x5c));
        for (at, line) in self.lines.iter().enumerate() {
            match line {
                Line::Rest(secs) => actor.wait(secs.max(0.0)),
                Line::RestUntil(secs) => actor.wait((secs - actor.now_secs).max(0.0)),
                Line::Play(motion, speed) => {
                    let motion =
                        SyntheticMotion::named(motion).ok_or_else(|| unknown(at, motion))?;
                    let usual = actor.person.tempo;
                    actor.person.tempo = usual * speed.clamp(0.2, 5.0);
                    let span = motion.perform(&mut actor);
                    actor.person.tempo = usual;
                    labels.push(Mark::new(motion.name(), span));
                }
            }
        }
        let person = std::mem::take(&mut person.name);
        Ok(SyntheticTake {
            clip: film(actor, name, rate_hz),
            labels,
            person,
        })
    }
}

fn unknown(at: usize, found: &str) -> UnknownMotion {
    let expected: Vec<&str> = all().map(|m| m.name()).collect();
    UnknownMotion {
        line: at + 1,
        expected: expected.join(", "),
        found: found.to_owned(),
    }
}

impl SyntheticTake {
    /// The take with only the labels of `kind`: what a recogniser trained on those classes should find.
    pub fn keep(mut self, kind: MotionKind) -> SyntheticTake {
        self.labels
            .retain(|l| SyntheticMotion::named(l.class).is_some_and(|m| m.kind() == kind));
        self
    }
}
