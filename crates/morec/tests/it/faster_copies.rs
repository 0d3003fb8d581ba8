//! Faster copies of samples as templates: for other people than those who teach.

use morec::synth::DatabaseSpec;
use morec::train::TrainParams;

use crate::made;

/// Rows of every template of `class` when this many people each show it twice.
fn lengths(people: usize, class: &'static str) -> Vec<usize> {
    let spec = DatabaseSpec {
        people,
        repetitions: 2,
        rate_hz: 30.0,
        classes: vec![class],
        ..Default::default()
    };
    let params = TrainParams {
        faster_copies: 1,
        ..Default::default()
    };
    let model = made::train(&spec, params);
    model.samples.iter().map(|s| s.rows.len()).collect()
}

#[test]
fn who_teaches_alone_gives_no_faster_copies() {
    assert_eq!(lengths(1, "kick").len(), 2);
}

#[test]
fn of_several_people_a_usual_sample_is_copied_faster() {
    let mut lengths = lengths(2, "kick");
    let copy = lengths.pop().unwrap();
    assert_eq!(lengths.len(), 4);
    lengths.sort_unstable();
    let shorter = lengths[2] as f64 * TrainParams::default().faster_duration;
    assert!((shorter - copy as f64).abs() <= 1.0, "{lengths:?}, {copy}");
}

#[test]
fn a_copy_that_would_report_the_way_out_of_a_motion_is_left_out() {
    assert_eq!(lengths(2, "push").len(), 4);
}
