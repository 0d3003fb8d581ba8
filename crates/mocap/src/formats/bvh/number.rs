//! Numbers as BVH files spell them.

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

/// Reads the number at `text[*pos]` that a blank, a line end or the end follows, and moves past it; `None`, without moving,
/// leaves the token to a closer look.
#[inline]
pub(super) fn next(text: &[u8], pos: &mut usize) -> Option<f64> {
    let (value, length) = fast_float2::parse_partial::<f64, _>(&text[*pos..]).ok()?;
    let end = *pos + length;
    if text.get(end).is_some_and(|&byte| byte > b' ') {
        return None;
    }
    *pos = end;
    Some(usable(value))
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

    proptest! {
        #[test]
        fn a_number_within_a_row_is_the_token(text in "-?[0-9]{0,9}\\.?[0-9]{0,17}[ \n\re.-]?[0-9. -]{0,12}") {
            let mut at = 0;
            match next(text.as_bytes(), &mut at) {
                Some(value) => {
                    let token = text.split([' ', '\n', '\r']).next().unwrap_or_default();
                    prop_assert_eq!(Some(value.to_bits()), parse(token.as_bytes()).map(f64::to_bits));
                    prop_assert_eq!(at, token.len());
                }
                None => prop_assert_eq!(at, 0),
            }
        }

        #[test]
        fn decimals_are_read_to_the_last_bit(text in "-?[0-9]{1,9}\\.[0-9]{1,12}") {
            let mut at = 0;
            let expected: f64 = text.parse().unwrap();
            prop_assert_eq!(next(text.as_bytes(), &mut at).map(f64::to_bits), Some(expected.to_bits()));
        }

        #[test]
        fn a_token_agrees_with_the_standard_library(text in "[-+]?[0-9]{0,30}\\.?[0-9]{0,30}([eE][-+]?[0-9]{1,3})?") {
            let expected = text.parse::<f64>().ok().map(usable);
            prop_assert_eq!(parse(text.as_bytes()).map(f64::to_bits), expected.map(f64::to_bits));
        }

        #[test]
        fn any_bytes_are_survived(token in proptest::collection::vec(any::<u8>(), 0..20)) {
            let (mut pos, mut out) = (0, Vec::new());
            let _ = (next(&token, &mut pos), parse(&token), parse_with_comma(&token));
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
