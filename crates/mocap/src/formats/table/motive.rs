//! OptiTrack Motive's CSV export, after its documentation ("Data Export: CSV"): a row of keys and values, then a row each
//! of types, names, numbers and properties above the columns.

use super::layout::{ColumnLayout, TableLine};
use crate::formats::cells::{Decimal, number};
use crate::formats::points::metres_of;

/// True if the first row has the keys of such an export.
pub(super) fn begins(rows: &[TableLine]) -> bool {
    let is_key = |cell: &&str| matches!(*cell, "Format Version" | "Take Name");
    rows.first()
        .is_some_and(|(_, cells)| cells.iter().any(is_key))
}

/// The layout, if this is such an export. Bones are taken if there are any, else rigid bodies and markers.
pub(super) fn layout(rows: &[TableLine]) -> Option<ColumnLayout> {
    let keys = &rows.first()?.1;
    let is_motive = begins(rows);
    let frame_row = rows.iter().position(|(_, cells)| cells[0] == "Frame")?;
    let named = |name: &str| {
        let is = |(_, cells): &&TableLine| cells.iter().take(2).any(|cell| *cell == name);
        rows[..frame_row].iter().find(is).map(|(_, cells)| cells)
    };
    // Older versions have the same rows without a word before them.
    const KINDS: [&str; 5] = [
        "Bone",
        "Bone Marker",
        "Rigid Body",
        "Rigid Body Marker",
        "Marker",
    ];
    let kinds = rows
        .get(1..frame_row)?
        .iter()
        .position(|(_, cells)| cells.iter().skip(2).any(|cell| KINDS.contains(cell)))
        .map(|at| at + 1);
    let row_of = |at: usize| rows[..frame_row].get(at).map(|(_, cells)| cells);
    let types = named("Type").or_else(|| row_of(kinds?))?;
    let names = named("Name").or_else(|| row_of(kinds? + 1))?;
    let properties = rows[..frame_row].iter().rev().map(|(_, cells)| cells);
    let properties = properties
        .into_iter()
        .find(|cells| cells.contains(&"Position"))?;
    if !is_motive && properties.len() < 5 {
        return None;
    }
    let value = |key: &str| {
        let at = keys.iter().position(|cell| *cell == key)?;
        keys.get(at + 1).copied()
    };
    let rate = |key| value(key).and_then(|text| number(text, Decimal::Either));
    let mut found = ColumnLayout {
        header_rows: frame_row + 1,
        frame: Some(0),
        time: Some((1, Some(1.0))),
        rate_hz: rate("Export Frame Rate").or(rate("Capture Frame Rate")),
        metres_per_unit: value("Length Units").and_then(metres_of),
        ..ColumnLayout::default()
    };
    let axes = &rows[frame_row].1;
    let is_x = |c: &usize| properties[*c] == "Position" && axes.get(*c) == Some(&"X");
    let mut columns: Vec<(usize, &str)> = (2..properties.len())
        .filter(is_x)
        .filter_map(|c| Some((c, types.get(c).copied()?)))
        .collect();
    if columns.iter().any(|(_, kind)| *kind == "Bone") {
        let all = columns.len();
        columns.retain(|(_, kind)| *kind == "Bone");
        if columns.len() < all {
            let text = format!("{} markers beside the bones left out", all - columns.len());
            found.notes.push(text);
        }
    }
    // Markers that the solver laid onto a body repeat those that were measured.
    let name = |x: usize| names.get(x).copied().unwrap_or_default();
    let measured: Vec<&str> = columns
        .iter()
        .filter(|(_, kind)| *kind == "Marker")
        .map(|&(x, _)| name(x))
        .collect();
    columns.retain(|(x, kind)| !kind.ends_with(" Marker") || !measured.contains(&name(*x)));
    for (x, _) in columns {
        let name = names.get(x).copied().unwrap_or_default();
        found.points.push((name.to_owned(), [x, x + 1, x + 2]));
    }
    (!found.points.is_empty()).then_some(found)
}
