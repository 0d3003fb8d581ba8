//! Small cases whose every count was worked out on paper.

use super::*;

fn counts(thesis: &ThesisAccuracy) -> [usize; 4] {
    [
        thesis.true_positives,
        thesis.false_positives,
        thesis.false_negatives,
        thesis.true_negatives,
    ]
}

/// Ten seconds: one walk found well, one badly, a jump taken for a run, a kick missed, a jump seen in a pause.
fn one_stream() -> (Vec<StreamInfo>, Vec<GroundTruth>, Vec<ClipDetection>) {
    let truths = vec![
        truth("a", "walk", 1.0, 2.0),
        truth("a", "walk", 2.0, 3.0),
        truth("a", "jump", 5.0, 6.0),
        truth("a", "kick", 8.0, 8.8),
    ];
    let founds = vec![
        ClipDetection {
            reported_secs: Some(2.15),
            ..found("a", "walk", 1.1, 1.95)
        },
        ClipDetection {
            reported_secs: Some(3.4),
            ..found("a", "walk", 2.6, 3.2)
        },
        found("a", "run", 5.2, 5.9),
        found("a", "jump", 6.5, 7.5),
        found("u", "jump", 3.0, 4.0),
        found("u", "walk", 13.0, 14.0),
    ];
    (
        vec![stream("a", 10.0), unknown("u", 30.0), unknown("v", 30.0)],
        truths,
        founds,
    )
}

#[test]
fn ten_seconds() {
    let (infos, truths, founds) = one_stream();
    let e = Evaluation::of(&infos, &truths, &founds).unwrap();
    // Samples: two walks right, jump taken for run, kick missed. Pauses: 0–1, 3–5, 8.8–10 left alone, 6–8 not.
    assert_eq!(counts(&e.thesis), [2, 2, 1, 3]);
    close(e.thesis.accuracy, 5.0 / 8.0);
    // The second walk overlaps by 0.4 s of 1.2 s.
    let matched: Vec<usize> = e.overlap.iter().map(|o| o.matched).collect();
    assert_eq!(matched, [2, 2, 1, 1]);
    close(e.f1_at(0.25), 0.5);
    close(e.f1_at(0.5), 0.25);
    assert_eq!((e.overlap[2].missed, e.overlap[2].spurious), (3, 3));
    assert_eq!(e.false_alarms.count, 1);
    close(e.false_alarms.per_minute, 6.0);
    assert_eq!(
        (
            e.unknown.clips,
            e.unknown.clips_accepted,
            e.unknown.detections
        ),
        (2, 1, 2)
    );
    close(e.unknown.unknown_accepted, 0.5);
    close(e.unknown.per_minute, 2.0);
    assert_eq!(e.delay.count, 1);
    close(e.delay.median_secs, 0.15);
    close(e.boundaries.start_median_secs, 0.1);
    close(e.boundaries.stop_median_secs, -0.05);
    close(e.boundaries.stop_median_abs_secs, 0.05);
    let c = &e.classification;
    assert_eq!((c.right, c.wrong, c.rejected), (2, 1, 1));
    assert_eq!(e.confusion.rows, ["jump", "kick", "walk"]);
    assert_eq!(e.confusion.columns, ["jump", "kick", "run", "walk"]);
    let expected = [
        [0, 0, 1, 0, 0],
        [0, 0, 0, 0, 1],
        [0, 0, 0, 2, 0],
        [1, 0, 0, 0, 3],
    ];
    assert_eq!(e.confusion.counts, expected.map(|row| row.to_vec()));
}

#[test]
fn ten_seconds_class_by_class() {
    let (infos, truths, founds) = one_stream();
    let e = Evaluation::of(&infos, &truths, &founds).unwrap();
    let class = |name: &str| e.classes.iter().find(|c| c.class == name).unwrap();
    let jump = class("jump");
    assert_eq!(
        (jump.samples, jump.detections, jump.unknown_detections),
        (1, 1, 1)
    );
    assert_eq!(jump.false_alarms.count, 1);
    assert_eq!(
        jump.mistaken_for,
        [Mistake {
            class: "run".into(),
            count: 1
        }]
    );
    assert_eq!((class("kick").missed, class("walk").missed), (1, 0));
    close(class("walk").overlap[2].f1, 0.5);
    assert_eq!(class("run").overlap[0].recall, None);
    assert_eq!(class("kick").overlap[0].precision, None);
}

