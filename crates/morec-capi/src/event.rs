//! Events in their C form.

use std::ffi::c_char;

use morec::features::ALL_BONES;
use morec::live::{Event, Phase};

use crate::memory;
use crate::status::{CallError, MorecStatus, guard};

/// Phase of a motion.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MorecPhase {
    /// A motion has probably started. Tentative; only with `MOREC_TENTATIVE`.
    Start = 0,
    /// The progress or the probable class has changed. Tentative.
    Update = 1,
    /// The motion that a start event announced was not confirmed.
    Cancel = 2,
    /// The motion has ended. Final: an end is never revoked, and every motion ends once.
    End = 3,
    /// A repetition of an activity is complete, from the event's start to its stop; `repetitions` is its number. Only with
    /// `MOREC_EACH_REPETITION`. (Not in the first version.)
    Repetition = 4,
    /// How far one class has come, of every class with each frame that completes a row: `progress` is how far and `score` how like to a sample,
    /// both 0 to 1, and `motion` is 0. Only with `MOREC_PROGRESS`. (Not in the first version.)
    Progress = 5,
}

/// An event of a motion. Times are seconds on the clock of the frames unless stated otherwise.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MorecEvent {
    /// A `MorecPhase`.
    pub phase: i32,
    /// Class in the index, from 0; tentative before the end.
    pub class_id: u32,
    /// Number of the motion, from 1: its start, updates and end share it.
    pub motion: u64,
    /// Number of the event, from 1. A gap means a lost event, which is counted in `MorecStats.lost_events`.
    pub sequence: u64,
    /// Probability that the detection is right, 0 to 1. The lowest accepted score is 0.05 to 0.44, depending on the index. For
    /// held poses and indexes without calibration (svrdm, older files) it is the similarity to a sample instead. Of a tentative
    /// event: how near what was seen so far is to the beginning of a sample, 0 to 1.
    pub score: f64,
    /// Share of the motion seen so far, 0 to 1; 1 at its end.
    pub progress: f64,
    /// Start, seconds of the stream.
    pub start_secs: f64,
    /// Stop, seconds of the stream; for a motion that has not ended, the time of its latest frame.
    pub stop_secs: f64,
    /// Time of the frame that caused the event, seconds of the stream.
    pub reported_secs: f64,
    /// Wall clock when this frame was pushed, seconds since 1970, UTC.
    pub wall_secs: f64,
    /// Repetitions of an activity so far; 0 if nothing is counted.
    pub repetitions: u32,
    /// Duration of one, as it was last.
    pub period_secs: f64,
    /// With `MOREC_DEVIATION`: mean angle between its bones and those of the nearest sample, degrees; -1 where nothing is compared. (Not in
    /// the first version.)
    pub off_degrees: f64,
    /// Its duration over the sample's, so far; 0 where nothing is compared.
    pub pace: f64,
    /// Number of the bone that is farthest off: see `morec_bone_name`.
    pub worst_bone: u32,
    /// The largest angle of that bone, degrees.
    pub worst_degrees: f64,
}

impl MorecEvent {
    /// Size of the first release's.
    pub(crate) const FIRST_SIZE: usize = std::mem::offset_of!(Self, repetitions);
}

impl From<&Event> for MorecEvent {
    fn from(event: &Event) -> Self {
        let phase = match event.phase {
            Phase::Start => MorecPhase::Start,
            Phase::Update => MorecPhase::Update,
            Phase::Cancel => MorecPhase::Cancel,
            Phase::End => MorecPhase::End,
            Phase::Repetition => MorecPhase::Repetition,
            Phase::Progress => MorecPhase::Progress,
        };
        Self {
            phase: phase as i32,
            class_id: u32::from(event.class.0),
            motion: event.motion,
            sequence: event.sequence,
            score: event.score,
            progress: event.progress,
            start_secs: event.span.start_secs,
            stop_secs: event.span.stop_secs,
            reported_secs: event.reported_secs,
            wall_secs: event.wall_secs,
            repetitions: event.repetitions.map_or(0, |r| r.count),
            period_secs: event.repetitions.map_or(0.0, |r| r.period_secs),
            off_degrees: event.deviation.map_or(-1.0, |d| d.off_degrees),
            pace: event.pace.unwrap_or(0.0),
            worst_bone: event.deviation.map_or(0, |d| number_of(d.worst_bone)),
            worst_degrees: event.deviation.map_or(0.0, |d| d.worst_degrees),
        }
    }
}

fn number_of(bone: &str) -> u32 {
    let at = ALL_BONES.iter().position(|known| known.name == bone);
    at.unwrap_or(0) as u32
}

/// Writes the name of a bone (`MorecEvent.worst_bone`), such as `left_forearm`, with a zero at the end.
///
/// If `needed` is not null, it receives the number of bytes needed, with the zero. If `size` is smaller, the text is truncated,
/// zero-terminated, and the status is `MOREC_STATUS_BUFFER_TOO_SMALL`.
///
/// # Safety
/// `buffer` is null or may be written to for `size` bytes; `needed` is null or may be written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn morec_bone_name(
    bone: u32,
    buffer: *mut c_char,
    size: usize,
    needed: *mut usize,
) -> MorecStatus {
    guard(|| {
        let bone = ALL_BONES.get(bone as usize).ok_or_else(|| {
            CallError::invalid(format!(
                "bone {bone}: the event has {} bones, numbered from 0",
                ALL_BONES.len()
            ))
        })?;
        // SAFETY: as promised to this function.
        unsafe { memory::give_text((buffer, size), needed, bone.name) }
    })
}
