//! Shares of time against frames, edits against their definition.

use proptest::prelude::*;

use super::super::frames::edit_distance;
use super::*;

fn of(truths: &[GroundTruth], founds: &[ClipDetection]) -> FrameScore {
    let infos = [stream("a", 10.0)];
    Evaluation::of(&infos, truths, founds).unwrap().frames
}

#[test]
fn by_hand() {
    let truths = [truth("a", "walk", 1.0, 5.0), truth("a", "sit", 5.0, 7.0)];
    let founds = [
        found("a", "walk", 0.5, 3.0),
        found("a", "walk", 4.0, 6.0),
        found("a", "sit", 6.5, 7.5),
    ];
    let s = of(&truths, &founds);
    // Walk 1-3 and 4-5, sit 6.5-7; nothing 0-0.5 and 7.5-10.
    assert!((s.labelled_right_secs - 3.5).abs() < 1e-9, "{s:?}");
    assert!((s.labelled_accuracy.unwrap() - 3.5 / 6.0).abs() < 1e-9);
    assert!((s.frame_accuracy.unwrap() - 0.65).abs() < 1e-9);
    // One walk too many.
    assert!((s.edit_score.unwrap() - 2.0 / 3.0).abs() < 1e-9);
    let none = of(&[], &[]);
    assert_eq!((none.frame_accuracy, none.edit_score), (Some(1.0), None));
    assert_eq!(none.labelled_accuracy, None);
}

#[test]
fn of_two_classes_at_once_either_is_right() {
    let truths = [truth("a", "walk", 0.0, 10.0), truth("a", "wave", 4.0, 6.0)];
    let s = of(&truths, &[found("a", "wave", 4.0, 6.0)]);
    assert!((s.labelled_right_secs - 2.0).abs() < 1e-9);
    let s = of(&truths, &[found("a", "walk", 0.0, 10.0)]);
    assert!((s.labelled_right_secs - 10.0).abs() < 1e-9);
}

proptest! {
    #[test]
    fn time_is_that_of_small_frames(
        truths in prop::collection::vec((0usize..3, 0u32..90, 1u32..30), 0..5),
        founds in prop::collection::vec((0usize..3, 0u32..90, 1u32..30), 0..5),
    ) {
        const CLASSES: [&str; 3] = ["a", "b", "c"];
        // Tenths of a second, so that frames of a tenth are exact.
        let secs = |tenths: u32| f64::from(tenths.min(100)) / 10.0;
        let truths: Vec<_> = (truths.iter())
            .map(|(c, at, length)| truth("a", CLASSES[*c], secs(*at), secs(at + length)))
            .collect();
        let founds: Vec<_> = (founds.iter())
            .map(|(c, at, length)| found("a", CLASSES[*c], secs(*at), secs(at + length)))
            .collect();
        let is_right = |frame: &u32| {
            let at = f64::from(*frame) / 10.0 + 0.05;
            let truths: Vec<_> = truths.iter().filter(|t| t.span.start_secs < at && at < t.span.stop_secs).collect();
            let mut founds = founds.iter().filter(|f| f.span.start_secs < at && at < f.span.stop_secs);
            match truths.is_empty() {
                true => founds.next().is_none(),
                false => founds.any(|f| truths.iter().any(|t| t.class == f.class)),
            }
        };
        let frames = (0..100).filter(is_right).count();
        let s = of(&truths, &founds);
        prop_assert!((s.right_secs - frames as f64 / 10.0).abs() < 1e-6);
    }

    #[test]
    fn edits_are_a_distance(a in "[ab]{0,6}", b in "[ab]{0,6}") {
        let classes = |text: &str| -> Vec<&'static str> {
            text.chars().map(|c| if c == 'a' { "a" } else { "b" }).collect()
        };
        let (a, b) = (classes(&a), classes(&b));
        let distance = edit_distance(&a, &b);
        prop_assert_eq!(distance, edit_distance(&b, &a));
        prop_assert_eq!(distance, slow(&a, &b));
    }
}

/// By its definition.
fn slow(a: &[&str], b: &[&str]) -> usize {
    match (a.split_first(), b.split_first()) {
        (None, _) => b.len(),
        (_, None) => a.len(),
        (Some((x, a_rest)), Some((y, b_rest))) => {
            let replaced = slow(a_rest, b_rest) + usize::from(x != y);
            let removed = slow(a_rest, b) + 1;
            replaced.min(removed).min(slow(a, b_rest) + 1)
        }
    }
}
