//! The eight calls of Bucur 2009, Table 4.3, and one more: one index, one source of motion and one recognition in the
//! process.
//!
//! Each says whether it did what it is for; `morec_last_error` says why not. They may be called from any thread, one
//! after the other: a call waits for the one before it.

mod clips;
mod player;
mod segment;
mod state;

use std::ffi::{c_char, c_int};
use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::memory;
use crate::status::{CallError, MorecStatus, guard};
pub use segment::MotionSeg;
use state::ThesisState;

static STATE: Mutex<ThesisState> = Mutex::new(ThesisState::new());

fn state() -> MutexGuard<'static, ThesisState> {
    // After a fault the parts are as they were before it or gone; every call looks at what is there.
    STATE.lock().unwrap_or_else(PoisonError::into_inner)
}

fn done(call: impl FnOnce() -> Result<(), CallError>) -> bool {
    guard(call) == MorecStatus::Ok
}

/// Initialises the library with an index file, which `morec train` wrote; `szClassifierFile` is UTF-8.
///
/// # Safety
/// `szClassifierFile` is null or ends with a zero.
#[unsafe(no_mangle)]
#[allow(non_snake_case)]
pub unsafe extern "C" fn mrInit(szClassifierFile: *const c_char) -> bool {
    done(|| {
        // SAFETY: as promised to this function.
        let path = unsafe { memory::text(szClassifierFile, "szClassifierFile") }?;
        state().init(Path::new(path))
    })
}

/// Ends recognition and releases everything. Never fails; the speed of sources is reset to 1.
#[unsafe(no_mangle)]
#[allow(non_snake_case)]
pub extern "C" fn mrTerminate() {
    done(|| {
        state().terminate();
        Ok(())
    });
}

/// Sets the clip in a file (BVH; AMC with its ASF in the same folder) as the source of motion; if the file has several people,
/// the first. `szSourceFile` is UTF-8.
///
/// The clip is played frame by frame at the speed of the performance. It starts together with recognition, so that no frame is
/// missed.
///
/// # Safety
/// `szSourceFile` is null or ends with a zero.
#[unsafe(no_mangle)]
#[allow(non_snake_case)]
pub unsafe extern "C" fn mrSetDataSource(szSourceFile: *const c_char) -> bool {
    done(|| {
        // SAFETY: as promised to this function.
        let path = unsafe { memory::text(szSourceFile, "szSourceFile") }?;
        state().set_source(Path::new(path))
    })
}

/// Sets the speed of sources, also while they are playing: 1 as performed, 2 twice as fast, infinity as fast as recognition can.
/// Not one of the eight functions of the thesis.
#[unsafe(no_mangle)]
#[allow(non_snake_case)]
pub extern "C" fn mrSetDataSourceSpeed(speed: f64) -> bool {
    done(|| state().set_speed(speed))
}

/// Stops the source. Frames that it has already sent are still recognised.
#[unsafe(no_mangle)]
#[allow(non_snake_case)]
pub extern "C" fn mrStopDataSource() -> bool {
    done(|| state().stop_source())
}

/// True if the source will send no more frames: it has ended, was stopped, or is not set.
#[unsafe(no_mangle)]
#[allow(non_snake_case)]
pub extern "C" fn mrIsDataSourceDepleted() -> bool {
    let mut depleted = true;
    done(|| {
        depleted = state().is_depleted();
        Ok(())
    });
    depleted
}

/// Starts recognition of the source, in separate threads; a source that was played before starts again.
#[unsafe(no_mangle)]
#[allow(non_snake_case)]
pub extern "C" fn mrStart() -> bool {
    done(|| state().start())
}

/// Stops recognition after all frames sent by the source have been recognised. The solution is kept.
#[unsafe(no_mangle)]
#[allow(non_snake_case)]
pub extern "C" fn mrStop() -> bool {
    done(|| state().stop())
}

/// Returns the solution so far: the last motions recognised since `mrStart`, at most `*nSegments`, in order of time. Sets
/// `*nSegments` to their number.
///
/// Motions stay in the solution; `number` shows which are new. At most the last 16384 motions are kept. If `pSegments` is null,
/// `*nSegments` is set to the number of all kept motions.
///
/// # Safety
/// `pSegments` is null or has room for `*nSegments`; `nSegments` is null or may be read and written.
#[unsafe(no_mangle)]
#[allow(non_snake_case)]
pub unsafe extern "C" fn mrQueryMotionSegments(
    pSegments: *mut MotionSeg,
    nSegments: *mut c_int,
) -> bool {
    done(|| {
        // SAFETY: as promised to this function.
        let room = unsafe { memory::get(nSegments, "nSegments") }?;
        let room = usize::try_from(room)
            .map_err(|_| CallError::invalid(format!("nSegments is {room}")))?;
        let mut state = state();
        let solution = state.solution()?;
        let mut count = solution.len();
        if !pSegments.is_null() {
            let of = size_of::<MotionSeg>();
            // SAFETY: as promised to this function.
            let mut places = unsafe { memory::Places::new(pSegments, of, room, of, "pSegments") }?;
            count = count.min(room);
            for (at, segment) in solution.iter().skip(solution.len() - count).enumerate() {
                places.put(at, segment);
            }
        }
        // SAFETY: as promised to this function.
        unsafe { memory::put(nSegments, count as c_int, "nSegments") }
    })
}
