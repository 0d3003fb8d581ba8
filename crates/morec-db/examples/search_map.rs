//! How well search finds motions of the class of its example:
//! `cargo run --release -p morec-db --example search_map [FOLDER [WARP_SHARE]]`.
//!
//! Needs a folder with `clips/` (BVH) and `clips.tsv` (clip, class, and style or person): `everyday` of `MOREC_DATA`, if
//! none is given. Every clip is the example once, as with `morec db search DB CLIP --one-a-clip`; printed is mean average
//! precision over all other clips, and over those of other styles than the example's, which are the question. With a
//! learned metric: half of the styles are labelled to learn from, every half once; examples and answers are the others.

#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::print_stderr)]

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use morec_db::labels::{NewSample, SampleFilter, SampleState};
use morec_db::search::{LearnedMetric, SearchIndex, SearchOptions};
use morec_db::{ClipFilter, ClipId, ClipUpdate, MotionDb};

/// A clip with what it shows and how.
struct Shown {
    id: ClipId,
    secs: f64,
    class: String,
    style: String,
}

fn main() {
    let mut args = std::env::args().skip(1);
    let folder = args
        .next()
        .map_or_else(|| data().join("everyday"), PathBuf::from);
    let share = args
        .next()
        .map_or(SearchOptions::default().warp_share, |s| s.parse().unwrap());
    let Ok(table) = std::fs::read_to_string(folder.join("clips.tsv")) else {
        println!(
            "skipped: {} is not there (MOREC_DATA says where the clips are)",
            folder.join("clips.tsv").display()
        );
        return;
    };
    let temporary = tempfile::tempdir().unwrap();
    let mut db = MotionDb::create(&temporary.path().join("search.mdb")).unwrap();
    let clips = imported(&mut db, &folder, &table);
    let index = SearchIndex::of_db(&mut db, &()).unwrap();
    let options = SearchOptions {
        limit: clips.len(),
        one_a_clip: true,
        warp_share: share,
        ..SearchOptions::default()
    };
    let (all, other) = means(&index, &clips, &options, None);
    println!(
        "{} clips, no labels: all {all:.3}, other styles only {other:.3}",
        clips.len()
    );
    learned(&mut db, &index, &clips, &options);
}

fn data() -> PathBuf {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    std::env::var_os("MOREC_DATA").map_or(beside, PathBuf::from)
}

fn imported(db: &mut MotionDb, folder: &Path, table: &str) -> Vec<Shown> {
    let cells: BTreeMap<&str, (&str, &str)> = table
        .lines()
        .skip(1)
        .filter_map(|line| {
            let mut cells = line.split('\t');
            Some((cells.next()?, (cells.next()?, cells.next()?)))
        })
        .collect();
    let mut paths: Vec<PathBuf> = cells
        .keys()
        .map(|name| folder.join(format!("clips/{name}.bvh")))
        .filter(|p| p.exists())
        .collect();
    paths.sort();
    db.import(
        &paths,
        &morec::files::FileReader::default(),
        &ClipUpdate::default(),
        &(),
    )
    .unwrap();
    let clips = db.clips(&ClipFilter::default()).unwrap();
    let shown = clips.into_iter().filter_map(|clip| {
        let (class, style) = cells.get(clip.name.as_str())?;
        let secs = clip.duration_secs();
        Some(Shown {
            id: clip.id,
            secs,
            class: (*class).into(),
            style: (*style).into(),
        })
    });
    shown.collect()
}

/// Mean average precision over all other clips and over those of other styles, of those that are asked about.
fn means(
    index: &SearchIndex,
    clips: &[Shown],
    options: &SearchOptions,
    metric: Option<(&LearnedMetric, &BTreeSet<&str>)>,
) -> (f64, f64) {
    let asked =
        |clip: &&Shown| metric.is_none_or(|(_, known)| !known.contains(clip.style.as_str()));
    let by_id: BTreeMap<ClipId, &Shown> = clips.iter().filter(asked).map(|c| (c.id, c)).collect();
    let (mut all, mut other) = (Vec::new(), Vec::new());
    for clip in by_id.values() {
        let Some(example) = index.example(clip.id, 0.0..clip.secs) else {
            continue;
        };
        let hits = index.search_by(&example, options, metric.map(|(metric, _)| metric));
        let found: Vec<&Shown> = hits
            .iter()
            .filter_map(|hit| by_id.get(&hit.clip).copied())
            .collect();
        let relevant = |c: &&Shown| c.class == clip.class && c.id != clip.id;
        let elsewhere = |c: &&Shown| c.style != clip.style;
        let count = by_id.values().copied().filter(|c| relevant(c)).count();
        all.extend(average_precision(found.iter().map(&relevant), count));
        let count = by_id
            .values()
            .copied()
            .filter(|c| relevant(c) && elsewhere(c))
            .count();
        other.extend(average_precision(
            found.iter().filter(|c| elsewhere(c)).map(relevant),
            count,
        ));
    }
    (mean(&all), mean(&other))
}

fn learned(db: &mut MotionDb, index: &SearchIndex, clips: &[Shown], options: &SearchOptions) {
    let styles: Vec<&str> = clips
        .iter()
        .map(|c| c.style.as_str())
        .collect::<BTreeSet<_>>()
        .into_iter()
        .collect();
    let (half, mut values) = (styles.len() / 2, Vec::new());
    for set in (0u32..1 << styles.len()).filter(|set| set.count_ones() as usize == half) {
        let known: BTreeSet<&str> = styles
            .iter()
            .enumerate()
            .filter(|(i, _)| set >> i & 1 == 1)
            .map(|(_, s)| *s)
            .collect();
        let samples: Vec<NewSample> = clips
            .iter()
            .filter(|c| known.contains(c.style.as_str()))
            .map(labelled)
            .collect();
        db.add_samples(&samples, "search_map").unwrap();
        let metric = index.learn(&db.samples(&SampleFilter::default()).unwrap());
        db.undo(None).unwrap();
        match metric {
            Ok(metric) => {
                let (_, other) = means(index, clips, options, Some((&metric, &known)));
                println!(
                    "learned from {}: other styles only {other:.3}",
                    Vec::from_iter(known).join(", ")
                );
                values.push(other);
            }
            Err(error) => println!("{error}"),
        }
    }
    let (least, most) = values
        .iter()
        .fold((1.0f64, 0.0f64), |(a, b), v| (a.min(*v), b.max(*v)));
    println!(
        "learned: other styles only {:.3} ({least:.3} to {most:.3})",
        mean(&values)
    );
}

fn labelled(clip: &Shown) -> NewSample {
    NewSample {
        clip: clip.id,
        class: clip.class.clone(),
        start_secs: 0.0,
        stop_secs: clip.secs,
        whole_clip: true,
        state: SampleState::Accepted,
        score: None,
    }
}

/// Of answers in their order, of which `count` are right in all; `None` if there are none.
fn average_precision(right: impl Iterator<Item = bool>, count: usize) -> Option<f64> {
    let (mut found, mut sum) = (0, 0.0);
    for (at, right) in right.enumerate() {
        if right {
            found += 1;
            sum += f64::from(found) / (at + 1) as f64;
        }
    }
    (count > 0).then(|| sum / count as f64)
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}
