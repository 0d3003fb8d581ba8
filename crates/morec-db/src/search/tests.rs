//! Finding what was put there.

use morec::features::{FeatureParams, Rows};

use super::layout::{DIM, mirrored, to_canonical};
use super::*;
use crate::labels::{NewSample, SampleFilter};
use crate::rows::ClipRows;
use morec::files::FileReader;

use crate::testing::{database_of_waves, waves, write_bvh};
use crate::{ClipFilter, ClipUpdate};

#[test]
fn a_mirror_of_a_mirror_is_the_thing() {
    let values = (0..3 * DIM).map(|i| i as f32 - 50.0).collect();
    let laid = to_canonical(
        &Rows::from_values(DIM, values),
        morec::features::BoneSet::BODY,
    );
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
    let example = index.example(clip, label.span).unwrap();
    let hits = index.search(
        &example,
        &SearchOptions {
            limit: 4,
            ..Default::default()
        },
    );
    assert_eq!(hits.len(), 4);
    let right = hits.iter().filter(|hit| {
        let info = db
            .clips(&ClipFilter::default())
            .unwrap()
            .into_iter()
            .find(|c| c.id == hit.clip)
            .unwrap();
        let take = takes.iter().find(|t| t.clip.name == info.name).unwrap();
        take.labels.iter().any(|l| {
            let shared = l.span.overlap_secs(hit.span);
            l.class == "wave" && shared > 0.5 * l.span.duration_secs()
        })
    });
    assert!(right.count() >= 3, "{hits:?}");
    assert!(hits.windows(2).all(|pair| pair[0].score >= pair[1].score));
}

/// An exact copy of the example is the first hit, and its mirror image the first mirrored one.
#[test]
fn an_exact_copy_comes_first() {
    let (_folder, db) = indexed(4);
    let rows = db.1;
    let mut again = rows.clone();
    again.push(ClipRows {
        clip: ClipId(1000),
        ..rows[2].clone()
    });
    let bones = rows[2].bones;
    let image = mirrored(&to_canonical(&rows[2].rows, bones)).rows;
    again.push(ClipRows {
        clip: ClipId(1001),
        bones: morec::features::BoneSet::BODY,
        rows: image,
    });
    let index = SearchIndex::new(&again, 30.0);
    for (start, stop, one_a_clip) in [
        (0.0, 1e9, true),
        (0.0, 1e9, false),
        (2.0, 3.5, false),
        (1.0, 4.0, true),
    ] {
        let example = index.example(rows[2].clip, start..stop).unwrap();
        let options = SearchOptions {
            one_a_clip,
            mirror: true,
            ..Default::default()
        };
        let hits = index.search(&example, &options);
        assert_eq!(
            (hits[0].clip, hits[0].mirrored),
            (ClipId(1000), false),
            "{hits:?}"
        );
        assert!(
            hits[0].score > 0.97 && hits[0].warp_distance < 0.02,
            "{hits:?}"
        );
        assert!((hits[0].span.start_secs - start).abs() < 0.05, "{hits:?}");
        let image = hits.iter().find(|hit| hit.mirrored).unwrap();
        assert_eq!(image.clip, ClipId(1001), "{hits:?}");
    }
}

fn indexed(people: usize) -> (tempfile::TempDir, (crate::MotionDb, Vec<ClipRows>)) {
    let (folder, mut db) = database_of_waves(people);
    let rows = db.rows(&FeatureParams::default(), &()).unwrap();
    (folder, (db, rows))
}

/// All labels of these takes, as accepted samples.
fn label(db: &mut crate::MotionDb, takes: &[morec::synth::SyntheticTake]) {
    let mut samples = Vec::new();
    for take in takes {
        let clip = db.find_clip(&take.clip.name).unwrap().id;
        samples.extend(
            take.labels
                .iter()
                .map(|l| NewSample::accepted(clip, l.class, l.span)),
        );
    }
    db.add_samples(&samples, "test").unwrap();
}

/// Learned from three people, the metric brings waves of a fourth nearer to those of a fifth, relative to bows.
#[test]
fn a_learned_metric_tells_classes_of_others_apart() {
    let takes = waves(5);
    let (_folder, (mut db, rows)) = indexed(5);
    let index = SearchIndex::new(&rows, 30.0);
    let samples = |db: &crate::MotionDb| db.samples(&SampleFilter::default()).unwrap();
    assert!(
        index
            .learn(&samples(&db))
            .unwrap_err()
            .to_string()
            .contains("2 classes")
    );
    label(&mut db, &takes[..3]);
    let one: Vec<_> = samples(&db)
        .into_iter()
        .filter(|s| s.class == "wave")
        .collect();
    assert!(index.learn(&one).is_err());
    let metric = index.learn(&samples(&db)).unwrap();
    assert_eq!(metric.classes(), ["bow", "wave"]);
    assert_eq!(metric.samples(), samples(&db).len());
    label(&mut db, &takes[3..]);
    let place = |take: usize, class: &str| {
        let clip = db.find_clip(&takes[take].clip.name).unwrap().id;
        let of = samples(&db)
            .into_iter()
            .find(|s| s.clip == clip && s.class == class)
            .unwrap();
        let indexed = index.clips.iter().find(|c| c.clip == clip).unwrap();
        let span = (of.start_secs * 30.0) as usize..(of.stop_secs * 30.0) as usize;
        let summary = indexed.sums.octaves(&span);
        (
            metric.place(&summary, span.len(), indexed.laid.bones),
            summary,
        )
    };
    let (wave, bow, other) = (place(3, "wave"), place(3, "bow"), place(4, "wave"));
    let plain = |a: &summary::Summary, b: &summary::Summary| {
        summary::SummaryDistance::over(morec::features::BoneSet::BODY).distance(a, b)
    };
    let learned = wave.0.distance(&other.0) / wave.0.distance(&bow.0);
    assert!(
        learned < plain(&wave.1, &other.1) / plain(&wave.1, &bow.1),
        "{learned}"
    );
    assert!(learned < 0.5, "{learned}");

    let label = takes[3].labels.iter().find(|l| l.class == "wave").unwrap();
    let clip = db.find_clip(&takes[3].clip.name).unwrap().id;
    let example = index.example(clip, label.span).unwrap();
    let hits = index.search_by(
        &example,
        &SearchOptions {
            limit: 6,
            ..Default::default()
        },
        Some(&metric),
    );
    let right = hits.iter().filter(|hit| {
        let all = samples(&db);
        all.iter().any(|s| {
            let shared = s.span().overlap_secs(hit.span);
            s.clip == hit.clip && s.class == "wave" && shared > 0.5 * s.span().duration_secs()
        })
    });
    assert!(right.count() >= 5, "{hits:?}");
}

