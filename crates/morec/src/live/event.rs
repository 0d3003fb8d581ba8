//! Events that a live session emits.

use crate::TimeSpan;
use crate::classes::ClassId;
use crate::decode::Repetitions;
use crate::templates::Deviation;

use super::{Detection, PerformerId};

/// Phase of a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Phase {
    /// A motion seems to be under way. Tentative.
    Start,
    /// Its progress, or what it seems to be, has changed. Tentative.
    Update,
    /// One more repetition of an activity is over, from the event's start to its stop; its number is the count of `repetitions`. What ends
    /// has had as many as it counts. Only if [asked for](EventOptions::each_repetition).
    Repetition,
    /// How far one class has come, of every class with each frame that completes a row. Its motion is 0. Only if
    /// [asked for](EventOptions::progress).
    Progress,
    /// It came to nothing. Ends what a start began.
    Cancel,
    /// It has happened. Final: nothing that ended is taken back, and every motion ends once.
    End,
}

impl Phase {
    /// Its name on the wire.
    pub fn name(self) -> &'static str {
        match self {
            Phase::Start => "start",
            Phase::Update => "update",
            Phase::Repetition => "repetition",
            Phase::Progress => "progress",
            Phase::Cancel => "cancel",
            Phase::End => "end",
        }
    }
}

/// Something said of a motion. Times are on the source's clock, if not said otherwise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// Phase of the motion.
    pub phase: Phase,
    /// Number of the motion, from 1, for each performer: its start, updates and end share it. 0 of the phase progress.
    pub motion: u64,
    /// Number of the event in its session or stream, from 1, without gaps as long as nothing is lost on the way.
    pub sequence: u64,
    /// Whose motion.
    pub actor: PerformerId,
    /// Class of the motion, tentative before its end.
    pub class: ClassId,
    /// Probability that the detection is right, 0 to 1. The lowest accepted score is 0.05 to 0.44, depending on the index. For
    /// held poses and indexes without calibration (svrdm, older files) it is the similarity to a sample instead. Of a tentative
    /// event: how near what was seen so far is to the beginning of a sample, 0 to 1.
    pub score: f64,
    /// Share of the motion that has been seen, 0 to 1; 1 at its end.
    pub progress: f64,
    /// From its beginning to its end, or to when it was last seen, if it has not ended.
    pub span: TimeSpan,
    /// The source's clock at the frame that settled it.
    pub reported_secs: f64,
    /// Wall clock at the arrival of that frame: seconds since 1970, UTC.
    pub wall_secs: f64,
    /// Of an activity that repeats, so far.
    pub repetitions: Option<Repetitions>,
    /// Its duration over that of the nearest sample, with `deviation`; of the phase progress, so far.
    pub pace: Option<f64>,
    /// How far it was from the nearest sample, of what ends and of repetitions; only if [asked for](EventOptions::deviation), and not of held
    /// poses, activities as a whole, and the method of 2009.
    pub deviation: Option<Deviation>,
}

impl Event {
    /// The detection that ended, as [`Recognizer`](super::Recognizer) reports it.
    pub fn detection(&self) -> Detection {
        Detection {
            class: self.class,
            span: self.span,
            score: self.score,
            reported_secs: self.reported_secs,
            repetitions: self.repetitions,
        }
    }

    /// The wall clock at a time of the source's clock, seen from this event.
    pub fn wall_at_secs(&self, time_secs: f64) -> f64 {
        self.wall_secs - (self.reported_secs - time_secs)
    }
}

/// Selection and rate of events: those of [`StreamOptions`](super::StreamOptions), with its defaults.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct EventOptions {
    /// Report what seems to be under way, too.
    pub tentative: bool,
    /// Make each repetition of an activity an event of its own ([`Phase::Repetition`]).
    pub each_repetition: bool,
    /// Compare each gesture that ends, and each repetition that is an event, with the nearest sample of its class ([`Event::deviation`]).
    pub deviation: bool,
    /// Report how far every class has come with each frame ([`Phase::Progress`]).
    pub progress: bool,
    /// A motion of the same class that ends less than this after the one before it is not reported (but counted), seconds.
    /// At 0 the decoder's own rule holds: motions of one performer follow each other and never share more than two
    /// ticks, so one performance is one event.
    pub refractory_secs: f64,
}
