//! Finds the x, y and z columns of each point, from the header rows.

use super::axis_labels::{axis_number, is_mark, prefix, suffix};
use super::glued::{axis_glued, prefix_glued, suffix_glued, unit_of, without_unit};
use super::layout::{ColumnLayout, IN_PLANE, TableLine};
use super::quantities::{self, is_other, is_other_unit, is_plate, is_position, unit_in};
use super::rates::{counts, rate_above, rises_evenly};
use crate::formats::cells::{Decimal, number};
use crate::formats::points::metres_of;

/// The layout of a table whose header names its columns, in one row or several; with `planar`, of x and y alone, too.
pub(super) fn layout(rows: &[TableLine], planar: bool) -> Option<ColumnLayout> {
    let header_rows = header_rows(rows)?;
    let (header, units) = without_units(&rows[..header_rows]);
    let labels = labels(header);
    let mut found = ColumnLayout {
        header_rows,
        rate_hz: rate_above(header),
        ..ColumnLayout::default()
    };
    if quantities::says_other_above(header) {
        return None;
    }
    let has_sides = labels.iter().any(|label| is_left_alone(label));
    let open = named_points(&labels, units, &|label| axis_with(label, has_sides));
    let is_whole = |open: &[OpenPoint]| {
        open.iter()
            .any(|(_, axes)| axes.iter().all(Option::is_some))
    };
    let glued = || {
        [suffix_glued, prefix_glued].into_iter().find_map(|axis| {
            let open = named_points(&labels, units, &|label| axis_glued(label, axis, &labels));
            // `kneerx` is how a knee turns; where sides are meant, there are left ones, too.
            let is_turned = open.iter().all(|(name, _)| {
                // Nor is `knee_vx` a place.
                let last = name.rsplit(is_mark).next().unwrap_or_default();
                name.ends_with(['r', 'R']) || is_other(&last.to_ascii_lowercase())
            });
            (is_whole(&open) && open.len() > 1 && !is_turned).then_some(open)
        })
    };
    let open = match is_whole(&open) {
        true => open,
        false => glued().unwrap_or(open),
    };
    let is_axis = |column: usize| {
        let of = |(_, axes): &OpenPoint| axes.contains(&Some(column));
        open.iter().any(of)
    };
    for (column, label) in labels.iter().enumerate() {
        if is_axis(column) {
            let below = || metres_of(units?.get(column)?);
            let unit = unit_of(label).or_else(below);
            found.metres_per_unit = found.metres_per_unit.or(unit);
        } else if found.time.is_none() && is_time(label) {
            let below = || units?.get(column).and_then(|unit| seconds_of(unit));
            found.time = Some((column, seconds_of(label).or_else(below)));
        } else if found.frame.is_none() && is_frame(label, column) {
            found.frame = Some(column);
        }
    }
    if found.time.is_none() {
        let first = (0..labels.len())
            .find(|column| is_axis(*column))
            .unwrap_or(0);
        let mut before = (0..first).filter(|column| found.frame != Some(*column));
        let rising = before.find(|column| rises_evenly(&rows[header_rows..], *column));
        let whole =
            |column: &usize| found.frame.is_none() || !counts(&rows[header_rows..], *column);
        found.time = rising.filter(whole).map(|column| {
            let below = || units?.get(column).and_then(|unit| seconds_of(unit));
            (column, seconds_of(&labels[column]).or_else(below))
        });
    }
    for (name, columns) in open {
        match columns {
            [Some(x), Some(y), Some(z)] if is_quaternion(&labels, &name, [x, y, z], rows) => {
                let text = format!("`{name}` has x, y, z and w, a rotation; left out");
                found.notes.push(text);
            }
            [Some(x), Some(y), Some(z)] => found.points.push((name, [x, y, z])),
            [Some(x), Some(y), None] if planar => found.points.push((name, [x, y, IN_PLANE])),
            _ => found
                .notes
                .push(format!("`{name}` has not all of x, y and z; left out")),
        }
    }
    (!found.points.is_empty()).then_some(found)
}

/// A point's name and the columns of its axes that are found so far.
type OpenPoint = (String, [Option<usize>; 3]);

