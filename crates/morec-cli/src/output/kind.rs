//! Recognises the kind of an existing file by its first bytes, for messages.

use morec::formats::probe::probe;

/// An SQLite database, of morec or another program.
pub const DATABASE: &str = "an SQLite database";

/// Kind of a file that begins so; `None` for an empty one.
pub fn of(head: &[u8]) -> Option<&'static str> {
    if head.is_empty() {
        return None;
    }
    if head.starts_with(b"SQLite format 3\0") {
        return Some(DATABASE);
    }
    // The length of the header in JSON, then the header: the container of indexes.
    if head.get(8) == Some(&b'{') && head[4..8] == [0; 4] {
        return Some("an index");
    }
    let text = text(head);
    if let Some(kind) = text.and_then(of_markup) {
        return Some(kind);
    }
    match probe(head, "") {
        Ok(format) => Some(format.noun()),
        Err(_) => Some(text.map_or("a file of another kind", of_text)),
    }
}

/// The head as text, without a sign that was cut at its end.
fn text(head: &[u8]) -> Option<&str> {
    let text = match std::str::from_utf8(head) {
        Ok(text) => text,
        Err(error) if error.error_len().is_none() => {
            std::str::from_utf8(&head[..error.valid_up_to()]).ok()?
        }
        Err(_) => return None,
    };
    (!text.contains('\0')).then_some(text)
}

fn of_markup(text: &str) -> Option<&'static str> {
    let text = text.trim_start_matches('\u{feff}').trim_start();
    if text.starts_with(['{', '[']) {
        return Some("JSON");
    }
    if !text.starts_with('<') {
        return None;
    }
    let text = text.to_ascii_lowercase();
    let kinds = [
        ("<html", "a page of HTML"),
        ("<svg", "an SVG picture"),
        ("<annotation_document", "an ELAN file"),
    ];
    let found = kinds.into_iter().find(|(tag, _)| text.contains(tag));
    Some(found.map_or("XML", |(_, kind)| kind))
}

fn of_text(text: &str) -> &'static str {
    let header = text.lines().next().unwrap_or_default();
    if header.contains('\t') || header.starts_with("file,") || header.starts_with("clip,") {
        "a table"
    } else {
        "text"
    }
}
