//! Text tables of positions: CSV, TSV and variants.
//!
//! - One joint in three columns, named in one row (`hips_x`, `Hips.X`, `Hips Tx`) or in several (DeepLabCut's `bodyparts`
//!   and `coords`), with a column of times or frames or none.
//! - The exports of OptiTrack Motive, Vicon Nexus and Qualisys, with their rows of keys, types, names and properties.
//! - The long form: a row for each joint of each frame.
//! - Numbers alone, if there are as many columns as a known set of landmarks needs, or a point on each line.

mod axis_labels;
mod brackets;
mod certainty;
mod columns;
mod glued;
mod layout;
mod long;
mod motive;
mod nexus;
mod plain;
mod qualisys;
mod quantities;
mod rates;

pub(super) use self::columns::axis_of;
use self::columns::is_value;
use self::layout::{ColumnLayout, IN_PLANE, TableFrames, TableLine};
use super::cells::{Decimal, clock, empty_rows, lines, number, split, utf8};
use super::descriptor::{FormatDescriptor, FormatInput};
use super::points::{IN_A_PICTURE, Point, UNSEEN, check_size};
use super::timing::{Clock, Stamps, TimedPoints};
use super::{Limits, Loaded, ParseError, Place, Warning, opensim};
use crate::math::Vec3;

pub(super) const FORMAT: FormatDescriptor = FormatDescriptor {
    name: "table",
    title: "table of positions",
    noun: "a table",
    endings: &["csv", "tsv", "tab"],
    looks_so: |h| {
        !h.is_binary() && (!opensim::is_table(h) || opensim::has_markers(h)) && looks_so(h.bytes)
    },
    up: None,
    read: read_as,
};

/// TableFrames a second of a table without times.
const ASSUMED_HZ: f64 = 30.0;

/// Reads a table of positions: a clip of points called `name`, one for each subject if several have a body. Blank cells
/// are points that were not seen. `rate_hz` replaces the rate in the file. O(bytes).
///
/// # Errors
/// The place and the cause: no columns of positions, only two dimensions, no frames, more of either than `limits` allow.
pub fn read(
    bytes: &[u8],
    name: &str,
    rate_hz: Option<f64>,
    limits: &Limits,
) -> Result<Loaded, ParseError> {
    read_as(&FormatInput::alone(bytes, name, rate_hz, limits))
}

/// [`read`]; of points in two dimensions too if `planar` is set, whose z is 0.
pub(super) fn read_as(file: &FormatInput<'_>) -> Result<Loaded, ParseError> {
    let (bytes, planar) = (file.bytes, file.planar);
    let text = utf8(bytes);
    let rows = lines(&text, file.limits)?;
    let separator = separator(&rows);
    let limits = &limits_beside(&rows, separator, file.limits)?;
    let mut cells: Vec<TableLine> = Vec::with_capacity(rows.len());
    for (line, row) in &rows {
        cells.push((*line, split(row, separator)));
    }
    let cells = brackets::spread(cells);
    let mut cells = plain::stacked(&cells).unwrap_or(cells);
    let head = &cells[..cells.len().min(HEAD_ROWS)];
    let mut warnings = Vec::new();
    // Sections of other measurements may stand above that of positions.
    let section = nexus::layout(&cells).map(TableHeader::Wide);
    let (points, stamps, layout) = match section.or_else(|| header(head, planar)) {
        Some(TableHeader::Long(columns)) => long::frames(&columns, &cells, limits)?,
        Some(TableHeader::Wide(layout)) => {
            check_size(layout.points.len(), cells.len(), bytes.len(), limits)?;
            if let Some(text) = certainty::without_doubtful(&mut cells, &layout) {
                warnings.push(Warning::new(Place::File, text));
            }
            let cells = with_empty_rows(cells, &layout, &text);
            wide(layout, &cells, limits, &mut warnings)?
        }
        None => match plain::layout(&cells) {
            Some(layout) => wide(layout, &cells, limits, &mut warnings)?,
            None => return Err(no_columns(&cells)),
        },
    };
    check_size(points.len(), stamps.secs.len(), bytes.len(), limits)?;
    for note in layout.notes {
        warnings.push(Warning::new(Place::File, note));
    }
    let clock = Clock {
        given_hz: file.rate_hz,
        stated_hz: layout.rate_hz,
        assumed_hz: ASSUMED_HZ,
    };
    let timed = TimedPoints {
        points,
        stamps,
        clock,
        metres_per_unit: layout.metres_per_unit,
    };
    timed.into_loaded(file.name, warnings, limits)
}

