//! An adaptive binary range coder, and the coding of whole numbers with it. Used by the stored forms of clips and feature rows.
//!
//! The coder narrows a range bit by bit and carries into bytes already made (Martin, *Range encoding: an algorithm for
//! removing redundancy from a digitised message*, 1979); chances follow what comes as in Howard and Vitter, *Arithmetic
//! coding for data compression*, 1994. Writing and reading go through the same functions, so that they cannot drift
//! apart.

/// Probability of a 0, of 4096.
pub type Chance = u16;

const CHANCE_BITS: u32 = 12;
const EVEN: Chance = 1 << (CHANCE_BITS - 1);
/// Rate of adaptation of probabilities; motions are short.
const PATIENCE: u32 = 4;
/// A 1 is next to never seen.
const FEW: Chance = (1 << CHANCE_BITS) - 32;
const LEAST_RANGE: u32 = 1 << 24;
/// Zeros that a reader adds to the end.
const TAKEN_FOR_GRANTED: usize = 4;

/// Writes bits, or reads them: a writer returns what it was given, a reader pays it no heed.
pub trait Coder {
    /// A bit that is foreseen by its chance.
    fn bit(&mut self, chance: &mut Chance, bit: bool) -> bool;
    /// A bit that nothing is known of.
    fn even(&mut self, bit: bool) -> bool;
    /// True if a reader has asked for more than there was.
    fn is_beyond_end(&self) -> bool;
}

fn learn(chance: &mut Chance, bit: bool) {
    match bit {
        false => *chance += ((1 << CHANCE_BITS) - *chance) >> PATIENCE,
        true => *chance -= *chance >> PATIENCE,
    }
}

/// Range coder that writes bits with given probabilities.
pub struct Writer {
    low: u64,
    range: u32,
    /// The byte that a carry may still raise, and how many 255s follow it.
    cache: u8,
    pending: u64,
    out: Vec<u8>,
}

impl Default for Writer {
    fn default() -> Self {
        Self::new()
    }
}

impl Writer {
    pub fn new() -> Self {
        Self {
            low: 0,
            range: u32::MAX,
            cache: 0,
            pending: 0,
            out: Vec::new(),
        }
    }

    fn narrow(&mut self, bound: u32, bit: bool) {
        if bit {
            self.low += u64::from(bound);
            self.range -= bound;
        } else {
            self.range = bound;
        }
        while self.range < LEAST_RANGE {
            self.range <<= 8;
            self.shift();
        }
    }

    fn shift(&mut self) {
        let carry = (self.low >> 32) as u8;
        if self.low < 0xFF00_0000 || carry > 0 {
            self.out.push(self.cache.wrapping_add(carry));
            for _ in 0..std::mem::take(&mut self.pending) {
                self.out.push(0xFFu8.wrapping_add(carry));
            }
            self.cache = (self.low >> 24) as u8;
        } else {
            self.pending += 1;
        }
        self.low = (self.low & 0x00FF_FFFF) << 8;
    }

    /// All bytes. Up to [`TAKEN_FOR_GRANTED`] zeros at the end are left out.
    pub fn finish(mut self) -> Vec<u8> {
        for _ in 0..5 {
            self.shift();
        }
        // The first byte is the 0 that the cache began with.
        self.out.remove(0);
        for _ in 0..TAKEN_FOR_GRANTED {
            self.out.pop_if(|last| *last == 0);
        }
        self.out
    }
}

impl Coder for Writer {
    fn bit(&mut self, chance: &mut Chance, bit: bool) -> bool {
        self.narrow((self.range >> CHANCE_BITS) * u32::from(*chance), bit);
        learn(chance, bit);
        bit
    }

    fn even(&mut self, bit: bool) -> bool {
        self.narrow(self.range >> 1, bit);
        bit
    }

    fn is_beyond_end(&self) -> bool {
        false
    }
}

/// Reads what [`Writer`] wrote, with the same probabilities.
pub struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
    code: u32,
    range: u32,
}

impl<'a> Reader<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        let mut reader = Self {
            bytes,
            at: 0,
            code: 0,
            range: u32::MAX,
        };
        for _ in 0..4 {
            reader.next_byte();
        }
        reader
    }

    fn next_byte(&mut self) {
        let byte = self.bytes.get(self.at).copied().unwrap_or(0);
        self.at += 1;
        self.code = self.code << 8 | u32::from(byte);
    }

    fn narrow(&mut self, bound: u32) -> bool {
        let bit = self.code >= bound;
        if bit {
            self.code -= bound;
            self.range -= bound;
        } else {
            self.range = bound;
        }
        self.widen();
        bit
    }

    fn widen(&mut self) {
        while self.range < LEAST_RANGE {
            self.range <<= 8;
            self.next_byte();
        }
    }
}

impl Coder for Reader<'_> {
    fn bit(&mut self, chance: &mut Chance, _: bool) -> bool {
        let bit = self.narrow((self.range >> CHANCE_BITS) * u32::from(*chance));
        learn(chance, bit);
        bit
    }

    fn even(&mut self, _: bool) -> bool {
        // No branch: the bit is as likely 0 as 1, so that every second prediction would be wrong.
        let bound = self.range >> 1;
        let bit = self.code >= bound;
        let mask = u32::from(bit).wrapping_neg();
        self.code -= bound & mask;
        self.range = bound + (self.range & 1 & mask);
        self.widen();
        bit
    }

    fn is_beyond_end(&self) -> bool {
        self.at > self.bytes.len() + TAKEN_FOR_GRANTED
    }
}

