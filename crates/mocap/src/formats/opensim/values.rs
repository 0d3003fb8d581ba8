//! Numbers in the elements of a model.

use roxmltree::Node;

use super::super::ParseError;
use super::super::cells::finite;
use super::super::xml::{child, place};
use crate::math::Vec3;
use crate::parse_error::shortened;

/// The numbers in the child `tag` of `node`; none without it.
///
/// # Errors
/// Something else than numbers, or not `count` of them.
pub(super) fn numbers(
    node: Node<'_, '_>,
    tag: &str,
    count: Option<usize>,
) -> Result<Vec<f64>, ParseError> {
    let Some(holder) = child(node, tag) else {
        return Ok(Vec::new());
    };
    let text = holder.text().unwrap_or_default();
    let wrong = || {
        let expected = match count {
            Some(count) => format!("{count} numbers in <{tag}>"),
            None => format!("numbers in <{tag}>"),
        };
        ParseError::new(
            place(holder),
            expected,
            format!("`{}`", shortened(text.trim())),
        )
    };
    let found: Option<Vec<f64>> = text.split_ascii_whitespace().map(finite).collect();
    let found = found.ok_or_else(wrong)?;
    match count {
        Some(count) if found.len() != count => Err(wrong()),
        _ => Ok(found),
    }
}

/// The three numbers in the child `tag`; `None` without it.
pub(super) fn vector(node: Node<'_, '_>, tag: &str) -> Result<Option<Vec3>, ParseError> {
    let found = numbers(node, tag, Some(3));
    match child(node, tag) {
        Some(_) => Ok(Some(Vec3::from_column_slice(&found?))),
        None => Ok(None),
    }
}
