//! Bounds hold, and a search that reads few clips has the hits of a search that reads all.

use morec::features::{BoneSet, FeatureParams, RowLayout, Rows};
use proptest::prelude::*;

use super::bound::{BoundDepth, lower_bounds};
use super::candidates::spans;
use super::rank::probes;
use super::*;
use crate::testing::database_of_waves;

/// Motion of the bones at random: directions that turn about, rest for a while, or jump; and travel.
fn wandering(seed: u64, rows: usize, bones: BoneSet) -> Rows {
    let layout = RowLayout::of(bones);
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    let mut random = move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 40) as f32 / (1 << 24) as f32 - 0.5
    };
    let mut out = Rows::new(layout.dim());
    let mut row = vec![0f32; layout.dim()];
    let phases: Vec<f32> = (0..layout.dim()).map(|_| 6.0 * random()).collect();
    let (mut pace, mut size) = (0.2, 0.5);
    for t in 0..rows {
        if t % 20 == 0 {
            pace = 0.4 * (random() + 0.5);
            size = if random() > 0.2 { 0.0 } else { random() + 0.5 };
        }
        for (i, value) in row.iter_mut().enumerate() {
            let moved = size * (pace * t as f32 + phases[i]).sin() + 0.02 * random();
            *value = ((0.4 * phases[i] / 3.0 + 0.5 * moved) * 64.0).round() / 64.0;
        }
        out.push(&row);
    }
    out
}

fn clips_of(seed: u64, count: usize, bones: &[BoneSet]) -> Vec<ClipRows> {
    (0..count)
        .map(|i| ClipRows {
            clip: ClipId(100 + i as i64),
            bones: bones[i % bones.len()],
            rows: wandering(
                seed + i as u64,
                1 + (seed as usize + 37 * i) % 150,
                bones[i % bones.len()],
            ),
        })
        .collect()
}

fn sketches_of(clips: &[ClipRows]) -> Vec<Vec<u8>> {
    let sketch = |clip: &ClipRows| sketch_of(clip).unwrap_or_default();
    clips.iter().map(sketch).collect()
}

fn sketched<'a>(sketch: &'a Vec<u8>, clip: &ClipRows) -> SketchedClip<'a> {
    SketchedClip {
        sketch,
        bones: clip.bones,
    }
}

/// Clips with their sketches.
struct Sketched<'a> {
    clips: &'a [ClipRows],
    sketches: Vec<Vec<u8>>,
}

impl SketchedClips for Sketched<'_> {
    fn count(&self) -> usize {
        self.clips.len()
    }

    fn clip(&self, at: usize) -> SketchedClip<'_> {
        sketched(&self.sketches[at], &self.clips[at])
    }
}

fn bounds(
    example: &Example,
    options: &SearchOptions,
    depth: BoundDepth,
    reach: f32,
    clips: &[ClipRows],
) -> Vec<f32> {
    let sketches = sketches_of(clips);
    let clip = |(sketch, clip)| sketched(sketch, clip);
    lower_bounds(
        example,
        options,
        depth,
        reach,
        sketches.par_iter().zip(clips).map(clip),
    )
}

/// The search that reads few clips, the likeliest by `codes` first: its hits, and how many clips it read.
fn pruned(
    example: &Example,
    options: &SearchOptions,
    clips: &[ClipRows],
    codes: Option<&SketchCodes>,
    exact: bool,
) -> (Vec<Hit>, usize) {
    let sketches = Sketched {
        clips,
        sketches: sketches_of(clips),
    };
    let mut plan = SearchPlan::new(example, options, 30.0, &sketches, codes);
    let mut read = 0;
    loop {
        let which = plan.next_to_read(exact, &sketches);
        if which.is_empty() {
            return (plan.hits(), read);
        }
        read += which.len();
        let rows: Vec<ClipRows> = which.iter().map(|at| clips[*at].clone()).collect();
        plan.take(&rows);
    }
}

fn all_options(limit: usize) -> Vec<SearchOptions> {
    let mut all = Vec::new();
    for (mirror, one_a_clip) in [(false, false), (true, false), (false, true), (true, true)] {
        all.push(SearchOptions {
            limit,
            mirror,
            one_a_clip,
            ..Default::default()
        });
    }
    all
}

fn check_bounds(example: &Example, clips: &[ClipRows]) {
    let index = SearchIndex::new(clips, 30.0);
    for options in all_options(20) {
        let probes = probes(example, &options, None);
        let [boxes, eighths] = [BoundDepth::Box, BoundDepth::Eighths]
            .map(|depth| bounds(example, &options, depth, f32::INFINITY, clips));
        let mut order = eighths.clone();
        order.sort_by(f32::total_cmp);
        let reach = order[order.len() / 3];
        let near = bounds(example, &options, BoundDepth::Eighths, reach, clips);
        for (near, far) in near.iter().zip(&eighths) {
            assert!(near == far || *near > reach, "{near} {far} {reach}");
        }
        for clip in &index.clips {
            let at = clips.iter().position(|c| c.clip == clip.clip).unwrap();
            let rows = clip.laid.rows.len();
            let whole = probes[0].whole.then_some(0..rows).filter(|_| rows >= 3);
            for span in spans(example.laid.rows.len(), rows).chain(whole) {
                for probe in probes
                    .iter()
                    .filter(|p| !p.bones.and(clip.laid.bones).is_empty())
                {
                    let distance = probe.distance_of(clip, &span);
                    for bound in [boxes[at], eighths[at]] {
                        assert!(bound <= distance, "{span:?}: {bound} {distance}");
                    }
                    let said = near[at];
                    assert!(
                        said <= distance || distance > reach,
                        "{span:?}: {said} {distance}, {reach}"
                    );
                }
            }
        }
    }
}

