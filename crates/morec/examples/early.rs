//! How well motions are known at half of their length: `cargo run --release -p morec --example early`.
//!
//! Trains on two of the three referee clips with signals, plays the third, and goes round. At the middle of every
//! sample: is its class being told? And of all that is told as half done or more: how much is right? Needs the clips
//! (`MOREC_DATA`). Arguments `name=value` set a figure of `EarlyDetectionParams`.

// What tests share lies outside of test functions, where the lint looks for it.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::print_stderr)]

#[path = "../tests/it/kit.rs"]
#[allow(dead_code)]
mod kit;

use std::sync::Arc;

use morec::features::{bones_of_clip, for_each_pose};
use morec::labels::{ClipLength, Labels, Sample};
use morec::live::{EarlyDetection, Recognizer};
use morec::templates::{EarlyDetectionParams, TemplateModel};
use morec::train::{Everyday, LabelSet, StreamKind, TrainClip, TrainOptions, train_clips};

const SIGNALS: [&str; 3] = ["signals_1", "signals_2", "signals_3"];
const CLASSES: [&str; 7] = [
    "traveling",
    "illegal_dribble",
    "visible_count",
    "no_score",
    "hands_up",
    "pushing",
    "stop_clock",
];

fn main() {
    let Some(data) = kit::data() else { return };
    let mut params = EarlyDetectionParams::default();
    std::env::args()
        .skip(1)
        .for_each(|arg| set(&mut params, &arg));
    println!("{params:?}");
    let names: Vec<String> = std::fs::read_dir(data.join("referee/clips"))
        .unwrap()
        .filter_map(|e| {
            e.unwrap()
                .path()
                .file_stem()
                .map(|s| s.to_string_lossy().into_owned())
        })
        .collect();
    let of = |prefixes: &[&str]| -> Vec<&String> {
        let mut found: Vec<&String> = names
            .iter()
            .filter(|n| prefixes.iter().any(|p| n.starts_with(p)))
            .collect();
        found.sort();
        found
    };
    let load = |names: Vec<&String>, source| -> Vec<TrainClip> {
        names
            .into_iter()
            .map(|n| kit::referee(&data, n, source))
            .collect()
    };
    let background = load(
        of(&["jumping_", "soccer_", "running_"]),
        StreamKind::Background,
    );
    let unknown = load(
        of(&["walking_", "basketball_", "traffic_4"]),
        StreamKind::Background,
    );
    let signals: Vec<TrainClip> = SIGNALS
        .iter()
        .map(|n| kit::referee(&data, n, StreamKind::Labelled))
        .collect();
    let labels = Labels::read(&std::fs::read(data.join("referee/labels.tsv")).unwrap()).unwrap();
    let lengths = signals.iter().map(|c| {
        (
            c.name.clone(),
            ClipLength {
                frames: c.clip.frames,
                rate_hz: c.clip.rate_hz,
            },
        )
    });
    let mut samples = labels.resolve(&lengths.collect()).samples;
    samples.retain(|s| CLASSES.contains(&s.class.as_str()));

    let (mut all, mut known, mut told, mut right, mut false_unknown) =
        (0usize, 0usize, 0usize, 0usize, 0usize);
    for test in 0..signals.len() {
        let mut clips: Vec<TrainClip> = background.clone();
        clips.extend(
            signals
                .iter()
                .enumerate()
                .filter(|(i, _)| *i != test)
                .map(|(_, c)| c.clone()),
        );
        let taught: Vec<Sample> = samples
            .iter()
            .filter(|s| s.clip != SIGNALS[test])
            .cloned()
            .collect();
        let model = Arc::new(train(&clips, &taught));
        let name = |h: &EarlyDetection| model.classes[h.class.index()].name.clone();
        let hunches = play(&model, &signals[test], params);
        for s in samples.iter().filter(|s| s.clip == SIGNALS[test]) {
            all += 1;
            let middle_secs = 0.5 * (s.start_secs + s.stop_secs);
            let at = hunches
                .iter()
                .rev()
                .find(|(t, _)| *t <= middle_secs)
                .and_then(|(_, h)| *h);
            // One that began well before the sample is another motion's, perhaps of the same class.
            let length_secs = s.stop_secs - s.start_secs;
            let of_it = |h: EarlyDetection| {
                name(&h) == s.class && h.start_secs > s.start_secs - 0.25 * length_secs
            };
            known += usize::from(at.is_some_and(of_it));
        }
        for h in half_done(&hunches) {
            told += 1;
            let is = |s: &&Sample| {
                s.clip == SIGNALS[test]
                    && s.class == name(&h)
                    && s.start_secs < h.seen_secs
                    && h.start_secs < s.stop_secs
            };
            right += usize::from(samples.iter().any(|s| is(&s)));
        }
        if test == 0 {
            false_unknown = unknown
                .iter()
                .map(|c| half_done(&play(&model, c, params)).len())
                .sum();
        }
    }
    println!(
        "known at the middle of {all} samples: {known}, recall {:.2}",
        known as f64 / all as f64
    );
    println!(
        "told as half done or more: {told}, right {right}, precision {:.2}",
        right as f64 / told as f64
    );
    let secs: f64 = unknown.iter().map(|c| c.clip.duration_secs()).sum();
    println!(
        "in {:.1} min without the signals: {false_unknown} told",
        secs / 60.0
    );
}

