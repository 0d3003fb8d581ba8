#![no_main]
//! Any bytes read as a table of labels, people or detections: no panic, and what is left lies within its clips.

use std::collections::BTreeMap;

use libfuzzer_sys::fuzz_target;
use morec::labels::{ClipLength, Labels, read_detections, read_people};

fuzz_target!(|bytes: &[u8]| {
    let lengths = BTreeMap::from([
        (
            "a".to_owned(),
            ClipLength {
                frames: 300,
                rate_hz: 30.0,
            },
        ),
        (
            "b".to_owned(),
            ClipLength {
                frames: 0,
                rate_hz: 120.0,
            },
        ),
    ]);
    let people = read_people(bytes);
    if let Ok(mut labels) = Labels::read(bytes) {
        assert!(labels.rows.iter().all(|row| row.line >= 2));
        if let Ok(people) = &people {
            labels.add_people(people);
        }
        for sample in labels.resolve(&lengths).samples {
            let secs = lengths[&sample.clip].duration_secs();
            assert!(
                0.0 <= sample.span.start_secs
                    && sample.span.is_stretch()
                    && sample.span.stop_secs <= secs + 1e-9
            );
        }
    }
    if let Ok(table) = read_detections(bytes) {
        let (found, _) = table.resolve(&lengths);
        assert!(
            found
                .iter()
                .all(|f| f.span.is_stretch() && lengths.contains_key(&f.clip))
        );
    }
});
