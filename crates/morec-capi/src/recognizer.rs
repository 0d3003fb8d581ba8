//! Recognisers: creation, frames in, events out.

use morec::live::StreamOptions;
use morec::roles::Role;
use morec::templates::PerformerKind;

use crate::axes::Convention;
use crate::event::MorecEvent;
use crate::frame::{CheckedFrame, MorecFrame};
use crate::handles::{self, MorecIndex, MorecRecognizer};
use crate::memory::{self, Places, Versioned};
use crate::skeleton::{self, MorecSkeleton};
use crate::status::{CallError, MorecStatus, guard};
use crate::stream::Stream;
use crate::words;

/// Also report motions before they end: events of the phases start, update and cancel.
pub const MOREC_TENTATIVE: u32 = 1;

/// Any performer: the score threshold is never raised. For hands, tracked points and older indexes, matching is relaxed from the
/// first frame, not only after motions of a performer unlike the training subject.
pub const MOREC_PERFORMER_ANYONE: u32 = 2;

/// The performer is the training subject: the score threshold is raised from the first frame, by the scores of the training
/// samples.
pub const MOREC_PERFORMER_TEACHER: u32 = 4;

/// Report each repetition of an activity as an event of its own.
pub const MOREC_EACH_REPETITION: u32 = 8;

/// Say how far from the nearest sample each gesture that ends, and each repetition that is an event, was.
pub const MOREC_DEVIATION: u32 = 16;

/// Say with each frame how far every class has come: as many events, of the phase `Progress`. Of templates only.
pub const MOREC_PROGRESS: u32 = 32;

/// Options of a recogniser.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct MorecOptions {
    /// Set to `sizeof(MorecOptions)`.
    pub struct_size: usize,
    /// A `MorecHandedness`; required.
    pub handedness: i32,
    /// A `MorecUpAxis`.
    pub up_axis: i32,
    /// The stream's joints; null for a stream of roles, in which joint `r` has the `MorecRole` `r`.
    pub skeleton: *const MorecSkeleton,
    /// For a stream of roles: bit `r` for each `MorecRole` `r` that it contains; 0 for all.
    pub roles: u32,
    /// `MOREC_TENTATIVE`, `MOREC_EACH_REPETITION`, `MOREC_DEVIATION`, `MOREC_PROGRESS`, and one of `MOREC_PERFORMER_ANYONE` and `MOREC_PERFORMER_TEACHER`; or 0.
    pub flags: u32,
    /// Events that can wait to be polled, 128 to 1048576; 0 for 256. Memory is taken for as many, and with `MOREC_PROGRESS` for those of
    /// a frame at least.
    pub event_capacity: usize,
    /// Least time between two reports of the same class, seconds; suppressed motions are counted. 0: every motion is reported
    /// once.
    pub refractory_secs: f64,
    /// Sensitivity: accepted false alarms a minute in background motion; 0.1 is strict, 1 is generous. 0: as trained. (Not in the
    /// first version of this struct.)
    pub sensitivity: f64,
}

// SAFETY: repr(C), begins with its size, numbers and pointers only.
unsafe impl Versioned for MorecOptions {
    const NAME: &'static str = "MorecOptions";
    const FIRST_SIZE: usize = std::mem::offset_of!(Self, sensitivity);
}

/// Counts of a recogniser since it was created or reset.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MorecStats {
    /// Set to `sizeof(MorecStats)` before the call.
    pub struct_size: usize,
    /// Frames taken.
    pub frames: u64,
    /// Frames refused because the event queue was full (`MOREC_STATUS_QUEUE_FULL`).
    pub refused_frames: u64,
    /// Events produced so far, polled or queued.
    pub events: u64,
    /// Events lost because the queue was full. Always 0, because frames are refused before that.
    pub lost_events: u64,
    /// Motions not reported because of `refractory_secs`.
    pub suppressed_motions: u64,
    /// Shortest time from the end of a motion to its event, seconds on the clock of the frames.
    pub latency_secs: f64,
}

