//! Properties that hold for any samples and any detections.

use proptest::prelude::*;

use super::*;
use crate::eval::spans;

/// Stretches of a stream of 10 s on a grid of 50 ms, overlapping as they like, of three classes.
fn stretches(most: usize) -> impl Strategy<Value = Vec<(usize, f64, f64)>> {
    let one = (0usize..3, 0u32..180, 1u32..40);
    prop::collection::vec(
        one.prop_map(|(c, at, len)| (c, f64::from(at) / 20.0, f64::from(at + len) / 20.0)),
        0..most,
    )
}

/// Stretches of one class that crowd each other: pairing them by falling overlap alone often misses pairs.
fn crowded(most: usize) -> impl Strategy<Value = Vec<(usize, f64, f64)>> {
    let one = (0u32..30, 5u32..25)
        .prop_map(|(at, len)| (0, f64::from(at) / 20.0, f64::from(at + len) / 20.0));
    prop::collection::vec(one, 0..most)
}

/// Samples one after the other, as labels mostly are.
fn sequence() -> impl Strategy<Value = Vec<GroundTruth>> {
    prop::collection::vec((0usize..3, 0u32..20, 1u32..40), 0..8).prop_map(|steps| {
        let mut at = 0;
        let mut next = |(class, pause, length): (usize, u32, u32)| {
            let start = at + pause;
            at = start + length;
            truth(
                "a",
                CLASSES[class],
                f64::from(start) / 20.0,
                f64::from(at) / 20.0,
            )
        };
        steps.into_iter().map(&mut next).collect()
    })
}

const CLASSES: [&str; 3] = ["x", "y", "z"];

fn truths_of(stretches: &[(usize, f64, f64)]) -> Vec<GroundTruth> {
    stretches
        .iter()
        .map(|(c, start, stop)| truth("a", CLASSES[*c], *start, *stop))
        .collect()
}

fn founds_of(stretches: &[(usize, f64, f64)]) -> Vec<ClipDetection> {
    let scored = |i: usize| Some((i * 7 % 5) as f64);
    let made = stretches.iter().enumerate();
    made.map(|(i, (c, start, stop))| ClipDetection {
        score: scored(i),
        reported_secs: Some(stop + 0.1),
        ..found("a", CLASSES[*c], *start, *stop)
    })
    .collect()
}

fn evaluate(truths: &[GroundTruth], founds: &[ClipDetection]) -> Evaluation {
    Evaluation::of(&[stream("a", 40.0), stream("b", 5.0)], truths, founds).unwrap()
}

/// The largest one-to-one pairing, by trying every partner for each sample.
fn most_pairs(
    truths: &[GroundTruth],
    founds: &[ClipDetection],
    min_iou: f64,
    used: &mut Vec<bool>,
) -> usize {
    let Some((first, rest)) = truths.split_first() else {
        return 0;
    };
    let mut best = most_pairs(rest, founds, min_iou, used);
    for f in 0..founds.len() {
        let (a, b) = (first.span, founds[f].span);
        let shared = (a.stop_secs.min(b.stop_secs) - a.start_secs.max(b.start_secs)).max(0.0);
        let iou = shared / (a.stop_secs.max(b.stop_secs) - a.start_secs.min(b.start_secs));
        if !used[f] && first.class == founds[f].class && shared > 0.0 && iou >= min_iou - 1e-9 {
            used[f] = true;
            best = best.max(1 + most_pairs(rest, founds, min_iou, used));
            used[f] = false;
        }
    }
    best
}

