//! TRC: points over time as tab-separated text (Motion Analysis, OpenSim).
//!
//! A header of two rows of names and values (rate, counts, unit), a row with a name above every three columns, a row of
//! `X1 Y1 Z1 …`, then frames. Producers leave rows out, separate by commas, or name one point a cell; all of it is read.

mod write;

pub use write::write;

use super::cells::{Decimal, lines, number, split};
use super::descriptor::FormatDescriptor;
use super::head::Head;
use super::points::{Point, UNSEEN, check_size, metres_of};
use super::table::axis_of;
use super::timing::{Clock, Stamps, TimedPoints};
use super::{Limits, Loaded, ParseError, Place, Warning};
use crate::math::Vec3;

pub(super) const FORMAT: FormatDescriptor = FormatDescriptor {
    name: "trc",
    title: "TRC",
    noun: "a TRC recording",
    endings: &["trc"],
    looks_so: is_trc,
    up: None,
    read: |file| read(file.bytes, file.name, file.rate_hz, file.limits),
};

/// `PathFileType`, or a row that begins with `Frame#` and names points after a row of TRC's header.
fn is_trc(head: &Head) -> bool {
    let begins = |line: &[u8], word: &[u8]| {
        let line = line.strip_prefix(b"\"").unwrap_or(line);
        line.len() >= word.len() && line[..word.len()].eq_ignore_ascii_case(word)
    };
    let opens = |line: &[u8]| begins(line, b"PathFileType") || begins(line, b"DataRate");
    !head.is_binary() && head.lines().take(3).any(opens)
}

/// The header's rows before the names of points.
struct Heading {
    rate_hz: Option<f64>,
    unit: Option<String>,
    frames: Option<f64>,
    points: Option<f64>,
}

/// Reads a TRC file: a clip of points called `name`, one for each subject if several have a body. Blank cells are points
/// that were not seen. `rate_hz` replaces the rate in the file. O(bytes).
///
/// # Errors
/// The place and the cause: no row that begins with `Frame#`, no points, no frames, more of either than `limits` allow.
pub fn read(
    bytes: &[u8],
    name: &str,
    rate_hz: Option<f64>,
    limits: &Limits,
) -> Result<Loaded, ParseError> {
    let rows = lines(bytes, limits)?;
    let Some((at, separator)) = names_row(&rows) else {
        let found = match rows.len() {
            0 => "an empty file".to_owned(),
            n => format!("none in {n} rows"),
        };
        return Err(ParseError::new(
            Place::Line(rows.last().map_or(1, |row| row.0)),
            "a row of a TRC file that begins with Frame# and names the points",
            found,
        ));
    };
    let heading = Heading::read(&rows[..at], separator);
    let columns = columns(&split(rows[at].1, separator));
    if columns.is_empty() {
        return Err(ParseError::new(
            Place::Line(rows[at].0),
            "names of points in the TRC file",
            "none: the file contains no points",
        ));
    }
    let mut warnings = Vec::new();
    if let Some(stated) = heading.points.filter(|&n| n != columns.len() as f64) {
        let text = format!(
            "{} points are named, the header states {stated}",
            columns.len()
        );
        warnings.push(Warning::new(Place::Line(rows[at].0), text));
    }
    let body: Vec<(u64, Vec<&str>)> = rows[at + 1..]
        .iter()
        .map(|&(line, text)| (line, split(text, separator)))
        .filter(|(_, cells)| !is_axes_row(cells))
        .collect();
    check_size(columns.len(), body.len(), bytes.len(), limits)?;
    let table = frames(&columns, &body, limits, &mut warnings)?;
    if let Some(stated) = heading
        .frames
        .filter(|&n| n != table.stamps.secs.len() as f64)
    {
        let text = format!(
            "found {} frames, the header states {stated}",
            table.stamps.secs.len()
        );
        warnings.push(Warning::new(Place::File, text));
    }
    let clock = Clock {
        given_hz: rate_hz,
        stated_hz: heading.rate_hz,
        assumed_hz: 60.0,
    };
    let unit = heading.unit.as_deref().and_then(metres_of);
    if unit.is_none() {
        let text = "no known unit of length in the header; it is inferred from the body's height";
        warnings.push(Warning::new(Place::File, text));
    }
    let timed = TimedPoints {
        points: table.points,
        stamps: table.stamps,
        clock,
        metres_per_unit: unit,
    };
    timed.into_loaded(name, warnings, limits)
}

/// The row that names the points, and what separates its cells.
fn names_row(rows: &[(u64, &str)]) -> Option<(usize, Option<char>)> {
    // More rows before it are no header.
    const MOST: usize = 30;
    rows.iter()
        .take(MOST)
        .enumerate()
        .find_map(|(i, (_, row))| {
            let lower = row
                .trim_start()
                .trim_start_matches('"')
                .to_ascii_lowercase();
            let separator = ['\t', ',', ';'].into_iter().find(|&c| row.contains(c));
            lower.starts_with("frame").then_some((i, separator))
        })
}