/// Adds the rows whose cells are all empty, as gaps, where a table has neither times nor frame numbers. Empty
/// rows directly below the header and after the last frame are not frames.
fn with_empty_rows<'a>(
    rows: Vec<TableLine<'a>>,
    layout: &ColumnLayout,
    text: &[u8],
) -> Vec<TableLine<'a>> {
    let first = rows.get(layout.header_rows).map(|row| row.0);
    let (Some(first), Some(&(last, _))) = (first, rows.last()) else {
        return rows;
    };
    if layout.time.is_some() || layout.frame.is_some() || layout.stop_row.is_some() {
        return rows;
    }
    let above = rows.get(layout.header_rows.wrapping_sub(1));
    let header = above.map_or(0, |row| row.0);
    let mut empty: Vec<u64> = empty_rows(text)
        .filter(|line| (header..last).contains(line))
        .collect();
    if empty.iter().filter(|line| **line < first).count() == 1 {
        empty.remove(0);
    }
    let mut all = rows;
    all.extend(empty.into_iter().map(|line| (line, vec![""])));
    all.sort_by_key(|row| row.0);
    all
}

/// Rows among which a header is looked for.
const HEAD_ROWS: usize = 40;

/// True if text begins as a table of positions does: its header names x, y and z of something.
pub(super) fn looks_so(head: &[u8]) -> bool {
    let limits = Limits {
        line_bytes: usize::MAX,
        ..Limits::default()
    };
    let text = utf8(head);
    let Ok(rows) = lines(&text, &limits) else {
        return false;
    };
    let separator = separator(&rows);
    // The last row may be cut.
    let whole = &rows[..rows.len().saturating_sub(usize::from(rows.len() > 2))];
    let cells = |most: usize| -> Vec<TableLine> {
        let rows = whole.iter().take(most);
        rows.map(|(line, row)| (*line, split(row, separator)))
            .collect()
    };
    let first = brackets::spread(cells(HEAD_ROWS));
    match header(&first, false) {
        Some(TableHeader::Long(_)) => true,
        Some(TableHeader::Wide(layout)) => layout.points.len() >= 2,
        None => {
            nexus::begins(&first)
                || plain::is_row_of_points(&first)
                || plain::is_stacked(&cells(usize::MAX))
        }
    }
}

enum TableHeader {
    Wide(ColumnLayout),
    Long(long::LongColumns),
}

fn header(rows: &[TableLine], planar: bool) -> Option<TableHeader> {
    if let Some(layout) = motive::layout(rows).or_else(|| qualisys::layout(rows)) {
        return Some(TableHeader::Wide(layout));
    }
    if let Some(columns) = rows
        .iter()
        .enumerate()
        .find_map(|(r, row)| long::columns(r, row, &rows[r + 1..]))
    {
        return Some(TableHeader::Long(columns));
    }
    columns::layout(rows, planar).map(TableHeader::Wide)
}

/// Separator of cells: of tab, semicolon and comma the one that most rows have; none if no row has any.
fn separator(rows: &[(u64, &str)]) -> Option<char> {
    let looked_at = || {
        rows.iter()
            .rev()
            .take(HEAD_ROWS)
            .chain(rows.iter().take(HEAD_ROWS))
    };
    // A comma may stand in numbers where a semicolon or tab separates them.
    ['\t', ';', ',']
        .into_iter()
        .map(|c| (looked_at().filter(|(_, row)| row.contains(c)).count(), c))
        .filter(|&(count, _)| 2 * count > looked_at().count())
        .map(|(_, c)| c)
        .next()
}

