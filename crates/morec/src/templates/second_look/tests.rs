//! Against the obvious slow version, the reference, and by hand.

use proptest::prelude::*;

use crate::features::{BoneSet, FeatureParams, KeyPose, RowLayout, Rows};
use crate::math::{Axis, Vec3};
use crate::roles::Role;

use super::body::BodyTrack;
use super::bounds::{CoarseBasis, TOGETHER, apart, least_costs, sketch_of};
use super::comparison::warped_rows;
use super::extent::LookExtent;
use super::segment::{
    BAND, GrownExtent, LONG, PADDED, SEGMENT, SEGMENT_ROWS, SHORT, grow, sample_span,
};
use super::{LOOK_COLUMNS, segment_of};

/// The recurrence as written, over a table of its own.
fn slow(a: &[f64], b: &[f64], band: usize) -> f64 {
    slow_by(a.len(), band, |i, j| (a[i] - b[j]).powi(2))
}

/// The same of rows of `width` values.
fn slow_of(width: usize, a: &[f32], b: &[f32]) -> f64 {
    slow_by(SEGMENT_ROWS, BAND, |i, j| {
        let rows = a[i * width..][..width].iter().zip(&b[j * width..][..width]);
        rows.map(|(a, b)| (f64::from(*a) - f64::from(*b)).powi(2))
            .sum()
    })
}

fn slow_by(n: usize, band: usize, cost: impl Fn(usize, usize) -> f64) -> f64 {
    let mut table = vec![vec![f64::INFINITY; n + 1]; n + 1];
    table[0][0] = 0.0;
    for i in 0..n {
        for j in 0..n {
            if i.abs_diff(j) <= band {
                let cost = cost(i, j);
                let both = table[i][j] + 2.0 * cost;
                table[i + 1][j + 1] = both.min(table[i][j + 1] + cost).min(table[i + 1][j] + cost);
            }
        }
    }
    table[n][n]
}

fn values() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-4.0f64..4.0, SEGMENT_ROWS)
}

proptest! {
    #[test]
    fn the_alignment_is_the_cheapest_within_the_band(a in values(), b in values()) {
        let (fast, expected) = (warped_rows(&a, &b), slow(&a, &b, 6));
        prop_assert!((f64::from(fast) - expected).abs() < 1e-3 * (1.0 + expected), "{fast} {expected}");
    }
}

proptest! {
    #[test]
    fn bounds_are_no_larger_than_costs(
        segments in prop::collection::vec(prop::collection::vec(-3.0f32..3.0, SEGMENT), 2..11),
        limit in 1.0f32..40_000.0,
    ) {
        let basis = CoarseBasis::of(&segments.concat());
        let rows = basis.rows(&segments[0]);
        let (blocks, _) = basis.blocks(&segments.concat());
        let all = |limit: f32| -> Vec<f32> {
            let costs = |block| least_costs(block, &rows, &[limit; TOGETHER]);
            blocks.iter().flat_map(costs).collect()
        };
        let (bounds, limited) = (all(f32::INFINITY), all(limit));
        for ((segment, bound), limited) in segments.iter().zip(bounds).zip(limited) {
            let cost = slow_of(PADDED, segment, &segments[0]);
            prop_assert!(f64::from(bound) <= cost * 1.001, "{} {}", bound, cost);
            let is_kept = bound < limit && limited == bound || bound >= limit && limited >= limit;
            prop_assert!(is_kept, "{} {} {}", bound, limited, limit);
        }
    }

    #[test]
    fn sketches_are_no_farther_than_rows_aligned_one_by_one(
        segments in prop::collection::vec(prop::collection::vec(-3.0f32..3.0, SEGMENT), 2..11),
    ) {
        let basis = CoarseBasis::of(&segments.concat());
        let (_, sketches) = basis.blocks(&segments.concat());
        let first = sketch_of(&basis.rows(&segments[0]));
        let distances = sketches.iter().flat_map(|block| apart(block, &first));
        for (segment, distance) in segments.iter().zip(distances) {
            let cost = slow_by(SEGMENT_ROWS, 0, |i, j| {
                let rows = segment[i * PADDED..][..PADDED].iter().zip(&segments[0][j * PADDED..]);
                rows.map(|(a, b)| (f64::from(*a) - f64::from(*b)).powi(2)).sum()
            });
            prop_assert!(f64::from(distance) <= cost * 1.001 + 1e-3, "{} {}", distance, cost);
        }
    }

    #[test]
    fn bounds_of_rows_of_few_values_are_costs(a in values(), b in values()) {
        let rows = |values: &[f64]| {
            let mut rows = vec![0.0f32; SEGMENT];
            for (row, value) in rows.chunks_exact_mut(PADDED).zip(values) {
                row[3] = *value as f32;
            }
            rows
        };
        let (a, b) = (rows(&a), rows(&b));
        let basis = CoarseBasis::of(&[a.clone(), b.clone()].concat());
        let (blocks, _) = basis.blocks(&a);
        let [bound, ..] = least_costs(&blocks[0], &basis.rows(&b), &[f32::INFINITY; TOGETHER]);
        let cost = slow_of(PADDED, &a, &b);
        prop_assert!((f64::from(bound) - cost).abs() < 1e-3 * (1.0 + cost), "{} {}", bound, cost);
    }
}

