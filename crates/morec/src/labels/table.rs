//! Tables of tab-separated text: the part that all of them share.

use crate::formats::{ParseError, Place, Warning};
use mocap::shortened;

/// A table whose header has been read.
pub(super) struct Table<'a> {
    text: &'a str,
    /// Column names as written, trimmed.
    header: Vec<&'a str>,
    header_line: u64,
}

/// One row: its cells, trimmed, each with the byte column at which it starts.
pub(super) struct Row<'a> {
    pub line: u64,
    cells: Vec<(u64, &'a str)>,
    end: u64,
}

impl<'a> Table<'a> {
    /// Reads the header: the first line that is not blank.
    pub fn new(bytes: &'a [u8]) -> Result<Self, ParseError> {
        let text = decode(bytes)?;
        let (line, raw) = numbered_lines(text)
            .find(|(_, raw)| !raw.trim().is_empty())
            .ok_or_else(|| {
                ParseError::new(
                    Place::File,
                    "a header line with column names",
                    "an empty file",
                )
            })?;
        let mut header: Vec<&str> = raw.split('\t').map(str::trim).collect();
        while header.last().is_some_and(|name| name.is_empty()) {
            header.pop();
        }
        for (i, name) in header.iter().enumerate() {
            if !name.is_empty()
                && header[..i]
                    .iter()
                    .any(|other| other.eq_ignore_ascii_case(name))
            {
                let found = format!("a second column `{name}`");
                return Err(ParseError::new(
                    Place::Line(line),
                    "each column once",
                    found,
                ));
            }
        }
        Ok(Self {
            text,
            header,
            header_line: line,
        })
    }

    /// Index of the column of this name, upper and lower case alike.
    pub fn find(&self, name: &str) -> Option<usize> {
        self.header
            .iter()
            .position(|h| h.eq_ignore_ascii_case(name))
    }

    /// Index of a column that must be there; the error names what the header holds instead.
    pub fn need(&self, name: &str) -> Result<usize, ParseError> {
        self.find(name).ok_or_else(|| {
            let expected = format!("a column `{name}` (tab-separated)");
            ParseError::new(
                Place::Line(self.header_line),
                expected,
                self.describe_header(),
            )
        })
    }

    /// Both columns of a pair, or neither.
    pub fn find_pair(
        &self,
        first: &str,
        second: &str,
    ) -> Result<Option<(usize, usize)>, ParseError> {
        match (self.find(first), self.find(second)) {
            (None, None) => Ok(None),
            _ => Ok(Some((self.need(first)?, self.need(second)?))),
        }
    }

    /// A warning for each column that is none of `known`.
    pub fn unknown_columns(&self, known: &[&str]) -> Vec<Warning> {
        self.header
            .iter()
            .filter(|name| !name.is_empty() && !known.iter().any(|k| k.eq_ignore_ascii_case(name)))
            .map(|name| {
                Warning::new(
                    Place::Line(self.header_line),
                    format!("column `{name}` is not known; left out"),
                )
            })
            .collect()
    }

    /// The rows below the header, blank lines skipped; and a warning for each row that is longer than the header.
    pub fn rows(&self) -> (Vec<Row<'a>>, Vec<Warning>) {
        let mut warnings = Vec::new();
        let mut rows = Vec::new();
        for (line, raw) in numbered_lines(self.text) {
            if line <= self.header_line || raw.trim().is_empty() {
                continue;
            }
            let row = Row::new(line, raw);
            if let Some((column, cell)) = row
                .cells
                .iter()
                .skip(self.header.len())
                .find(|(_, c)| !c.is_empty())
            {
                let text = format!(
                    "`{}` stands beyond the last column; left out",
                    shortened(cell)
                );
                warnings.push(Warning::new(Place::Column(line, *column), text));
            }
            rows.push(row);
        }
        (rows, warnings)
    }

    fn describe_header(&self) -> String {
        let header = self.header.join(", ");
        let commas = self.header.len() == 1 && (header.contains(',') || header.contains(';'));
        let hint = if commas { " (separated by tabs?)" } else { "" };
        format!("the columns `{}`{hint}", shortened(&header))
    }
}