/// The points whose axes `axis` finds in labels, but for columns of angles, speeds or forces by their units.
fn named_points(
    labels: &[String],
    units: Option<&[&str]>,
    axis: &dyn Fn(&str) -> Option<(String, usize)>,
) -> Vec<OpenPoint> {
    let mut open: Vec<OpenPoint> = Vec::new();
    let mut places = std::collections::HashMap::new();
    for (column, label) in labels.iter().enumerate() {
        let unit = units.and_then(|units| units.get(column));
        let is_length =
            unit.is_none_or(|unit| !is_other_unit(unit.trim_matches(['(', ')', '[', ']'])));
        let Some((name, axis)) = axis(label).filter(|_| is_length) else {
            continue;
        };
        let at = *places.entry(name.clone()).or_insert_with(|| {
            open.push((name, [None; 3]));
            open.len() - 1
        });
        open[at].1[axis] = open[at].1[axis].or(Some(column));
    }
    open
}

/// The words above each column, if there is a header.
pub(super) fn header_labels(rows: &[TableLine]) -> Option<Vec<String>> {
    Some(labels(header_above(rows)?))
}

/// The rows above the numbers, but for one of units.
pub(super) fn header_above<'a, 'b>(rows: &'a [TableLine<'b>]) -> Option<&'a [TableLine<'b>]> {
    Some(without_units(&rows[..header_rows(rows)?]).0)
}

/// True if the columns have x and y, and z nowhere.
pub(super) fn is_flat(labels: &[String]) -> bool {
    let axes: Vec<usize> = labels
        .iter()
        .filter_map(|label| Some(axis_of(label)?.1))
        .collect();
    axes.contains(&0) && axes.contains(&1) && !axes.contains(&2)
}

/// The header without a last row of units (`mm`, `s`, `-`), and that row's cells.
fn without_units<'a, 'b>(
    header: &'a [TableLine<'b>],
) -> (&'a [TableLine<'b>], Option<&'a [&'b str]>) {
    let Some(((_, last), above)) = header.split_last().filter(|(_, above)| !above.is_empty())
    else {
        return (header, None);
    };
    let bare = |cell: &&str| cell.trim_matches(['(', ')', '[', ']']).to_owned();
    let mut filled = last.iter().filter(|cell| !cell.is_empty());
    let lengths = last.iter().filter(|cell| metres_of(&bare(cell)).is_some());
    let is_unit = |cell: &&str| {
        const OTHERS: [&str; 9] = ["-", "s", "sec", "ms", "hz", "deg", "rad", "px", "1"];
        let cell = bare(cell).to_ascii_lowercase();
        metres_of(&cell).is_some() || OTHERS.contains(&cell.as_str())
    };
    match lengths.count() > 2 && filled.all(is_unit) {
        true => (above, Some(last)),
        false => (header, None),
    }
}

/// Rows before the first of numbers; `None` if there is none, or no row of numbers.
fn header_rows(rows: &[TableLine]) -> Option<usize> {
    // A frame may begin with words (a class, a track) and hold others (`Tracked`) below names that are certain.
    let is_below_axes = |above: &TableLine, cells: &[&str]| {
        let named = |&(_, label): &(usize, &&str)| axis_of(label).is_some();
        let axes: Vec<usize> = above
            .1
            .iter()
            .enumerate()
            .filter(named)
            .map(|(column, _)| column)
            .collect();
        let is_number = |column: &&usize| cells.get(**column).is_some_and(|cell| is_value(cell));
        let numbers = axes.iter().filter(is_number).count();
        axes.len() >= 6 && numbers > 0 && numbers * 5 >= axes.len() * 4
    };
    let is_frame = |row: &usize| {
        let (_, cells) = &rows[*row];
        let filled = cells.iter().filter(|cell| !cell.is_empty());
        let numbers = filled.clone().filter(|cell| is_value(cell));
        let first = filled.clone().next();
        let (filled, numbers) = (filled.count(), numbers.count());
        let starts = first.is_some_and(|cell| is_value(cell));
        filled > 0 && starts && numbers * 5 >= filled * 4
            || *row > 0 && is_below_axes(&rows[row - 1], cells)
    };
    let first = (0..rows.len())
        .position(|row| is_frame(&row))
        .unwrap_or(rows.len());
    (first > 0).then_some(first)
}

