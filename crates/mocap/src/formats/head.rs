//! The first bytes of a file, by which its format is recognised.

/// The beginning of a file.
pub(super) struct Head<'a> {
    pub(super) bytes: &'a [u8],
}

impl<'a> Head<'a> {
    const LONGEST: usize = 64 * 1024;

    pub(super) fn new(bytes: &'a [u8]) -> Self {
        let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
        Self {
            bytes: &bytes[..bytes.len().min(Self::LONGEST)],
        }
    }

    pub(super) fn starts(&self, text: &str) -> bool {
        self.bytes.trim_ascii_start().starts_with(text.as_bytes())
    }

    pub(super) fn contains(&self, text: &[u8]) -> bool {
        self.bytes
            .windows(text.len())
            .any(|window| window.eq_ignore_ascii_case(text))
    }

    /// True if one of the first lines holds a word in lower case, however it is written there.
    pub(super) fn says(&self, word: &str) -> bool {
        let is_word = |at: &[u8]| at.eq_ignore_ascii_case(word.as_bytes());
        let holds = |line: &[u8]| line.windows(word.len()).any(is_word);
        self.lines().take(200).any(holds)
    }

    pub(super) fn is_markup(&self) -> bool {
        self.starts("<")
    }

    pub(super) fn is_binary(&self) -> bool {
        self.bytes.contains(&0)
    }

    /// Lines that are no comment and not empty.
    pub(super) fn lines(&self) -> impl Iterator<Item = &'a [u8]> {
        let lines = self
            .bytes
            .split(|b| matches!(b, b'\n' | b'\r'))
            .map(<[u8]>::trim_ascii);
        lines.filter(|line| !line.is_empty() && !line.starts_with(b"#"))
    }
}