/// A clip as the example: a clip that continues with other motion is less similar than one that does not.
#[test]
fn whole_clips_are_compared_with_whole_clips() {
    let (_folder, (_db, rows)) = indexed(2);
    let tick = |secs: f64| (secs * 30.0) as usize;
    let takes = waves(2);
    let take = |n: usize| {
        takes
            .iter()
            .position(|t| t.clip.name == takes[n].clip.name)
            .unwrap()
    };
    let first = |n: usize| takes[take(n)].labels[0];
    let cut = |n: usize, id: i64, stop: f64| {
        let span = tick(first(n).span.start_secs)..tick(stop).min(rows[n].rows.len());
        ClipRows {
            clip: ClipId(id),
            bones: rows[n].bones,
            rows: rows[n].rows.slice(span),
        }
    };
    let clips = [
        cut(0, 1, first(0).span.stop_secs),
        cut(0, 2, 1e9),
        cut(1, 3, first(1).span.stop_secs),
    ];
    let index = SearchIndex::new(&clips, 30.0);
    let options = SearchOptions {
        one_a_clip: true,
        ..Default::default()
    };
    let example = index.example(ClipId(1), 0.0..1e9).unwrap();
    let of = |hits: &[Hit]| hits.iter().map(|h| h.clip.0).collect::<Vec<_>>();
    // As a stretch the beginning of the second clip is the very same.
    assert_eq!(
        of(&index.search(&example.clone().cut_out(), &options))[0],
        2
    );
    let whole = index.search(&example, &options);
    let stretch = index.search(&example.cut_out(), &options);
    let score = |hits: &[Hit], id: i64| hits.iter().find(|h| h.clip.0 == id).unwrap().score;
    assert!(score(&whole, 2) < score(&stretch, 2), "{whole:?}");
}

/// Wherever the example is cut out, what lies beside it in its clip is found without it.
#[test]
fn the_example_itself_is_no_hit() {
    let (_folder, mut db) = database_of_waves(2);
    let index = SearchIndex::of_db(&mut db, &()).unwrap();
    let clip = db.clips(&ClipFilter::default()).unwrap().remove(0);
    for start in 0..((clip.duration_secs() - 1.5) * 4.0) as usize {
        let span = TimeSpan::new(start as f64 / 4.0, start as f64 / 4.0 + 1.5);
        let example = index.example(clip.id, span).unwrap();
        for hit in index.search(&example, &SearchOptions::default()) {
            let is_own = hit.clip == clip.id && hit.span.overlap_share(span) >= 0.5;
            assert!(!is_own, "{span}: {hit:?}");
        }
    }
}

/// The same motion at another rate, turned, and cut short is found as a copy; its mirror image as a mirrored one; and
/// clips of others are not.
#[test]
fn planted_copies_are_found_and_nothing_else() {
    let (folder, mut db) = database_of_waves(3);
    let original = waves(1).remove(0).clip;
    let resampled = original.resampled(30.0).unwrap();
    let image = mirror_of(&original);
    let paths = [
        write_bvh(folder.path(), "resampled", &resampled),
        write_bvh(folder.path(), "image", &image),
    ];
    db.import(&paths, &FileReader::default(), &ClipUpdate::default(), &())
        .unwrap();
    let index = SearchIndex::of_db(&mut db, &()).unwrap();
    let id = |name: &str| db.find_clip(name).unwrap().id;
    let pairs = |found: Vec<NearCopy>| {
        let mut pairs: Vec<_> = found
            .into_iter()
            .map(|c| ([c.of.min(c.copy), c.of.max(c.copy)], c.mirrored))
            .collect();
        pairs.sort();
        pairs
    };
    let (a, b, c) = (id(&original.name), id("resampled"), id("image"));
    assert_eq!(
        pairs(near_duplicates(&index)),
        [([a, b], false), ([a, c], true), ([b, c], true)]
    );
    assert_eq!(
        pairs(near_duplicates_of(&index, &[b].into())),
        [([a, b], false), ([b, c], true)]
    );
}

/// Sides swapped and everything reflected in the plane x = 0.
fn mirror_of(clip: &morec::clip::Clip) -> morec::clip::Clip {
    use morec::math::{Quat, Vec3};
    let joints = clip.skeleton.joints();
    let other = |name: &str| {
        if name.contains("Left") {
            name.replace("Left", "Right")
        } else {
            name.replace("Right", "Left")
        }
    };
    let opposite: Vec<usize> = joints
        .iter()
        .map(|j| clip.skeleton.find(&other(&j.name)).expect("both sides"))
        .collect();
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
