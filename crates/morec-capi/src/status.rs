//! The result of a call: a status and a message.

use std::borrow::Cow;
use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Result of a call. Values never change; later versions may add new ones.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MorecStatus {
    /// Done.
    Ok = 0,
    /// A pointer that must point to something is null.
    NullPointer = 1,
    /// An invalid handle: never created, of another type, or destroyed.
    BadHandle = 2,
    /// Invalid value; no change.
    InvalidValue = 3,
    /// The buffer is too small for the answer; the function returns the needed size as documented there.
    BufferTooSmall = 4,
    /// Another thread is using this recogniser; nothing was changed.
    Busy = 5,
    /// The event queue is full, so the frame was not processed. Poll events, then push the frame again.
    QueueFull = 6,
    /// A file cannot be read.
    File = 7,
    /// The bytes are not an index that this release can read.
    BadIndex = 8,
    /// The index and the stream have no bone in common.
    NothingInCommon = 9,
    /// Another call must come first.
    WrongOrder = 10,
    /// A struct is smaller than its first version, or has fields set that this release does not know.
    StructSize = 11,
    /// An internal error of morec. Destroy the handle, and please report the error.
    Internal = 12,
}

impl MorecStatus {
    fn text(self) -> &'static CStr {
        match self {
            MorecStatus::Ok => c"done",
            MorecStatus::NullPointer => c"a pointer is null",
            MorecStatus::BadHandle => c"not a handle, or a destroyed one",
            MorecStatus::InvalidValue => c"an invalid value",
            MorecStatus::BufferTooSmall => c"the buffer is too small",
            MorecStatus::Busy => c"another thread is using this recogniser",
            MorecStatus::QueueFull => c"the event queue is full: poll events first",
            MorecStatus::File => c"a file cannot be read",
            MorecStatus::BadIndex => c"not an index that this release can read",
            MorecStatus::NothingInCommon => c"the stream has none of the index's bones",
            MorecStatus::WrongOrder => c"another call must come first",
            MorecStatus::StructSize => c"a struct of the wrong size",
            MorecStatus::Internal => c"an internal error of morec; please report it",
        }
    }

    fn of_number(number: i32) -> Option<Self> {
        use MorecStatus::*;
        let all = [
            Ok,
            NullPointer,
            BadHandle,
            InvalidValue,
            BufferTooSmall,
            Busy,
            QueueFull,
            File,
            BadIndex,
            NothingInCommon,
            WrongOrder,
            StructSize,
            Internal,
        ];
        all.into_iter().find(|status| *status as i32 == number)
    }
}

/// A code and, where there is more to say than the code does, a text.
#[derive(Debug)]
pub(crate) struct CallError {
    status: MorecStatus,
    text: Cow<'static, CStr>,
}

impl CallError {
    /// With a text for people: what was expected, what was found.
    pub(crate) fn new(status: MorecStatus, text: impl Into<String>) -> Self {
        // A text from a caller's own strings may hold anything but should not end early.
        let text: String = text.into().chars().filter(|c| *c != '\0').collect();
        Self {
            status,
            text: CString::new(text).map_or(Cow::Borrowed(status.text()), Cow::Owned),
        }
    }

    /// Invalid value.
    pub(crate) fn invalid(text: impl Into<String>) -> Self {
        Self::new(MorecStatus::InvalidValue, text)
    }
}

impl From<MorecStatus> for CallError {
    /// Without memory: for what happens on the frame path.
    fn from(status: MorecStatus) -> Self {
        Self {
            status,
            text: Cow::Borrowed(status.text()),
        }
    }
}

thread_local! {
    static LAST: RefCell<Cow<'static, CStr>> = const { RefCell::new(Cow::Borrowed(c"")) };
}

/// Runs a call so that nothing but a status comes out of it.
pub(crate) fn guard(call: impl FnOnce() -> Result<(), CallError>) -> MorecStatus {
    let caught = catch_unwind(AssertUnwindSafe(call));
    match caught.unwrap_or_else(|_| Err(MorecStatus::Internal.into())) {
        Ok(()) => MorecStatus::Ok,
        Err(error) => {
            // A thread that is ending has no last error any more; the status is there all the same.
            let _ = LAST.try_with(|last| {
                if let Ok(mut last) = last.try_borrow_mut() {
                    *last = error.text;
                }
            });
            error.status
        }
    }
}

/// Message of the last failed call on this thread, one sentence; empty if no call has failed.
/// UTF-8. The text is valid until the next failing call on this thread. Never null.
#[unsafe(no_mangle)]
pub extern "C" fn morec_last_error() -> *const c_char {
    let text = LAST.try_with(|last| last.try_borrow().map_or(c"".as_ptr(), |text| text.as_ptr()));
    text.unwrap_or(c"".as_ptr())
}

/// Meaning of a status in a few words; null if the number is not a status. The text is valid for ever.
#[unsafe(no_mangle)]
pub extern "C" fn morec_status_text(status: i32) -> *const c_char {
    MorecStatus::of_number(status).map_or(std::ptr::null(), |status| status.text().as_ptr())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn last() -> String {
        // SAFETY: a text of ours, with a zero at its end.
        unsafe { CStr::from_ptr(morec_last_error()) }
            .to_string_lossy()
            .into_owned()
    }

    #[test]
    fn no_panic_comes_out() {
        assert_eq!(guard(|| panic!("on purpose")), MorecStatus::Internal);
        assert_eq!(last(), "an internal error of morec; please report it");
    }

    #[test]
    fn the_last_error_is_each_threads_own_and_outlasts_what_succeeds() {
        assert_eq!(
            guard(|| Err(CallError::invalid("too \0 many"))),
            MorecStatus::InvalidValue
        );
        assert_eq!(guard(|| Ok(())), MorecStatus::Ok);
        assert_eq!(last(), "too  many");
        assert_eq!(std::thread::spawn(last).join().unwrap(), "");
    }

    #[test]
    fn every_status_has_a_text() {
        for number in 0..=12 {
            assert!(!morec_status_text(number).is_null());
        }
        assert!(morec_status_text(13).is_null() && morec_status_text(-1).is_null());
    }
}