fn set(params: &mut EarlyDetectionParams, arg: &str) {
    let (name, value) = arg.split_once('=').expect("name=value");
    let value: f32 = value.parse().expect("a number");
    match name {
        "least_progress" => params.least_progress = value,
        "least_ticks" => params.least_ticks = value as usize,
        "reach" => params.reach = value,
        "gate" => params.gate = value,
        "rival" => params.rival = value,
        "streak" => params.streak = value as usize,
        _ => panic!("no figure is called {name}"),
    }
}

fn train(clips: &[TrainClip], samples: &[Sample]) -> TemplateModel {
    let classes = CLASSES.map(str::to_owned);
    let labelling = LabelSet {
        samples,
        held_back: &[],
        classes: &classes,
        unlabelled_is_background: true,
    };
    let options = TrainOptions {
        everyday: Everyday::Auto,
        ..TrainOptions::default()
    };
    train_clips(clips, &labelling, &options, &()).unwrap().0
}

/// The early detection after every pose, with the pose's time in seconds.
fn play(
    model: &Arc<TemplateModel>,
    c: &TrainClip,
    params: EarlyDetectionParams,
) -> Vec<(f64, Option<EarlyDetection>)> {
    let mut recognizer = Recognizer::new(model, bones_of_clip(&c.clip, &c.roles, &c.rest)).unwrap();
    recognizer.set_early(params);
    let mut told = Vec::new();
    for_each_pose(&c.clip, &c.roles, &c.rest, |time_secs, pose| {
        recognizer.push(time_secs, pose);
        told.push((time_secs, recognizer.early_detection()));
    });
    told
}

/// One hunch for every row of hunches of a class, at the moment it is half done.
fn half_done(hunches: &[(f64, Option<EarlyDetection>)]) -> Vec<EarlyDetection> {
    let mut found: Vec<EarlyDetection> = Vec::new();
    for hunch in hunches
        .iter()
        .filter_map(|(_, h)| *h)
        .filter(|h| h.progress >= 0.5)
    {
        let same = |last: &EarlyDetection| {
            last.class == hunch.class && hunch.seen_secs - last.seen_secs < 0.3
        };
        match found.last_mut() {
            Some(last) if same(last) => {
                *last = EarlyDetection {
                    start_secs: last.start_secs,
                    ..hunch
                }
            }
            _ => found.push(hunch),
        }
    }
    found
}