/// A number or a gap.
pub(super) fn is_value(cell: &str) -> bool {
    number(cell, Decimal::Either).is_some() || is_nan(cell)
}

fn is_nan(cell: &str) -> bool {
    const NONE: [&str; 9] = [
        "nan", "-nan", "na", "n/a", "null", "none", "inf", "-inf", "#n/a",
    ];
    NONE.iter().any(|none| cell.eq_ignore_ascii_case(none))
}

/// The words above each column. In a row with blanks, a word holds for the columns up to the next; a last row of axes
/// gets the name that changes above it.
fn labels(header: &[TableLine]) -> Vec<String> {
    let width = header
        .iter()
        .map(|(_, cells)| cells.len())
        .max()
        .unwrap_or(0);
    let Some((last, above)) = header.split_last() else {
        return Vec::new();
    };
    let is_axis = |cell: &&str| matches!(cell.to_ascii_lowercase().as_str(), "x" | "y" | "z");
    let axes = last.1.iter().filter(|cell| is_axis(cell)).count();
    if axes < 2 || above.is_empty() {
        let cell = |column: usize| {
            last.1
                .get(column)
                .map_or(String::new(), |c| (*c).to_owned())
        };
        return (0..width).map(cell).collect();
    }
    // The row that names points has the most different words; scorers and kinds have few.
    let filled: Vec<Vec<&str>> = above
        .iter()
        .map(|(_, cells)| carried(cells, width))
        .collect();
    let different = |cells: &&Vec<&str>| {
        let mut words: Vec<&str> = cells.to_vec();
        words.sort_unstable();
        words.dedup();
        words.len()
    };
    let names = filled
        .iter()
        .max_by_key(different)
        .cloned()
        .unwrap_or_default();
    // DeepLabCut names animals, or people, in a row of their own.
    let whose = filled.iter().find(|cells| {
        cells
            .first()
            .is_some_and(|c| c.eq_ignore_ascii_case("individuals"))
    });
    let label = |column: usize| {
        let axis = last.1.get(column).copied().unwrap_or_default();
        let name = names.get(column).copied().unwrap_or_default();
        let whose = whose.and_then(|cells| cells.get(column)).copied();
        match axis {
            "" => name.to_owned(),
            axis if is_axis(&axis) && !name.is_empty() => match whose {
                Some(whose) if !whose.is_empty() => format!("{whose}:{name}_{axis}"),
                _ => format!("{name}_{axis}"),
            },
            axis => axis.to_owned(),
        }
    };
    (0..width).map(label).collect()
}

/// A row with blanks filled from the left.
fn carried<'a>(cells: &[&'a str], width: usize) -> Vec<&'a str> {
    let mut last = "";
    (0..width)
        .map(|column| {
            let cell = cells.get(column).copied().unwrap_or_default();
            if !cell.is_empty() {
                last = cell;
            }
            last
        })
        .collect()
}

/// The point and the axis (0 to 2) that a column's label names.
pub(in crate::formats) fn axis_of(label: &str) -> Option<(String, usize)> {
    axis_with(label, false)
}

/// True if a label is of a point whose name ends in an `l` alone: then an `r` alone is the other side, no rotation.
fn is_left_alone(label: &str) -> bool {
    axis_of(label).is_some_and(|(name, _)| {
        let bare = name.strip_suffix(['l', 'L']);
        bare.is_some_and(|rest| rest.ends_with(is_mark))
    })
}

/// [`axis_of`]; with `has_sides`, a name that ends in `_r` is a right one.
fn axis_with(label: &str, has_sides: bool) -> Option<(String, usize)> {
    if let Some(found) = in_brackets(label) {
        return Some(found);
    }
    if unit_in(label).is_some_and(is_other_unit) {
        return None;
    }
    let label = without_unit(label).trim();
    let (name, axis) = suffix(label).or_else(|| prefix(label))?;
    let mut name = name.trim_end_matches(is_mark);
    let last = |name: &str| {
        let start = name.rfind(is_mark).map_or(0, |at| at + 1);
        (start, name[start..].to_ascii_lowercase())
    };
    let (start, word) = last(name);
    let is_turned = quantities::names_other(name);
    if is_other(&word) && start > 0 && !(has_sides && word == "r") || is_plate(name) || is_turned {
        return None;
    }
    if is_position(&word) && start > 0 {
        name = name[..start].trim_end_matches(is_mark);
        // Axis Studio writes `Hips-Joint-Posi-x`.
        let (start, word) = last(name);
        if word == "joint" && start > 0 {
            name = name[..start].trim_end_matches(is_mark);
        }
    }
    // A point has a name; `rotation x` alone has none.
    let lower = name.to_ascii_lowercase();
    let is_name = !name.is_empty() && !is_other(&lower);
    is_name.then(|| (name.to_owned(), axis))
}

