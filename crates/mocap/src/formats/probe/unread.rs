//! Formats that are recognised but not supported, with advice on how to convert them: the table `unread.tsv`.
//!
//! Its columns are what the format is called, signs of its content, an ending of files whose content does not tell, and the way to a
//! format that is read. A row fits if each of its signs, with spaces between them, holds; of signs with `|` between them, one must. The
//! first row that fits counts.
//!
//! | sign | holds if |
//! |---|---|
//! | `=TEXT`, `@8=TEXT` | the file begins with the text, or has it eight bytes on |
//! | `^TEXT`, `%TEXT` | it begins with the text behind white space, or so in any case |
//! | `~TEXT` | the text is anywhere in its beginning, in any case |
//! | `binary` | there is a zero byte |
//! | `!SIGN` | the sign does not hold |
//!
//! In a text `\s` is a space, `\n` the end of a line, `\0` and `\x1F` are bytes.

use std::sync::LazyLock;

use crate::formats::head::Head;

/// A format that is not read.
pub(super) struct UnreadFormat {
    pub(super) name: &'static str,
    /// Way to a format that is read; a sentence without its first letter's case.
    pub(super) advice: &'static str,
    /// In lower case; empty if content tells.
    ending: &'static str,
    /// Of each group one sign holds; none if the ending tells.
    signs: Vec<Vec<Sign>>,
}

struct Sign {
    kind: SignKind,
    text: Vec<u8>,
    negated: bool,
}

enum SignKind {
    At(usize),
    Start,
    StartAnyCase,
    Anywhere,
    Binary,
}

static TABLE: LazyLock<Vec<UnreadFormat>> = LazyLock::new(|| {
    let rows = include_str!("unread.tsv").lines().skip(1);
    rows.filter_map(UnreadFormat::of_row).collect()
});

/// The format that a beginning shows.
pub(super) fn of_content(head: &Head) -> Option<&'static UnreadFormat> {
    TABLE.iter().find(|format| {
        let holds = |signs: &Vec<Sign>| signs.iter().any(|sign| sign.holds(head));
        !format.signs.is_empty() && format.signs.iter().all(holds)
    })
}

/// The format that a file's ending promises.
pub(super) fn of_ending(ending: &str) -> Option<&'static UnreadFormat> {
    let is_it = |format: &&UnreadFormat| format.ending.eq_ignore_ascii_case(ending);
    TABLE
        .iter()
        .filter(|format| !format.ending.is_empty())
        .find(is_it)
}

impl UnreadFormat {
    fn of_row(row: &'static str) -> Option<Self> {
        let mut cells = row.split('\t');
        let (name, content, ending, advice) =
            (cells.next()?, cells.next()?, cells.next()?, cells.next()?);
        let group = |group: &str| group.split('|').map(Sign::parse).collect::<Option<_>>();
        Some(Self {
            name,
            advice,
            ending,
            signs: content
                .split_whitespace()
                .map(group)
                .collect::<Option<_>>()?,
        })
    }
}

impl Sign {
    fn parse(text: &str) -> Option<Self> {
        let (text, negated) = match text.strip_prefix('!') {
            Some(rest) => (rest, true),
            None => (text, false),
        };
        let (kind, text) = match text.chars().next()? {
            '=' => (SignKind::At(0), &text[1..]),
            '^' => (SignKind::Start, &text[1..]),
            '%' => (SignKind::StartAnyCase, &text[1..]),
            '~' => (SignKind::Anywhere, &text[1..]),
            '@' => {
                let (at, text) = text[1..].split_once('=')?;
                (SignKind::At(at.parse().ok()?), text)
            }
            _ if text == "binary" => (SignKind::Binary, ""),
            _ => return None,
        };
        Some(Self {
            kind,
            text: unescaped(text)?,
            negated,
        })
    }

    fn holds(&self, head: &Head) -> bool {
        let begins = |bytes: &[u8]| bytes.starts_with(&self.text);
        let start = head.bytes.trim_ascii_start();
        let holds = match self.kind {
            SignKind::At(at) => head.bytes.get(at..).is_some_and(begins),
            SignKind::Start => begins(start),
            SignKind::StartAnyCase => (start.get(..self.text.len()))
                .is_some_and(|start| start.eq_ignore_ascii_case(&self.text)),
            SignKind::Anywhere => head.contains(&self.text),
            SignKind::Binary => head.is_binary(),
        };
        holds != self.negated
    }
}

fn unescaped(text: &str) -> Option<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut rest = text;
    while let Some(at) = rest.find('\\') {
        bytes.extend_from_slice(&rest.as_bytes()[..at]);
        let escape = rest.get(at + 1..at + 2)?;
        let mut used = at + 2;
        bytes.push(match escape {
            "s" => b' ',
            "n" => b'\n',
            "0" => 0,
            "x" => {
                used += 2;
                u8::from_str_radix(rest.get(at + 2..used)?, 16).ok()?
            }
            _ => return None,
        });
        rest = &rest[used..];
    }
    bytes.extend_from_slice(rest.as_bytes());
    Some(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_is_understood_and_has_signs_or_an_ending() {
        let rows = include_str!("unread.tsv").lines().count() - 1;
        assert_eq!(TABLE.len(), rows);
        for format in TABLE.iter() {
            assert_ne!(format.signs.is_empty(), format.ending.is_empty());
            assert!(!format.advice.is_empty(), "{}", format.name);
        }
    }

    #[test]
    fn signs_are_read_as_described() {
        let holds = |sign: &str, bytes: &[u8]| Sign::parse(sign).unwrap().holds(&Head::new(bytes));
        assert!(holds(r"=PK\x03", b"PK\x03\x04") && !holds("=K", b"PK"));
        assert!(holds("@4=ftyp", b"\0\0\0\x20ftypisom") && !holds("@4=ftyp", b"ftyp"));
        assert!(holds("^<a", b"\n <a>") && !holds("^<A", b"<a>") && holds("%<A", b"<a>"));
        assert!(holds(r"~b\sc", b"A B C") && !holds("~bc", b"A B C") && holds("!~bc", b"A B C"));
        assert!(holds("binary", b"a\0") && !holds("binary", b"a"));
        for wrong in ["", "a", "@x=a", r"=\q", r"=\x1", "=\\"] {
            assert!(Sign::parse(wrong).is_none(), "{wrong}");
        }
    }
}