fn no_columns(rows: &[TableLine]) -> ParseError {
    const SHOWN: usize = 6;
    let expected = "columns of x, y and z for each point, as in `hips_x`, `hips_y`, `hips_z`";
    let Some((line, first)) = rows.first() else {
        return ParseError::new(Place::Line(1), expected, "an empty file");
    };
    if motive::begins(rows) {
        let expected = "positions of bones, rigid bodies or markers in the export of Motive";
        let found = "none: export positions as well, in global coordinates";
        return ParseError::new(Place::Line(*line), expected, found);
    }
    if let Some(found) = measured(rows) {
        return ParseError::new(Place::Line(*line), expected, found);
    }
    if nexus::begins(rows) {
        let expected = "a section `Trajectories` or `Segments` in the export of Vicon";
        let found = format!("`{}` without it: export trajectories as well", first[0]);
        return ParseError::new(Place::Line(*line), expected, found);
    }
    if first
        .iter()
        .all(|cell| number(cell, Decimal::Either).is_some())
    {
        let found = format!(
            "only numbers, {} on each line, which match no known set of points: add a header row with names",
            first.len()
        );
        return ParseError::new(Place::Line(*line), expected, found);
    }
    let named: Vec<&str> = first
        .iter()
        .copied()
        .filter(|cell| !cell.is_empty())
        .collect();
    let shown = named[..named.len().min(SHOWN)].join(", ");
    let more = if named.len() > SHOWN { ", …" } else { "" };
    ParseError::new(Place::Line(*line), expected, format!("`{shown}{more}`"))
}

/// What is left of `limits` beside the cells of the rows.
fn limits_beside(
    rows: &[(u64, &str)],
    separator: Option<char>,
    limits: &Limits,
) -> Result<Limits, ParseError> {
    let ends = |c: char| separator.map_or(c.is_whitespace(), |separator| c == separator);
    let cells = |row: &str| row.chars().filter(|c| ends(*c)).count() + 1;
    let cells = rows.iter().map(|(_, row)| cells(row)).sum::<usize>();
    // Lists grow to twice what they hold.
    let used = cells * 2 * size_of::<&str>() + rows.len() * size_of::<TableLine>();
    limits.without(used)
}

/// What a table measures in place of positions, as far as its header tells.
fn measured(rows: &[TableLine]) -> Option<&'static str> {
    let labels = columns::header_labels(rows)?;
    if columns::is_flat(&labels) {
        return Some(IN_A_PICTURE);
    }
    let above = columns::header_above(rows).is_some_and(quantities::says_other_above);
    (above || quantities::is_turned(&labels)).then_some(
        "angles, rotations or sensor readings, which contain no positions: give positions, or BVH",
    )
}

/// What the beginning of a text that may be a table holds in place of positions: [`measured`], labels, or rows of numbers.
pub(super) fn what_it_is(head: &[u8]) -> Option<String> {
    const LEAST_ROWS: usize = 5;
    const LEAST_NUMBERS: usize = 6;
    let limits = Limits {
        line_bytes: usize::MAX,
        ..Limits::default()
    };
    let text = utf8(head);
    let rows = lines(&text, &limits).ok()?;
    let separator = separator(&rows);
    let cells = rows
        .iter()
        .take(HEAD_ROWS)
        .map(|(line, row)| (*line, split(row, separator)));
    let cells: Vec<TableLine> = cells.collect();
    if let Some(found) = measured(&cells) {
        return Some(found.to_owned());
    }
    let (_, first) = cells.first()?;
    let has = |name: &str| first.iter().any(|cell| cell.eq_ignore_ascii_case(name));
    if (has("clip") || has("file")) && (has("class") || has("label")) {
        return Some("a table of labels: give it where labels are expected".to_owned());
    }
    let is_number = |cell: &&str| cell.is_empty() || number(cell, Decimal::Either).is_some();
    let numbers =
        |(_, cells): &TableLine| cells.len() == first.len() && cells.iter().all(&is_number);
    let whole = &cells[..cells.len().saturating_sub(1)];
    (whole.len() >= LEAST_ROWS && first.len() >= LEAST_NUMBERS && whole.iter().all(numbers)).then(|| {
        format!(
            "rows of {} numbers without names, which match no known set of points: add a header row with names",
            first.len()
        )
    })
}

