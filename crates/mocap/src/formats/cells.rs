//! Rows and cells of text tables, and the numbers in them.

use std::borrow::Cow;

use super::encoding::Encoding;
use super::{Limits, ParseError, Place};

/// Decimal separator.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Decimal {
    Point,
    Comma,
    Either,
}

impl Decimal {
    /// A comma, if numbers among the first `cells` have commas and none has a point.
    pub(super) fn of<'a>(cells: impl Iterator<Item = &'a str>) -> Self {
        const LOOKED_AT: usize = 10_000;
        let mut comma = false;
        for cell in cells.take(LOOKED_AT) {
            if number(cell, Decimal::Point).is_some() {
                if cell.contains('.') {
                    return Self::Point;
                }
            } else if number(cell, Decimal::Comma).is_some() {
                comma = true;
            }
        }
        if comma { Self::Comma } else { Self::Point }
    }
}

/// The number in a cell; `None` for blanks, words and what is not finite.
pub(super) fn number(cell: &str, decimal: Decimal) -> Option<f64> {
    let cell = cell.trim();
    let has_comma = cell.contains(',');
    if has_comma && decimal == Decimal::Point {
        return None;
    }
    if has_comma {
        finite(&cell.replacen(',', ".", 1))
    } else {
        finite(cell)
    }
}

/// The number that `word` is with a decimal point and nothing around it; `None` for what is not finite.
pub(super) fn finite(word: &str) -> Option<f64> {
    let value = fast_float2::parse::<f64, _>(word).ok();
    value.filter(|value| value.is_finite())
}

/// Seconds in a cell that shows a clock, `10:05:07.25`, with a date before it or without; the date is not looked at.
pub(super) fn clock(cell: &str) -> Option<f64> {
    let cell = cell.trim().trim_end_matches(['Z', 'z']);
    let time = cell.rsplit(['T', ' ']).next()?;
    // Without what says how far this is from UTC.
    let time = time.split('+').next()?;
    let mut parts = time.split(':');
    let [hours, minutes] = [parts.next()?, parts.next()?].map(|part| part.parse::<u32>().ok());
    let secs = number(parts.next()?, Decimal::Either)?;
    // A fourth part may count frames or milliseconds.
    let none_behind = parts.next().is_none();
    let secs = (f64::from(hours?) * 60.0 + f64::from(minutes?)) * 60.0 + secs;
    (none_behind && (0.0..=90_000.0).contains(&secs)).then_some(secs)
}

/// Text in Shift-JIS or Latin-1 as UTF-8; what is UTF-8 or binary stays as it is. O(bytes).
pub(super) fn utf8(bytes: &[u8]) -> Cow<'_, [u8]> {
    match Encoding::of(bytes) {
        Encoding::Utf8 => Cow::Borrowed(bytes),
        _ if bytes.contains(&0) => Cow::Borrowed(bytes),
        other => Cow::Owned(other.decode(bytes).into_bytes()),
    }
}

/// Rows that are not blank, with their line numbers from 1. The text is UTF-8 but for single bytes in names, with or
/// without a byte order mark.
///
/// # Errors
/// UTF-16, zero bytes, or a line longer than `limits` allow.
pub(super) fn lines<'a>(
    bytes: &'a [u8],
    limits: &Limits,
) -> Result<Vec<(u64, &'a str)>, ParseError> {
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    if bytes.starts_with(b"\xFF\xFE") || bytes.starts_with(b"\xFE\xFF") {
        return Err(ParseError::new(Place::File, "UTF-8 text", "UTF-16 text"));
    }
    if let Some(zero) = bytes.iter().position(|&b| b == 0) {
        return Err(ParseError::new(
            Place::Byte(zero as u64),
            "text",
            "a zero byte",
        ));
    }
    let ends = bytes.iter().filter(|b| matches!(b, b'\n' | b'\r'));
    limits.afford(ends.count() + 1, 2 * size_of::<(u64, &str)>())?;
    let mut rows = Vec::new();
    for (line, row) in numbered_lines(bytes) {
        if row.len() > limits.line_bytes {
            let expected = format!("a line of at most {} bytes", limits.line_bytes);
            return Err(ParseError::new(
                Place::Line(line),
                expected,
                row.len().to_string(),
            ));
        }
        // A name in another encoding spoils its row only from there on: numbers are below it.
        let text = match std::str::from_utf8(row) {
            Ok(text) => text,
            Err(error) => std::str::from_utf8(&row[..error.valid_up_to()]).unwrap_or_default(),
        };
        if !is_blank(text) {
            rows.push((line, text.trim_end_matches('\r')));
        }
    }
    Ok(rows)
}

