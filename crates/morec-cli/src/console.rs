//! Standard output and standard error of the command.

use std::fmt::Arguments;
use std::io::{ErrorKind, StdoutLock, Write};
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
    if let Err(error) = stdout().write_fmt(text)
        && error.kind() != ErrorKind::BrokenPipe
        && let Ok(mut failed) = FAILED.lock()
    {
        failed.get_or_insert(error);
    }
}

/// Writes to standard error; a failure is ignored, as there is nowhere to report it.
pub fn err(text: Arguments<'_>) {
    let _ = PlainText::new(std::io::stderr().lock()).write_fmt(text);
}

/// Standard output for text that people read.
pub fn stdout() -> PlainText<StdoutLock<'static>> {
    PlainText::new(std::io::stdout().lock())
}

/// Text without control characters but tabs and line ends: names in files may hold some that move the cursor or change what the
/// terminal shows; each becomes a question mark.
pub struct PlainText<W: Write> {
    out: W,
    /// The last byte was the first of two that may be a control character.
    pending: bool,
}

impl<W: Write> PlainText<W> {
    /// First byte of the control characters U+0080 to U+009F, and of letters behind them, in UTF-8.
    const FIRST_OF_TWO: u8 = 0xc2;

    fn new(out: W) -> Self {
        Self {
            out,
            pending: false,
        }
    }
}

impl<W: Write> Write for PlainText<W> {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        let mut text = Vec::with_capacity(bytes.len());
        for &byte in bytes {
            if std::mem::take(&mut self.pending) {
                if matches!(byte, 0x80..=0x9f) {
                    text.push(b'?');
                    continue;
                }
                text.push(Self::FIRST_OF_TWO);
            }
            match byte {
                Self::FIRST_OF_TWO => self.pending = true,
                b'\n' | b'\t' => text.push(byte),
                0..0x20 | 0x7f => text.push(b'?'),
                _ => text.push(byte),
            }
        }
        self.out.write_all(&text)?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.out.flush()
    }
}

/// Flushes standard output.
///
/// # Errors
/// The first failure to write to it, such as a full disk; a closed pipe does not count.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_are_question_marks() {
        let mut out = PlainText::new(Vec::new());
        let text = "a\tHüfte\u{1b}[31m\u{9b}2J\u{7f}\r\u{a0}é\n";
        for byte in text.as_bytes() {
            out.write_all(&[*byte]).unwrap();
        }
        let readable = "a\tHüfte?[31m?2J??\u{a0}é\n";
        assert_eq!(String::from_utf8(out.out).unwrap(), readable);
    }
}
