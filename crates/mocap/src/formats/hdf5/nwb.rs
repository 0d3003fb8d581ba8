//! Poses in Neurodata Without Borders: a series of places for each part of a body (the extension `ndx-pose`), or of an animal as a
//! whole (`SpatialSeries`), with times or a rate.

use std::collections::HashMap;

use hdf5_pure::AttrValue;

use super::contents::{Hdf5Contents, damaged, text_of};
use crate::formats::npy::Array;
use crate::formats::points::{Point, UNSEEN, metres_of};
use crate::formats::timing::{Clock, Stamps, TimedPoints};
use crate::formats::{ParseError, Place};
use crate::math::Vec3;

const ASSUMED_HZ: f64 = 30.0;

/// A series of places.
struct PoseSeries<'a> {
    path: &'a str,
    values: Array,
    /// The factor of its numbers.
    scale: f64,
    metres_per_unit: Option<f64>,
}

/// Points of all pose series in a file; `None` if the file holds no pose series.
///
/// # Errors
/// Places in a picture alone; series of different lengths; more than the limits allow.
pub(super) fn series(
    tree: &Hdf5Contents,
    rate_hz: Option<f64>,
) -> Result<Option<TimedPoints>, ParseError> {
    let mut all: Vec<PoseSeries> = Vec::new();
    for path in &tree.groups {
        let attributes = tree.group(path)?.attrs().unwrap_or_default();
        let kind = text_of(attributes.get("neurodata_type")).unwrap_or_default();
        if kind != "PoseEstimationSeries" && kind != "SpatialSeries" {
            continue;
        }
        let Some(values) = tree.numbers(&format!("{path}/data"))? else {
            continue;
        };
        let data = attributes_of(tree, &format!("{path}/data"))?;
        let number = |name: &str| data.get(name).and_then(number_of);
        all.push(PoseSeries {
            path,
            values,
            scale: number("conversion").unwrap_or(1.0),
            metres_per_unit: text_of(data.get("unit")).and_then(metres_of),
        });
    }
    // Poses are more than where an animal was; of several kinds of poses the first is read.
    let is_place = |series: &PoseSeries| matches!(series.values.shape[..], [_, 3]);
    let Some(first) = all.iter().find(|series| is_place(series)) else {
        return match all.is_empty() {
            true => Ok(None),
            false => Err(ParseError::new(
                Place::File,
                "poses in three dimensions",
                "series of x and y alone: two dimensions are not enough (triangulate several views)",
            )),
        };
    };
    let frames = first.values.shape[0];
    let alike = |series: &&PoseSeries| is_place(series) && series.values.shape[0] == frames;
    let used: Vec<&PoseSeries> = all.iter().filter(alike).collect();
    let parents: Vec<&str> = used.iter().map(|series| split(series.path).0).collect();
    let several = parents.iter().any(|parent| *parent != parents[0]);
    let points = used.iter().zip(&parents).map(|(series, parent)| {
        let (_, name) = split(series.path);
        let name = name
            .trim_start_matches("PoseEstimationSeries")
            .trim_matches(['_', ' ']);
        let whose = split(parent).1;
        let place = |row: &[f64]| match row {
            [x, y, z] => Vec3::new(*x, *y, *z) * series.scale,
            _ => UNSEEN,
        };
        Point {
            name: if several {
                format!("{whose}:{name}")
            } else {
                name.to_owned()
            },
            positions: series.values.values.chunks_exact(3).map(place).collect(),
        }
    });
    let points: Vec<Point> = points.collect();
    let (stamps, stated_hz) = times(tree, &used, frames)?;
    Ok(Some(TimedPoints {
        points,
        stamps,
        clock: Clock {
            given_hz: rate_hz,
            stated_hz,
            assumed_hz: ASSUMED_HZ,
        },
        metres_per_unit: first.metres_per_unit,
    }))
}

/// Times of the frames in seconds, or their rate, of the first series that has them: the others may refer to its.
fn times(
    tree: &Hdf5Contents,
    used: &[&PoseSeries],
    frames: usize,
) -> Result<(Stamps, Option<f64>), ParseError> {
    let mut rate_hz = None;
    for series in used {
        let times = tree.numbers(&format!("{}/timestamps", series.path))?;
        if let Some(times) = times.filter(|times| times.values.len() == frames) {
            let secs = times.values.iter().copied().map(Some).collect();
            return Ok((Stamps::of_values(secs, Some(1.0)), None));
        }
        let start = attributes_of(tree, &format!("{}/starting_time", series.path))?;
        rate_hz = rate_hz.or_else(|| start.get("rate").and_then(number_of));
    }
    Ok((Stamps::none(frames), rate_hz))
}

fn attributes_of(
    tree: &Hdf5Contents,
    path: &str,
) -> Result<HashMap<String, AttrValue>, ParseError> {
    match tree.array(path) {
        Some(dataset) => dataset.attrs().map_err(damaged),
        None => Ok(HashMap::new()),
    }
}

fn number_of(value: &AttrValue) -> Option<f64> {
    match value {
        AttrValue::F64(value) => Some(*value),
        AttrValue::F32(value) => Some(f64::from(*value)),
        AttrValue::I64(value) => Some(*value as f64),
        AttrValue::I32(value) => Some(f64::from(*value)),
        AttrValue::F64Array(values) => values.first().copied(),
        _ => None,
    }
}

/// What is before the last slash, and behind it.
fn split(path: &str) -> (&str, &str) {
    path.rsplit_once('/').unwrap_or(("", path))
}