/// A body that stands and swings its arms, turned about the vertical and scaled.
fn rows(turned_rad: f64, scale: f64) -> Rows {
    let turn = Axis::Y.rotation(turned_rad);
    let pose = |tick: usize| {
        let swing = (tick as f64 * 0.2).sin();
        let mut pose = KeyPose::default();
        let mut put =
            |role, x: f64, y: f64, z: f64| pose.set(role, turn * Vec3::new(x, y, z) * scale);
        put(Role::Hips, 0.0, 1.0, 0.0);
        put(Role::Neck, 0.0, 1.5, 0.0);
        put(Role::Head, 0.0, 1.7, 0.0);
        for (side, roles) in [
            (
                1.0,
                [
                    Role::LeftThigh,
                    Role::LeftShin,
                    Role::LeftFoot,
                    Role::LeftArm,
                    Role::LeftForearm,
                    Role::LeftHand,
                ],
            ),
            (
                -1.0,
                [
                    Role::RightThigh,
                    Role::RightShin,
                    Role::RightFoot,
                    Role::RightArm,
                    Role::RightForearm,
                    Role::RightHand,
                ],
            ),
        ] {
            put(roles[0], 0.1 * side, 1.0, 0.0);
            put(roles[1], 0.1 * side, 0.5, 0.0);
            put(roles[2], 0.1 * side, 0.0, 0.0);
            put(roles[3], 0.2 * side, 1.45, 0.0);
            put(roles[4], 0.25 * side, 1.2, 0.1 * swing);
            put(roles[5], 0.25 * side, 1.0 + 0.2 * swing.abs(), 0.25 * swing);
        }
        pose
    };
    let params = FeatureParams::default();
    let mut stream = crate::features::FeatureStream::new(BoneSet::BODY, &params);
    let mut rows = Rows::new(stream.dim());
    for tick in 0..90 {
        stream.push(tick as f64 / 30.0, &pose(tick), &mut |row| rows.push(row));
    }
    stream.finish(&mut |row| rows.push(row));
    rows
}

fn tracked(rows: &Rows) -> BodyTrack {
    let mut track = BodyTrack::new(BoneSet::BODY, &FeatureParams::default(), rows.len());
    rows.iter().for_each(|row| track.push(row));
    track
}

#[test]
fn rows_depend_neither_on_heading_nor_on_size() {
    let all: Vec<usize> = (0..LOOK_COLUMNS).collect();
    let segment = |turned, scale| segment_of(&tracked(&rows(turned, scale)), 20..60, &all);
    let reference = segment(0.0, 1.0);
    for (turned, scale) in [(1.0, 1.0), (-2.5, 1.0), (0.3, 2.0)] {
        let other = segment(turned, scale);
        let apart = reference.values().iter().zip(other.values());
        let worst = apart.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(worst < 2e-3, "{turned} {scale}: {worst}");
    }
    // Hands swing, feet stand: the places say which.
    let spread = |column: usize| {
        let values = reference.iter().map(|row| row[column]);
        values.clone().fold(f32::MIN, f32::max) - values.fold(f32::MAX, f32::min)
    };
    assert!(
        spread(2) > 0.2 && spread(14) < 0.01,
        "{} {}",
        spread(2),
        spread(14)
    );
}

#[test]
fn a_track_that_forgets_gives_the_rows_of_one_that_remembers() {
    let rows = rows(0.0, 1.0);
    let mut short = BodyTrack::new(BoneSet::BODY, &FeatureParams::default(), 16);
    let long = tracked(&rows);
    let (mut a, mut b) = ([0.0; LOOK_COLUMNS], [0.0; LOOK_COLUMNS]);
    for (tick, row) in rows.iter().enumerate() {
        short.push(row);
        let ready = tick as i64 - 12;
        if ready > short.first() + 12 {
            short.row(ready, &mut a);
            long.row(ready, &mut b);
            assert_eq!(a, b, "{ready}");
        }
    }
}

#[test]
fn columns_are_those_of_points_whose_bones_are_there() {
    assert_eq!(BodyTrack::columns(BoneSet::BODY).len(), LOOK_COLUMNS);
    // Without the right forearm there is no right hand: its place, velocity and texture.
    let body = BoneSet::BODY;
    let without = body.indices().filter(|bone| *bone != 9);
    let columns = BodyTrack::columns(without.fold(BoneSet::NONE, BoneSet::with));
    assert_eq!(columns.len(), LOOK_COLUMNS - 9);
    assert!(!columns.contains(&3) && columns.contains(&0) && columns.contains(&9));
    assert_eq!(RowLayout::of(body).dim(), 70);
}

#[test]
fn spans_and_growths_are_those_of_the_reference() {
    let data = std::env::var_os("MOREC_DATA").map_or_else(
        || std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data"),
        std::path::PathBuf::from,
    );
    let path = data.join("../design/second-look/golden.json");
    let Ok(text) = std::fs::read_to_string(&path) else {
        eprintln!("skipped: no {}", path.display());
        return;
    };
    let golden: serde_json::Value = serde_json::from_str(&text).unwrap();
    let number = |value: &serde_json::Value| value.as_i64().unwrap();
    let extent = |value: &serde_json::Value| LookExtent {
        start: number(&value[0]),
        stop: number(&value[1]),
    };
    let cases = golden["cases"].as_array().unwrap();
    assert_eq!(cases.len(), 2);
    for case in cases {
        let pace = case["pace"].as_array().unwrap().iter();
        let pace: Vec<f32> = pace.map(|p| p.as_f64().unwrap() as f32).collect();
        let span = extent(&case["span"]);
        assert_eq!(sample_span(&pace), span.start as usize..span.stop as usize);
        let track = BodyTrack::of_pace(&pace);
        for look in case["looks"].as_array().unwrap() {
            for (growth, name) in [(SHORT, "short"), (LONG, "long")] {
                let grown = grow(&track, extent(&look["match"]), growth, 0, true);
                assert_eq!(
                    grown,
                    GrownExtent::To(extent(&look[name]["extent"])),
                    "{name}"
                );
            }
        }
    }
}
