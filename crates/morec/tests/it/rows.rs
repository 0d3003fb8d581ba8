//! Feature and pose rows of synthetic people: their mirror images, other paces, the bytes they take, the parts they have.

use std::ops::Range;

use morec::features::{
    BoneSet, FeatureParams, FeatureStream, KeyPose, RowLayout, Rows, bones_of_clip, for_each_pose,
    mirrored_rows, retimed_rows, rows_of_clip,
};
use morec::pivots::{PivotMap, PivotSet};
use morec::roles::RoleMap;
use morec::synth::{self, Person, Script};

/// Poses of somebody who walks and waves, with their times.
fn poses() -> Vec<(f64, KeyPose)> {
    let script = Script::new(1, Person::draw(1, 0)).play("walk").play("wave");
    let take = script.film("m", 60.0).unwrap();
    let roles = RoleMap::find(&take.clip.skeleton);
    let mut poses = Vec::new();
    for_each_pose(&take.clip, &roles, &(0..0), |t, pose| {
        poses.push((t, *pose))
    });
    poses
}

/// Rows of poses whose times are multiplied by `duration`.
fn rows(poses: &[(f64, KeyPose)], duration: f64) -> Rows {
    let mut stream = FeatureStream::new(BoneSet::BODY, &FeatureParams::default());
    let mut rows = Rows::new(stream.dim());
    for (t, pose) in poses {
        stream.push(t * duration, pose, &mut |row| rows.push(row));
    }
    stream.finish(&mut |row| rows.push(row));
    rows
}

/// Mean squared difference over some columns.
fn difference(a: &Rows, b: &Rows, columns: Range<usize>) -> f64 {
    let len = a.len().min(b.len());
    let squares = (0..len).flat_map(|i| {
        let (a, b) = (&a.row(i)[columns.clone()], &b.row(i)[columns.clone()]);
        a.iter()
            .zip(b)
            .map(|(a, b)| f64::from(a - b).powi(2))
            .collect::<Vec<_>>()
    });
    squares.sum::<f64>() / (len * columns.len()) as f64
}

#[test]
fn retimed_rows_are_the_rows_of_a_faster_performer() {
    let poses = poses();
    let (usual, fast) = (rows(&poses, 1.0), rows(&poses, 0.7));
    let params = FeatureParams::default();
    let retimed = retimed_rows(&usual, BoneSet::BODY, &params, 0.7);
    assert!(retimed.len().abs_diff(fast.len()) <= 1);
    // The same poses at the same velocities: without dividing by the factor velocities are far off.
    let velocities = RowLayout::BODY.velocities();
    let slow = FeatureParams {
        velocity_saturation: 1e9,
        ..params
    };
    let resampled = retimed_rows(&usual, BoneSet::BODY, &slow, 0.7);
    let zero = Rows::from_values(fast.dim(), vec![0.0; fast.values().len()]);
    let size = difference(&fast, &zero, velocities.clone());
    let error = difference(&fast, &retimed, velocities.clone());
    assert!(error < 0.1 * size, "{error} of {size}");
    assert!(error < difference(&fast, &resampled, velocities.clone()));
    let directions = 0..velocities.start;
    let error = difference(&fast, &retimed, directions);
    assert!(error < 0.01, "{error}");
}

#[test]
fn mirrored_rows_are_the_rows_of_a_mirrored_performer() {
    let poses = poses();
    let image: Vec<(f64, KeyPose)> = poses.iter().map(|(t, p)| (*t, p.mirrored())).collect();
    let expected = rows(&image, 1.0);
    let found = mirrored_rows(&rows(&poses, 1.0), BoneSet::BODY).unwrap();
    assert_eq!(found.len(), expected.len());
    for (a, b) in found.values().iter().zip(expected.values()) {
        assert!((a - b).abs() < 2e-3, "{a} and {b}");
    }
}

#[test]
fn moving_people_take_less_than_four_bits_a_value() {
    let params = FeatureParams::default();
    let (mut values, mut bytes) = (0, 0);
    for made in synth::everyday(1).into_iter().take(6) {
        let roles = RoleMap::find(&made.skeleton);
        let bones = bones_of_clip(&made, &roles, &(0..0));
        let rows = rows_of_clip(&made, &roles, &(0..0), bones, &params);
        values += rows.values().len();
        bytes += rows.to_packed().len();
    }
    assert!(values > 10_000);
    assert!(2 * bytes < values, "{bytes} bytes for {values} values");
}

#[test]
fn every_made_person_has_all_roles() {
    let script = Script::new(3, Person::draw(3, 1)).rest(0.2).play("bow");
    let clip = script.film("bow", 60.0).unwrap().clip;
    let roles = RoleMap::find(&clip.skeleton);
    let map = PivotMap::resolve(&PivotSet::roles(), &clip.skeleton, &roles).unwrap();
    assert_eq!(map.missing().len(), 0, "{:?}", map.missing());
}
