//! Text tables separated by tabs, or in the variants of R and spreadsheets: the common part of all readers of tables.

use crate::formats::{ParseError, Place, Warning};
use mocap::shortened;

/// A table whose header has been read.
pub(super) struct Table<'a> {
    text: &'a str,
    /// Column names as written, trimmed.
    header: Vec<&'a str>,
    header_line: u64,
    /// What separates cells; `None` for blanks.
    separator: Option<char>,
}

/// One row: its cells, trimmed, each with the byte column at which it starts.
pub(super) struct Row<'a> {
    pub line: u64,
    cells: Vec<(u64, &'a str)>,
    end: u64,
    /// True if numbers may have a comma for a point.
    has_comma: bool,
}

impl<'a> Table<'a> {
    /// Reads the header, the first line that is not blank.
    ///
    /// # Errors
    /// The file is empty, or not text.
    pub fn new(bytes: &'a [u8]) -> Result<Self, ParseError> {
        let text = decode(bytes)?;
        let (line, raw) = numbered_lines(text)
            .find_map(|(line, raw)| Some((line, header_in(raw)?)))
            .ok_or_else(|| {
                ParseError::new(
                    Place::File,
                    "a header line with column names",
                    "an empty file",
                )
            })?;
        let separator = separator(raw);
        let mut header: Vec<&str> = cells(raw, separator)
            .into_iter()
            .map(|(_, name)| name)
            .collect();
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
            separator,
        })
    }

    /// Index of the column of this name, upper and lower case alike.
    pub fn find(&self, name: &str) -> Option<usize> {
        self.header
            .iter()
            .position(|h| h.eq_ignore_ascii_case(name))
    }

    /// Index of a required column.
    ///
    /// # Errors
    /// The column is missing; the message lists the columns that the header has.
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

    /// A warning for each column that is not in `known`.
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
            let row = Row::new(line, raw, self.separator);
            // A name may begin with the sign of a comment.
            let is_comment = raw.starts_with("# ")
                || raw.starts_with('#') && row.cells.len() < self.header.len();
            if !is_comment {
                rows.push(row);
            }
        }
        self.drop_row_names(&mut rows);
        for row in &rows {
            if let Some((column, cell)) = row
                .cells
                .iter()
                .skip(self.header.len())
                .find(|(_, c)| !c.is_empty())
            {
                let text = format!("`{}` is beyond the last column; left out", shortened(cell));
                warnings.push(Warning::new(Place::Column(row.line, *column), text));
            }
        }
        (rows, warnings)
    }

    /// R numbers rows in a column that its header does not name.
    fn drop_row_names(&self, rows: &mut [Row<'a>]) {
        let is_numbered = |(row, number): (&Row, usize)| {
            row.cells.len() == self.header.len() + 1 && row.cell(0) == number.to_string()
        };
        if !rows.is_empty() && rows.iter().zip(1..).all(is_numbered) {
            for row in rows {
                row.cells.remove(0);
            }
        }
    }

    fn describe_header(&self) -> String {
        let header = self.header.join(", ");
        format!("the columns `{}`", shortened(&header))
    }
}

impl<'a> Row<'a> {
    fn new(line: u64, raw: &'a str, separator: Option<char>) -> Self {
        Self {
            line,
            cells: cells(raw, separator),
            end: raw.len() as u64 + 1,
            has_comma: separator != Some(','),
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

    /// The text of a cell; `expected` describes it in errors.
    ///
    /// # Errors
    /// The cell is missing or empty.
    pub fn text(&self, column: usize, expected: &str) -> Result<String, ParseError> {
        match self.cell(column) {
            "" => Err(self.error(column, expected)),
            cell => Ok(cell.to_owned()),
        }
    }

    /// A cell with a frame number. `146.0`, as some programs write it, is accepted.
    ///
    /// # Errors
    /// The cell is not a whole number of 0 or more.
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

    /// A cell with a time in seconds.
    ///
    /// # Errors
    /// The cell is not a number of 0 or more.
    pub fn secs(&self, column: usize) -> Result<f64, ParseError> {
        match self.number(column) {
            Some(secs) if secs >= 0.0 => Ok(secs),
            _ => Err(self.error(column, "seconds: a number, 0 or more")),
        }
    }

    /// A cell with a finite number; `None` if it is empty.
    ///
    /// # Errors
    /// The cell contains something else.
    pub fn optional_number(&self, column: usize) -> Result<Option<f64>, ParseError> {
        if self.cell(column).is_empty() {
            return Ok(None);
        }
        match self.number(column) {
            Some(value) => Ok(Some(value)),
            _ => Err(self.error(column, "a number or nothing")),
        }
    }

    /// The finite number in a cell; spreadsheets may write it with a comma.
    fn number(&self, column: usize) -> Option<f64> {
        let cell = self.cell(column);
        let value = match self.has_comma && cell.contains(',') {
            true => cell.replacen(',', ".", 1).parse::<f64>(),
            false => cell.parse(),
        };
        value.ok().filter(|value| value.is_finite())
    }
}

/// The header in a line; `None` if it is blank or a comment. A header may be marked as one, too.
fn header_in(raw: &str) -> Option<&str> {
    let Some(comment) = raw.trim_start().strip_prefix('#') else {
        return (!raw.trim().is_empty()).then_some(raw);
    };
    let has = |name: &str| {
        let mut cells = comment.split(['\t', ',', ';']);
        cells.any(|cell| cell.trim().eq_ignore_ascii_case(name))
    };
    (has("clip") && has("class")).then_some(comment)
}

/// What separates the cells of a header.
fn separator(header: &str) -> Option<char> {
    let found = ['\t', ';', ','].into_iter().find(|c| header.contains(*c));
    // R writes names in quotes with blanks between them.
    let is_quoted = header.trim().starts_with('"') && header.contains("\" \"");
    found.or((!is_quoted).then_some('\t'))
}

/// The cells of a line, trimmed, each with the byte column at which it starts; a separator within quotes separates nothing.
fn cells(raw: &str, separator: Option<char>) -> Vec<(u64, &str)> {
    let ends = |c: char| separator.map_or(c.is_whitespace(), |separator| c == separator);
    let mut cells = Vec::new();
    let mut start = 0;
    loop {
        let rest = &raw[start..];
        let indent = rest.len()
            - rest
                .trim_start_matches(|c: char| c.is_whitespace() && !ends(c))
                .len();
        let quoted = rest[indent..].strip_prefix('"').and_then(|inner| {
            let close = inner.find('"')?;
            let behind = &inner[close + 1..];
            let end = behind.find(ends).unwrap_or(behind.len());
            behind[..end]
                .trim()
                .is_empty()
                .then_some((close, indent + close + 2 + end))
        });
        let (cell, at, length) = match quoted {
            Some((close, length)) => (&rest[indent + 1..indent + 1 + close], indent + 1, length),
            None => {
                let length = rest.find(ends).unwrap_or(rest.len());
                let cell = &rest[..length];
                (cell, cell.len() - cell.trim_start().len(), length)
            }
        };
        // Several blanks are one separator.
        if separator.is_some() || length > 0 {
            cells.push(((start + at) as u64 + 1, cell.trim()));
        }
        let Some(next) = rest[length..].chars().next() else {
            return cells;
        };
        start += length + next.len_utf8();
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
