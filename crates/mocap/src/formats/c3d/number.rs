//! Number formats of the three processors for which C3D files exist.

/// Processor whose byte order and floating point a file uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Processor {
    /// Little-endian, IEEE 754.
    Intel,
    /// Little-endian integers, VAX F floating point.
    Dec,
    /// Big-endian, IEEE 754 (SGI, MIPS).
    Sgi,
}

impl Processor {
    pub(super) const ALL: [Processor; 3] = [Processor::Intel, Processor::Dec, Processor::Sgi];

    /// By the fourth byte of the parameter section.
    pub(super) fn of_byte(byte: u8) -> Option<Self> {
        match byte {
            84 => Some(Self::Intel),
            85 => Some(Self::Dec),
            86 => Some(Self::Sgi),
            _ => None,
        }
    }

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Intel => "Intel",
            Self::Dec => "DEC",
            Self::Sgi => "SGI",
        }
    }

    pub(super) fn u16(self, bytes: [u8; 2]) -> u16 {
        match self {
            Self::Intel | Self::Dec => u16::from_le_bytes(bytes),
            Self::Sgi => u16::from_be_bytes(bytes),
        }
    }

    pub(super) fn i16(self, bytes: [u8; 2]) -> i16 {
        self.u16(bytes) as i16
    }

    pub(super) fn f32(self, bytes: [u8; 4]) -> f64 {
        match self {
            Self::Intel => f64::from(f32::from_le_bytes(bytes)),
            Self::Sgi => f64::from(f32::from_be_bytes(bytes)),
            Self::Dec => vax(bytes),
        }
    }
}

/// VAX F: two little-endian words, the higher one first; a fraction of 1/2 to 1 and an exponent biased by 128.
/// An exponent of 0 is the number 0 or, with a sign, no number.
fn vax([b0, b1, b2, b3]: [u8; 4]) -> f64 {
    let bits = u32::from_be_bytes([b1, b0, b3, b2]);
    let (negative, exponent) = (bits >> 31 == 1, (bits >> 23 & 0xFF) as i32);
    if exponent == 0 {
        return if negative { f64::NAN } else { 0.0 };
    }
    let fraction = f64::from(bits & 0x7F_FFFF | 0x80_0000) / f64::from(1 << 24);
    let value = fraction * f64::powi(2.0, exponent - 128);
    if negative { -value } else { value }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vax_numbers_from_the_manual() {
        // 1.0 is a half times two: sign 0, exponent 129, fraction 0.
        for (value, bytes) in [
            (1.0, [0x80, 0x40, 0, 0]),
            (-1.0, [0x80, 0xC0, 0, 0]),
            (0.5, [0x00, 0x40, 0, 0]),
            (10.0, [0x20, 0x42, 0, 0]),
            (0.0, [0, 0, 0, 0]),
        ] {
            assert_eq!(Processor::Dec.f32(bytes), value);
        }
        assert!(Processor::Dec.f32([0, 0x80, 0, 0]).is_nan());
    }

    #[test]
    fn big_and_little_ends() {
        let bytes = 12.75f32.to_be_bytes();
        assert_eq!(Processor::Sgi.f32(bytes), 12.75);
        assert_eq!(Processor::Sgi.i16([0xFF, 0xFE]), -2);
        assert_eq!(Processor::Intel.i16([0xFE, 0xFF]), -2);
    }
}
