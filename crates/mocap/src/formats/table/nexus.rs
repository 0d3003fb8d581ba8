//! Vicon's export as text: sections one below the other, each with a row for its title (`Trajectories`, `Devices`, `Model Outputs`),
//! its rate, the names, the axes and the units, then its frames. Trajectories hold markers; segments of a solved skeleton
//! are read where there are no trajectories.

use super::layout::{ColumnLayout, TableLine};
use crate::formats::cells::{Decimal, number};
use crate::formats::points::metres_of;

const TITLES: [&str; 7] = [
    "trajectories",
    "segments",
    "devices",
    "model outputs",
    "joints",
    "events",
    "analog",
];

/// True if a file begins like an export of Nexus. Lines about the trial may precede it.
pub(super) fn begins(rows: &[TableLine]) -> bool {
    const PREAMBLE: usize = 12;
    let begins = |pair: &[TableLine]| {
        let is_events = pair[0].1[0].eq_ignore_ascii_case("events");
        is_title(&pair[0]) && (rate(&pair[1]).is_some() || is_events)
    };
    let pairs = rows[..rows.len().min(PREAMBLE)].windows(2);
    pairs.into_iter().any(begins)
}

/// The rate below a title: `100`, `100,Hz`, `100 Hz`.
fn rate((_, cells): &TableLine) -> Option<f64> {
    let word = cells.first()?.split_whitespace().next()?;
    number(word, Decimal::Either)
}

fn is_title((_, cells): &TableLine) -> bool {
    let title = cells[0].to_ascii_lowercase();
    TITLES.contains(&title.as_str()) && cells[1..].iter().all(|cell| cell.is_empty())
}

/// The layout of the section that holds positions; `None` if there is none.
pub(super) fn layout(rows: &[TableLine]) -> Option<ColumnLayout> {
    if !begins(rows) {
        return None;
    }
    let titles: Vec<usize> = (0..rows.len()).filter(|&at| is_title(&rows[at])).collect();
    let named = |name: &str| {
        let mut titles = titles.iter().copied();
        titles.find(|&at| rows[at].1[0].eq_ignore_ascii_case(name))
    };
    let (taken, mut found) = ["trajectories", "segments"].iter().find_map(|name| {
        let at = named(name)?;
        Some((at, section(rows, at)?))
    })?;
    let others = titles.iter().filter(|&&at| at != taken);
    let others: Vec<&str> = others.map(|&at| rows[at].1[0]).collect();
    if !others.is_empty() {
        let text = format!(
            "other sections of the export left out: {}",
            others.join(", ")
        );
        found.notes.push(text);
    }
    Some(found)
}

/// Rows from a title to the first frame, at most.
const SECTION_HEAD: usize = 6;

fn section(rows: &[TableLine], title: usize) -> Option<ColumnLayout> {
    let is_axes = |(_, cells): &TableLine| {
        let first = cells[0].to_ascii_lowercase();
        (["frame", "field", "sample"].iter()).any(|word| first.starts_with(word))
    };
    let head = rows.get(title..(title + SECTION_HEAD).min(rows.len()))?;
    let axes = title + head.iter().position(is_axes)?;
    let is_frame = |(_, cells): &TableLine| number(cells[0], Decimal::Either).is_some();
    let begin = axes + 1 + rows[axes + 1..].iter().take(3).position(is_frame)?;
    let end = rows[begin..].iter().position(|row| !is_frame(row));
    let (names, labels) = (&rows[axes.checked_sub(1)?].1, &rows[axes].1);
    let cell = |cells: &[&str], at: usize| {
        cells
            .get(at)
            .copied()
            .unwrap_or_default()
            .to_ascii_lowercase()
    };
    let mut found = ColumnLayout {
        header_rows: begin,
        stop_row: end.map(|rows| begin + rows),
        frame: Some(0),
        rate_hz: rate(rows.get(title + 1)?),
        ..ColumnLayout::default()
    };
    let mut name = "";
    for x in 1..labels.len() {
        name = match names.get(x) {
            Some(named) if !named.is_empty() => named,
            _ => name,
        };
        let axes = [x, x + 1, x + 2].map(|at| cell(labels, at));
        let axes = axes.each_ref().map(|axis| axis.trim_start_matches('t'));
        if axes == ["x", "y", "z"] && !name.is_empty() {
            found.points.push((name.to_owned(), [x, x + 1, x + 2]));
            let unit = rows[begin - 1].1.get(x).copied().unwrap_or_default();
            found.metres_per_unit = found.metres_per_unit.or(metres_of(unit));
        }
    }
    (!found.points.is_empty()).then_some(found)
}
