//! Reads incomplete JSON documents, as a stopped recorder leaves them.

use serde_json::Value;

use super::{Limits, ParseError, Place, Warning};

/// Reads a document; one that breaks off within a list of at least two whole elements is read up to the last of them, with
/// a warning. O(bytes).
///
/// # Errors
/// The line, and what is wrong there.
pub(super) fn read(bytes: &[u8], warnings: &mut Vec<Warning>) -> Result<Value, ParseError> {
    let error = match serde_json::from_slice(bytes) {
        Ok(document) => return Ok(document),
        Err(error) => error,
    };
    let saved = error.is_eof().then(|| closed(bytes)).flatten();
    if let Some(document) = saved.and_then(|text| serde_json::from_slice(&text).ok()) {
        let text =
            "the document is incomplete and is read up to the last complete element of its list";
        warnings.push(Warning::new(line(&error), text));
        return Ok(document);
    }
    Err(located(&error))
}

/// What is left of `limits` beside the parsed document. O(bytes).
///
/// # Errors
/// The document takes more memory than there is.
pub(super) fn limits_beside(bytes: &[u8], limits: &Limits) -> Result<Limits, ParseError> {
    /// A node of an object's tree, with room for eleven fields.
    const OBJECT: usize = 700;
    /// An element of a list, of which up to half of the room is not used; a text with what the allocator takes.
    const VALUE: usize = 2 * size_of::<Value>();
    if limits.memory == usize::MAX {
        return Ok(*limits);
    }
    let memory = bytes.iter().map(|byte| match byte {
        b'{' => OBJECT,
        b',' | b'[' | b':' => VALUE,
        _ => 1,
    });
    limits.without(memory.sum())
}

/// An error of the parser at its line.
pub(super) fn located(error: &serde_json::Error) -> ParseError {
    ParseError::new(line(error), "JSON", error.to_string())
}

fn line(error: &serde_json::Error) -> Place {
    Place::Line(u64::try_from(error.line()).unwrap_or(0))
}

/// The document up to the last whole element of the outermost list that has two, and closed there.
fn closed(bytes: &[u8]) -> Option<Vec<u8>> {
    const LEAST: usize = 2;
    let mut open: Vec<u8> = Vec::new();
    // For each open list or object: its whole elements that are lists or objects, and where the last one ends.
    let mut whole: Vec<(usize, usize)> = Vec::new();
    let (mut in_string, mut escaped) = (false, false);
    for (at, byte) in bytes.iter().enumerate() {
        match byte {
            _ if escaped => escaped = false,
            b'\\' if in_string => escaped = true,
            b'"' => in_string = !in_string,
            _ if in_string => {}
            b'[' | b'{' => {
                open.push(*byte);
                whole.push((0, 0));
            }
            b']' | b'}' => {
                open.pop();
                whole.pop();
                if let Some((count, end)) = whole.last_mut() {
                    (*count, *end) = (*count + 1, at + 1);
                }
            }
            _ => {}
        }
    }
    let is_list = |depth: &usize| open[*depth] == b'[' && whole[*depth].0 >= LEAST;
    let depth = (0..open.len()).find(is_list)?;
    let mut text = bytes[..whole[depth].1].to_vec();
    let closing = open[..=depth].iter().rev();
    text.extend(closing.map(|byte| if *byte == b'[' { b']' } else { b'}' }));
    Some(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_breaks_off_is_read_to_its_last_whole_element() {
        let text = r#"{"fps": 30, "note": "a ] \" {", "frames": [[[1, 2], [3, 4]], [[5, 6], [7, 8]], [[9, 1], [2, 3]]]}"#;
        let whole: Value = serde_json::from_str(text).unwrap();
        for end in 0..text.len() {
            let mut warnings = Vec::new();
            let Ok(document) = read(&text.as_bytes()[..end], &mut warnings) else {
                continue;
            };
            assert_eq!(document["fps"], 30);
            let (found, all) = (document["frames"].as_array().unwrap(), &whole["frames"]);
            assert!(
                found
                    .iter()
                    .enumerate()
                    .all(|(f, frame)| f == 0 || *frame == all[f]),
                "{document}"
            );
            assert_eq!(warnings.len(), 1);
        }
        let mut warnings = Vec::new();
        let cut = &text.as_bytes()[..text.len() - 4];
        assert_eq!(
            read(cut, &mut warnings).unwrap()["frames"]
                .as_array()
                .unwrap()
                .len(),
            2
        );
        let mistake = read(b"[[1, 2], [3, 4], x", &mut warnings).unwrap_err();
        assert_eq!(mistake.at, Place::Line(1));
    }
}
