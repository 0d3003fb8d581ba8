//! Tables of numbers without names.

use super::layout::{ColumnLayout, TableLine};
use super::rates::counts;
use crate::formats::cells::{Decimal, number};
use crate::roles::points::{NUMBERED_HANDS, numbered_counts};

/// Rows that a table of numbers has at least to be taken for points without its name saying so.
const LEAST_ROWS: usize = 5;

/// True if a known set of landmarks has this many points.
fn is_known(count: usize) -> bool {
    numbered_counts().any(|known| known == count)
}

/// The cells of a row; a separator may stand behind the last.
fn filled<'a, 'b>(cells: &'b [&'a str]) -> &'b [&'a str] {
    match cells.split_last() {
        Some((&"", before)) => before,
        _ => cells,
    }
}

fn is_number(cell: &str) -> bool {
    number(cell, Decimal::Either).is_some()
}

/// True if all rows are numbers, as many as a known set needs.
pub(super) fn is_row_of_points(rows: &[TableLine]) -> bool {
    let width = rows.first().map_or(0, |(_, cells)| cells.len());
    let alike = |(_, cells): &TableLine| {
        cells.len() == width && filled(cells).iter().all(|cell| is_number(cell))
    };
    rows.len() >= LEAST_ROWS && rows.iter().all(alike) && layout(rows).is_some()
}

/// True if rows hold one point each, and every N of them the next frame.
pub(super) fn is_stacked(rows: &[TableLine]) -> bool {
    stride(rows).is_some()
}

/// Rows of one point each, put together to a row for each frame; `None` if they are not that.
pub(super) fn stacked<'a>(rows: &[TableLine<'a>]) -> Option<Vec<TableLine<'a>>> {
    let points = stride(rows).filter(|points| rows.len().is_multiple_of(*points))?;
    let frame = |rows: &[TableLine<'a>]| {
        let cells = rows.iter().flat_map(|(_, cells)| cells.iter().copied());
        (rows[0].0, cells.collect())
    };
    Some(rows.chunks_exact(points).map(frame).collect())
}

/// After how many rows of one point each the next frame begins: where a point is nearest to where it was.
fn stride(rows: &[TableLine]) -> Option<usize> {
    const LOOKED_AT: usize = 4000;
    const LEAST_FRAMES: usize = 3;
    let width = rows.first()?.1.len();
    let point = |(_, cells): &TableLine| -> Option<[f64; 3]> {
        let value = |at: usize| number(cells.get(at)?, Decimal::Point);
        (cells.len() == width).then_some([value(0)?, value(1)?, value(2)?])
    };
    if !(3..=4).contains(&width) {
        return None;
    }
    let points: Option<Vec<[f64; 3]>> = rows.iter().take(LOOKED_AT).map(point).collect();
    let points = points?;
    let shift = |by: usize| {
        let pairs = points.iter().zip(&points[by..]);
        let sum: f64 = pairs
            .map(|(a, b)| (0..3).map(|i| (a[i] - b[i]).abs()).sum::<f64>())
            .sum();
        sum / (points.len() - by) as f64
    };
    let fits = |count: &usize| points.len() >= LEAST_FRAMES * count;
    let best = numbered_counts()
        .filter(fits)
        .min_by(|&a, &b| shift(a).total_cmp(&shift(b)))?;
    let next = shift(1);
    (next > 0.0 && shift(best) < 0.2 * next).then_some(best)
}

