//! Status of a session, readable at any time without delaying recognition.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use std::sync::{Arc, Mutex, PoisonError, TryLockError};

use crate::classes::ClassId;
use crate::diagnosis::Diagnosis;

use super::waits::{LatencyHistogram, WaitCells};
use super::{Event, Frame, PerformerId, Phase, SourceCounts};

/// Performers that one session can follow at once.
pub const MAX_PERFORMERS: usize = 16;

/// Status of a session. Each figure is right at some instant of the reading; figures of different lines may be a
/// frame apart.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Status {
    /// Frames that went through recognition.
    pub frames: u64,
    /// Frames dropped because recognition had not caught up ([`OverflowPolicy::Drop`](super::OverflowPolicy)).
    pub dropped_frames: u64,
    /// Frames of no known skeleton, or of one that shows none of the index's bones.
    pub unusable_frames: u64,
    /// Events said, tentative ones included.
    pub events: u64,
    /// Events that a reader had no room for.
    pub dropped_events: u64,
    /// Motions that ended.
    pub motions: u64,
    /// Motions not reported because of the refractory time.
    pub suppressed: u64,
    /// What the source counts: lost, late and unreadable packets.
    pub source: SourceCounts,
    /// The longest that a frame has waited from its arrival to the end of its recognition, seconds.
    pub longest_wait_secs: f64,
    /// Waiting times of frames likewise.
    pub waits: LatencyHistogram,
    /// True if the stream has ended and everything is reported.
    pub ended: bool,
    /// The performers seen so far.
    pub actors: Vec<PerformerStatus>,
}

/// Status of one performer: the solution at this moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PerformerStatus {
    /// The performer that it is about.
    pub actor: PerformerId,
    /// Frames of this performer.
    pub frames: u64,
    /// The source's clock at the last of them.
    pub time_secs: f64,
    /// When that arrived ([`wall_now_secs`](super::wall_now_secs)).
    pub wall_secs: f64,
    /// From its arrival to the end of its recognition, seconds.
    pub wait_secs: f64,
    /// The motion that seems to be under way, and its progress, 0 to 1.
    pub early: Option<(ClassId, f64)>,
    /// The last motion that ended, and its score.
    pub last: Option<(ClassId, f64)>,
    /// True while a wider gate for performers unlike the teacher is open ([`Recognizer::admits_strangers`](super::Recognizer::admits_strangers)).
    pub admits_strangers: bool,
    /// Findings about the stream, renewed every 16 frames.
    pub diagnosis: Option<Diagnosis>,
}

/// A handle on a session's status; copies are cheap and may outlive the session.
#[derive(Debug, Clone)]
pub struct StatusHandle {
    pub(super) cells: Arc<SessionCounters>,
}

impl StatusHandle {
    /// The status now. Never waits and holds nothing up.
    pub fn get(&self) -> Status {
        self.cells.read()
    }
}

/// Counters that the threads of a session write; single words.
#[derive(Debug, Default)]
pub(super) struct SessionCounters {
    pub(super) frames: AtomicU64,
    pub(super) dropped_frames: Arc<AtomicU64>,
    pub(super) unusable: AtomicU64,
    pub(super) events: AtomicU64,
    pub(super) dropped_events: AtomicU64,
    pub(super) dropped_detections: AtomicU64,
    pub(super) motions: AtomicU64,
    pub(super) suppressed: AtomicU64,
    pub(super) source: [AtomicU64; 8],
    pub(super) longest_wait: AtomicU64,
    waits: WaitCells,
    pub(super) ended: AtomicBool,
    actors: [PerformerCounters; MAX_PERFORMERS],
}

#[derive(Debug, Default)]
struct PerformerCounters {
    frames: AtomicU64,
    time: AtomicU64,
    wall: AtomicU64,
    wait: AtomicU64,
    early: AtomicU64,
    last: AtomicU64,
    admits_strangers: AtomicBool,
    /// Written with `try_lock` only: recognition never waits for a reader.
    diagnosis: Mutex<Option<Diagnosis>>,
}

/// A class and a share of 1 in one word, so that they cannot come apart; 0 is nothing.
fn pack(class: ClassId, share: f64) -> u64 {
    1 << 63 | u64::from(class.0) << 32 | (share.clamp(0.0, 1.0) * f64::from(u32::MAX)) as u64
}

fn unpack(word: u64) -> Option<(ClassId, f64)> {
    let share = f64::from(word as u32) / f64::from(u32::MAX);
    (word >> 63 == 1).then_some((ClassId((word >> 32) as u16), share))
}

impl SessionCounters {
    /// A frame has been through recognition at `now_secs`.
    pub(super) fn frame(&self, frame: &Frame, now_secs: f64) {
        self.frame_of(frame.actor, frame.time_secs, frame.wall_secs, now_secs);
    }

