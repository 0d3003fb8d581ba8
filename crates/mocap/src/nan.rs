//! Reads JSON with `NaN` and `Infinity`, as Python writes it, which standard JSON does not allow.

use std::borrow::Cow;

/// What stands for no number.
const WORDS: [&str; 4] = ["-Infinity", "Infinity", "-NaN", "NaN"];

/// What is written as `null` in place of a number that is not finite.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoNumber {
    /// The number itself.
    Alone,
    /// The innermost list that it is in: a place of which a coordinate is unknown is unknown.
    InList,
}

/// The text of JSON with `null` in place of `NaN` and `Infinity` outside of strings. O(text).
pub fn without_nan(text: &str, becomes: NoNumber) -> Cow<'_, str> {
    if !text.contains("NaN") && !text.contains("Infinity") {
        return Cow::Borrowed(text);
    }
    let mut plain = String::with_capacity(text.len());
    // Where the list that is open begins in what is written, if nothing but numbers is in it so far.
    let mut list = None;
    let mut has_none = false;
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let word = WORDS.iter().find(|word| rest.starts_with(**word));
        let length = match (c, word) {
            ('"', _) => string_length(rest),
            (_, Some(word)) => word.len(),
            _ => c.len_utf8(),
        };
        match c {
            '[' => (list, has_none) = (Some(plain.len()), false),
            '{' | '"' => list = None,
            _ => {}
        }
        match word {
            Some(_) => {
                plain.push_str("null");
                has_none = true;
            }
            None => plain.push_str(&rest[..length]),
        }
        if c == ']' {
            if let Some(start) = list.filter(|_| has_none && becomes == NoNumber::InList) {
                plain.truncate(start);
                plain.push_str("null");
            }
            list = None;
        }
        rest = &rest[length..];
    }
    Cow::Owned(plain)
}

/// Bytes of the string that `text` begins with, with its quotes.
fn string_length(text: &str) -> usize {
    let mut escaped = false;
    let end = text.bytes().enumerate().skip(1).find(|(_, byte)| {
        let ends = *byte == b'"' && !escaped;
        escaped = *byte == b'\\' && !escaped;
        ends
    });
    end.map_or(text.len(), |(at, _)| at + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_are_none_become_null() {
        for (text, alone, in_list) in [
            (
                r#"{"a":[NaN, 1,-Infinity]}"#,
                r#"{"a":[null, 1,null]}"#,
                r#"{"a":null}"#,
            ),
            (r#"[[1,2],[NaN,2]]"#, r#"[[1,2],[null,2]]"#, "[[1,2],null]"),
            (
                r#"{"x":NaN,"n":"NaN [\"NaN"}"#,
                r#"{"x":null,"n":"NaN [\"NaN"}"#,
                r#"{"x":null,"n":"NaN [\"NaN"}"#,
            ),
            ("[1,2]", "[1,2]", "[1,2]"),
            ("[NaN", "[null", "[null"),
            ("\"NaN", "\"NaN", "\"NaN"),
        ] {
            assert_eq!(without_nan(text, NoNumber::Alone), alone);
            assert_eq!(without_nan(text, NoNumber::InList), in_list);
        }
    }
}
