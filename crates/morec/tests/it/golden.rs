//! The published figures of the reference prototype hold; see `testdata/reference/README.md`.

use std::collections::BTreeMap;
use std::path::Path;

use morec::features::{BoneSet, rows_of_clip};
use morec::labels::{ClipLength, Labels, Sample};
use morec::templates::TemplateEngine;
use morec::train::{LabelSet, StreamKind, TrainClip, TrainParams, build_train_set, train};

use crate::kit;

const SIGNALS: [&str; 3] = ["signals_1", "signals_2", "signals_3"];
const BACKGROUND: [&str; 6] = [
    "jumping_1",
    "jumping_3",
    "soccer_1",
    "soccer_2",
    "running_1",
    "running_2",
];
const CLASSES: [&str; 7] = [
    "hands_up",
    "illegal_dribble",
    "no_score",
    "pushing",
    "stop_clock",
    "traveling",
    "visible_count",
];

#[derive(serde::Deserialize)]
struct Golden {
    feature_rows: BTreeMap<String, Vec<Vec<f32>>>,
    folds: BTreeMap<String, Fold>,
}

#[derive(serde::Deserialize)]
struct Fold {
    theta: f64,
    templates: usize,
    detections: Vec<(i64, i64, String, f64, i64)>,
}

fn golden() -> Golden {
    serde_json::from_str(include_str!("../../testdata/reference/templates.json")).unwrap()
}

fn clips(data: &Path) -> Vec<TrainClip> {
    let signals = SIGNALS
        .iter()
        .map(|n| kit::referee(data, n, StreamKind::Labelled));
    let background = BACKGROUND
        .iter()
        .map(|n| kit::referee(data, n, StreamKind::Background));
    let exercises = ["13_29", "13_30", "13_31"].iter();
    let exercises = exercises
        .map(|n| kit::acclaim(data, "exercises", "skeleton.asf", n, StreamKind::Background));
    let mixed = kit::acclaim(
        data,
        "segmentation",
        "86.asf",
        "86_01",
        StreamKind::Background,
    );
    signals
        .chain(background)
        .chain(exercises)
        .chain([mixed])
        .collect()
}

fn samples(data: &Path, clips: &[TrainClip]) -> Vec<Sample> {
    let labels = Labels::read(&std::fs::read(data.join("referee/labels.tsv")).unwrap()).unwrap();
    let length = |c: &TrainClip| ClipLength {
        frames: c.clip.frames,
        rate_hz: c.clip.rate_hz,
    };
    let lengths = clips.iter().map(|c| (c.name.clone(), length(c))).collect();
    let signal =
        |s: &Sample| SIGNALS.contains(&s.clip.as_str()) && CLASSES.contains(&s.class.as_str());
    labels
        .resolve(&lengths)
        .samples
        .into_iter()
        .filter(signal)
        .collect()
}

#[test]
fn feature_rows_are_the_prototypes() {
    let Some(data) = kit::data() else { return };
    let params = TrainParams::reference().features;
    for (name, expected) in golden().feature_rows {
        let clip = kit::referee(&data, &name, StreamKind::Labelled);
        let bones = morec::features::BoneSet::BODY;
        let rows = rows_of_clip(&clip.clip, &clip.roles, &clip.rest, bones, &params);
        for (index, expected) in expected.iter().enumerate() {
            for (column, (found, expected)) in
                rows.row(100 + index).iter().zip(expected).enumerate()
            {
                assert!(
                    (found - expected).abs() < 2e-5,
                    "{name}, row {}, column {column}: {found} for {expected}",
                    100 + index
                );
            }
        }
    }
}

#[test]
fn thresholds_and_detections_are_the_prototypes() {
    let Some(data) = kit::data() else { return };
    let clips = clips(&data);
    let samples = samples(&data, &clips);
    let params = TrainParams::reference();
    let classes: Vec<String> = CLASSES.iter().map(|c| (*c).to_owned()).collect();
    for (left_out, expected) in golden().folds {
        let others: Vec<TrainClip> = clips
            .iter()
            .filter(|c| c.name != left_out)
            .cloned()
            .collect();
        let taught: Vec<Sample> = samples
            .iter()
            .filter(|s| s.clip != left_out)
            .cloned()
            .collect();
        let labelling = LabelSet {
            samples: &taught,
            held_back: &[],
            classes: &classes,
            unlabelled_is_background: true,
        };
        let prepared = build_train_set(&others, &labelling, BoneSet::BODY, &params.features);
        let model = train(&prepared.set, prepared.bones, &params, &())
            .unwrap()
            .model;
        assert_eq!(model.samples.len(), expected.templates);
        // Single precision and a metric packed to it: four digits are left.
        let theta = f64::from(model.threshold);
        assert!(
            (theta - expected.theta).abs() < 2e-4 * expected.theta,
            "{theta} for {}",
            expected.theta
        );

        let clip = clips.iter().find(|c| c.name == left_out).unwrap();
        let rows = rows_of_clip(
            &clip.clip,
            &clip.roles,
            &clip.rest,
            prepared.bones,
            &params.features,
        );
        let mut engine = TemplateEngine::new(&model).unwrap();
        let mut found = vec![];
        for (tick, row) in rows.iter().enumerate() {
            let now = engine.push(row);
            found.extend(now.map(|d| (*d, 4 * (tick as i64 + 1))));
        }
        let last = engine.finish();
        found.extend(last.map(|d| (*d, 4 * rows.len() as i64)));
        assert_eq!(found.len(), expected.detections.len(), "{left_out}");
        for ((d, reported), e) in found.iter().zip(&expected.detections) {
            let class = &classes[d.class.index()];
            assert_eq!(
                (4 * d.start, 4 * d.stop, class, *reported),
                (e.0, e.1, &e.2, e.4),
                "{left_out}"
            );
            assert!(
                (d.score - e.3).abs() < 1e-3,
                "{left_out}: score {} for {}",
                d.score,
                e.3
            );
        }
    }
}
