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

/// `'0'` eight times.
const ZEROS: u64 = 0x3030_3030_3030_3030;

/// The eight bytes at `at`, less `'0'` each, the first in the lowest place.
#[inline]
fn eight_at(text: &[u8], at: usize) -> Option<u64> {
    let bytes = text.get(at..at + 8)?.first_chunk::<8>()?;
    Some(u64::from_le_bytes(*bytes) ^ ZEROS)
}

/// Number of digits among eight such bytes before the first that is none: a byte over 9 carries into its highest bit when
/// 0x76 is added, and what that spoils lies behind it.
#[inline]
fn leading_digits(bytes: u64) -> usize {
    const OVER_9: u64 = 0x7676_7676_7676_7676;
    const HIGH: u64 = 0x8080_8080_8080_8080;
    (((bytes.wrapping_add(OVER_9) | bytes) & HIGH).trailing_zeros() / 8) as usize
}

/// The number that the first `count` (at most 8) of eight such bytes spell: neighbours are joined to pairs, those to
/// fours, those to eight.
#[inline]
fn spelt(bytes: u64, count: usize) -> u64 {
    if count == 0 {
        return 0;
    }
    // Digits move behind zeros.
    let digits = bytes << (64 - 8 * count);
    let pairs = (digits.wrapping_mul(10).wrapping_add(digits >> 8)) & 0x00FF_00FF_00FF_00FF;
    let fours = (pairs.wrapping_mul(100).wrapping_add(pairs >> 16)) & 0x0000_FFFF_0000_FFFF;
    (fours.wrapping_mul(10_000).wrapping_add(fours >> 32)) & 0xFFFF_FFFF
}

/// [`fixed`] for numbers of up to seven digits before and fifteen behind the point, with something behind them in the file: eight
/// bytes at once.
#[inline]
pub(super) fn quick(text: &[u8], pos: &mut usize) -> Option<f64> {
    let mut p = *pos;
    let negative = text.get(p) == Some(&b'-');
    p += usize::from(negative);
    let bytes = eight_at(text, p)?;
    let whole = leading_digits(bytes);
    if whole == 8 {
        return None;
    }
    let mut mantissa = spelt(bytes, whole);
    p += whole;
    let mut fraction = 0;
    if text.get(p) == Some(&b'.') {
        p += 1;
        let bytes = eight_at(text, p)?;
        fraction = leading_digits(bytes);
        mantissa = mantissa * WHOLE_POWERS[fraction] + spelt(bytes, fraction);
        p += fraction;
        if fraction == 8 {
            let bytes = eight_at(text, p)?;
            let more = leading_digits(bytes);
            if whole + 8 + more > 18 || more == 8 {
                return None;
            }
            mantissa = mantissa * WHOLE_POWERS[more] + spelt(bytes, more);
            p += more;
            fraction += more;
        }
    }
    let ends = text.get(p).is_none_or(|&b| b <= b' ');
    if !ends || whole + fraction == 0 || mantissa >= 1 << 53 {
        return None;
    }
    *pos = p;
    let magnitude = mantissa as f64 / POWERS[fraction];
    Some(if negative { -magnitude } else { magnitude })
}

/// Powers of ten up to eight digits.
const WHOLE_POWERS: [u64; 9] = [
    1,
    10,
    100,
    1_000,
    10_000,
    100_000,
    1_000_000,
    10_000_000,
    100_000_000,
];

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
        fn eight_digits_at_once_are_the_same_number(text in "-?[0-9]{0,9}\\.?[0-9]{0,17}[ \n\re.-]?[0-9. -]{0,12}") {
            let (mut at, mut expected_at) = (0, 0);
            if let Some(value) = quick(text.as_bytes(), &mut at) {
                prop_assert_eq!(Some(value.to_bits()), fixed(text.as_bytes(), &mut expected_at).map(f64::to_bits));
                prop_assert_eq!(at, expected_at);
            } else {
                prop_assert_eq!(at, 0);
            }
        }

        #[test]
        fn eight_digits_at_once_are_taken(text in "-?[0-9]{1,7}\\.[0-9]{1,8}") {
            let text = format!("{text} 0.0 0.0 0.0");
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
