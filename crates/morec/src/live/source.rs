//! Sources of poses.

use std::sync::Arc;

use super::{Frame, PerformerId, Rig};

/// What a source gives when it is asked for the next frame.
#[derive(Debug, Clone)]
pub enum SourceEvent {
    /// The frame was filled in.
    Frame,
    /// From now on this performer has this skeleton. Comes before its first frame, and again on every change.
    Rig(PerformerId, Arc<Rig>),
    /// This performer has stopped sending, for now: what its last moments hold can be reported.
    Gone(PerformerId),
    /// Nothing came in a while (some ten milliseconds); ask again.
    Quiet,
    /// There will be nothing more.
    Ended,
}

/// Something of a source's performers on its way, a frame as `F`.
#[derive(Debug)]
pub enum SourceItem<F> {
    /// The next pose of a performer.
    Frame(F),
    /// From now on this performer has this skeleton.
    Rig(PerformerId, Arc<Rig>),
    /// This performer has stopped sending, for now.
    Gone(PerformerId),
}

/// Counts of a source since its beginning. Those that do not apply stay 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
pub struct SourceCounts {
    /// Packets or lines that arrived.
    pub packets: u64,
    /// Of these, the ones that could not be understood.
    pub malformed: u64,
    /// Messages of kinds that say nothing about a pose.
    pub ignored: u64,
    /// Frames that showed no motion of a person: the rest pose of a sender that has lost its tracker.
    pub not_motion: u64,
    /// Frames that lacked a part which was there before.
    pub incomplete: u64,
    /// Frames that came too late, behind a newer one.
    pub late: u64,
    /// Packets of senders beyond the number that can be followed at once.
    pub refused: u64,
    /// Number of interruptions after which it came back.
    pub interruptions: u64,
}

/// A source of poses, asked from a thread of its own.
///
/// A source survives whatever its other end does: silence, rubbish, a new skeleton, an end and a new beginning. It
/// reports it in [`SourceEvent`] and in its counts, and goes on.
pub trait Source: Send {
    /// The next thing it has; waits for it a little (at most some ten milliseconds, so that a session can be
    /// stopped). `frame` may hold an older frame's values and is filled in only for [`SourceEvent::Frame`].
    fn next(&mut self, frame: &mut Frame) -> SourceEvent;

    /// Counts since the beginning.
    fn counts(&self) -> SourceCounts {
        SourceCounts::default()
    }
}
