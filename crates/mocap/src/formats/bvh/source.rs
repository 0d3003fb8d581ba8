//! The text of a motion table, in memory or in a file that is read piece by piece.

use std::io::{Read, Seek, SeekFrom};

use super::number::is_newline;
use crate::formats::{ParseError, Place};

/// The text of a motion table, in pieces of whole lines.
pub(super) trait TableText {
    /// Length in bytes.
    fn bytes(&self) -> usize;
    /// Back to its start.
    fn rewind(&mut self) -> Result<(), ParseError>;
    /// The next lines; `None` behind the last.
    fn next(&mut self) -> Result<Option<&[u8]>, ParseError>;
}

/// A table in memory, as one piece.
pub(super) struct InMemory<'a> {
    text: &'a [u8],
    given: bool,
}

impl<'a> InMemory<'a> {
    pub fn new(text: &'a [u8]) -> Self {
        Self { text, given: false }
    }
}

impl TableText for InMemory<'_> {
    fn bytes(&self) -> usize {
        self.text.len()
    }

    fn rewind(&mut self) -> Result<(), ParseError> {
        self.given = false;
        Ok(())
    }

    fn next(&mut self) -> Result<Option<&[u8]>, ParseError> {
        let is_first = !std::mem::replace(&mut self.given, true);
        Ok(is_first.then_some(self.text))
    }
}

/// A table that stands in a file from `start` to its end.
pub(super) struct InFile<F> {
    file: F,
    start: u64,
    bytes: u64,
    /// Read, and not given yet from `given` on.
    buffer: Vec<u8>,
    given: usize,
    /// Bytes that are read at a time.
    piece: usize,
    /// Longer lines are given as they are, for the reader to refuse.
    longest_line: usize,
}

impl<F: Read + Seek> InFile<F> {
    pub fn new(
        mut file: F,
        start: u64,
        piece: usize,
        longest_line: usize,
    ) -> Result<Self, ParseError> {
        let end = file.seek(SeekFrom::End(0)).map_err(unreadable)?;
        let mut table = Self {
            file,
            start,
            bytes: end.saturating_sub(start),
            buffer: Vec::new(),
            given: 0,
            piece,
            longest_line,
        };
        table.rewind()?;
        Ok(table)
    }

    /// Reads on; whether there was more.
    fn fill(&mut self) -> Result<bool, ParseError> {
        let more = self.file.by_ref().take(self.piece as u64);
        let read = read_all(more, &mut self.buffer)?;
        Ok(read > 0)
    }
}

impl<F: Read + Seek> TableText for InFile<F> {
    fn bytes(&self) -> usize {
        usize::try_from(self.bytes).unwrap_or(usize::MAX)
    }

    fn rewind(&mut self) -> Result<(), ParseError> {
        self.buffer.clear();
        self.given = 0;
        self.file
            .seek(SeekFrom::Start(self.start))
            .map_err(unreadable)?;
        Ok(())
    }

    fn next(&mut self) -> Result<Option<&[u8]>, ParseError> {
        self.buffer.drain(..self.given);
        loop {
            let more = self.fill()?;
            self.given = match (more, end_of_lines(&self.buffer)) {
                (false, _) => self.buffer.len(),
                (true, 0) if self.buffer.len() <= self.longest_line => continue,
                (true, 0) => self.buffer.len(),
                (true, end) => end,
            };
            return Ok((self.given > 0).then_some(&self.buffer[..self.given]));
        }
    }
}

/// End of the last line that is known to be whole. A carriage return at the end may be half of a line end.
fn end_of_lines(text: &[u8]) -> usize {
    let known = match text {
        [whole @ .., b'\r'] => whole,
        _ => text,
    };
    let last = known.iter().rposition(|&byte| is_newline(byte));
    last.map_or(0, |at| at + 1)
}

/// Appends what `from` has to `bytes`.
pub(super) fn read_all(mut from: impl Read, bytes: &mut Vec<u8>) -> Result<usize, ParseError> {
    from.read_to_end(bytes).map_err(unreadable)
}

pub(super) fn unreadable(error: std::io::Error) -> ParseError {
    let expected = "a file that can be read to its end";
    ParseError::new(Place::File, expected, error.to_string())
}