/// Foresees a flag.
pub struct Flag(Chance);

impl Default for Flag {
    fn default() -> Self {
        Self(EVEN)
    }
}

impl Flag {
    pub fn code(&mut self, coder: &mut impl Coder, bit: bool) -> bool {
        coder.bit(&mut self.0, bit)
    }
}

/// Foresees whole numbers below 2^63 in absolute value: how many binary digits, then the digits, the first of them by
/// its chance.
pub struct Whole {
    digits: [Chance; 64],
    /// True if `digits` says of each number of digits whether there are more, false if it is a tree over 0 to 63.
    is_counted: bool,
    second: [Chance; 64],
}

impl Default for Whole {
    fn default() -> Self {
        Self {
            digits: [EVEN; 64],
            is_counted: false,
            second: [EVEN; 64],
        }
    }
}

impl Whole {
    /// Foresees from the start that few numbers have 16 binary digits or more: short series need not learn it.
    pub fn of_few_digits() -> Self {
        let mut whole = Self::default();
        whole.digits[1] = FEW;
        whole.digits[2] = FEW;
        whole
    }

    /// Counts binary digits one by one: numbers of few digits take fewer steps.
    pub fn counted() -> Self {
        Self {
            is_counted: true,
            ..Self::default()
        }
    }

    /// The number of binary digits, below 64.
    fn digits(&mut self, coder: &mut impl Coder, digits: usize) -> usize {
        if self.is_counted {
            let mut count = 0;
            while count < 63 && coder.bit(&mut self.digits[count], digits > count) {
                count += 1;
            }
            return count;
        }
        let mut node = 1;
        for level in (0..6).rev() {
            let bit = coder.bit(&mut self.digits[node], digits >> level & 1 == 1);
            node = node << 1 | usize::from(bit);
        }
        node - 64
    }

    /// A number of at least 0.
    pub fn natural(&mut self, coder: &mut impl Coder, value: u64) -> u64 {
        let digits = (u64::BITS - value.leading_zeros()) as usize;
        let digits = self.digits(coder, digits);
        if digits < 2 {
            return digits as u64;
        }
        let mut found = 1;
        for level in (0..digits - 1).rev() {
            let bit = value >> level & 1 == 1;
            let bit = match level == digits - 2 {
                true => coder.bit(&mut self.second[digits], bit),
                false => coder.even(bit),
            };
            found = found << 1 | u64::from(bit);
        }
        found
    }

    /// A number of either sign.
    pub fn signed(&mut self, coder: &mut impl Coder, value: i64) -> i64 {
        let size = self.natural(coder, value.unsigned_abs()) as i64;
        if size == 0 {
            return 0;
        }
        // Negation in two's complement where the mask is all ones, the number itself where it is 0.
        let mask = -i64::from(coder.even(value < 0));
        (size ^ mask) - mask
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn counted_numbers_are_read(values in prop::collection::vec((any::<i64>(), 0u32..64), 0..300)) {
            let numbers = || values.iter().map(|(value, shift)| (value >> shift).max(-i64::MAX));
            let (mut writer, mut whole) = (Writer::new(), Whole::counted());
            numbers().for_each(|number| {
                whole.signed(&mut writer, number);
            });
            let bytes = writer.finish();
            let (mut reader, mut whole) = (Reader::new(&bytes), Whole::counted());
            for number in numbers() {
                prop_assert_eq!(whole.signed(&mut reader, 0), number);
            }
            prop_assert!(!reader.is_beyond_end());
        }

        #[test]
        fn what_is_written_is_read(values in prop::collection::vec((any::<i64>(), 0u32..63, any::<bool>()), 0..300)) {
            let values: Vec<(i64, bool)> = values.into_iter().map(|(v, s, b)| (v >> s >> 1, b)).collect();
            let (mut writer, mut whole, mut flag) = (Writer::new(), Whole::default(), Flag::default());
            for &(value, bit) in &values {
                whole.signed(&mut writer, value);
                flag.code(&mut writer, bit);
            }
            let bytes = writer.finish();
            let (mut reader, mut whole, mut flag) = (Reader::new(&bytes), Whole::default(), Flag::default());
            for &(value, bit) in &values {
                prop_assert_eq!(whole.signed(&mut reader, 0), value);
                prop_assert_eq!(flag.code(&mut reader, false), bit);
            }
            prop_assert!(!reader.is_beyond_end());
        }

        #[test]
        fn any_bytes_give_numbers(bytes in prop::collection::vec(any::<u8>(), 0..40)) {
            let (mut reader, mut whole) = (Reader::new(&bytes), Whole::default());
            let mut read = 0;
            while !reader.is_beyond_end() && read < 1_000_000 {
                whole.signed(&mut reader, 0);
                read += 1;
            }
        }
    }

    #[test]
    fn what_repeats_costs_next_to_nothing() {
        let (mut writer, mut whole) = (Writer::new(), Whole::default());
        for _ in 0..1000 {
            whole.signed(&mut writer, 0);
        }
        assert!(writer.finish().len() < 80);
    }
}
