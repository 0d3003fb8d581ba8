//! Errors and warnings with their place in a file, used by all readers.

use std::fmt;

/// Place in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Place {
    /// No place within the file.
    File,
    /// A line of a text file, from 1.
    Line(u64),
    /// A line and a column (in bytes) of a text file, both from 1.
    Column(u64, u64),
    /// A byte of a binary file, from 0.
    Byte(u64),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Place::File => f.write_str("file"),
            Place::Line(line) => write!(f, "line {line}"),
            Place::Column(line, column) => write!(f, "line {line}, column {column}"),
            Place::Byte(byte) => write!(f, "byte {byte}"),
        }
    }
}

/// A file that could not be read, and why.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{at}: expected {expected}, found {found}")]
pub struct ParseError {
    /// Place where reading stopped.
    pub at: Place,
    /// The expected content.
    pub expected: String,
    /// The content found.
    pub found: String,
}

impl ParseError {
    /// An error at `at`.
    pub fn new(at: Place, expected: impl Into<String>, found: impl Into<String>) -> Self {
        Self {
            at,
            expected: expected.into(),
            found: found.into(),
        }
    }

    /// The error of a file for which `most` bytes of memory do not suffice.
    #[cfg(feature = "formats")]
    pub(crate) fn of_memory(most: usize, needed: usize) -> Self {
        let megabytes = |bytes: usize| bytes.div_ceil(1 << 20);
        let expected = format!("{OF_MEMORY}{} MiB of memory", megabytes(most));
        let found = format!("a file that needs {} MiB or more", megabytes(needed));
        Self::new(Place::File, expected, found)
    }

    /// True if the file was refused for the memory it needs: it may be read with more, or in parts.
    pub fn is_of_memory(&self) -> bool {
        self.expected.starts_with(OF_MEMORY)
    }
}

/// Beginning of what is expected of a file that needs too much memory.
const OF_MEMORY: &str = "a file that is read with ";

/// At most 60 characters of `text` for an error message, with `…` for the rest.
pub fn shortened(text: &str) -> std::borrow::Cow<'_, str> {
    const LONGEST: usize = 60;
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &text[..end]).into(),
        None => text.into(),
    }
}

/// Something that was repaired or looks wrong, in a file that was read all the same.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct Warning {
    /// Line, byte or other place of the fault.
    pub at: Place,
    /// Fault and repair, in a sentence.
    pub text: String,
}

impl Warning {
    /// A warning at `at`.
    pub fn new(at: Place, text: impl Into<String>) -> Self {
        Self {
            at,
            text: text.into(),
        }
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.at, self.text)
    }
}
