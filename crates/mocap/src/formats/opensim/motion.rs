//! The motion: a table of coordinates over time, applied to a model.

use super::super::builder::{ClipBuilder, check_size};
use super::super::cells::{Decimal, lines, number, split};
use super::super::timing::{Clock, Schedule, Stamps};
use super::super::{Limits, Loaded, ParseError, Place, Warning};
use super::model::{BodyPlacement, JointAxis, OsimBody, OsimModel};
use crate::clip::Joint;
use crate::math::{Quat, Vec3};
use crate::parse_error::shortened;
use nalgebra::Unit;

/// When the times say nothing.
const ASSUMED_HZ: f64 = 60.0;

/// Reads a motion of `model`: one clip called `name`, a joint for each body. Coordinates that the table lacks stay at the model's default,
/// or follow others as the model says. O(rows × bodies).
///
/// # Errors
/// The place and the cause: no header, no column that is a coordinate of the model, no rows, more than `limits` allow.
pub fn read_motion(
    bytes: &[u8],
    name: &str,
    model: &OsimModel,
    rate_hz: Option<f64>,
    limits: &Limits,
) -> Result<Loaded, ParseError> {
    let mut warnings = Vec::new();
    let table = CoordinateTable::read(bytes, model, limits, &mut warnings)?;
    let clock = Clock {
        given_hz: rate_hz,
        stated_hz: None,
        assumed_hz: ASSUMED_HZ,
    };
    let schedule = Schedule::of(&table.stamps, &clock, &mut warnings);
    let frames = schedule.places.as_ref().map_or(table.rows.len(), Vec::len);
    check_size(frames, model.bodies.len(), 0, bytes.len(), limits)?;
    let mut builder = ClipBuilder::new(model.joints());
    let mut push = |row: Option<&[f64]>| match row {
        Some(values) => {
            let pose = model.pose(values);
            builder.push_local(
                pose.iter().map(|p| p.rotation),
                pose.iter().map(|p| p.position),
            );
        }
        None => builder.push_missing(),
    };
    match &schedule.places {
        None => table.rows.iter().for_each(|row| push(row.as_deref())),
        Some(places) => {
            for place in places {
                let row = |at: usize| table.rows[at].as_ref();
                let both = row(place.before).zip(row(place.after));
                let mix = |(a, b): (&Vec<f64>, &Vec<f64>)| -> Vec<f64> {
                    let mixed = a.iter().zip(b);
                    mixed.map(|(a, b)| a + place.t * (b - a)).collect()
                };
                push(both.filter(|_| place.known).map(mix).as_deref());
            }
        }
    }
    let clip = builder.finish(name.to_owned(), schedule.rate_hz)?;
    Ok(Loaded {
        clips: vec![clip],
        warnings,
    })
}

impl OsimModel {
    /// A joint at the origin of each body; places are those of the model's defaults.
    fn joints(&self) -> Vec<Joint> {
        let values: Vec<f64> = self.coordinates.iter().map(|c| c.default).collect();
        let pose = self.pose(&values);
        let joint = |(body, place): (&OsimBody, &BodyPlacement)| Joint {
            name: body.name.clone(),
            parent: body.parent,
            offset: place.position,
            tip: None,
        };
        self.bodies.iter().zip(&pose).map(joint).collect()
    }

    /// Place of every body in its parent, given the values of all coordinates.
    fn pose(&self, values: &[f64]) -> Vec<BodyPlacement> {
        let placed = |body: &OsimBody| {
            let mut joint = BodyPlacement {
                rotation: Quat::identity(),
                position: Vec3::zeros(),
            };
            for turn in &body.turns {
                let axis = Unit::new_unchecked(turn.axis);
                joint.rotation *= Quat::from_axis_angle(&axis, turn.amount(values));
            }
            for slide in &body.slides {
                joint.position += slide.axis * slide.amount(values);
            }
            body.in_parent.then(&joint).then(&body.in_child.inverse())
        };
        self.bodies.iter().map(placed).collect()
    }
}

impl JointAxis {
    fn amount(&self, values: &[f64]) -> f64 {
        let inputs: Vec<f64> = self.inputs.iter().map(|&k| values[k]).collect();
        let amount = self.function.at(&inputs);
        // A wild value in a file must not become a pose without numbers.
        if amount.is_finite() { amount } else { 0.0 }
    }
}

/// Values of all coordinates of a model, row by row.
struct CoordinateTable {
    stamps: Stamps,
    /// `None`: a row that lacks numbers.
    rows: Vec<Option<Vec<f64>>>,
}

/// Header and column names, which come before the rows of numbers.
struct Header<'a> {
    in_degrees: Option<bool>,
    columns: Vec<&'a str>,
    line: u64,
    /// Rows before the first of numbers.
    rows: usize,
}