/// `Hips(x)`, `Hips[X]`, `Hips[0]`.
fn in_brackets(label: &str) -> Option<(String, usize)> {
    let pair = ["()", "[]"];
    let (name, axis) = pair.iter().find_map(|pair| {
        let rest = label.trim().strip_suffix(&pair[1..])?;
        rest.rsplit_once(&pair[..1])
    })?;
    let axis = match axis.trim() {
        "0" => 0,
        "1" => 1,
        "2" => 2,
        letter => axis_number(letter.chars().next()?).filter(|_| letter.len() == 1)?,
    };
    let name = name.trim_end_matches(is_mark);
    (!name.is_empty() && !is_time(name) && !is_frame(name, 1)).then(|| (name.to_owned(), axis))
}

/// The label of x in whose place this one has w: `hips_w`, `W Element`.
fn as_x(label: &str) -> Option<String> {
    let last = |w: &str, x: &str| label.strip_suffix(w).map(|rest| format!("{rest}{x}"));
    let first = |w: &str, x: &str| label.strip_prefix(w).map(|rest| format!("{x}{rest}"));
    let named = |label: &String| axis_of(label).is_some();
    last("w", "x")
        .or(last("W", "X"))
        .filter(named)
        .or(first("w", "x").or(first("W", "X")).filter(named))
}

/// True if columns of x, y and z have a fourth of w, and the first rows of numbers are rotations.
fn is_quaternion(labels: &[String], name: &str, axes: [usize; 3], rows: &[TableLine]) -> bool {
    let is_w = |label: &String| {
        let found = as_x(label).and_then(|label| axis_of(&label));
        found.is_some_and(|(known, _)| known == name)
    };
    let Some(w) = labels.iter().position(is_w) else {
        return false;
    };
    let squared = |(_, cells): &TableLine| {
        let value = |column: usize| number(cells.get(column)?, Decimal::Either);
        let squares = [axes[0], axes[1], axes[2], w].map(|column| Some(value(column)?.powi(2)));
        squares.into_iter().sum::<Option<f64>>()
    };
    let mut lengths = rows.iter().filter_map(squared).peekable();
    lengths.peek().is_some() && lengths.all(|length| (length - 1.0).abs() < 0.02)
}

pub(super) fn is_time(label: &str) -> bool {
    let lower = without_unit(label).to_ascii_lowercase();
    matches!(lower.as_str(), "t" | "secs" | "seconds" | "sec" | "ms") || lower.contains("time")
}

/// Seconds in the unit that a label of times names.
pub(super) fn seconds_of(label: &str) -> Option<f64> {
    let lower = label.to_ascii_lowercase();
    let says = |words: &[&str]| {
        let mut parts = lower.split(|c: char| !c.is_alphanumeric());
        parts.any(|part| words.contains(&part))
    };
    match () {
        () if says(&["ns", "nanoseconds"]) => Some(1e-9),
        () if says(&["us", "microseconds"]) => Some(1e-6),
        () if says(&["ms", "milliseconds", "msec"]) => Some(1e-3),
        () if says(&["s", "sec", "secs", "seconds"]) => Some(1.0),
        () => None,
    }
}

pub(super) fn is_frame(label: &str, column: usize) -> bool {
    let lower = label.to_ascii_lowercase();
    let words = [
        "frame",
        "frame#",
        "frames",
        "fnum",
        "index",
        "frame_number",
        "framenumber",
        "coords",
    ];
    words.contains(&lower.as_str()) || lower.starts_with("frame") || column == 0 && lower.is_empty()
}
