//! Cells that hold a whole point, as Python prints them: `"(0.1, 0.2, 0.3)"`, `[0.1 0.2 0.3]`; or without brackets, with tabs
//! between the cells: `0.1 0.2 0.3`.

use super::layout::TableLine;
use crate::formats::cells::{Decimal, number};

/// The table with such cells spread over three columns each, below a row of their axes; as it is without any.
pub(super) fn spread(rows: Vec<TableLine<'_>>) -> Vec<TableLine<'_>> {
    let Some((_, first)) = rows.get(1) else {
        return rows;
    };
    let is_point: Vec<bool> = first.iter().map(|cell| point(cell).is_some()).collect();
    if is_point.iter().filter(|is| **is).count() < 2 {
        return rows;
    }
    let mut spread = Vec::with_capacity(rows.len() + 1);
    for (at, (line, cells)) in rows.into_iter().enumerate() {
        let mut wide = Vec::with_capacity(3 * cells.len());
        for (column, cell) in cells.into_iter().enumerate() {
            match (is_point.get(column) == Some(&true), at) {
                (true, 0) => wide.extend([cell, "", ""]),
                (true, _) => wide.extend(point(cell).unwrap_or(["", "", ""])),
                (false, _) => wide.push(cell),
            }
        }
        spread.push((line, wide));
        if at == 0 {
            let axes = is_point.iter().flat_map(|is| match is {
                true => &["x", "y", "z"][..],
                false => &[""],
            });
            spread.push((line, axes.copied().collect()));
        }
    }
    spread
}

/// The three numbers of a cell; a fourth is how sure they are.
fn point(cell: &str) -> Option<[&str; 3]> {
    let inner = cell.trim_matches(['"', '\'', ' ']);
    let inner = ["()", "[]"]
        .iter()
        .find_map(|pair| inner.strip_prefix(&pair[..1])?.strip_suffix(&pair[1..]))
        .unwrap_or(inner);
    let mut parts = inner.split([',', ' ', ';']).filter(|part| !part.is_empty());
    let point = [parts.next()?, parts.next()?, parts.next()?];
    let numbers = point
        .iter()
        .all(|part| number(part, Decimal::Point).is_some() || part.eq_ignore_ascii_case("nan"));
    (numbers && parts.count() <= 1).then_some(point)
}