/// Some bones.
fn some() -> BoneSet {
    [0, 1, 4, 6].into_iter().fold(BoneSet::NONE, BoneSet::with)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_window_is_nearer_than_the_bound(seed in 0u64..1 << 40, start in 0usize..100, length in 3usize..120) {
        let clips = clips_of(seed, 12, &[BoneSet::BODY, BoneSet::BODY, some()]);
        let from = wandering(seed ^ 77, 220, BoneSet::BODY);
        let example = SearchIndex::example_of(&from.slice(start..start + length), BoneSet::BODY).unwrap();
        check_bounds(&example, &clips);
        check_bounds(&example.cut_out(), &clips);
    }

}

proptest! {
    // Each case is sixteen searches among hundreds of clips.
    #![proptest_config(ProptestConfig { cases: 2, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn few_clips_are_read_and_the_hits_are_those_of_all(seed in 0u64..1 << 40, limit in 1usize..40) {
        let mut clips = clips_of(seed, 300, &[BoneSet::BODY, some(), BoneSet::BODY]);
        // Equal distances: copies under other numbers.
        for at in (0..300).step_by(10) {
            clips[at + 5].rows = clips[at].rows.clone();
            clips[at + 5].bones = clips[at].bones;
        }
        let index = SearchIndex::new(&clips, 30.0);
        let of = clips.iter().find(|c| c.rows.len() > 60).unwrap();
        let codes = SketchCodes::default();
        for example in [
            index.example(of.clip, 0.3..1.8).unwrap(),
            SearchIndex::example_of(&of.rows, of.bones).unwrap(),
        ] {
            for options in all_options(limit) {
                for codes in [None, Some(&codes)] {
                    let (hits, read) = pruned(&example, &options, &clips, codes, true);
                    prop_assert_eq!(&hits, &index.search(&example, &options));
                    prop_assert!(read <= clips.len(), "none is read twice");
                }
            }
        }
    }
}

/// Motion of people: the bounds hold, the hits are the same, and a good part is not read.
#[test]
fn of_motion_few_clips_are_read() {
    let (_folder, mut db) = database_of_waves(6);
    let rows = db.rows(&FeatureParams::default(), &()).unwrap();
    let mut clips = Vec::new();
    for (number, start) in (0..20).flat_map(|start| (0..rows.len()).map(move |n| (n, start))) {
        let of = &rows[number];
        let from = 20 * start;
        if from + 100 <= of.rows.len() {
            clips.push(ClipRows {
                clip: ClipId(clips.len() as i64),
                bones: of.bones,
                rows: of.rows.slice(from..from + 100),
            });
        }
    }
    let index = SearchIndex::new(&clips, 30.0);
    let example = index.example(ClipId(3), 0.5..2.5).unwrap();
    check_bounds(&example, &clips);
    for options in all_options(3) {
        let (hits, _) = pruned(&example, &options, &clips, None, true);
        assert_eq!(hits, index.search(&example, &options));
    }
}

/// On real clips: the bounds hold, hits are the same and most clips are not read.
#[test]
fn of_real_clips_most_are_not_read() {
    let Some(data) = mocap::testing::data() else {
        return;
    };
    let found = std::fs::read_dir(data.join("everyday/clips")).unwrap();
    let files: Vec<_> = found.map(|f| f.unwrap().path()).collect();
    let home = tempfile::tempdir().unwrap();
    let mut db = MotionDb::create(&home.path().join("all.mdb")).unwrap();
    let (reader, about) = (
        morec::files::FileReader::default(),
        crate::ClipUpdate::default(),
    );
    db.import(&files, &reader, &about, &()).unwrap();
    let rows = db.rows(&FeatureParams::default(), &()).unwrap();
    // Pieces of two seconds, so that there are many.
    let pieces = rows.iter().flat_map(|of| {
        let starts = (0..of.rows.len().saturating_sub(60)).step_by(15);
        starts.map(|start| (of.bones, of.rows.slice(start..start + 60)))
    });
    let clips: Vec<ClipRows> = pieces
        .enumerate()
        .map(|(number, (bones, rows))| ClipRows {
            clip: ClipId(number as i64),
            bones,
            rows,
        })
        .collect();
    let index = SearchIndex::new(&clips, 30.0);
    let (mut shares, codes, mut likely) = (Vec::new(), SketchCodes::default(), (0, 0));
    for number in (0..clips.len() as i64).step_by(clips.len() / 8) {
        let example = index.example(ClipId(number), 0.2..1.4).unwrap();
        check_bounds(&example, &clips[..100.min(clips.len())]);
        for options in all_options(5) {
            let (hits, read) = pruned(&example, &options, &clips, Some(&codes), true);
            assert_eq!(hits, index.search(&example, &options));
            shares.push(read as f64 / clips.len() as f64);
            let (quick, fewer) = pruned(&example, &options, &clips, Some(&codes), false);
            assert!(fewer <= read);
            let is_found = |hit: &&Hit| {
                quick
                    .iter()
                    .any(|q| (q.clip, q.span) == (hit.clip, hit.span))
            };
            likely = (
                likely.0 + hits.iter().filter(is_found).count(),
                likely.1 + hits.len(),
            );
        }
    }
    let mean = shares.iter().sum::<f64>() / shares.len() as f64;
    println!("{} clips, {mean:.3} of them read", clips.len());
    assert!(mean < 0.6, "{mean} of {} clips read", clips.len());
    let (found, of) = likely;
    println!("{found} of {of} hits by the likeliest clips alone");
    assert!(
        4 * found >= 3 * of,
        "{found} of {of} hits are among the likeliest clips"
    );
}