// SAFETY: repr(C), begins with its size, numbers only.
unsafe impl Versioned for MorecStats {
    const NAME: &'static str = "MorecStats";
    const FIRST_SIZE: usize = size_of::<Self>();
}

/// Creates a recogniser for one performer's motions and writes its handle to `*recognizer`; release it with
/// `morec_recognizer_destroy`. Allocates memory and may take some milliseconds.
///
/// # Safety
/// `options` is null or as its fields say; `recognizer` is null or may be written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn morec_recognizer_create(
    index: *const MorecIndex,
    options: *const MorecOptions,
    recognizer: *mut *mut MorecRecognizer,
) -> MorecStatus {
    guard(|| {
        // SAFETY: as promised to this function.
        unsafe { memory::put(recognizer, std::ptr::null_mut(), "recognizer") }?;
        let index = handles::find(index)?;
        // SAFETY: as promised to this function.
        let c = unsafe { memory::read_struct(options) }?;
        let (options, convention) = (
            stream_options(&c)?,
            Convention::new(c.handedness, c.up_axis)?,
        );
        let declared = if c.skeleton.is_null() {
            skeleton::of_roles(if c.roles == 0 {
                (1 << Role::BODY_COUNT) - 1
            } else {
                c.roles
            })?
        } else if c.roles == 0 {
            // SAFETY: as promised to this function.
            unsafe { skeleton::read(c.skeleton, &convention, &index) }?
        } else {
            return Err(CallError::invalid(
                "roles: only for streams without a skeleton; a skeleton has roles of its own",
            ));
        };
        let stream = Stream::new(&index, declared, convention, &options, c.event_capacity)?;
        // SAFETY: as promised to this function.
        unsafe { memory::put(recognizer, handles::give(stream)?, "recognizer") }
    })
}

/// The options that C says by numbers and flags.
fn stream_options(c: &MorecOptions) -> Result<StreamOptions, CallError> {
    let known = MOREC_TENTATIVE
        | MOREC_EACH_REPETITION
        | MOREC_DEVIATION
        | MOREC_PROGRESS
        | MOREC_PERFORMER_ANYONE
        | MOREC_PERFORMER_TEACHER;
    if c.flags & !known != 0 {
        return Err(CallError::invalid(format!(
            "flags: {:#x} contains bits that this release does not know",
            c.flags
        )));
    }
    let performer = match c.flags & (MOREC_PERFORMER_ANYONE | MOREC_PERFORMER_TEACHER) {
        0 => PerformerKind::Auto,
        MOREC_PERFORMER_ANYONE => PerformerKind::Anyone,
        MOREC_PERFORMER_TEACHER => PerformerKind::Teacher,
        _ => {
            return Err(CallError::invalid(
                "MOREC_PERFORMER_ANYONE and MOREC_PERFORMER_TEACHER exclude each other",
            ));
        }
    };
    Ok(StreamOptions {
        sensitivity: (c.sensitivity != 0.0).then_some(c.sensitivity),
        performer,
        tentative: c.flags & MOREC_TENTATIVE != 0,
        each_repetition: c.flags & MOREC_EACH_REPETITION != 0,
        deviation: c.flags & MOREC_DEVIATION != 0,
        progress: c.flags & MOREC_PROGRESS != 0,
        refractory_secs: c.refractory_secs,
        ..StreamOptions::default()
    })
}

/// Releases a recogniser and discards its queued events. A call running on another thread completes safely.
#[unsafe(no_mangle)]
pub extern "C" fn morec_recognizer_destroy(recognizer: *mut MorecRecognizer) -> MorecStatus {
    guard(|| handles::take_back(recognizer.cast_const()))
}

