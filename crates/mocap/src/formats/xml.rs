//! XML for readers: text of any encoding, errors with their place, elements by name.

use std::borrow::Cow;

use roxmltree::{Document, Node, ParsingOptions};

use super::{Limits, ParseError, Place};

/// UTF-8; producers of other encodings keep them to names and comments.
///
/// # Errors
/// Binary content.
pub(super) fn text_of(bytes: &[u8]) -> Result<Cow<'_, str>, ParseError> {
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    if bytes.contains(&0) {
        return Err(ParseError::new(Place::File, "XML text", "binary content"));
    }
    Ok(match std::str::from_utf8(bytes) {
        Ok(text) => text.into(),
        Err(_) => encoding_rs::WINDOWS_1252.decode(bytes).0,
    })
}

/// What is left of `limits` beside the parsed document. O(bytes).
///
/// # Errors
/// The document takes more memory than there is.
pub(super) fn limits_beside(text: &str, limits: &Limits) -> Result<Limits, ParseError> {
    /// For each element, text or attribute, in lists of which up to half of the room is not used.
    const NODE: usize = 160;
    // An element has two of these, or one and an end.
    let nodes = text.bytes().filter(|b| matches!(b, b'<' | b'='));
    limits.without(nodes.count().saturating_mul(NODE))
}

/// A document of at most `most_nodes` nodes.
///
/// # Errors
/// Line and column of what is not well-formed, or too many nodes.
pub(super) fn parse(text: &str, most_nodes: usize) -> Result<Document<'_>, ParseError> {
    let options = ParsingOptions {
        allow_dtd: true,
        nodes_limit: u32::try_from(most_nodes).unwrap_or(u32::MAX),
        ..ParsingOptions::default()
    };
    // Blank lines above the declaration are a fault that producers leave.
    let text = match text.trim_start().starts_with("<?xml") {
        true => text.trim_start(),
        false => text,
    };
    Document::parse_with_options(text, options).map_err(|error| {
        let at = error.pos();
        ParseError::new(
            Place::Column(at.row.into(), at.col.into()),
            "well-formed XML",
            error.to_string(),
        )
    })
}

/// True for an element of this name, in any case.
pub(super) fn is(node: Node<'_, '_>, tag: &str) -> bool {
    node.is_element() && node.tag_name().name().eq_ignore_ascii_case(tag)
}

/// The first child of this name.
pub(super) fn child<'a, 'input>(node: Node<'a, 'input>, tag: &str) -> Option<Node<'a, 'input>> {
    node.children().find(|n| is(*n, tag))
}

/// The line on which an element begins.
pub(super) fn place(node: Node<'_, '_>) -> Place {
    let at = node.document().text_pos_at(node.range().start);
    Place::Line(at.row.into())
}