fn numbered_lines(bytes: &[u8]) -> impl Iterator<Item = (u64, &[u8])> {
    let rows = bytes.split(|&b| b == b'\n').flat_map(mac_lines);
    (1..).zip(rows)
}

fn is_blank(text: &str) -> bool {
    let says_nothing = |c: char| c.is_whitespace() || matches!(c, ',' | ';' | '"');
    text.trim_matches(says_nothing).is_empty()
}

/// The line numbers of rows whose cells are all empty.
pub(super) fn empty_rows(bytes: &[u8]) -> impl Iterator<Item = u64> {
    let rows = numbered_lines(bytes).filter(|(_, row)| {
        let separated = row.iter().any(|b| matches!(b, b',' | b';' | b'\t'));
        separated && std::str::from_utf8(row).is_ok_and(is_blank)
    });
    rows.map(|(line, _)| line)
}

/// The lines of old Macintosh files, which end in a carriage return alone.
fn mac_lines(row: &[u8]) -> impl Iterator<Item = &[u8]> {
    let row = row.strip_suffix(b"\r").unwrap_or(row);
    row.split(|&b| b == b'\r')
}

/// The cells of a row, without blanks and quotes around them; without a separator, at blanks.
pub(super) fn split(row: &str, separator: Option<char>) -> Vec<&str> {
    let Some(separator) = separator else {
        return at_blanks(row);
    };
    let mut cells = Vec::new();
    let (mut start, mut quoted) = (0, false);
    for (at, c) in row.char_indices() {
        if c == '"' {
            quoted = !quoted;
        } else if c == separator && !quoted {
            cells.push(bare(&row[start..at]));
            start = at + c.len_utf8();
        }
    }
    cells.push(bare(&row[start..]));
    cells
}

/// Cells between blanks; one in quotes may hold some.
fn at_blanks(row: &str) -> Vec<&str> {
    if !row.contains('"') {
        return row.split_whitespace().collect();
    }
    let mut quoted = false;
    let cells = row.split(|c: char| {
        quoted ^= c == '"';
        c.is_whitespace() && !quoted
    });
    cells.filter(|cell| !cell.is_empty()).map(bare).collect()
}

fn bare(cell: &str) -> &str {
    let cell = cell.trim();
    let inner = cell
        .strip_prefix('"')
        .and_then(|cell| cell.strip_suffix('"'));
    inner.unwrap_or(cell).trim()
}

/// True if a word is one of `words`, which blanks separate.
pub(super) fn is_among(words: &str, word: &str) -> bool {
    words.split(' ').any(|known| known == word)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_of_every_kind() {
        assert_eq!(split("a,\"b, c\", d ,", Some(',')), ["a", "b, c", "d", ""]);
        assert_eq!(split(" 1  2\t3", None), ["1", "2", "3"]);
        let comma = Decimal::of(["1", "2,5", "x"].into_iter());
        assert_eq!(number("2,5", comma), Some(2.5));
        assert_eq!(number("-1e3", comma), Some(-1000.0));
        assert_eq!(Decimal::of(["2,5", "0.5"].into_iter()), Decimal::Point);
        for none in ["", "nan", "inf", "x", "1 2"] {
            assert_eq!(number(none, Decimal::Either), None, "{none}");
        }
    }

    #[test]
    fn clocks() {
        for (cell, secs) in [
            ("10:00:07.25", Some(36_007.25)),
            ("2023-01-01 00:01:00", Some(60.0)),
            ("2023-01-01T00:00:01.5Z", Some(1.5)),
            ("2023-01-01T00:00:01.5+02:00", Some(1.5)),
            ("15:26:46:12.02", None),
            ("99999999999:1:1", None),
            ("12.5", None),
        ] {
            assert_eq!(clock(cell), secs, "{cell}");
        }
    }

    #[test]
    fn lines_keep_their_numbers() {
        let rows = lines(b"\xEF\xBB\xBFa\r\n\r\n ,,\nb\rc", &Limits::default()).unwrap();
        assert_eq!(rows, [(1, "a"), (4, "b"), (5, "c")]);
        assert!(lines(b"a\0b", &Limits::default()).is_err());
    }
}