/// Writes the number of the joint with the `MorecRole` `role` to `*joint`, or −1 if no joint has it.
///
/// # Safety
/// `joint` is null or may be written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn morec_recognizer_joint_of_role(
    recognizer: *const MorecRecognizer,
    role: i32,
    joint: *mut i32,
) -> MorecStatus {
    guard(|| {
        let stream = handles::find(recognizer)?;
        let role = words::role(role)
            .ok_or_else(|| CallError::invalid(format!("role {role} does not exist")))?;
        let number = stream
            .declared()
            .rig
            .roles
            .joint(role)
            .map_or(-1, |joint| joint as i32);
        // SAFETY: as promised to this function.
        unsafe { memory::put(joint, number, "joint") }
    })
}

/// Processes a frame and queues the events that it causes. Allocates no memory after the first frame, unless it fails or a second
/// of frames has other joints than declared.
///
/// Refused with `MOREC_STATUS_QUEUE_FULL` if the queue might not have room for these events, so that none is ever lost.
///
/// # Safety
/// `frame` is null or as its fields say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn morec_recognizer_push(
    recognizer: *mut MorecRecognizer,
    frame: *const MorecFrame,
) -> MorecStatus {
    guard(|| {
        let stream = handles::find(recognizer)?;
        // SAFETY: as promised to this function; the frame is not used after it.
        let given = unsafe { CheckedFrame::read(frame, stream.declared().rig.skeleton.len()) }?;
        stream.push(&given)
    })
}

/// Moves up to `capacity` queued events to `events`, the oldest first, and writes their number to `*count`.
///
/// `event_size` is `sizeof(MorecEvent)`, the distance of the elements in bytes. If `*count` equals `capacity`, more events may be
/// queued. With a `capacity` of 0, `events` may be null, and the status is `MOREC_STATUS_BUFFER_TOO_SMALL` if any event is
/// queued.
///
/// # Safety
/// `events` is null or may be written to for `capacity` times `event_size` bytes; `count` is null or may be written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn morec_recognizer_poll(
    recognizer: *mut MorecRecognizer,
    events: *mut MorecEvent,
    event_size: usize,
    capacity: usize,
    count: *mut usize,
) -> MorecStatus {
    guard(|| {
        // SAFETY: as promised to this function.
        unsafe { memory::put(count, 0, "count") }?;
        let stream = handles::find(recognizer)?;
        // SAFETY: as promised to this function.
        let mut places = unsafe {
            Places::new(
                events,
                event_size,
                capacity,
                MorecEvent::FIRST_SIZE,
                "events",
            )
        }?;
        let taken = stream.poll(places.capacity(), |at, event| {
            places.put(at, &MorecEvent::from(event))
        })?;
        // SAFETY: as promised to this function.
        unsafe { memory::put(count, taken, "count") }
    })
}

/// Ends the stream and queues its last events. The next frame starts a new stream.
///
/// Refused with `MOREC_STATUS_QUEUE_FULL` under the same condition as a frame.
#[unsafe(no_mangle)]
pub extern "C" fn morec_recognizer_finish(recognizer: *mut MorecRecognizer) -> MorecStatus {
    guard(|| handles::find(recognizer.cast_const())?.finish())
}

/// Resets the recogniser to its initial state: discards the stream so far, queued events and counts.
#[unsafe(no_mangle)]
pub extern "C" fn morec_recognizer_reset(recognizer: *mut MorecRecognizer) -> MorecStatus {
    guard(|| handles::find(recognizer.cast_const())?.reset())
}

/// Fills in `*stats`, whose `struct_size` must be set. May be called from any thread at any time.
///
/// # Safety
/// `stats` is null or points to a struct of the size it says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn morec_recognizer_stats(
    recognizer: *const MorecRecognizer,
    stats: *mut MorecStats,
) -> MorecStatus {
    guard(|| {
        let status = handles::find(recognizer)?.status();
        let known = MorecStats {
            struct_size: 0,
            frames: status.frames,
            refused_frames: status.refused_frames,
            events: status.events,
            lost_events: status.lost_events,
            suppressed_motions: status.suppressed,
            latency_secs: status.latency_secs,
        };
        // SAFETY: as promised to this function.
        unsafe { memory::write_struct(stats, &known) }
    })
}
