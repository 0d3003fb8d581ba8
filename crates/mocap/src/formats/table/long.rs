//! Tables in long form: one row for each joint of each frame.

use super::columns::{is_frame, is_time, seconds_of};
use super::layout::{ColumnLayout, TableFrames, TableLine};
use crate::formats::cells::{Decimal, clock, number};
use crate::formats::points::{Point, UNSEEN, check_size};
use crate::formats::timing::Stamps;
use crate::formats::{Limits, ParseError, Place};
use crate::math::Vec3;

/// Columns of the long form.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LongColumns {
    /// The row that names them.
    header: usize,
    name: usize,
    /// Column of the person.
    person: Option<usize>,
    /// Columns of what a point is part of: body, face, hand, by which method.
    parts: Vec<usize>,
    axes: [usize; 3],
    time: Option<(usize, Option<f64>)>,
    frame: Option<usize>,
}

/// Names of the columns of what a point is part of: FreeMoCap's, and those of tables of MediaPipe's holistic model.
const PARTS: [&str; 5] = ["model", "trajectory", "type", "landmark_type", "category"];

/// Names of the column of joint names.
const NAMES: &str = "joint|jointid|jointindex|landmarkid|keypointid|boneid|markerid|jointtype|joint_type|joint type|jointname|bone|\
    bone_name|bonename|keypoint_name|marker_name|markername|part|body part|keypoint|landmark|marker|bodypart|\
    body_part|point|name|label|joint_name|landmark_name|node";

/// The columns, if `row` is the header of a long table.
pub(super) fn columns(
    header: usize,
    (_, cells): &TableLine,
    below: &[TableLine],
) -> Option<LongColumns> {
    let lower: Vec<String> = cells.iter().map(|cell| cell.to_ascii_lowercase()).collect();
    let find = |is: &dyn Fn(&str) -> bool| lower.iter().position(|cell| is(cell));
    let axis = |axis: &str| {
        find(&|cell| {
            let cell = cell.split(['(', '[']).next().unwrap_or_default().trim();
            // Unity's and Kinect's `Position.X`, and `pos_x`.
            let words = ["position", "pos", "world", "camera"];
            let bare = words.iter().find_map(|word| cell.strip_prefix(word));
            let bare = bare.map(|rest| rest.trim_start_matches(['.', '_', ' ']));
            cell == axis
                || bare == Some(axis)
                || ["_m", "_mm", "_cm", " pos", "_pos"]
                    .iter()
                    .any(|end| cell.strip_suffix(end) == Some(axis))
        })
    };
    let axes = [axis("x")?, axis("y")?, axis("z")?];
    let person = find(&|cell| PEOPLE.split('|').any(|known| known == cell));
    // A landmark's number serves where it has no name.
    let name = NAMES
        .split('|')
        .find_map(|known| find(&|cell| cell == known));
    let numbers = |cell: &str| {
        let ends = [
            "_id", "_index", "_idx", " id", " index", "_no", "_num", "_number",
        ];
        let others = [
            "frame", "time", "sample", "image", "video", "file", "trial", "clip", "row",
        ];
        let numbered = ends.iter().any(|end| cell.ends_with(end)) || cell == "id";
        numbered
            && !PEOPLE.split('|').any(|known| known == cell)
            && !others.iter().any(|other| cell.starts_with(other))
    };
    let name = name.or_else(|| find(&numbers))?;
    let time = find(&|cell| is_time(cell)).map(|column| (column, seconds_of(&lower[column])));
    let frame = find(&|cell| !cell.is_empty() && is_frame(cell, 1));
    // What rises without a name of its own is a time.
    let unnamed = |column: &usize| {
        *column != name
            && !axes.contains(column)
            && person != Some(*column)
            && never_falls(below, *column)
    };
    let unnamed = (0..cells.len())
        .find(unnamed)
        .filter(|_| time.is_none() && frame.is_none());
    let time = time.or_else(|| Some((unnamed?, None)));
    let parts = lower.iter().enumerate();
    let parts = parts.filter(|(at, cell)| *at != name && PARTS.contains(&cell.as_str()));
    (time.is_some() || frame.is_some()).then_some(LongColumns {
        header,
        name,
        person,
        parts: parts.map(|(at, _)| at).collect(),
        axes,
        time,
        frame,
    })
}

/// True if the values of a column are numbers that rise and never fall.
fn never_falls(rows: &[TableLine], column: usize) -> bool {
    let value = |(_, cells): &TableLine| number(cells.get(column)?, Decimal::Either);
    let values: Option<Vec<f64>> = rows.iter().map(value).collect();
    values.is_some_and(|values| {
        values.windows(2).all(|w| w[1] >= w[0]) && values.first() < values.last()
    })
}

/// Names of the column that tells people apart.
const PEOPLE: &str = "person|person_id|personid|person_index|track_id|trackid|body_id|bodyid|skeleton_id|skeletonid|subject|\
    subject_id|actor|individual|hand|handedness|hand_id|hand_index|hand_label";