impl<'a> Row<'a> {
    fn new(line: u64, raw: &'a str) -> Self {
        let mut column = 1;
        let mut cells = Vec::new();
        for cell in raw.split('\t') {
            let indent = cell.len() - cell.trim_start().len();
            cells.push((column + indent as u64, cell.trim()));
            column += cell.len() as u64 + 1;
        }
        Self {
            line,
            cells,
            end: column - 1,
        }
    }

    /// The cell of a column; empty where the row is too short.
    pub fn cell(&self, column: usize) -> &'a str {
        self.cells.get(column).map_or("", |(_, cell)| cell)
    }

    /// Place of a column's cell in the file.
    pub fn place(&self, column: usize) -> Place {
        Place::Column(
            self.line,
            self.cells.get(column).map_or(self.end, |(at, _)| *at),
        )
    }

    /// An error about the cell of a column.
    pub fn error(&self, column: usize, expected: &str) -> ParseError {
        let cell = self.cell(column);
        let found = if cell.is_empty() {
            "nothing".to_owned()
        } else {
            format!("`{}`", shortened(cell))
        };
        ParseError::new(self.place(column), expected, found)
    }

    /// A cell that must hold text.
    pub fn text(&self, column: usize, expected: &str) -> Result<String, ParseError> {
        match self.cell(column) {
            "" => Err(self.error(column, expected)),
            cell => Ok(cell.to_owned()),
        }
    }

    /// A cell that must hold a frame number; `146.0`, as some programs write it, is one.
    pub fn frame(&self, column: usize) -> Result<usize, ParseError> {
        let cell = self.cell(column);
        let digits = match cell.split_once('.') {
            Some((whole, zeros)) if zeros.bytes().all(|b| b == b'0') => whole,
            _ => cell,
        };
        digits
            .parse()
            .map_err(|_| self.error(column, "a frame: a whole number, 0 or more"))
    }

    /// A cell that must hold a time.
    pub fn secs(&self, column: usize) -> Result<f64, ParseError> {
        match self.cell(column).parse::<f64>() {
            Ok(secs) if secs.is_finite() && secs >= 0.0 => Ok(secs),
            _ => Err(self.error(column, "seconds: a number, 0 or more, with a decimal point")),
        }
    }

    /// A cell that may be empty but otherwise holds a finite number.
    pub fn optional_number(&self, column: usize) -> Result<Option<f64>, ParseError> {
        if self.cell(column).is_empty() {
            return Ok(None);
        }
        match self.cell(column).parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(Some(value)),
            _ => Err(self.error(column, "a number or nothing")),
        }
    }
}

fn decode(bytes: &[u8]) -> Result<&str, ParseError> {
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err(ParseError::new(
            Place::File,
            "text in UTF-8",
            "text in UTF-16",
        ));
    }
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    std::str::from_utf8(bytes).map_err(|error| {
        let before = &bytes[..error.valid_up_to()];
        // Counted as the lines are: CR, LF and CRLF each end one.
        let line = String::from_utf8_lossy(before)
            .replace("\r\n", "\n")
            .replace('\r', "\n")
            .matches('\n')
            .count();
        let found = format!("the byte 0x{:02x}", bytes[error.valid_up_to()]);
        ParseError::new(Place::Line(line as u64 + 1), "text in UTF-8", found)
    })
}

/// Lines from 1, ended by LF, CRLF or a lone CR.
fn numbered_lines(text: &str) -> impl Iterator<Item = (u64, &str)> {
    let mut rest = Some(text);
    let lines = std::iter::from_fn(move || {
        let text = rest?;
        let Some(end) = text.find(['\r', '\n']) else {
            rest = None;
            return Some(text);
        };
        let ending = if text[end..].starts_with("\r\n") {
            2
        } else {
            1
        };
        rest = Some(&text[end + ending..]);
        Some(&text[..end])
    });
    (1..).zip(lines)
}
