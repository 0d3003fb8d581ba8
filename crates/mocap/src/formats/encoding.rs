//! Text encodings of names in files.

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
        let decoded =
            encoding_rs::SHIFT_JIS.decode_without_bom_handling_and_without_replacement(bytes);
        if leads && decoded.is_some() {
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
            Self::ShiftJis => encoding_rs::SHIFT_JIS
                .decode_without_bom_handling(bytes)
                .0
                .into_owned(),
            Self::Latin1 => bytes.iter().map(|&b| char::from(b)).collect(),
        }
    }
}
