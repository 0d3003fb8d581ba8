//! The lines of the motion table, one row of numbers at a time.

use super::notes::Notes;
use super::number::{self, is_newline};
use super::text::{Cursor, show};
use crate::formats::ParseError;

/// Contents of a line of the motion table; its numbers are in the caller's buffer.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum MotionLine {
    /// Numbers only.
    Numbers,
    /// Numbers and a word that is not a number.
    Spoilt(String),
}

/// Reads lines of the motion table, skipping what is blank, a comment or foreign text.
pub(super) struct MotionLines<'t> {
    cursor: Cursor<'t>,
    /// `None`: no line with numbers has been seen.
    decimal_comma: Option<bool>,
}

/// Knowledge from the earlier lines of a table.
#[derive(Debug, Clone, Copy)]
pub(super) struct LinesSoFar {
    line: u64,
    decimal_comma: Option<bool>,
}

impl LinesSoFar {
    /// Nothing; the table begins on `line`.
    pub fn new(line: u64) -> Self {
        Self {
            line,
            decimal_comma: None,
        }
    }
}

impl<'t> MotionLines<'t> {
    /// The lines of `text`. Commas are decimal points if the table's first line with numbers has them and no points.
    pub fn new(text: &'t [u8], line_limit: usize, so_far: LinesSoFar, notes: &mut Notes) -> Self {
        let mut cursor = Cursor::new(text, line_limit);
        cursor.line = so_far.line;
        let mut first = cursor.clone();
        let line = match so_far.decimal_comma.is_none() && first.skip_space().is_ok() {
            true => first.rest_of_line(),
            false => &[],
        };
        let decimal_comma = match line {
            [] => so_far.decimal_comma,
            line => Some(has_decimal_commas(line)),
        };
        if so_far.decimal_comma.is_none() && decimal_comma == Some(true) {
            let text = || {
                format!(
                    "decimal commas read as points, as in {}",
                    show(first_token(line))
                )
            };
            notes.count("decimal commas", first.line, text);
        }
        Self {
            cursor,
            decimal_comma,
        }
    }

    /// For the lines that follow.
    pub fn so_far(&self) -> LinesSoFar {
        LinesSoFar {
            line: self.cursor.line,
            decimal_comma: self.decimal_comma,
        }
    }

    /// Reads the next line that contains numbers into `values` and returns its line number and kind; `None` at the end of the
    /// table.
    ///
    /// # Errors
    /// The file cannot be read, or a line is longer than the limit.
    pub fn next(
        &mut self,
        values: &mut Vec<f64>,
        notes: &mut Notes,
    ) -> Result<Option<(u64, MotionLine)>, ParseError> {
        loop {
            self.cursor.skip_space()?;
            if self.cursor.peek().is_none() {
                return Ok(None);
            }
            values.clear();
            let line = self.cursor.line;
            let row = self.line(values, notes);
            self.cursor.newline()?;
            if let Some(row) = row {
                return Ok(Some((line, row)));
            }
        }
    }

    /// Reads the rest of the line; `None` if it held no number.
    fn line(&mut self, values: &mut Vec<f64>, notes: &mut Notes) -> Option<MotionLine> {
        loop {
            // The common case in a tight loop; whatever it does not understand is looked at closely.
            let text = self.cursor.text;
            while let Some(value) = number::next(text, &mut self.cursor.pos) {
                values.push(value);
                self.cursor.skip_blanks();
            }
            if self.cursor.at_line_end() {
                return Some(MotionLine::Numbers);
            }
            if self.cursor.at_comment() {
                notes.count("comment", self.cursor.line, || "comment skipped".into());
                self.cursor.rest_of_line();
                return (!values.is_empty()).then_some(MotionLine::Numbers);
            }
            let start = self.cursor.pos;
            let token = self.word();
            if self.token(token, values, notes).is_none() {
                return self.not_a_number(start, token, values, notes);
            }
            self.cursor.skip_blanks();
        }
    }

    /// Bytes up to the next blank or the end of the line.
    fn word(&mut self) -> &'t [u8] {
        let start = self.cursor.pos;
        while self.cursor.peek().is_some_and(|b| b > b' ') {
            self.cursor.pos += 1;
        }
        &self.cursor.text[start..self.cursor.pos]
    }

    /// Appends the value or values of a token that is no plain decimal.
    fn token(&self, token: &[u8], values: &mut Vec<f64>, notes: &mut Notes) -> Option<()> {
        if let Some(value) = number::parse(token) {
            values.push(value);
            return Some(());
        }
        if let Some(value) =
            number::parse_with_comma(token).filter(|_| self.decimal_comma == Some(true))
        {
            values.push(value);
            return Some(());
        }
        number::parse_glued(token, values)?;
        let text = || {
            format!(
                "numbers without a blank between them split at the sign, {}",
                show(Some(token))
            )
        };
        notes.count("glued", self.cursor.line, text);
        Some(())
    }

    /// A line with a token that is no number: spoilt if it has numbers as well, else foreign and skipped.
    fn not_a_number(
        &mut self,
        start: usize,
        token: &[u8],
        values: &[f64],
        notes: &mut Notes,
    ) -> Option<MotionLine> {
        let rest = self.cursor.rest_of_line();
        let mut others = rest.split(|&b| b <= b' ');
        if !values.is_empty() || others.any(|t| number::parse(t).is_some()) {
            return Some(MotionLine::Spoilt(show(Some(token))));
        }
        let whole = &self.cursor.text[start..self.cursor.pos];
        let text = || format!("a line without a number skipped, {}", show(Some(whole)));
        notes.count("foreign line", self.cursor.line, text);
        None
    }
}

fn has_decimal_commas(line: &[u8]) -> bool {
    line.contains(&b',')
        && line
            .split(|&b| b <= b' ')
            .filter(|t| !t.is_empty())
            .all(|t| {
                number::parse_with_comma(t).is_some()
                    || t.iter().all(|&b| b.is_ascii_digit() || b == b'-')
            })
}

fn first_token(line: &[u8]) -> Option<&[u8]> {
    line.split(|&b| b <= b' ').find(|t| t.contains(&b','))
}

/// Counts the lines of `text` that hold nothing but numbers, and the numbers on the first of them.
pub(super) fn count_numbers(text: &[u8]) -> (usize, usize) {
    let (mut lines, mut width) = (0, 0);
    for line in text.split(|&b| is_newline(b)) {
        let mut tokens = line
            .split(|&b| b <= b' ')
            .filter(|t| !t.is_empty())
            .peekable();
        if tokens.peek().is_none() {
            continue;
        }
        let mut numbers = 0;
        if tokens.all(|t| {
            numbers += 1;
            number::parse(t).is_some()
        }) {
            lines += 1;
            width = if width == 0 { numbers } else { width };
        }
    }
    (lines, width)
}
