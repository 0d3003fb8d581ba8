//! Axes in the labels of columns.

use crate::math::Axis;

pub(super) fn is_mark(c: char) -> bool {
    matches!(c, '_' | '.' | ' ' | '-' | ':' | '/' | '|')
}

pub(super) fn axis_number(letter: char) -> Option<usize> {
    Axis::from_letter(letter).map(Axis::index)
}

/// `hips_x`, `Hips.X`, `Hips Tx`, `HipsX`, `12x`.
pub(super) fn suffix(label: &str) -> Option<(&str, usize)> {
    let last = label.chars().next_back()?;
    let axis = axis_number(last)?;
    let rest = &label[..label.len() - 1];
    let before = rest.chars().next_back()?;
    if is_mark(before) {
        return Some((rest, axis));
    }
    // A letter for the kind of channel: T for translation; `Rx` and `Qx` are none of ours.
    let channel = rest.strip_suffix(['T', 't', 'P', 'p']);
    if let Some(name) = channel.filter(|name| name.ends_with(is_mark)) {
        return Some((name, axis));
    }
    let joined = last.is_uppercase() && before.is_lowercase() || before.is_ascii_digit();
    joined.then_some((rest, axis))
}

/// `x_hips`, `X hips`, `x12`.
pub(super) fn prefix(label: &str) -> Option<(&str, usize)> {
    let axis = axis_number(label.chars().next()?)?;
    let rest = &label[1..];
    let next = rest.chars().next()?;
    (is_mark(next) || next.is_ascii_digit()).then(|| (rest.trim_start_matches(is_mark), axis))
}
