//! Lines and tokens, as both Acclaim formats have them: any line end, `#` comments, any 8-bit encoding.

use std::borrow::Cow;

use crate::formats::{Limits, ParseError, Place};
use crate::parse_error::shortened;

/// Lines of `bytes` without comments, numbered from 1. LF, CRLF and CR end a line.
pub(super) struct AsfLines<'a> {
    rest: &'a [u8],
    number: u64,
    limit: usize,
}

impl<'a> AsfLines<'a> {
    pub(super) fn new(bytes: &'a [u8], limits: &Limits) -> Self {
        let rest = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
        Self {
            rest,
            number: 0,
            limit: limits.line_bytes,
        }
    }

    /// The next line with anything on it, and its number.
    pub(super) fn next(&mut self) -> Result<Option<(u64, &'a [u8])>, ParseError> {
        while !self.rest.is_empty() {
            let end = self
                .rest
                .iter()
                .position(|b| matches!(b, b'\n' | b'\r'))
                .unwrap_or(self.rest.len());
            let (line, after) = self.rest.split_at(end);
            self.rest = match after {
                [b'\r', b'\n', rest @ ..] | [_, rest @ ..] => rest,
                [] => after,
            };
            self.number += 1;
            if line.len() > self.limit {
                let found = format!("{} bytes", line.len());
                return Err(ParseError::new(
                    Place::Line(self.number),
                    format!("a line of at most {} bytes", self.limit),
                    found,
                ));
            }
            let code = line
                .iter()
                .position(|&b| b == b'#')
                .map_or(line, |comment| &line[..comment]);
            if tokens(code).next().is_some() {
                return Ok(Some((self.number, code)));
            }
        }
        Ok(None)
    }

    /// The number of the last line given.
    pub(super) fn number(&self) -> u64 {
        self.number
    }
}

/// The words of a line; commas and parentheses are blanks, as the definition of the format has it.
pub(super) fn tokens(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    let blank = |b: &u8| b.is_ascii_whitespace() || matches!(b, b',' | b'(' | b')' | 0x0B);
    line.split(blank).filter(|token| !token.is_empty())
}

/// The next of the words, in lower case; empty after the last.
pub(super) fn keyword<'a>(words: &mut impl Iterator<Item = &'a [u8]>) -> Vec<u8> {
    words.next().unwrap_or_default().to_ascii_lowercase()
}

/// A token as text: UTF-8 where it is, Latin-1 where it is not.
pub(super) fn text(token: &[u8]) -> Cow<'_, str> {
    match std::str::from_utf8(token) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => token.iter().map(|&b| char::from(b)).collect(),
    }
}

/// A token or a line for an error message: quoted, and cut where it is long.
pub(super) fn quoted(token: &[u8]) -> String {
    format!("`{}`", shortened(&text(token.trim_ascii())))
}

/// A number that a length or an angle can be: sums and products of such stay finite.
pub(super) fn number(token: &[u8]) -> Option<f64> {
    const LARGEST: f64 = 1e12;
    fast_float2::parse::<f64, _>(token)
        .ok()
        .filter(|value| value.abs() <= LARGEST)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(bytes: &[u8]) -> Vec<(u64, String)> {
        let limits = Limits::default();
        let mut lines = AsfLines::new(bytes, &limits);
        let mut out = Vec::new();
        while let Some((number, line)) = lines.next().unwrap() {
            out.push((number, text(line).into_owned()));
        }
        out
    }

    #[test]
    fn every_line_end_counts_once() {
        let expected: Vec<_> = [(1, "a"), (2, "b"), (4, "c"), (5, "d")]
            .map(|(n, s)| (n, s.to_owned()))
            .into();
        assert_eq!(lines(b"a\nb\r\n\rc\nd"), expected);
    }

    #[test]
    fn comments_and_latin_1_do_no_harm() {
        assert_eq!(
            lines(b"# X:\\f\xFCr Bonn\nB\xFCro 1 # two\n"),
            [(2, "Büro 1 ".to_owned())]
        );
    }

    #[test]
    fn long_lines_are_refused_with_their_number() {
        let limits = Limits {
            line_bytes: 4,
            ..Limits::default()
        };
        let mut lines = AsfLines::new(b"ab\nabcdef", &limits);
        assert!(lines.next().unwrap().is_some());
        assert_eq!(lines.next().unwrap_err().at, Place::Line(2));
    }
}
