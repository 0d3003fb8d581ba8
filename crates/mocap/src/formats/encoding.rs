//! Text encodings of names in files.

use std::iter::from_fn;
use std::sync::LazyLock;

/// Encoding of the names in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::formats) enum Encoding {
    Utf8,
    ShiftJis,
    Latin1,
}

impl Encoding {
    /// Tells the three apart. What is not UTF-8 is Shift-JIS if it holds bytes that only Shift-JIS gives a
    /// meaning (0x81 to 0x9F begin its commonest kana and kanji, and are control characters in Latin-1) and
    /// decodes without a fault; else Latin-1, which never fails.
    pub fn of(bytes: &[u8]) -> Self {
        if std::str::from_utf8(bytes).is_ok() {
            return Self::Utf8;
        }
        let leads = bytes.iter().any(|b| (0x81..=0x9f).contains(b));
        if leads && shift_jis(bytes).all(|found| found.is_some()) {
            Self::ShiftJis
        } else {
            Self::Latin1
        }
    }

    /// As warnings call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Utf8 => "UTF-8",
            Self::ShiftJis => "Shift-JIS",
            Self::Latin1 => "Latin-1",
        }
    }

    /// Bytes of the character that begins with `lead`, as far as it matters for finding a `{`: the second byte
    /// of a Shift-JIS character may be one (ボ is 83 7B).
    pub fn width(self, lead: u8) -> usize {
        let pairs = self == Self::ShiftJis && matches!(lead, 0x81..=0x9f | 0xe0..=0xfc);
        if pairs { 2 } else { 1 }
    }

    pub fn decode(self, bytes: &[u8]) -> String {
        match self {
            Self::Utf8 => String::from_utf8_lossy(bytes).into_owned(),
            Self::ShiftJis => shift_jis(bytes).map(or_replacement).collect(),
            Self::Latin1 => bytes.iter().map(|&b| char::from(b)).collect(),
        }
    }
}

/// Text of Windows in western Europe and America, which is Latin-1 with other signs for 0x80 to 0x9F.
pub(in crate::formats) fn windows_1252(bytes: &[u8]) -> String {
    /// From 0x80 on. Five bytes have no sign and stay control characters.
    const SIGNS: [char; 32] = [
        '€', '\u{81}', '‚', 'ƒ', '„', '…', '†', '‡', 'ˆ', '‰', 'Š', '‹', 'Œ', '\u{8d}', 'Ž',
        '\u{8f}', '\u{90}', '‘', '’', '“', '”', '•', '–', '—', '˜', '™', 'š', '›', 'œ', '\u{9d}',
        'ž', 'Ÿ',
    ];
    let sign = |&b: &u8| match b {
        0x80..=0x9f => SIGNS[usize::from(b - 0x80)],
        _ => char::from(b),
    };
    bytes.iter().map(sign).collect()
}

/// Text in UTF-16, without its byte order mark; `unit` puts two bytes together.
pub(in crate::formats) fn utf_16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> String {
    let units = bytes.chunks(2).map(|pair| match *pair {
        [a, b] => unit([a, b]),
        _ => 0xfffd,
    });
    let mut units = units.peekable();
    units.next_if_eq(&0xfeff);
    let read = char::decode_utf16(units);
    read.map(|found| or_replacement(found.ok())).collect()
}

fn or_replacement(found: Option<char>) -> char {
    found.unwrap_or(char::REPLACEMENT_CHARACTER)
}

/// The characters of text in Shift-JIS with the extensions of Windows, as browsers read it; nothing for bytes that mean none.
fn shift_jis(bytes: &[u8]) -> impl Iterator<Item = Option<char>> {
    let mut rest = bytes;
    from_fn(move || {
        let (&lead, behind) = rest.split_first()?;
        rest = behind;
        Some(match (lead, behind) {
            (0..=0x80, _) => Some(char::from(lead)),
            (0xa1..=0xdf, _) => char::from_u32(0xff61 + u32::from(lead - 0xa1)),
            (0x81..=0x9f | 0xe0..=0xfc, &[trail, ref after @ ..]) => {
                let found = pair(lead, trail);
                // ASCII behind a byte that should begin a pair is not lost with it.
                if found.is_some() || trail >= 0x80 {
                    rest = after;
                }
                found
            }
            _ => None,
        })
    })
}

/// The character of two bytes of Shift-JIS.
fn pair(lead: u8, trail: u8) -> Option<char> {
    /// A line for each first byte, in it the characters of the second bytes, U+FFFD for none.
    static TABLE: LazyLock<Vec<Vec<char>>> = LazyLock::new(|| {
        let lines = include_str!("shift_jis.txt").lines();
        lines.map(|line| line.chars().collect()).collect()
    });
    let column = match trail {
        0x40..=0x7e => trail - 0x40,
        0x80..=0xfc => trail - 0x41,
        _ => return None,
    };
    if let 0xf0..=0xf9 = lead {
        // For characters of one's own.
        return char::from_u32(0xe000 + u32::from(lead - 0xf0) * 188 + u32::from(column));
    }
    let row = lead.checked_sub(if lead < 0xa0 { 0x81 } else { 0xc1 })?;
    let line = TABLE.get(usize::from(row))?;
    let found = line.get(usize::from(column)).copied();
    found.filter(|&found| found != char::REPLACEMENT_CHARACTER)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Both readings of `bytes` in Shift-JIS: ours, and that of `encoding_rs`, which a program would link with the tables of all encodings.
    fn assert_shift_jis(bytes: &[u8]) {
        let theirs = encoding_rs::SHIFT_JIS;
        let (text, faults) = theirs.decode_without_bom_handling(bytes);
        assert_eq!(Encoding::ShiftJis.decode(bytes), text, "{bytes:x?}");
        assert_eq!(shift_jis(bytes).any(|c| c.is_none()), faults, "{bytes:x?}");
    }

    #[test]
    fn every_pair_of_bytes_is_read_as_browsers_read_it() {
        for first in 0..=255 {
            assert_shift_jis(&[first]);
            for second in 0..=255 {
                assert_shift_jis(&[first, second]);
            }
        }
        let all: Vec<u8> = (0..=255).collect();
        let (text, _) = encoding_rs::WINDOWS_1252.decode_without_bom_handling(&all);
        assert_eq!(windows_1252(&all), text);
    }

    proptest! {
        #[test]
        fn any_bytes_are_read_as_browsers_read_them(bytes in prop::collection::vec(any::<u8>(), 0..40)) {
            assert_shift_jis(&bytes);
            let whole = &bytes[..bytes.len() / 2 * 2];
            let (text, _) = encoding_rs::UTF_16LE.decode_with_bom_removal(whole);
            prop_assert_eq!(utf_16(whole, u16::from_le_bytes), text);
            let (text, _) = encoding_rs::UTF_16BE.decode_with_bom_removal(whole);
            prop_assert_eq!(utf_16(whole, u16::from_be_bytes), text);
        }
    }
}