impl CoordinateTable {
    fn read(
        bytes: &[u8],
        model: &OsimModel,
        limits: &Limits,
        warnings: &mut Vec<Warning>,
    ) -> Result<Self, ParseError> {
        let rows = lines(bytes, limits)?;
        refuse_other(&rows)?;
        let header = Header::read(&rows)?;
        let columns = coordinates_of(&header, model, warnings)?;
        let body = &rows[header.rows..];
        if body.len() > limits.frames {
            let expected = format!("at most {} frames", limits.frames);
            return Err(ParseError::new(
                Place::File,
                expected,
                body.len().to_string(),
            ));
        }
        let mut table = Self {
            stamps: Stamps::default(),
            rows: Vec::with_capacity(body.len()),
        };
        let mut spoilt = None;
        for (k, (line, text)) in body.iter().enumerate() {
            let cells = split(text, None);
            let value = |column: usize| {
                cells
                    .get(column)
                    .and_then(|cell| number(cell, Decimal::Point))
            };
            let found: Option<Vec<f64>> =
                columns.iter().map(|&(column, _)| value(column)).collect();
            if found.is_none() && k + 1 == body.len() && cells.len() < header.columns.len() {
                let text = format!(
                    "an incomplete last row is dropped: expected {} numbers",
                    header.columns.len()
                );
                warnings.push(Warning::new(Place::Line(*line), text));
                break;
            }
            if found.is_none() {
                let (_, count) = spoilt.get_or_insert((*line, 0));
                *count += 1;
            }
            table.stamps.secs.push(value(0));
            table
                .rows
                .push(found.map(|found| model.defaults_with(&columns, &found)));
        }
        if table.rows.iter().all(Option::is_none) {
            let found = format!("{} without numbers", table.rows.len());
            return Err(ParseError::new(
                Place::Line(header.line),
                "rows of joint angles",
                found,
            ));
        }
        if let Some((line, count)) = spoilt {
            let text = format!(
                "{count} rows lack numbers and are filled by interpolation; this is the first"
            );
            warnings.push(Warning::new(Place::Line(line), text));
        }
        let in_degrees = header
            .in_degrees
            .unwrap_or_else(|| table.guess_degrees(model, &columns, warnings));
        for row in table.rows.iter_mut().flatten() {
            if in_degrees {
                let angles = columns
                    .iter()
                    .filter(|(_, k)| model.coordinates[*k].is_angle);
                angles.for_each(|&(_, k)| row[k] = row[k].to_radians());
            }
            model.couple(row, &columns);
        }
        Ok(table)
    }

    /// Degrees if an angle is larger than a joint turns in radians.
    fn guess_degrees(
        &self,
        model: &OsimModel,
        columns: &[(usize, usize)],
        warnings: &mut Vec<Warning>,
    ) -> bool {
        const MOST_RADIANS: f64 = 7.0;
        let angles = || {
            columns
                .iter()
                .map(|&(_, k)| k)
                .filter(|&k| model.coordinates[k].is_angle)
        };
        let is_large = |row: &Vec<f64>| angles().any(|k| row[k].abs() > MOST_RADIANS);
        let degrees = self.rows.iter().flatten().any(is_large);
        let unit = if degrees { "degrees" } else { "radians" };
        let text = format!("the header lacks `inDegrees`; by their size the angles are {unit}");
        warnings.push(Warning::new(Place::File, text));
        degrees
    }
}

impl OsimModel {
    fn defaults_with(&self, columns: &[(usize, usize)], found: &[f64]) -> Vec<f64> {
        let mut values: Vec<f64> = self.coordinates.iter().map(|c| c.default).collect();
        for ((_, coordinate), value) in columns.iter().zip(found) {
            values[*coordinate] = *value;
        }
        values
    }

    /// Sets coordinates that follow others and have no column.
    fn couple(&self, row: &mut [f64], columns: &[(usize, usize)]) {
        for coupling in &self.couplings {
            if columns.iter().all(|&(_, k)| k != coupling.dependent) {
                let inputs: Vec<f64> = coupling.inputs.iter().map(|&k| row[k]).collect();
                row[coupling.dependent] = coupling.scale * coupling.function.at(&inputs);
            }
        }
    }
}

