//! Recognisers: made of an index, fed with frames, asked for events.

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

/// Say what seems to be under way, too: starts, updates and cancellations beside the ends.
pub const MOREC_TENTATIVE: u32 = 1;

/// Anyone performs: the bound of the score is never raised. For hands, tracked points and older indexes: more is accepted from the first
/// frame, not only once the performer's motions show somebody unlike the teacher.
pub const MOREC_PERFORMER_ANYONE: u32 = 2;

/// The person who taught performs: the bound of the score is raised from the first frame by the scores of the teacher's samples.
pub const MOREC_PERFORMER_TEACHER: u32 = 4;

/// Each repetition of an activity is an event of its own.
pub const MOREC_EACH_REPETITION: u32 = 8;

/// Say how far from the nearest sample each gesture that ends, and each repetition that is an event, was.
pub const MOREC_DEVIATION: u32 = 16;

/// Options of a recogniser.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct MorecOptions {
    /// Set to `sizeof(MorecOptions)`.
    pub struct_size: usize,
    /// A `MorecHandedness`; must be said.
    pub handedness: i32,
    /// A `MorecUpAxis`.
    pub up_axis: i32,
    /// The stream's joints; null for a stream of roles, whose joint `r` plays `MorecRole` `r`.
    pub skeleton: *const MorecSkeleton,
    /// For a stream of roles: bit `r` for each `MorecRole` `r` that it shows; 0 for all.
    pub roles: u32,
    /// `MOREC_TENTATIVE`, `MOREC_EACH_REPETITION`, `MOREC_DEVIATION`, and one of `MOREC_PERFORMER_ANYONE` and `MOREC_PERFORMER_TEACHER`; or 0.
    pub flags: u32,
    /// Events that can wait to be polled, 128 to 1048576; 0 for 256. Memory is taken for as many.
    pub event_capacity: usize,
    /// A motion of the same class that ends less than this after the one before it is not reported, but counted. 0: every
    /// motion is reported once.
    pub refractory_secs: f64,
    /// Sensitivity: false alarms a minute that background motion may raise, as in training, 0.1 strict … 1 generous.
    /// 0: as trained. (Not in the first version of this struct.)
    pub sensitivity: f64,
}

// SAFETY: repr(C), begins with its size, numbers and pointers only.
unsafe impl Versioned for MorecOptions {
    const NAME: &'static str = "MorecOptions";
    const FIRST_SIZE: usize = std::mem::offset_of!(Self, sensitivity);
}

/// Counts of a recogniser since it was made or reset.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MorecStats {
    /// Set to `sizeof(MorecStats)` before the call.
    pub struct_size: usize,
    /// Frames taken.
    pub frames: u64,
    /// Frames refused because events waited to be polled (`MOREC_STATUS_QUEUE_FULL`).
    pub refused_frames: u64,
    /// Events produced so far, polled or queued.
    pub events: u64,
    /// Events for which there was no room in the queue. Frames are refused before that happens: 0.
    pub lost_events: u64,
    /// Motions not reported because of `refractory_secs`.
    pub suppressed_motions: u64,
    /// From the end of a motion to its event at the earliest, on the clock of the frames.
    pub latency_secs: f64,
}

// SAFETY: repr(C), begins with its size, numbers only.
unsafe impl Versioned for MorecStats {
    const NAME: &'static str = "MorecStats";
    const FIRST_SIZE: usize = size_of::<Self>();
}

/// Makes a recogniser of one performer's motions and puts its handle into `*recognizer`, to be given back with
/// `morec_recognizer_destroy`. Takes memory; may take some milliseconds.
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
        refractory_secs: c.refractory_secs,
        ..StreamOptions::default()
    })
}

/// Gives a recogniser back. Events that wait are gone. A call that is under way on another thread ends well.
#[unsafe(no_mangle)]
pub extern "C" fn morec_recognizer_destroy(recognizer: *mut MorecRecognizer) -> MorecStatus {
    guard(|| handles::take_back(recognizer.cast_const()))
}

/// Puts the joint that plays the `MorecRole` `role` into `*joint`, or −1 if none does.
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

/// Takes a frame. What it settles waits to be polled. Takes no memory after the first frame, unless it fails, or a second of frames shows
/// other joints than were declared.
///
/// Refused with `MOREC_STATUS_QUEUE_FULL` while too many events wait for there to be room for what it settles:
/// nothing is ever lost.
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

/// Moves events that wait into the `capacity` places at `events`, the oldest first, and says in `*count` how many.
///
/// `event_size` is `sizeof(MorecEvent)`: how far the places lie apart. If `*count` is `capacity`, more may wait. With a
/// `capacity` of 0, `events` may be null, and the status is `MOREC_STATUS_BUFFER_TOO_SMALL` if any wait.
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

/// Ends the stream: what its last moments hold waits to be polled. The next frame begins a new stream.
///
/// Refused with `MOREC_STATUS_QUEUE_FULL` as a frame would be.
#[unsafe(no_mangle)]
pub extern "C" fn morec_recognizer_finish(recognizer: *mut MorecRecognizer) -> MorecStatus {
    guard(|| handles::find(recognizer.cast_const())?.finish())
}

/// Makes the recogniser as it was when it was made: the stream so far, events that wait, and counts are forgotten.
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
