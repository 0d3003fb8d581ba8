//! Numbers as BVH files spell them.

/// Exact powers of ten: every one up to 10^22 is a double.
const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

/// No length or angle is larger: what is, is damage, and would overflow further on.
const LARGEST: f64 = 1e12;

/// True if `byte` separates tokens within a line. Control characters do: NUL padding and Ctrl-Z occur.
pub(super) fn is_blank(byte: u8) -> bool {
    byte <= b' ' && !is_newline(byte)
}

/// True if `byte` ends a line (CR alone does too).
pub(super) fn is_newline(byte: u8) -> bool {
    byte == b'\n' || byte == b'\r'
}

/// Bytes that are looked at together.
const WORD: usize = 16;
/// One in each byte of a word.
const ONES: u128 = u128::MAX / 255;
/// The highest bit of each byte.
const HIGH_BITS: u128 = 0x80 * ONES;

/// Index of the first byte of `word` (its lowest is the first) whose highest bit is set in `marks`; [`WORD`] if there is none.
#[inline]
fn first(marks: u128) -> usize {
    (marks.trailing_zeros() / 8) as usize
}

/// Marks the blanks and line ends: bytes up to `' '`.
#[inline]
fn blanks(word: u128) -> u128 {
    // With the highest bit set, no byte borrows from the next; those of 0x80 and more are no blanks.
    !(((word | HIGH_BITS) - 0x21 * ONES) | word) & HIGH_BITS
}

/// Marks the bytes that are zero; above the first, others too.
#[inline]
fn zeros(word: u128) -> u128 {
    word.wrapping_sub(ONES) & !word & HIGH_BITS
}

/// The number whose digits are these bytes, the first in the lowest place: neighbours are joined to pairs, those to fours, those
/// to eight.
#[inline]
fn spelt(digits: u64) -> u64 {
    let pairs = (digits.wrapping_mul(10).wrapping_add(digits >> 8)) & 0x00FF_00FF_00FF_00FF;
    let fours = (pairs.wrapping_mul(100).wrapping_add(pairs >> 16)) & 0x0000_FFFF_0000_FFFF;
    (fours.wrapping_mul(10_000).wrapping_add(fours >> 32)) & 0xFFFF_FFFF
}

/// [`fixed`] for numbers of less than sixteen characters with something behind them in the file: their bytes are looked at together,
/// and where the number ends is known before its value is.
#[inline]
pub(super) fn quick(text: &[u8], pos: &mut usize) -> Option<f64> {
    let word = u128::from_le_bytes(*text.get(*pos..)?.first_chunk::<WORD>()?);
    let length = first(blanks(word));
    if length == WORD || length == 0 {
        return None;
    }
    let is_negative = word as u8 == b'-';
    // Digits as their values, what stands before them as zeros, the last in the highest byte.
    let signless = if is_negative {
        word & !0xFF | u128::from(b'0')
    } else {
        word
    };
    let digits = (signless ^ (u128::from(b'0') * ONES)) << (8 * (WORD - length));
    let point = first(zeros(digits ^ (u128::from(b'.' ^ b'0') * ONES)));
    let (digits, fraction) = match point {
        WORD => (digits, 0),
        point => {
            // What stands before the point moves to its place.
            let below = (1 << (8 * point)) - 1;
            let above = !below << 8;
            (((digits & below) << 8) | (digits & above), WORD - 1 - point)
        }
    };
    let count = length - usize::from(is_negative) - usize::from(point < WORD);
    let all_digits = (digits.wrapping_add(0x76 * ONES) | digits) & HIGH_BITS == 0;
    let mantissa = spelt(digits as u64) * 100_000_000 + spelt((digits >> 64) as u64);
    // Up to twelve digits before the point are below LARGEST; fifteen in all, of which there are never more, below 2^53.
    if !all_digits || count == 0 || count - fraction > 12 {
        return None;
    }
    *pos += length;
    let magnitude = mantissa as f64 / POWERS[fraction];
    Some(if is_negative { -magnitude } else { magnitude })
}