/// The frames of a table with three columns for each point.
fn wide(
    layout: ColumnLayout,
    rows: &[TableLine],
    limits: &Limits,
    warnings: &mut Vec<Warning>,
) -> Result<TableFrames, ParseError> {
    let stop = layout.stop_row.unwrap_or(rows.len()).min(rows.len());
    let body = &rows[layout.header_rows.min(stop)..stop];
    let decimal = Decimal::of(body.iter().flat_map(|(_, cells)| cells).copied());
    let mut points: Vec<Point> = layout
        .points
        .iter()
        .map(|(name, _)| Point {
            name: name.clone(),
            positions: Vec::with_capacity(body.len()),
        })
        .collect();
    let (mut times, mut numbers) = (Vec::new(), Vec::new());
    for (line, cells) in body {
        let value = |column: usize| cells.get(column).and_then(|cell| number(cell, decimal));
        let is_frame = layout
            .points
            .iter()
            .flat_map(|(_, c)| c)
            .any(|&c| value(c).is_some());
        let has_number = layout
            .frame
            .or(layout.time.map(|t| t.0))
            .and_then(value)
            .is_some();
        // Without either, a row is a frame by where it stands.
        let is_unseen = layout.frame.is_none()
            && layout.time.is_none()
            && cells.iter().all(|cell| cell.is_empty() || is_value(cell));
        if !is_frame && !has_number && !is_unseen {
            let text = format!(
                "a row that begins with `{}` is not a frame and is left out",
                cells[0]
            );
            warnings.push(Warning::new(Place::Line(*line), text));
            continue;
        }
        if times.len() == limits.frames {
            let expected = format!("at most {} frames", limits.frames);
            return Err(ParseError::new(Place::Line(*line), expected, "more"));
        }
        let clock = |column: usize| cells.get(column).and_then(|cell| clock(cell));
        let time = |(column, _)| value(column).or_else(|| clock(column));
        times.push(layout.time.and_then(time));
        numbers.push(layout.frame.and_then(value));
        let depth = |column| {
            if column == IN_PLANE {
                Some(0.0)
            } else {
                value(column)
            }
        };
        for ((_, [x, y, z]), point) in layout.points.iter().zip(&mut points) {
            point
                .positions
                .push(match [value(*x), value(*y), depth(*z)] {
                    [Some(x), Some(y), Some(z)] => Vec3::new(x, y, z),
                    _ => UNSEEN,
                });
        }
    }
    if times.is_empty() {
        let line = rows.last().map_or(1, |row| row.0);
        return Err(ParseError::new(
            Place::Line(line),
            "frames below the header",
            "none",
        ));
    }
    let secs = layout.time.and_then(|(_, secs)| secs);
    // A column without a name, or with a wrong one, may hold times.
    let is_fraction = |number: &Option<f64>| number.is_some_and(|number| number.fract() != 0.0);
    let stamps = match layout.time.is_none() && numbers.iter().any(is_fraction) {
        true => Stamps::of_values(numbers, None),
        false => Stamps::of_values(times, secs).numbered(numbers),
    };
    Ok((points, stamps, layout))
}

#[cfg(test)]
mod habits;
#[cfg(test)]
mod tests;
