//! Finding what was put there.

use morec::features::{FeatureParams, Rows};

use super::layout::{DIM, lay_out, mirrored};
use super::*;
use crate::testing::{BvhReader, database_of_waves, waves, write_bvh};
use crate::{ClipFilter, ImportSettings};

#[test]
fn a_mirror_of_a_mirror_is_the_thing() {
    let values = (0..3 * DIM).map(|i| i as f32 - 50.0).collect();
    let laid = lay_out(&Rows::from_values(DIM, values), morec::features::BoneSet::ALL);
    assert_eq!(mirrored(&mirrored(&laid)).rows, laid.rows);
    assert_ne!(mirrored(&laid).rows, laid.rows);
}

/// A wave of one person finds the waves of the others, at the right places.
#[test]
fn a_stretch_finds_its_like_in_other_clips() {
    let takes = waves(3);
    let (_folder, mut db) = database_of_waves(3);
    let index = SearchIndex::of_db(&mut db, &()).unwrap();
    let label = takes[0].labels.iter().find(|l| l.class == "wave").unwrap();
    let clip = db.find_clip(&takes[0].clip.name).unwrap().id;
    let example = index.example(clip, label.start_secs, label.stop_secs).unwrap();
    let hits = index.search(&example, &SearchOptions { limit: 4, ..Default::default() });
    assert_eq!(hits.len(), 4);
    let right = hits.iter().filter(|hit| {
        let info = db.clips(&ClipFilter::default()).unwrap().into_iter().find(|c| c.id == hit.clip).unwrap();
        let take = takes.iter().find(|t| t.clip.name == info.name).unwrap();
        take.labels.iter().any(|l| {
            let shared = l.stop_secs.min(hit.stop_secs) - l.start_secs.max(hit.start_secs);
            l.class == "wave" && shared > 0.5 * (l.stop_secs - l.start_secs)
        })
    });
    assert!(right.count() >= 3, "{hits:?}");
    assert!(hits.windows(2).all(|pair| pair[0].score >= pair[1].score));
}

/// The same motion at another rate, turned, and cut short is found as a copy; its mirror image as a mirrored one; and
/// clips of others are not.
#[test]
fn planted_copies_are_found_and_nothing_else() {
    let (folder, mut db) = database_of_waves(3);
    let original = waves(1).remove(0).clip;
    let resampled = original.resampled(30.0).unwrap();
    let image = mirror_of(&original);
    let paths =
        [write_bvh(folder.path(), "resampled", &resampled), write_bvh(folder.path(), "image", &image)];
    db.import(&paths, &BvhReader, &ImportSettings::default(), &()).unwrap();
    let index = SearchIndex::of_db(&mut db, &()).unwrap();
    let id = |name: &str| db.find_clip(name).unwrap().id;
    let pairs = |found: Vec<NearCopy>| {
        let mut pairs: Vec<_> =
            found.into_iter().map(|c| ([c.of.min(c.copy), c.of.max(c.copy)], c.mirrored)).collect();
        pairs.sort();
        pairs
    };
    let (a, b, c) = (id(&original.name), id("resampled"), id("image"));
    assert_eq!(pairs(near_copies(&index)), [([a, b], false), ([a, c], true), ([b, c], true)]);
    assert_eq!(pairs(near_copies_of(&index, &[b].into())), [([a, b], false), ([b, c], true)]);
}

/// Sides swapped and everything reflected in the plane x = 0.
fn mirror_of(clip: &morec::clip::Clip) -> morec::clip::Clip {
    use morec::math::{Quat, Vec3};
    let joints = clip.skeleton.joints();
    let other = |name: &str| {
        if name.contains("Left") { name.replace("Left", "Right") } else { name.replace("Right", "Left") }
    };
    let opposite: Vec<usize> =
        joints.iter().map(|j| clip.skeleton.find(&other(&j.name)).expect("both sides")).collect();
    let flip = |v: &Vec3| Vec3::new(-v.x, v.y, v.z);
    let mut image = clip.clone();
    image.name = "image".into();
    for frame in 0..clip.frames {
        for j in 0..joints.len() {
            let q = clip.rotations[frame * joints.len() + opposite[j]];
            let flipped = nalgebra::Quaternion::new(q.w, q.i, -q.j, -q.k);
            image.rotations[frame * joints.len() + j] = Quat::new_normalize(flipped);
        }
    }
    for track in &mut image.tracks {
        track.positions.iter_mut().for_each(|p| *p = flip(p));
    }
    image
}

#[test]
fn features_of_the_index_are_those_of_recognition() {
    let (_folder, mut db) = database_of_waves(1);
    let params = FeatureParams::default();
    let index = SearchIndex::of_db(&mut db, &()).unwrap();
    let rows = db.rows(&params, &()).unwrap();
    assert_eq!(index.ticks(), rows[0].rows.len());
    let stored = db.clip(rows[0].clip).unwrap();
    let (bones, fresh) = crate::rows::rows_of(&stored, &params);
    assert_eq!(bones, rows[0].bones);
    for (a, b) in fresh.values().iter().zip(rows[0].rows.values()) {
        assert!((a - b).abs() < 0.04);
    }
}
