//! Qualisys' export as text: rows of keys and values (`NO_OF_MARKERS`, `FREQUENCY`, `MARKER_NAMES`), perhaps a row that names
//! columns, then frames in millimetres, with or without their numbers and times.

use super::layout::{ColumnLayout, TableLine};
use crate::formats::cells::{Decimal, number};

/// The layout, if the keys name markers.
pub(super) fn layout(rows: &[TableLine]) -> Option<ColumnLayout> {
    let is_number = |cell: &str| number(cell, Decimal::Either).is_some();
    let begin = rows.iter().position(|(_, cells)| is_number(cells[0]))?;
    let keys = &rows[..begin];
    let value = |key: &str| {
        let row = keys.iter().find(|(_, cells)| cells[0] == key)?;
        Some(row.1[1..].to_vec())
    };
    value("NO_OF_FRAMES")?;
    let names: Vec<&str> = value("MARKER_NAMES")?
        .into_iter()
        .filter(|name| !name.is_empty())
        .collect();
    let cells = &rows[begin].1;
    let filled = cells.len()
        - cells
            .iter()
            .rev()
            .take_while(|cell| cell.is_empty())
            .count();
    // Frame and time come first, or one of them, or none.
    let before = match keys.last()?.1.as_slice() {
        [first, second, ..] if *first == "Frame" => 1 + usize::from(*second == "Time"),
        _ => filled.checked_sub(3 * names.len()).filter(|&n| n <= 2)?,
    };
    let point = |(number, name): (usize, &&str)| {
        let x = before + 3 * number;
        ((*name).to_owned(), [x, x + 1, x + 2])
    };
    let rate = value("FREQUENCY").and_then(|values| number(values.first()?, Decimal::Either));
    Some(ColumnLayout {
        points: names.iter().enumerate().map(point).collect(),
        time: (before == 2).then_some((1, Some(1.0))),
        frame: (before > 0).then_some(0),
        rate_hz: rate,
        metres_per_unit: Some(0.001),
        header_rows: begin,
        ..ColumnLayout::default()
    })
}
