//! Splits bytes into lines, tokens and names.

use super::number::{is_blank, is_newline};
use crate::formats::encoding::Encoding;
use crate::formats::{ParseError, Place};
use crate::parse_error::shortened;

/// A place in the text that knows its line.
#[derive(Debug, Clone)]
pub(super) struct Cursor<'a> {
    pub text: &'a [u8],
    pub pos: usize,
    /// Line of `pos`, from 1.
    pub line: u64,
    line_start: usize,
    line_limit: usize,
}

impl<'a> Cursor<'a> {
    pub fn new(text: &'a [u8], line_limit: usize) -> Self {
        Self {
            text,
            pos: 0,
            line: 1,
            line_start: 0,
            line_limit,
        }
    }

    pub fn place(&self) -> Place {
        Place::Line(self.line)
    }

    pub fn peek(&self) -> Option<u8> {
        self.text.get(self.pos).copied()
    }

    /// Moves past blanks, staying on the line.
    #[inline]
    pub fn skip_blanks(&mut self) {
        while self.peek().is_some_and(is_blank) {
            self.pos += 1;
        }
    }

    /// True if nothing is left on the line.
    pub fn at_line_end(&self) -> bool {
        self.peek().is_none_or(is_newline)
    }

    /// Moves past one line end, if the position is at one.
    ///
    /// # Errors
    /// The line before it was longer than the limit.
    #[inline]
    pub fn newline(&mut self) -> Result<(), ParseError> {
        if self.pos - self.line_start > self.line_limit {
            let expected = format!("at most {} bytes in a line", self.line_limit);
            return Err(ParseError::new(
                self.place(),
                expected,
                format!("{}", self.pos - self.line_start),
            ));
        }
        let length = match self.text[self.pos..] {
            [b'\r', b'\n', ..] => 2,
            [b'\r' | b'\n', ..] => 1,
            _ => return Ok(()),
        };
        self.pos += length;
        self.line += 1;
        self.line_start = self.pos;
        Ok(())
    }

    /// Moves past blanks and line ends.
    ///
    /// # Errors
    /// A line was longer than the limit.
    pub fn skip_space(&mut self) -> Result<(), ParseError> {
        loop {
            self.skip_blanks();
            if self.at_line_end() {
                self.newline()?;
            }
            if self.peek().is_none_or(|b| b > b' ') {
                return Ok(());
            }
        }
    }

    /// Moves to the end of the line and returns what was left of it, trimmed.
    pub fn rest_of_line(&mut self) -> &'a [u8] {
        let start = self.pos;
        while !self.at_line_end() {
            self.pos += 1;
        }
        trim(&self.text[start..self.pos])
    }

    /// True if a comment begins here (`#` or `//`).
    pub fn at_comment(&self) -> bool {
        self.text[self.pos..].starts_with(b"#") || self.text[self.pos..].starts_with(b"//")
    }

    /// The next token: a brace, or text up to a blank, a brace or the line's end; `None` at the end of the file.
    ///
    /// # Errors
    /// A line was longer than the limit.
    pub fn token(&mut self) -> Result<Option<&'a [u8]>, ParseError> {
        self.skip_space()?;
        Ok(self.token_on_line())
    }

    /// The next token of this line.
    pub fn token_on_line(&mut self) -> Option<&'a [u8]> {
        self.skip_blanks();
        let start = self.pos;
        while let Some(byte) = self.peek().filter(|&b| b > b' ') {
            let brace = matches!(byte, b'{' | b'}');
            if brace && self.pos > start {
                break;
            }
            self.pos += 1;
            if brace {
                break;
            }
        }
        (self.pos > start).then(|| &self.text[start..self.pos])
    }

    /// A joint's name: the rest of the line, or the next line if nothing is left, up to a `{` and trimmed; empty if there is no
    /// name.
    ///
    /// # Errors
    /// A line was longer than the limit.
    pub fn name(&mut self, encoding: Encoding) -> Result<String, ParseError> {
        self.skip_space()?;
        let start = self.pos;
        while let Some(byte) = self.peek().filter(|&b| !is_newline(b) && b != b'{') {
            self.pos = (self.pos + encoding.width(byte)).min(self.text.len());
        }
        Ok(encoding.decode(trim(&self.text[start..self.pos])))
    }
}

fn trim(bytes: &[u8]) -> &[u8] {
    let start = bytes.iter().position(|&b| b > b' ').unwrap_or(bytes.len());
    let stop = bytes
        .iter()
        .rposition(|&b| b > b' ')
        .map_or(start, |p| p + 1);
    &bytes[start..stop]
}

/// A token as an error shows it: quoted, decoded as far as it goes, not too long.
pub(super) fn show(token: Option<&[u8]>) -> String {
    let Some(token) = token else {
        return "the end of the file".into();
    };
    format!("`{}`", shortened(&String::from_utf8_lossy(token)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_of_line_end_counts_once() {
        for text in ["a\nb\nc", "a\r\nb\r\nc", "a\rb\rc", "a\r\nb\rc"] {
            let mut cursor = Cursor::new(text.as_bytes(), 100);
            let mut found = Vec::new();
            while let Some(token) = cursor.token().unwrap() {
                found.push((token[0], cursor.line));
            }
            assert_eq!(found, [(b'a', 1), (b'b', 2), (b'c', 3)], "{text:?}");
        }
    }

    #[test]
    fn encodings_are_told_apart() {
        assert_eq!(Encoding::of("JOINT Hüfte".as_bytes()), Encoding::Utf8);
        assert_eq!(Encoding::of(b"JOINT H\xfcfte"), Encoding::Latin1);
        assert_eq!(Encoding::of(b"JOINT \xe9paule"), Encoding::Latin1);
        // 左足, then ボーン, whose first character ends in the byte of a brace.
        let sjis = b"\x8d\xb6\x91\xab \x83\x7b\x81\x5b\x83\x93 {";
        assert_eq!(Encoding::of(sjis), Encoding::ShiftJis);
        assert_eq!(
            Cursor::new(sjis, 100).name(Encoding::ShiftJis).unwrap(),
            "左足 ボーン"
        );
    }

    #[test]
    fn a_line_over_the_limit_is_refused() {
        let mut cursor = Cursor::new(b"ok\nmuch too long\n", 5);
        while let Ok(Some(_)) = cursor.token() {}
        assert_eq!(cursor.token().unwrap_err().at, Place::Line(2));
    }
}