impl<'a> Header<'a> {
    /// The lines up to `endheader` and the names of the columns behind it.
    fn read(rows: &[(u64, &'a str)]) -> Result<Self, ParseError> {
        const LONGEST: usize = 1000;
        let end = rows
            .iter()
            .take(LONGEST)
            .position(|(_, text)| text.trim().eq_ignore_ascii_case("endheader"));
        let Some(end) = end else {
            return Err(ParseError::new(
                Place::File,
                "OpenSim's header, which ends in `endheader`",
                "none",
            ));
        };
        let Some(&(line, names)) = rows.get(end + 1) else {
            return Err(ParseError::new(
                Place::Line(rows[end].0),
                "the names of columns",
                "the end of the file",
            ));
        };
        let in_degrees = rows[..end].iter().find_map(|(_, text)| {
            let (key, value) = text.split_once('=')?;
            key.trim()
                .eq_ignore_ascii_case("inDegrees")
                .then(|| value.trim().eq_ignore_ascii_case("yes"))
        });
        Ok(Self {
            in_degrees,
            columns: names.split_whitespace().collect(),
            line,
            rows: end + 2,
        })
    }
}

/// Refuses what the first line says to be no positions: columns of speeds or errors have the names of coordinates, too.
fn refuse_other(rows: &[(u64, &str)]) -> Result<(), ParseError> {
    const OTHERS: [&str; 13] = [
        "speed",
        "velocit",
        "accelerat",
        "error",
        "jerk",
        "forces",
        "moments",
        "powers",
        "controls",
        "activation",
        "excitation",
        "residual",
        "dudt",
    ];
    let Some((line, title)) = rows.first() else {
        return Ok(());
    };
    let is_turned =
        |(_, text): &&(u64, &str)| text.trim().eq_ignore_ascii_case("DataType=Quaternion");
    if let Some((line, _)) = rows.iter().take(20).find(is_turned) {
        let found = "orientations of sensors, which contain no positions: give the joint angles computed from them";
        return Err(ParseError::new(
            Place::Line(*line),
            "a table of coordinates",
            found,
        ));
    }
    let lower = title.to_lowercase();
    let is_other = OTHERS.iter().any(|other| lower.contains(other)) || lower.trim() == "u";
    if lower.contains('=') || lower.contains("kinematics_q") || !is_other {
        return Ok(());
    }
    let found = format!(
        "a table of `{}`, which is not motion",
        shortened(title.trim())
    );
    let expected = "a table of coordinates (OpenSim's `Coordinates`, `…_q.sto`)";
    Err(ParseError::new(Place::Line(*line), expected, found))
}

/// What a table holds whose columns are no coordinates, as far as their names tell.
fn shown_columns(columns: &[&str]) -> String {
    let count = |end: &str| {
        let ends = |name: &&&str| name.to_lowercase().ends_with(end);
        columns.iter().filter(ends).count()
    };
    let most = |ends: &[&str]| ends.iter().map(|end| count(end)).sum::<usize>() * 3 > columns.len();
    let what = match () {
        () if count("_ox") > 0 => {
            "positions and rotations of bodies' centres of mass (BodyKinematics)"
        }
        () if most(&["_moment", "_force"]) => "forces and moments of joints (inverse dynamics)",
        () if most(&["_vx", "_px", "_vy", "_py", "_torque_x"]) => "forces of the ground",
        () if most(&["/speed"]) => "speeds of coordinates",
        () if most(&["/activation", ".activation", ".fiber_length"]) => "states of muscles",
        () => {
            let names: Vec<&str> = columns.iter().take(5).copied().collect();
            return shortened(&names.join(", ")).into_owned();
        }
    };
    format!("{what}: give the model's coordinates instead")
}

/// Column and number of each coordinate that the table has: named as in the model, or by its path (`/jointset/hip_r/hip_flexion_r/value`).
fn coordinates_of(
    header: &Header<'_>,
    model: &OsimModel,
    warnings: &mut Vec<Warning>,
) -> Result<Vec<(usize, usize)>, ParseError> {
    let coordinate = |(column, name): (usize, &&str)| {
        let name = match name.strip_suffix("/value") {
            Some(path) => path.rsplit('/').next()?,
            None => name,
        };
        let number = model.coordinates.iter().position(|c| c.name == name)?;
        Some((column, number))
    };
    let found: Vec<_> = header
        .columns
        .iter()
        .enumerate()
        .skip(1)
        .filter_map(coordinate)
        .collect();
    if found.is_empty() {
        return Err(ParseError::new(
            Place::Line(header.line),
            "columns of the model's coordinates",
            shown_columns(&header.columns),
        ));
    }
    let follows = |k: usize| model.couplings.iter().any(|c| c.dependent == k);
    let missing: Vec<&str> = (0..model.coordinates.len())
        .filter(|&k| found.iter().all(|f| f.1 != k) && !follows(k))
        .map(|k| model.coordinates[k].name.as_str())
        .collect();
    if !missing.is_empty() {
        let text = format!(
            "{} of {} coordinates of the model have no column and keep their default: {}",
            missing.len(),
            model.coordinates.len(),
            shortened(&missing.join(", "))
        );
        warnings.push(Warning::new(Place::Line(header.line), text));
    }
    Ok(found)
}