proptest! {
    #[test]
    fn pairing_is_the_largest_there_is(
        truths in prop_oneof![stretches(6), crowded(6)],
        founds in prop_oneof![stretches(6), crowded(6)],
    ) {
        let (truths, founds) = (truths_of(&truths), founds_of(&founds));
        let e = evaluate(&truths, &founds);
        for score in &e.overlap {
            let most = most_pairs(&truths, &founds, score.min_iou, &mut vec![false; founds.len()]);
            prop_assert_eq!(score.matched, most, "at {}", score.min_iou);
        }
    }

    #[test]
    fn order_of_rows_does_not_matter(truths in stretches(8), founds in stretches(8), turn in 0usize..8) {
        let (truths, founds) = (truths_of(&truths), founds_of(&founds));
        let turned = |n: usize| if n == 0 { 0 } else { turn % n };
        let (mut other_truths, mut other_founds) = (truths.clone(), founds.clone());
        other_truths.rotate_left(turned(truths.len()));
        other_truths.reverse();
        other_founds.reverse();
        other_founds.rotate_left(turned(founds.len()));
        let infos = [stream("b", 5.0), stream("a", 40.0)];
        let other = Evaluation::of(&infos, &other_truths, &other_founds).unwrap();
        prop_assert_eq!(evaluate(&truths, &founds), other);
    }

    #[test]
    fn the_truth_itself_is_perfect(truths in sequence()) {
        let founds: Vec<ClipDetection> = (truths.iter())
            .map(|t| ClipDetection { reported_secs: Some(t.span.stop_secs), ..found("a", &t.class, t.span.start_secs, t.span.stop_secs) })
            .collect();
        let e = evaluate(&truths, &founds);
        prop_assert_eq!(e.thesis.accuracy, Some(1.0));
        prop_assert_eq!(e.false_alarms.count, 0);
        if !truths.is_empty() {
            prop_assert!(e.overlap.iter().all(|o| o.f1 == Some(1.0)));
            prop_assert_eq!(e.classification.p_c, Some(1.0));
            prop_assert_eq!(e.delay.p90_secs, Some(0.0));
            prop_assert_eq!(e.boundaries.start_median_abs_secs, Some(0.0));
        }
    }

    #[test]
    fn finding_nothing_leaves_rest_alone_and_misses_the_rest(truths in sequence()) {
        let e = evaluate(&truths, &[]);
        prop_assert_eq!((e.thesis.true_positives, e.thesis.false_positives), (0, 0));
        prop_assert_eq!(e.thesis.false_negatives, truths.len());
        prop_assert!(e.overlap.iter().all(|o| o.matched == 0 && o.missed == truths.len()));
        prop_assert_eq!(e.classification.rejected, truths.len());
    }

    #[test]
    fn counts_add_up(truths in stretches(8), founds in stretches(8)) {
        let (truths, founds) = (truths_of(&truths), founds_of(&founds));
        let e = evaluate(&truths, &founds);
        let cells: usize = e.confusion.counts.iter().flatten().sum();
        let t = &e.thesis;
        prop_assert_eq!(cells, t.true_positives + t.false_positives + t.false_negatives + t.true_negatives);
        let missed: usize = e.classes.iter().map(|c| c.missed).sum();
        prop_assert_eq!(missed, t.false_negatives);
        for (i, score) in e.overlap.iter().enumerate() {
            prop_assert_eq!(score.matched, e.classes.iter().map(|c| c.overlap[i].matched).sum::<usize>());
            prop_assert!(i == 0 || score.matched <= e.overlap[i - 1].matched);
        }
        let alarms: usize = e.classes.iter().map(|c| c.false_alarms.count).sum();
        prop_assert_eq!(alarms, e.false_alarms.count);
        prop_assert_eq!(e.classification.right, e.classes.iter().map(|c| c.classification.right).sum::<usize>());
    }

    #[test]
    fn unknown_motion_moves_nothing_but_its_own_figures(truths in stretches(6), founds in stretches(6)) {
        let (truths, mut founds) = (truths_of(&truths), founds_of(&founds));
        let before = evaluate(&truths, &founds);
        let calm = founds.is_empty();
        founds.extend(founds.clone().into_iter().map(|f| ClipDetection { clip: "u".into(), ..f }));
        let infos = [stream("a", 40.0), stream("b", 5.0), unknown("u", 40.0)];
        let after = Evaluation::of(&infos, &truths, &founds).unwrap();
        prop_assert_eq!((&before.thesis, &before.overlap), (&after.thesis, &after.overlap));
        prop_assert_eq!((&before.false_alarms, &before.delay), (&after.false_alarms, &after.delay));
        prop_assert_eq!(&before.confusion, &after.confusion);
        prop_assert_eq!(after.unknown.unknown_accepted, Some(if calm { 0.0 } else { 1.0 }));
    }

    #[test]
    fn what_is_covered_and_what_is_left_make_up_the_stream(stretches in stretches(8)) {
        let mut sorted: Vec<TimeSpan> =
            stretches.iter().map(|(_, start, stop)| TimeSpan::new(*start, *stop)).collect();
        sorted.sort_by(|a, b| a.order(*b));
        let covered = TimeSpan::union(sorted.iter().copied());
        let left = spans::gaps(&covered, 12.0, 0.0);
        // On the grid, cell by cell: labelled by some stretch, or in a gap, never both.
        for cell in 0..240 {
            let at = (f64::from(cell) + 0.5) / 20.0;
            let within = |all: &[TimeSpan]| all.iter().any(|i| i.contains(at));
            prop_assert_eq!(within(&covered), within(&sorted));
            prop_assert_eq!(within(&left), !within(&sorted));
        }
    }
}