#[test]
fn ten_seconds_as_timelines() {
    let (infos, truths, founds) = one_stream();
    let lines = timelines(&infos, &truths, &founds).unwrap();
    assert_eq!(lines.len(), 3);
    let truths: Vec<_> = lines[0]
        .truths
        .iter()
        .map(|(_, verdict)| verdict.clone())
        .collect();
    use GroundTruthVerdict::{Missed, Mistaken, Right};
    assert_eq!(truths, [Right, Right, Mistaken("run".into()), Missed]);
    let founds: Vec<_> = lines[0]
        .founds
        .iter()
        .map(|(_, verdict)| *verdict)
        .collect();
    use DetectionVerdict as F;
    assert_eq!(founds, [F::Right, F::Loose, F::WrongClass, F::FalseAlarm]);
    assert!(
        lines[1]
            .founds
            .iter()
            .all(|(_, verdict)| *verdict == F::FalseAlarm)
    );
}

#[test]
fn several_detections_on_one_sample_count_once() {
    let truths = [truth("a", "x", 1.0, 3.0)];
    let founds = [found("a", "x", 1.0, 2.1), found("a", "x", 2.1, 3.0)];
    let e = Evaluation::of(&[stream("a", 3.0)], &truths, &founds).unwrap();
    assert_eq!(counts(&e.thesis), [1, 0, 0, 1]);
    assert_eq!(
        (
            e.overlap[0].matched,
            e.overlap[0].missed,
            e.overlap[0].spurious
        ),
        (1, 0, 1)
    );
}

#[test]
fn the_closest_pair_does_not_cost_another_pair() {
    // The second sample overlaps the first detection most (0.57), but then the first sample would have none.
    let truths = [truth("a", "x", 0.0, 1.0), truth("a", "x", 0.8, 2.0)];
    let founds = [found("a", "x", 0.6, 1.6), found("a", "x", 1.7, 2.4)];
    let e = Evaluation::of(&[stream("a", 3.0)], &truths, &founds).unwrap();
    assert_eq!(e.overlap[0].matched, 2);
}

#[test]
fn one_long_detection_decides_every_stretch_it_swallows() {
    // §5.4 looks from the ground truth only: two samples right, the pause between them wrong. One to one, only
    // one sample can have it, and hardly overlaps it.
    let truths = [truth("a", "x", 0.0, 1.0), truth("a", "x", 2.0, 3.0)];
    let e = Evaluation::of(&[stream("a", 3.0)], &truths, &[found("a", "x", 0.0, 3.0)]).unwrap();
    assert_eq!(counts(&e.thesis), [2, 1, 0, 0]);
    let matched: Vec<usize> = e.overlap.iter().map(|o| o.matched).collect();
    assert_eq!(matched, [1, 1, 0, 0]);
}

#[test]
fn the_detection_that_shares_most_decides_but_the_best_score_classifies() {
    let truths = [truth("a", "x", 0.0, 2.0)];
    let founds = [
        ClipDetection {
            score: Some(0.4),
            ..found("a", "x", 0.0, 1.2)
        },
        ClipDetection {
            score: Some(0.9),
            ..found("a", "y", 1.2, 2.0)
        },
    ];
    let e = Evaluation::of(&[stream("a", 2.0)], &truths, &founds).unwrap();
    assert_eq!(counts(&e.thesis), [1, 0, 0, 0]);
    assert_eq!((e.classification.right, e.classification.wrong), (0, 1));
    let unscored = [found("a", "x", 0.0, 1.2), found("a", "y", 1.2, 2.0)];
    let e = Evaluation::of(&[stream("a", 2.0)], &truths, &unscored).unwrap();
    assert_eq!((e.classification.right, e.classification.wrong), (1, 0));
}

