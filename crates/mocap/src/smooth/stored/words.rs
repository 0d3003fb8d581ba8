//! Plain fields before the motion: lengths, names, numbers.

use crate::formats::{ParseError, Place};

/// Writes fields.
#[derive(Default)]
pub(super) struct Words {
    pub bytes: Vec<u8>,
}

/// A decimal with more digits after the point than this is kept in its eight bytes.
const MOST_DIGITS: u8 = 9;
const EIGHT_BYTES: u8 = 255;

impl Words {
    /// A number of at least 0, seven bits to a byte.
    pub fn natural(&mut self, mut value: u64) {
        while value >= 0x80 {
            self.bytes.push(value as u8 | 0x80);
            value >>= 7;
        }
        self.bytes.push(value as u8);
    }

    pub fn text(&mut self, text: &str) {
        self.natural(text.len() as u64);
        self.bytes.extend_from_slice(text.as_bytes());
    }

    /// A number, exactly: as a decimal of few digits where it is one, as most numbers out of files are.
    pub fn number(&mut self, value: f64) {
        for digits in 0..=MOST_DIGITS {
            let whole = (value * power(digits)).round() as i64;
            // To the bit: a negative 0 is not what its decimal would give.
            if whole.unsigned_abs() < 1_000_000_000_000
                && (whole as f64 / power(digits)).to_bits() == value.to_bits()
            {
                self.bytes.push(digits);
                return self.natural((whole << 1 ^ whole >> 63) as u64);
            }
        }
        self.bytes.push(EIGHT_BYTES);
        self.bytes.extend_from_slice(&value.to_le_bytes());
    }
}

fn power(digits: u8) -> f64 {
    f64::powi(10.0, i32::from(digits))
}

/// Reads fields.
pub(super) struct Fields<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Fields<'a> {
    /// Fields of `bytes` from byte `at` on.
    pub fn new(bytes: &'a [u8], at: usize) -> Self {
        Self { bytes, at }
    }

    /// Position of the next field.
    pub fn at(&self) -> usize {
        self.at
    }

    /// The rest of the bytes.
    pub fn rest(&self) -> &'a [u8] {
        &self.bytes[self.at..]
    }

    /// That the field before the present place is wrong.
    pub fn wrong(&self, expected: impl Into<String>, found: impl Into<String>) -> ParseError {
        ParseError::new(Place::Byte(self.at as u64), expected, found)
    }

    fn take(&mut self, count: usize, what: &str) -> Result<&'a [u8], ParseError> {
        let left = self.bytes.len() - self.at;
        if count > left {
            return Err(self.wrong(format!("{count} bytes of {what}"), format!("{left} bytes")));
        }
        let taken = &self.bytes[self.at..self.at + count];
        self.at += count;
        Ok(taken)
    }

    fn byte(&mut self, what: &str) -> Result<u8, ParseError> {
        Ok(self.take(1, what)?[0])
    }

    /// A little-endian number of `N` bytes, at most 8.
    ///
    /// # Errors
    /// The bytes end before it.
    pub fn word<const N: usize>(&mut self) -> Result<u64, ParseError> {
        let mut bytes = [0; 8];
        bytes[..N].copy_from_slice(self.take(N, "a number")?);
        Ok(u64::from_le_bytes(bytes))
    }

    pub fn natural(&mut self, what: &str) -> Result<u64, ParseError> {
        let mut value = 0u64;
        for shift in (0..64).step_by(7) {
            let byte = self.byte(what)?;
            value |= u64::from(byte & 0x7F) << shift;
            if byte & 0x80 == 0 {
                return Ok(value);
            }
        }
        Err(self.wrong(what, "a number of more than 64 bits"))
    }

    /// A whole number from 0 to `most`; `what` names it in errors.
    ///
    /// # Errors
    /// The bytes end within it, or it is larger than `most`.
    pub fn up_to(&mut self, most: usize, what: &str) -> Result<usize, ParseError> {
        let found = self.natural(what)?;
        usize::try_from(found)
            .ok()
            .filter(|&found| found <= most)
            .ok_or_else(|| self.wrong(format!("{what}, at most {most}"), found.to_string()))
    }

    pub fn text(&mut self, most: usize, what: &str) -> Result<String, ParseError> {
        let length = self.up_to(most, what)?;
        let bytes = self.take(length, what)?.to_vec();
        String::from_utf8(bytes).map_err(|_| self.wrong(what, "bytes that are no UTF-8"))
    }

    /// A finite number.
    pub fn number(&mut self, what: &str) -> Result<f64, ParseError> {
        let value = match self.byte(what)? {
            digits @ 0..=MOST_DIGITS => {
                let folded = self.natural(what)?;
                ((folded >> 1) as i64 ^ -((folded & 1) as i64)) as f64 / power(digits)
            }
            EIGHT_BYTES => f64::from_bits(self.word::<8>()?),
            other => return Err(self.wrong(what, format!("a number of kind {other}"))),
        };
        if value.is_finite() {
            Ok(value)
        } else {
            Err(self.wrong(what, value.to_string()))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn numbers_come_back_to_the_bit(whole in -1_000_000_000i64..1_000_000_000, digits in 0i32..14, any in any::<f64>()) {
            for value in [whole as f64 / f64::powi(10.0, digits), any, -0.0, 0.1 + 0.2] {
                let mut words = Words::default();
                words.number(value);
                let read = Fields::new(&words.bytes, 0).number("a number");
                match value.is_finite() {
                    true => prop_assert_eq!(read.unwrap().to_bits(), value.to_bits()),
                    false => prop_assert!(read.is_err()),
                }
            }
        }
    }

    #[test]
    fn short_decimals_are_short() {
        let mut words = Words::default();
        words.number(0.162767);
        assert!(words.bytes.len() <= 4, "{:?}", words.bytes);
    }
}