/// Reads a plain decimal (`-12.0345`) at `text[*pos]` that a blank, a line end or the end follows, and moves past
/// it; `None`, without moving, leaves the token to [`parse`].
///
/// Exact: a mantissa below 2^53 and a power of ten up to 10^22 are both doubles, and one division of doubles
/// rounds correctly (Clinger, *How to Read Floating Point Numbers Accurately*, 1990).
#[inline]
pub(super) fn fixed(text: &[u8], pos: &mut usize) -> Option<f64> {
    let mut p = *pos;
    let negative = text.get(p) == Some(&b'-');
    p += usize::from(negative);
    let start = p;
    let mut mantissa = 0u64;
    let whole = digits(text, &mut p, &mut mantissa);
    let mut fraction = 0;
    if text.get(p) == Some(&b'.') {
        p += 1;
        fraction = digits(text, &mut p, &mut mantissa);
    }
    let ends = text.get(p).is_none_or(|&b| b <= b' ');
    // Up to 19 digits cannot overflow the mantissa; more were wrapped around and are left to the slow path.
    if !ends || whole + fraction == 0 || p - start > 19 || mantissa >= 1 << 53 {
        return None;
    }
    *pos = p;
    let magnitude = mantissa as f64 / POWERS[fraction];
    Some(usable(if negative { -magnitude } else { magnitude }))
}

#[inline]
fn digits(text: &[u8], p: &mut usize, mantissa: &mut u64) -> usize {
    let start = *p;
    while let Some(digit) = text
        .get(*p)
        .map(|b| b.wrapping_sub(b'0'))
        .filter(|&d| d < 10)
    {
        *mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(digit));
        *p += 1;
    }
    *p - start
}

/// The value of one token; NaN stands for a number that is spelled but has no use: `NaN`, `-nan(ind)`,
/// `-1.#IND`, infinities and magnitudes over 10^12. `None`: not a number.
pub(super) fn parse(token: &[u8]) -> Option<f64> {
    if let Ok(value) = fast_float2::parse::<f64, _>(token) {
        return Some(usable(value));
    }
    is_not_a_number(token).then_some(f64::NAN)
}

/// `value`, or NaN if it has no use.
fn usable(value: f64) -> f64 {
    if value.abs() <= LARGEST {
        value
    } else {
        f64::NAN
    }
}

/// True if C runtimes spell a NaN or an infinity like this.
fn is_not_a_number(token: &[u8]) -> bool {
    let lower = token.to_ascii_lowercase();
    let bare = lower
        .strip_prefix(b"-")
        .or(lower.strip_prefix(b"+"))
        .unwrap_or(&lower);
    let tail = |prefix: &[u8]| bare.strip_prefix(prefix).map(<[u8]>::to_vec);
    let parenthesised = |rest: &[u8]| rest.first() == Some(&b'(') && rest.last() == Some(&b')');
    if let Some(rest) = tail(b"nan") {
        return rest.is_empty() || parenthesised(&rest);
    }
    // Microsoft's: 1.#IND00, 1.#QNAN, 1.#SNAN, 1.#INF.
    bare.first().is_some_and(u8::is_ascii_digit)
        && [&b".#ind"[..], b".#qnan", b".#snan", b".#inf"]
            .iter()
            .any(|mark| bare[1..].starts_with(mark))
}

/// The value of a token with a decimal comma (`-1,25`).
pub(super) fn parse_with_comma(token: &[u8]) -> Option<f64> {
    let comma = token.iter().position(|&b| b == b',')?;
    if token.contains(&b'.') || token[comma + 1..].contains(&b',') {
        return None;
    }
    let mut pointed = token.to_vec();
    pointed[comma] = b'.';
    parse(&pointed)
}

