//! Labels in which name, axis and unit follow each other without a separator.

use super::axis_labels::{axis_number, is_mark, prefix, suffix};
use super::quantities::{self, is_other, is_other_unit, unit_in};
use crate::formats::points::metres_of;

/// A label without a unit behind it, in brackets or behind its axis, `hips_x_mm`.
pub(super) fn without_unit(label: &str) -> &str {
    match label.find(['(', '[']) {
        Some(at) if label.ends_with([')', ']']) => label[..at].trim_end(),
        _ => unit_behind(label).map_or(label, |(rest, _)| rest),
    }
}

/// What stands before a unit of length that follows an axis, and the unit.
fn unit_behind(label: &str) -> Option<(&str, &str)> {
    let at = label.rfind(is_mark)?;
    let (rest, unit) = (&label[..at], &label[at + 1..]);
    // `knee_m` is a medial one.
    let is_behind = unit.len() > 1 && prefix(rest).is_some();
    let is_axis = suffix(rest).is_some() || axis_alone(rest) || is_behind;
    (is_axis && metres_of(unit).is_some()).then_some((rest, unit))
}

fn axis_alone(label: &str) -> bool {
    label.len() == 1 && label.chars().all(|c| axis_number(c).is_some())
}

pub(super) fn unit_of(label: &str) -> Option<f64> {
    metres_of(unit_in(label).or_else(|| Some(unit_behind(label)?.1))?)
}

/// `hipsx`.
pub(super) fn suffix_glued(label: &str) -> Option<(&str, usize)> {
    let last = label.chars().next_back()?;
    Some((&label[..label.len() - last.len_utf8()], axis_number(last)?))
}

/// `Xhips`.
pub(super) fn prefix_glued(label: &str) -> Option<(&str, usize)> {
    let first = label.chars().next()?;
    Some((&label[first.len_utf8()..], axis_number(first)?))
}

/// An axis glued to a name, where there are labels of the same name with the other two.
pub(super) fn axis_glued(
    label: &str,
    split: fn(&str) -> Option<(&str, usize)>,
    labels: &[String],
) -> Option<(String, usize)> {
    if unit_in(label).is_some_and(is_other_unit) {
        return None;
    }
    let (name, axis) = split(without_unit(label))?;
    let has = |wanted: usize| {
        let same = |other: &String| split(without_unit(other)) == Some((name, wanted));
        labels.iter().any(same)
    };
    let last = name.rsplit(is_mark).next().unwrap_or(name);
    let is_place = name.len() > 1
        && !name.starts_with(is_mark)
        && !name.ends_with(is_mark)
        && !is_other(&last.to_lowercase())
        && !quantities::names_other(name)
        && !quantities::is_glued_other(name);
    (is_place && (0..3).all(has)).then(|| (name.to_owned(), axis))
}