#[test]
fn exactly_half_is_no_match_and_no_false_alarm() {
    // Frames at a rate whose seconds are not exact.
    let at = |frame: u32| f64::from(frame) / 119.88;
    let truths = [truth("a", "x", at(100), at(200))];
    let e = Evaluation::of(
        &[stream("a", at(300))],
        &truths,
        &[found("a", "x", at(170), at(230))],
    )
    .unwrap();
    assert_eq!(counts(&e.thesis), [0, 0, 1, 2]);
    assert_eq!(e.false_alarms.count, 0);
    let e = Evaluation::of(
        &[stream("a", at(300))],
        &truths,
        &[found("a", "x", at(169), at(229))],
    )
    .unwrap();
    assert_eq!(e.thesis.true_positives, 1);
    let e = Evaluation::of(
        &[stream("a", at(300))],
        &truths,
        &[found("a", "x", at(171), at(231))],
    )
    .unwrap();
    assert_eq!(e.false_alarms.count, 1);
}

#[test]
fn short_pauses_are_no_decisions() {
    // 48 frames at frame time .0083333 are a hair less than 0.4 s, and count; 47 do not.
    let at = |frame: u32| f64::from(frame) * 0.008_333_3;
    for (pause, decisions) in [(48, 1), (47, 0)] {
        let truths = [
            truth("a", "x", 0.0, at(100)),
            truth("a", "x", at(100 + pause), at(300)),
        ];
        let e = Evaluation::of(&[stream("a", at(300))], &truths, &[]).unwrap();
        assert_eq!(e.thesis.true_negatives, decisions);
    }
    // Overlapping samples leave one pause, not two.
    let truths = [truth("a", "x", 0.0, 2.0), truth("a", "y", 0.5, 1.0)];
    let e = Evaluation::of(&[stream("a", 3.0)], &truths, &[]).unwrap();
    assert_eq!(counts(&e.thesis), [0, 0, 2, 1]);
}

#[test]
fn quantiles_interpolate() {
    let delays = [0.4, 0.1, 0.2, 0.3];
    let truths: Vec<GroundTruth> = (0..4)
        .map(|i| truth("a", "x", f64::from(i), f64::from(i) + 0.5))
        .collect();
    let founds: Vec<ClipDetection> = (truths.iter().zip(delays))
        .map(|(t, d)| ClipDetection {
            reported_secs: Some(t.span.stop_secs + d),
            ..found("a", "x", t.span.start_secs, t.span.stop_secs)
        })
        .collect();
    let e = Evaluation::of(&[stream("a", 4.0)], &truths, &founds).unwrap();
    close(e.delay.median_secs, 0.25);
    close(e.delay.p90_secs, 0.37);
}

#[test]
fn input_that_makes_no_sense_is_refused() {
    let infos = [stream("a", 1.0), unknown("u", 1.0)];
    let refused = |truths: &[GroundTruth], founds: &[ClipDetection]| {
        Evaluation::of(&infos, truths, founds).unwrap_err()
    };
    assert!(matches!(
        refused(&[truth("b", "x", 0.0, 1.0)], &[]),
        EvalError::NoStream {
            what: "a sample",
            ..
        }
    ));
    assert!(matches!(
        refused(&[], &[found("a", "x", 1.0, 1.0)]),
        EvalError::NoStretch { .. }
    ));
    assert!(matches!(
        refused(&[], &[found("a", "x", f64::NAN, 1.0)]),
        EvalError::NoStretch { .. }
    ));
    assert!(matches!(
        refused(&[truth("u", "x", 0.0, 1.0)], &[]),
        EvalError::SampleInUnknown { .. }
    ));
    let twice = [stream("a", 1.0), stream("a", 2.0)];
    assert!(matches!(
        Evaluation::of(&twice, &[], &[]),
        Err(EvalError::TwoStreams { .. })
    ));
    assert!(matches!(
        Evaluation::of(&[stream("a", 0.0)], &[], &[]),
        Err(EvalError::NoLength { .. })
    ));
}

#[test]
fn nothing_at_all_has_no_figures() {
    let e = Evaluation::of(&[], &[], &[]).unwrap();
    assert_eq!(
        (e.thesis.accuracy, e.f1_at(0.5), e.false_alarms.per_minute),
        (None, None, None)
    );
    let json = serde_json::to_value(&e).unwrap();
    assert!(json["thesis"]["accuracy"].is_null());
}