impl Heading {
    /// Values below their names, in any order.
    fn read(rows: &[(u64, &str)], separator: Option<char>) -> Self {
        let mut heading = Self {
            rate_hz: None,
            unit: None,
            frames: None,
            points: None,
        };
        let cells: Vec<Vec<&str>> = rows.iter().map(|(_, row)| split(row, separator)).collect();
        for pair in cells.windows(2) {
            for (name, value) in pair[0].iter().zip(&pair[1]) {
                let number = number(value, Decimal::Either);
                match name.to_ascii_lowercase().as_str() {
                    "datarate" => heading.rate_hz = number,
                    "camerarate" => heading.rate_hz = heading.rate_hz.or(number),
                    "numframes" => heading.frames = number,
                    "nummarkers" => heading.points = number,
                    "units" => heading.unit = Some((*value).to_owned()),
                    _ => {}
                }
            }
        }
        heading
    }
}

/// A name and the column of its x.
type MarkerColumn = (String, usize);

/// Points stand above every third column, in neighbouring cells, or above each of their columns. Before them are the frame's
/// number and its time.
fn columns(names: &[&str]) -> Vec<MarkerColumn> {
    let first = match names.get(1) {
        Some(second) if second.to_ascii_lowercase().starts_with("time") => 2,
        _ => 1,
    };
    let named: Vec<(usize, &str)> = names
        .iter()
        .copied()
        .enumerate()
        .skip(first)
        .filter(|(_, name)| !name.is_empty())
        .collect();
    if let Some(columns) = columns_of_axes(&named) {
        return columns;
    }
    let above = named.iter().all(|(column, _)| (column - first) % 3 == 0);
    let place = |(k, &(column, name)): (usize, &(usize, &str))| {
        let column = if above && named.len() > 1 {
            column
        } else {
            first + 3 * k
        };
        (name.to_owned(), column)
    };
    named.iter().enumerate().map(place).collect()
}

/// A name above each of a point's three columns: `Nose_x`, `Nose_y`, `Nose_z`, or `Nose` three times.
fn columns_of_axes(named: &[(usize, &str)]) -> Option<Vec<MarkerColumn>> {
    if named.is_empty() || !named.len().is_multiple_of(3) {
        return None;
    }
    let point = |triple: &[(usize, &str)]| {
        let [(x, name), (y, second), (z, third)] = *triple else {
            return None;
        };
        if (y, z) != (x + 1, x + 2) {
            return None;
        }
        if name == second && name == third {
            return Some((name.to_owned(), x));
        }
        let (point, axis) = axis_of(name)?;
        let same = |other: &str, number: usize| axis_of(other) == Some((point.clone(), number));
        (axis == 0 && same(second, 1) && same(third, 2)).then(|| (point.clone(), x))
    };
    named.chunks_exact(3).map(point).collect()
}

/// `X1 Y1 Z1` below the names.
fn is_axes_row(cells: &[&str]) -> bool {
    let first = cells.iter().find(|cell| !cell.is_empty());
    first.is_none_or(|cell| cell.starts_with(['X', 'x']))
}

/// Points of all frames, and when they are.
pub(super) struct TrcFrames {
    points: Vec<Point>,
    stamps: Stamps,
}

fn frames(
    columns: &[MarkerColumn],
    body: &[(u64, Vec<&str>)],
    limits: &Limits,
    warnings: &mut Vec<Warning>,
) -> Result<TrcFrames, ParseError> {
    let decimal = Decimal::of(body.iter().flat_map(|(_, cells)| cells).copied());
    let first = columns[0].1;
    let mut points: Vec<Point> = columns
        .iter()
        .map(|(name, _)| Point {
            name: name.clone(),
            positions: Vec::with_capacity(body.len()),
        })
        .collect();
    let mut stamps = Stamps::default();
    for (line, cells) in body {
        let frame = number(cells[0], decimal);
        if frame.is_none() {
            let text = format!(
                "a row that begins with `{}` instead of a frame number is left out",
                cells[0]
            );
            warnings.push(Warning::new(Place::Line(*line), text));
            continue;
        }
        if stamps.secs.len() == limits.frames {
            let expected = format!("at most {} frames", limits.frames);
            return Err(ParseError::new(Place::Line(*line), expected, "more"));
        }
        let value = |column: usize| cells.get(column).and_then(|cell| number(cell, decimal));
        stamps.secs.push(if first > 1 { value(1) } else { None });
        stamps.numbers.push(frame);
        for ((_, column), point) in columns.iter().zip(&mut points) {
            let at = [value(*column), value(column + 1), value(column + 2)];
            point.positions.push(match at {
                [Some(x), Some(y), Some(z)] => Vec3::new(x, y, z),
                _ => UNSEEN,
            });
        }
    }
    if stamps.secs.is_empty() {
        let line = body.last().map_or(1, |row| row.0);
        return Err(ParseError::new(
            Place::Line(line),
            "frames below the names of points",
            "none",
        ));
    }
    Ok(TrcFrames { points, stamps })
}

#[cfg(test)]
mod tests;
