//! The published figures of the reference prototype, from its detections.
//!
//! `reference_found.tsv` is what the prototype of the recommended recogniser found in `signals_1` to `signals_3`
//! of the `referee` data, leaving one clip out at a time (frames at 120 Hz). Its published figures are a thesis
//! accuracy of 0.903 and an F1 at half overlap of 0.909. The labels lie beside the project.

use std::collections::BTreeMap;

use super::*;
use morec::labels::{ClipLength, Labels, read_detections};

/// Frames and rate as the clip's own header has them.
fn length(bvh: &str) -> ClipLength {
    let after = |key: &str| {
        bvh.lines()
            .find_map(|line| line.trim().strip_prefix(key))
            .unwrap()
            .trim()
    };
    let frame_secs: f64 = after("Frame Time:").parse().unwrap();
    ClipLength {
        frames: after("Frames:").parse().unwrap(),
        rate_hz: 1.0 / frame_secs,
    }
}

#[test]
fn the_published_figures_come_out() {
    let Some(data) = mocap::testing::data() else {
        return;
    };
    let folder = data.join("referee");
    let labels = std::fs::read(folder.join("labels.tsv")).unwrap();
    let clips: BTreeMap<String, ClipLength> = ["signals_1", "signals_2", "signals_3"]
        .map(|name| {
            let text = std::fs::read_to_string(folder.join(format!("clips/{name}.bvh"))).unwrap();
            (name.to_owned(), length(&text))
        })
        .into();
    let resolved = Labels::read(&labels).unwrap().resolve(&clips);
    assert!(resolved.warnings.is_empty(), "{:?}", resolved.warnings);
    let truths: Vec<GroundTruth> = resolved
        .samples
        .into_iter()
        .map(GroundTruth::from)
        .collect();
    let (founds, warnings) = read_detections(include_bytes!("reference_found.tsv"))
        .unwrap()
        .resolve(&clips);
    assert!(warnings.is_empty());
    let infos: Vec<StreamInfo> = clips
        .iter()
        .map(|(name, length)| stream(name, length.duration_secs()))
        .collect();
    let e = Evaluation::of(&infos, &truths, &founds).unwrap();
    let t = &e.thesis;
    let counts = [
        t.true_positives,
        t.false_positives,
        t.false_negatives,
        t.true_negatives,
    ];
    assert_eq!(counts, [45, 5, 2, 20]);
    assert_eq!(format!("{:.3}", t.accuracy.unwrap()), "0.903");
    assert_eq!((e.totals.samples, e.totals.detections), (49, 50));
    assert_eq!(
        e.overlap.iter().map(|o| o.matched).collect::<Vec<_>>(),
        [45, 45, 45, 39]
    );
    assert_eq!(format!("{:.3}", e.f1_at(0.5).unwrap()), "0.909");
    // Reported a lag of 32 frames after the detection's own stop.
    assert!(
        (e.delay.median_secs.unwrap() - 0.27).abs() < 0.05,
        "{:?}",
        e.delay
    );
}