/// TableFrames in the order in which they appear.
pub(super) fn frames(
    columns: &LongColumns,
    rows: &[TableLine],
    limits: &Limits,
) -> Result<TableFrames, ParseError> {
    let body = &rows[columns.header + 1..];
    let (kept, notes) = columns.body_part(body);
    let decimal = Decimal::of(body.iter().flat_map(|(_, cells)| cells).copied());
    let mut points: Vec<Point> = Vec::new();
    let mut times: Vec<Option<f64>> = Vec::new();
    let mut numbers: Vec<Option<f64>> = Vec::new();
    let mut of_name = std::collections::HashMap::new();
    let mut of_frame = std::collections::HashMap::new();
    for (line, cells) in body {
        let cell = |column: usize| cells.get(column).copied().unwrap_or_default();
        let value = |column: usize| number(cell(column), decimal);
        let time = columns
            .time
            .and_then(|(column, _)| value(column).or_else(|| clock(cell(column))));
        let key = columns.frame.or(columns.time.map(|t| t.0)).map_or("", cell);
        let name = cell(columns.name);
        let whose = columns.person.map_or("", cell);
        let other = |part: &Vec<&str>| columns.part(cells) != *part;
        if key.is_empty() || name.is_empty() || kept.as_ref().is_some_and(other) {
            continue;
        }
        let next = times.len();
        let frame = *of_frame.entry(key).or_insert(next);
        if frame == next {
            if next == limits.frames {
                let expected = format!("at most {} frames", limits.frames);
                return Err(ParseError::new(Place::Line(*line), expected, "more"));
            }
            times.push(time);
            numbers.push(columns.frame.and_then(value));
        }
        let next = points.len();
        let point = *of_name.entry((whose, name)).or_insert(next);
        if point == next {
            if next == limits.joints {
                let expected = format!("at most {} points", limits.joints);
                return Err(ParseError::new(Place::Line(*line), expected, "more"));
            }
            let name = match whose {
                "" => name.to_owned(),
                whose => format!("{whose}:{name}"),
            };
            points.push(Point {
                name,
                positions: Vec::new(),
            });
        }
        if let [Some(x), Some(y), Some(z)] = columns.axes.map(value) {
            let positions = &mut points[point].positions;
            positions.resize(positions.len().max(frame + 1), UNSEEN);
            positions[frame] = Vec3::new(x, y, z);
        }
    }
    if times.is_empty() {
        let line = rows.last().map_or(1, |row| row.0);
        return Err(ParseError::new(
            Place::Line(line),
            "rows below the header",
            "none",
        ));
    }
    let bytes = body
        .iter()
        .map(|(_, cells)| cells.iter().map(|c| c.len() + 1).sum::<usize>());
    check_size(points.len(), times.len(), bytes.sum(), limits)?;
    for point in &mut points {
        point.positions.resize(times.len(), UNSEEN);
    }
    let secs = columns.time.and_then(|(_, secs)| secs);
    let stamps = Stamps::of_values(times, secs).numbered(numbers);
    let layout = ColumnLayout {
        notes,
        ..ColumnLayout::default()
    };
    Ok((points, stamps, layout))
}

impl LongColumns {
    /// What the point of a row is part of.
    fn part<'a>(&self, cells: &[&'a str]) -> Vec<&'a str> {
        let cell = |column: &usize| cells.get(*column).copied().unwrap_or_default();
        self.parts.iter().map(cell).collect()
    }

    /// The part that is the body, if points are parts of several things, and what is left out then. Other parts have
    /// points of the same names, or none of a body.
    fn body_part<'a>(&self, rows: &[TableLine<'a>]) -> (Option<Vec<&'a str>>, Vec<String>) {
        let mut parts: Vec<Vec<&str>> = Vec::new();
        for (_, cells) in rows {
            let part = self.part(cells);
            if !parts.contains(&part) && parts.len() < MOST_PARTS {
                parts.push(part);
            }
        }
        let says = |part: &[&str], words: &[&str]| {
            let lower = part.join(" ").to_lowercase();
            words.iter().any(|word| lower.contains(word))
        };
        let body = |part: &&Vec<&str>| says(part, &["body", "pose"]) && !says(part, &["mass"]);
        let bodies = || parts.iter().filter(body);
        let world = bodies().find(|part| says(part, &["world"]));
        let Some(kept) = world
            .or_else(|| bodies().next())
            .filter(|_| parts.len() > 1)
        else {
            return (None, Vec::new());
        };
        let others: Vec<String> = parts
            .iter()
            .filter(|part| *part != kept)
            .map(|part| part.join(" "))
            .collect();
        let note = format!("points of `{}` left out", others.join("`, `"));
        (Some(kept.clone()), vec![note])
    }
}

/// Words of more kinds are no parts.
const MOST_PARTS: usize = 64;