/// The layout of a table of numbers whose width is that of a known set of landmarks, with or without a column of frames
/// or times before it.
pub(super) fn layout(rows: &[TableLine]) -> Option<ColumnLayout> {
    let (_, first) = rows.first()?;
    // A header that says nothing may stand before the numbers.
    let header_rows = usize::from(!filled(first).iter().all(|cell| is_number(cell)));
    let cells = filled(&rows.get(header_rows)?.1);
    if !cells.iter().all(|cell| is_number(cell)) {
        return None;
    }
    let fits = |before: usize, width: usize| {
        let values = cells.len().checked_sub(before)?;
        let known = values.is_multiple_of(width) && is_known(values / width);
        known.then_some((before, width, values / width))
    };
    // A count that fits says nothing against a first column that counts frames: then a hand's points may be behind it.
    let counted = rows.len() > header_rows + 2 && counts(&rows[header_rows..], 0);
    let behind_count = || {
        fits(1, 3)
            .or_else(|| fits(1, 4))
            .or_else(|| hand_width(cells, 1))
    };
    // A fourth number is how sure the sensor was.
    let (before, width, count) = (counted.then(behind_count).flatten())
        .or_else(|| fits(0, 3))
        .or_else(|| fits(1, 3))
        .or_else(|| fits(0, 4))
        .or_else(|| fits(1, 4))
        .or_else(|| (0..3).find_map(|before| hand_width(cells, before)))
        .or_else(|| two_bodies(cells.len()))?;
    let bodies = if is_known(count) || NUMBERED_HANDS.contains(&count) {
        1
    } else {
        2
    };
    let named = names_above(&rows[..header_rows], before, width, count);
    if named.is_none() && header_rows > 0 && is_telling(first) {
        return None;
    }
    // Rows of First-Person Hand Action (Garcia-Hernando et al. 2018) are a frame's number and 21 joints, of right hands alone.
    let of_right_hand = counted && named.is_none() && (before, width, count) == (1, 3, 21);
    let point = |number: usize| {
        let x = before + width * number;
        let name = named.as_ref().map(|names| names[number].to_owned());
        let numbered = || match bodies {
            1 if of_right_hand => format!("right_{number}"),
            1 => number.to_string(),
            _ => {
                let own = count / bodies;
                format!("{}:{}", number / own + 1, number % own)
            }
        };
        (name.unwrap_or_else(numbered), [x, x + 1, x + 2])
    };
    let value = |(_, cells): &TableLine| number(cells[0], Decimal::Either);
    let counts = rows[header_rows..]
        .iter()
        .filter_map(value)
        .all(|v| v.fract() == 0.0);
    let turned = if width == 7 {
        " with rotations, which are left out"
    } else {
        ""
    };
    let whose = match bodies {
        1 if of_right_hand => format!("{count} points of a right hand"),
        1 => format!("{count} points"),
        _ => format!("{} points of each of {bodies} bodies", count / bodies),
    };
    let text = format!("no names of columns; read as x, y and z of {whose}{turned}");
    let notes = if named.is_some() {
        Vec::new()
    } else {
        vec![text]
    };
    Some(ColumnLayout {
        points: (0..count).map(point).collect(),
        time: (before > 0).then(|| (before - 1, None)),
        frame: (before > 1 && counts).then_some(0),
        header_rows,
        notes,
        ..ColumnLayout::default()
    })
}

/// Columns before the points, columns of a point and number of points in a row of `columns` that holds two bodies.
fn two_bodies(columns: usize) -> Option<(usize, usize, usize)> {
    let fits = |(before, width): (usize, usize)| {
        let values = columns.checked_sub(before)?;
        let is_two = values.is_multiple_of(2 * width) && is_known(values / width / 2);
        is_two.then_some((before, width, values / width))
    };
    [(0, 3), (1, 3), (0, 4), (1, 4)].into_iter().find_map(fits)
}

/// Columns before the points, columns of a point and number of points in a row that holds a hand behind `before` columns: places alone, or
/// each with a rotation x, y, z, w as in the rows of SHREC.
fn hand_width(cells: &[&str], before: usize) -> Option<(usize, usize, usize)> {
    let value = |at: usize| number(cells.get(at)?, Decimal::Either);
    let is_rotation = |at: usize| {
        let squares = (at..at + 4).map(|at| Some(value(at)?.powi(2)));
        squares
            .sum::<Option<f64>>()
            .is_some_and(|length| (length - 1.0).abs() < 0.02)
    };
    let fits = |width: usize| {
        let values = cells.len().checked_sub(before)?;
        let count = values / width;
        let is_hand = values.is_multiple_of(width) && NUMBERED_HANDS.contains(&count);
        let turned = width < 7 || (0..count).all(|point| is_rotation(before + width * point + 3));
        (is_hand && turned).then_some((before, width, count))
    };
    [3, 7].into_iter().find_map(fits)
}

/// True if a row names its columns by more than numbers: then they are not x, y and z of a point each.
fn is_telling(header: &[&str]) -> bool {
    const STEMS: usize = 4;
    let stem = |cell: &&str| {
        let letters = cell.chars().filter(|c| c.is_alphabetic());
        letters.collect::<String>().to_lowercase()
    };
    let filled = header.iter().filter(|cell| !cell.is_empty());
    let mut stems: Vec<String> = filled.skip(1).map(stem).collect();
    stems.sort_unstable();
    stems.dedup();
    stems.len() > STEMS
}

/// The names that a row has above the first column of each point and nowhere else: `SpineBase,,,SpineMid,,`.
fn names_above<'a>(
    header: &[TableLine<'a>],
    before: usize,
    width: usize,
    count: usize,
) -> Option<Vec<&'a str>> {
    let (_, cells) = header.first()?;
    let cell = |column: usize| cells.get(column).copied().unwrap_or_default();
    let name = |point: usize| Some(cell(before + point * width)).filter(|name| !name.is_empty());
    let names: Option<Vec<&str>> = (0..count).map(name).collect();
    let filled = cells.iter().skip(before).filter(|cell| !cell.is_empty());
    names.filter(|names| filled.count() == names.len())
}