    /// A frame of `actor`, of `time_secs` on the source's clock, which arrived at `wall_secs`, is through.
    pub(super) fn frame_of(
        &self,
        actor: PerformerId,
        time_secs: f64,
        wall_secs: f64,
        now_secs: f64,
    ) {
        self.frames.fetch_add(1, Relaxed);
        let wait_secs = (now_secs - wall_secs).max(0.0);
        // What is not negative is in the order of its bits.
        self.longest_wait.fetch_max(wait_secs.to_bits(), Relaxed);
        self.waits.add(wait_secs);
        let Some(cells) = self.actors.get(actor.index()) else {
            return;
        };
        cells.frames.fetch_add(1, Relaxed);
        cells.time.store(time_secs.to_bits(), Relaxed);
        cells.wall.store(wall_secs.to_bits(), Relaxed);
        cells.wait.store(wait_secs.to_bits(), Relaxed);
    }

    /// Findings about the stream of `actor`; left out while somebody reads what was known before.
    pub(super) fn diagnosis(&self, actor: PerformerId, diagnosis: Option<Diagnosis>) {
        let Some(cells) = self.actors.get(actor.index()) else {
            return;
        };
        match cells.diagnosis.try_lock() {
            Ok(mut kept) => *kept = diagnosis,
            Err(TryLockError::Poisoned(kept)) => *kept.into_inner() = diagnosis,
            Err(TryLockError::WouldBlock) => {}
        }
    }

    /// Whether the wider gate is open for `actor`.
    pub(super) fn admits_strangers(&self, actor: PerformerId, is_open: bool) {
        if let Some(cells) = self.actors.get(actor.index()) {
            cells.admits_strangers.store(is_open, Relaxed);
        }
    }

    /// An event was said.
    pub(super) fn event(&self, event: &Event) {
        self.events.fetch_add(1, Relaxed);
        if event.phase == Phase::End {
            self.motions.fetch_add(1, Relaxed);
        }
        let Some(cells) = self.actors.get(event.actor.index()) else {
            return;
        };
        match event.phase {
            Phase::Start | Phase::Update => cells
                .early
                .store(pack(event.class, event.progress), Relaxed),
            Phase::Repetition | Phase::Progress => {}
            Phase::Cancel => cells.early.store(0, Relaxed),
            Phase::End => {
                cells.early.store(0, Relaxed);
                cells.last.store(pack(event.class, event.score), Relaxed);
            }
        }
    }

    pub(super) fn source(&self, c: &SourceCounts) {
        let counts = [
            c.packets,
            c.malformed,
            c.ignored,
            c.not_motion,
            c.incomplete,
            c.late,
            c.refused,
            c.interruptions,
        ];
        for (cell, count) in self.source.iter().zip(counts) {
            cell.store(count, Relaxed);
        }
    }

    fn read(&self) -> Status {
        // As `source` puts them.
        let count = |at: usize| self.source[at].load(Relaxed);
        let source = SourceCounts {
            packets: count(0),
            malformed: count(1),
            ignored: count(2),
            not_motion: count(3),
            incomplete: count(4),
            late: count(5),
            refused: count(6),
            interruptions: count(7),
        };
        let bits = |cell: &AtomicU64| f64::from_bits(cell.load(Relaxed));
        let actor = |(i, cells): (usize, &PerformerCounters)| PerformerStatus {
            actor: PerformerId(i as u16),
            frames: cells.frames.load(Relaxed),
            time_secs: bits(&cells.time),
            wall_secs: bits(&cells.wall),
            wait_secs: bits(&cells.wait),
            early: unpack(cells.early.load(Relaxed)),
            last: unpack(cells.last.load(Relaxed)),
            admits_strangers: cells.admits_strangers.load(Relaxed),
            diagnosis: *cells
                .diagnosis
                .lock()
                .unwrap_or_else(PoisonError::into_inner),
        };
        Status {
            frames: self.frames.load(Relaxed),
            dropped_frames: self.dropped_frames.load(Relaxed),
            unusable_frames: self.unusable.load(Relaxed),
            events: self.events.load(Relaxed),
            dropped_events: self.dropped_events.load(Relaxed)
                + self.dropped_detections.load(Relaxed),
            motions: self.motions.load(Relaxed),
            suppressed: self.suppressed.load(Relaxed),
            source,
            longest_wait_secs: bits(&self.longest_wait),
            waits: self.waits.read(),
            ended: self.ended.load(std::sync::atomic::Ordering::Acquire),
            actors: self
                .actors
                .iter()
                .enumerate()
                .map(actor)
                .filter(|a| a.frames > 0)
                .collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_class_and_its_share_fit_one_word() {
        assert_eq!(unpack(0), None);
        for (class, share) in [(0, 0.0), (7, 0.25), (u16::MAX, 1.0)] {
            let (found, of) = unpack(pack(ClassId(class), share)).unwrap();
            assert_eq!(found, ClassId(class));
            assert!((of - share).abs() < 1e-9);
        }
    }
}