/// Splits numbers written without a blank between them, `0.0-7.5`, at each sign that follows a digit or point;
/// appends their values to `out`. `None`, with `out` as it was, if the parts are not all numbers.
pub(super) fn parse_glued(token: &[u8], out: &mut Vec<f64>) -> Option<()> {
    if token.is_empty() {
        return None;
    }
    let before = out.len();
    let mut start = 0;
    for p in 1..=token.len() {
        let splits = p == token.len()
            || (matches!(token[p], b'-' | b'+')
                && (token[p - 1].is_ascii_digit() || token[p - 1] == b'.'));
        if splits {
            let Some(value) = parse(&token[start..p]) else {
                out.truncate(before);
                return None;
            };
            out.push(value);
            start = p;
        }
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn read_fixed(text: &str) -> Option<f64> {
        let mut pos = 0;
        let value = fixed(text.as_bytes(), &mut pos)?;
        assert_eq!(pos, text.len());
        Some(value)
    }

    proptest! {
        #[test]
        fn plain_decimals_are_read_to_the_last_bit(text in "-?[0-9]{0,9}\\.?[0-9]{0,12}") {
            if let Some(value) = read_fixed(&text) {
                prop_assert_eq!(value.to_bits(), usable(text.parse().unwrap()).to_bits());
            }
        }

        #[test]
        fn characters_read_together_are_the_same_number(text in "-?[0-9]{0,9}\\.?[0-9]{0,17}[ \n\re.-]?[0-9. -]{0,12}") {
            let (mut at, mut expected_at) = (0, 0);
            if let Some(value) = quick(text.as_bytes(), &mut at) {
                prop_assert_eq!(Some(value.to_bits()), fixed(text.as_bytes(), &mut expected_at).map(f64::to_bits));
                prop_assert_eq!(at, expected_at);
            } else {
                prop_assert_eq!(at, 0);
            }
        }

        #[test]
        fn characters_read_together_are_taken(text in "-?[0-9]{1,4}\\.[0-9]{1,9}") {
            let text = format!("{text} 0.0 0.0 0.0 0.0");
            prop_assert!(quick(text.as_bytes(), &mut 0).is_some());
        }

        #[test]
        fn the_fast_path_takes_what_files_hold(text in "-?[0-9]{1,4}\\.[0-9]{1,10}") {
            prop_assert!(read_fixed(&text).is_some());
        }

        #[test]
        fn the_slow_path_agrees_with_the_standard_library(text in "[-+]?[0-9]{0,30}\\.?[0-9]{0,30}([eE][-+]?[0-9]{1,3})?") {
            let expected = text.parse::<f64>().ok().map(usable);
            prop_assert_eq!(parse(text.as_bytes()).map(f64::to_bits), expected.map(f64::to_bits));
        }

        #[test]
        fn any_bytes_are_survived(token in proptest::collection::vec(any::<u8>(), 0..20)) {
            let (mut pos, mut out) = (0, Vec::new());
            let _ = (fixed(&token, &mut pos), parse(&token), parse_with_comma(&token));
            let _ = parse_glued(&token, &mut out);
            prop_assert!(pos <= token.len());
        }
    }

    #[test]
    fn spellings_seen_in_files() {
        for (text, value) in [
            (".0083333", 0.0083333),
            ("-9.93923e-017", -9.93923e-17),
            ("-4.0020632E-7", -4.0020632e-7),
            ("5.", 5.0),
        ] {
            assert_eq!(parse(text.as_bytes()), Some(value), "{text}");
        }
        for text in [
            "NaN",
            "nan",
            "-nan",
            "-nan(ind)",
            "nan(0x8)",
            "inf",
            "-INF",
            "Infinity",
            "1.#INF",
            "-1.#IND",
            "1.#QNAN0",
            "1e400",
        ] {
            assert!(parse(text.as_bytes()).is_some_and(f64::is_nan), "{text}");
        }
        for text in [
            "", "-", ".", "x", "1.2x", "0x10", "nana", "1,5", "1.#", "e5",
        ] {
            assert_eq!(parse(text.as_bytes()), None, "{text}");
        }
    }

    #[test]
    fn glued_numbers_come_apart_at_their_signs() {
        let mut out = Vec::new();
        assert_eq!(parse_glued(b"0.0-7.5094748", &mut out), Some(()));
        assert_eq!(parse_glued(b"-1e-3+2E+1-.5", &mut out), Some(()));
        assert_eq!(out, [0.0, -7.5094748, -1e-3, 20.0, -0.5]);
        assert_eq!(parse_glued(b"1-x", &mut out), None);
        assert_eq!(parse_glued(b"", &mut out), None);
        assert_eq!(out.len(), 5);
    }

    #[test]
    fn a_decimal_comma_is_not_a_list() {
        assert_eq!(parse_with_comma(b"-1,25"), Some(-1.25));
        assert_eq!(parse_with_comma(b"1,2,3"), None);
        assert_eq!(parse_with_comma(b"1.0,2"), None);
    }
}
