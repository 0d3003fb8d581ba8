//! Standard output and standard error of the command.

use std::fmt::Arguments;
use std::io::{ErrorKind, Write};
use std::sync::Mutex;

use anyhow::{Context, Result};

/// As the standard library's, but a reader that has gone does not end the work: what is to be written is written all the same.
macro_rules! println {
    ($($text:tt)*) => { crate::console::out(format_args!("{}\n", format_args!($($text)*))) };
}

/// See `println`.
macro_rules! print {
    ($($text:tt)*) => { crate::console::out(format_args!($($text)*)) };
}

/// See `println`.
macro_rules! eprintln {
    ($($text:tt)*) => { crate::console::err(format_args!("{}\n", format_args!($($text)*))) };
}

/// See `println`.
macro_rules! eprint {
    ($($text:tt)*) => { crate::console::err(format_args!($($text)*)) };
}

/// The first failure of standard output.
static FAILED: Mutex<Option<std::io::Error>> = Mutex::new(None);

/// Writes to standard output. A failure is reported at the end ([`finish`]): work that is under way is finished first.
pub fn out(text: Arguments<'_>) {
    if let Err(error) = std::io::stdout().lock().write_fmt(text)
        && error.kind() != ErrorKind::BrokenPipe
        && let Ok(mut failed) = FAILED.lock()
    {
        failed.get_or_insert(error);
    }
}

/// Writes to standard error; a failure is ignored, as there is nowhere to report it.
pub fn err(text: Arguments<'_>) {
    let _ = std::io::stderr().lock().write_fmt(text);
}

/// Flushes standard output.
///
/// # Errors
/// The first failure to write to it, such as a full disk; a reader that has gone is none.
pub fn finish() -> Result<()> {
    let flushed = std::io::stdout().flush();
    let failed = FAILED.lock().ok().and_then(|mut failed| failed.take());
    match failed.or(flushed.err()) {
        Some(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(error).context("standard output")
        }
        _ => Ok(()),
    }
}
