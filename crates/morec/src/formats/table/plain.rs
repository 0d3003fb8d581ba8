//! Tables of numbers without names.

use super::{ColumnLayout, TableLine};
use crate::formats::cells::{Decimal, number};

/// How many points known sets of landmarks have.
const COUNTS: [usize; 7] = [17, 18, 20, 22, 24, 25, 33];

/// The layout of a table of numbers whose width is that of a known set of landmarks, with or without a column of frames
/// or times before it.
pub(super) fn layout(rows: &[TableLine]) -> Option<ColumnLayout> {
    let (_, first) = rows.first()?;
    let is_number = |cell: &&str| number(cell, Decimal::Either).is_some();
    // A header that says nothing may stand before the numbers.
    let header_rows = usize::from(!first.iter().all(is_number));
    let (_, cells) = rows.get(header_rows)?;
    if !cells.iter().all(is_number) {
        return None;
    }
    let fits = |before: usize, width: usize| {
        let values = cells.len().checked_sub(before)?;
        let known = values.is_multiple_of(width) && COUNTS.contains(&(values / width));
        known.then_some((before, width, values / width))
    };
    // A fourth number is how sure the sensor was.
    let (before, width, count) = fits(0, 3)
        .or_else(|| fits(1, 3))
        .or_else(|| fits(0, 4))
        .or_else(|| fits(1, 4))?;
    let point = |number: usize| {
        let x = before + width * number;
        (number.to_string(), [x, x + 1, x + 2])
    };
    let value = |(_, cells): &TableLine| number(cells[0], Decimal::Either);
    let counts = rows[header_rows..]
        .iter()
        .filter_map(value)
        .all(|v| v.fract() == 0.0);
    let text = format!("no names of columns; read as x, y and z of {count} points");
    Some(ColumnLayout {
        points: (0..count).map(point).collect(),
        time: (before == 1 && !counts).then_some((0, None)),
        frame: (before == 1 && counts).then_some(0),
        header_rows,
        notes: vec![text],
        ..ColumnLayout::default()
    })
}
