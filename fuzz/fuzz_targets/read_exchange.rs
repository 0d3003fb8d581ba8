#![no_main]
//! Any bytes read as labels in every form of `morec-db`: no panic, and times that are times. The first byte chooses the
//! form; what was read and can be written is read again the same.

use libfuzzer_sys::fuzz_target;
use morec::labels::ClipLength;
use morec_db::exchange::{ClipLengths, LabelFormat, read, write};

fuzz_target!(|bytes: &[u8]| {
    let Some((first, bytes)) = bytes.split_first() else {
        return;
    };
    let form = LabelFormat::ALL[usize::from(*first) % LabelFormat::ALL.len()];
    let lengths = ClipLengths::from([
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
    let _ = LabelFormat::of_file("x.json", bytes);
    let Ok(labels) = read(form, bytes, Some("a"), &lengths) else {
        return;
    };
    for a in &labels.annotations {
        if let Some((start, stop)) = a.extent {
            assert!(
                start.is_finite() && stop.is_finite() && start >= 0.0 && stop > start,
                "{a:?}"
            );
        }
        assert!(a.score.is_none_or(f64::is_finite), "{a:?}");
    }
    let known = labels
        .annotations
        .iter()
        .all(|a| lengths.contains_key(&a.clip));
    if matches!(form, LabelFormat::Csv | LabelFormat::Json) && known {
        let text = write(form, &labels.annotations, &lengths).expect("every length is known");
        let again =
            read(form, text.as_bytes(), None, &lengths).expect("what was written can be read");
        assert_eq!(again.annotations.len(), labels.annotations.len());
    }
});
