//! Numbers of a line of the motion table, as text.
//!
//! The formatting of the standard library decides every digit by exact arithmetic, which takes several times as long as a table of
//! millions of numbers is worth.

/// One line in the making. Numbers have seven decimals (an error of 1e-9 rad for angles in degrees, 5e-8 units for lengths), or
/// four where the last three are 0, as in most files.
#[derive(Debug, Default)]
pub(super) struct NumberLine {
    /// The line's characters, and room behind them.
    bytes: Vec<u8>,
    used: usize,
}

const DECIMALS: u64 = 10_000_000;
/// A sign, nine digits, the point, seven decimals, a blank, and what copies of fixed length write behind.
const ROOM: usize = 24;

impl NumberLine {
    /// Appends a number and a blank.
    pub fn push(&mut self, value: f64) {
        let scaled = (value * DECIMALS as f64).abs();
        // Whole numbers up to 2^53 are doubles.
        if scaled.is_nan() || scaled >= 9e15 {
            return self.push_text(&format!("{value:.7} "));
        }
        let steps = (scaled + 0.5) as u64;
        let (whole, decimals) = ((steps / DECIMALS) as usize, (steps % DECIMALS) as usize);
        if self.bytes.len() < self.used + ROOM {
            self.bytes.resize(2 * self.used + ROOM, 0);
        }
        let room = &mut self.bytes[self.used..self.used + ROOM];
        room[0] = b'-';
        let mut at = usize::from(value < 0.0 && steps > 0);
        let mut leading = usize::from(whole < 100) + usize::from(whole < 10);
        if whole >= 1000 {
            let thousands = (whole / 1000).to_string();
            room[at..at + thousands.len()].copy_from_slice(thousands.as_bytes());
            (at, leading) = (at + thousands.len(), 0);
        }
        let digits = u32::from_le_bytes(THREE_DIGITS[whole % 1000]) >> (8 * leading);
        room[at..at + 4].copy_from_slice(&digits.to_le_bytes());
        at += 4 - leading;
        room[at] = b'0' + (decimals / 1_000_000) as u8;
        room[at + 1..at + 5].copy_from_slice(&THREE_DIGITS[decimals / 1000 % 1000]);
        room[at + 4..at + 8].copy_from_slice(&THREE_DIGITS[decimals % 1000]);
        at += if decimals % 1000 == 0 { 4 } else { 7 };
        room[at] = b' ';
        self.used += at + 1;
    }

    fn push_text(&mut self, text: &str) {
        self.bytes.truncate(self.used);
        self.bytes.extend_from_slice(text.as_bytes());
        self.used = self.bytes.len();
    }

    /// The line with its end in place of the last blank; the next number begins another.
    pub fn ended(&mut self) -> &[u8] {
        let length = std::mem::take(&mut self.used);
        match self.bytes[..length].last_mut() {
            Some(blank) => *blank = b'\n',
            None => return b"\n",
        }
        &self.bytes[..length]
    }
}

/// The three digits of each number below 1000, and a point.
const THREE_DIGITS: [[u8; 4]; 1000] = {
    let mut texts = [[b'.'; 4]; 1000];
    let mut n = 0;
    while n < 1000 {
        texts[n][0] = b'0' + (n / 100) as u8;
        texts[n][1] = b'0' + (n / 10 % 10) as u8;
        texts[n][2] = b'0' + (n % 10) as u8;
        n += 1;
    }
    texts
};

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn written(value: f64) -> String {
        let mut line = NumberLine::default();
        line.push(value);
        String::from_utf8(line.ended().to_vec()).unwrap()
    }

    proptest! {
        #[test]
        fn numbers_are_those_of_the_standard_library(small in -400.0f64..400.0, large in -1e12f64..1e12) {
            for value in [small, large, small.round(), small / 1e6, small * 1e3, large / 1e4] {
                let text = written(value);
                let trimmed = text.strip_suffix('\n').unwrap();
                let expected: f64 = format!("{value:.7}").parse().unwrap();
                let read: f64 = trimmed.parse().unwrap();
                // A tie may fall to the other side.
                prop_assert!((read - expected).abs() <= 1.01e-7 + value.abs() * 1e-15, "{value} {text}");
                prop_assert!((read - value).abs() <= 5.01e-8 + value.abs() * 1e-15, "{value} {text}");
                let decimals = trimmed.split_once('.').unwrap().1;
                prop_assert!(decimals.len() == 4 || decimals.len() == 7 && (!decimals.ends_with("000") || value.abs() > 1e8));
            }
        }
    }

    #[test]
    fn zero_has_no_sign_and_what_is_too_large_is_written_all_the_same() {
        assert_eq!(written(-1e-9), "0.0000\n");
        assert_eq!(written(-0.5), "-0.5000\n");
        assert_eq!(written(0.12345), "0.1234500\n");
        assert_eq!(written(99.99999999), "100.0000\n");
        assert_eq!(written(-1007.0000001), "-1007.0000001\n");
        assert_eq!(written(899_999_999.25), "899999999.2500\n");
        assert_eq!(written(1e15), "1000000000000000.0000000\n");
        assert_eq!(written(f64::NAN), "NaN\n");
    }

    #[test]
    fn lines_hold_their_numbers_apart_by_blanks_and_begin_anew() {
        let mut line = NumberLine::default();
        for value in [1.0, f64::INFINITY, -2.5] {
            line.push(value);
        }
        assert_eq!(line.ended(), b"1.0000 inf -2.5000\n");
        assert_eq!(line.ended(), b"\n");
        line.push(3.25);
        assert_eq!(line.ended(), b"3.2500\n");
    }
}
