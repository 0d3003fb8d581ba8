//! Measures against counts made by hand, against brute force, and against what must not change them.

mod agreement;
mod by_hand;
mod frames;
mod properties;
mod reference;

use super::*;

fn close(value: Option<f64>, expected: f64) {
    assert!(
        (value.unwrap() - expected).abs() < 1e-9,
        "{value:?}, expected {expected}"
    );
}

pub(crate) fn truth(clip: &str, class: &str, start_secs: f64, stop_secs: f64) -> GroundTruth {
    GroundTruth {
        clip: clip.into(),
        class: class.into(),
        span: TimeSpan::new(start_secs, stop_secs),
    }
}

pub(crate) fn found(clip: &str, class: &str, start_secs: f64, stop_secs: f64) -> ClipDetection {
    ClipDetection {
        clip: clip.into(),
        class: class.into(),
        span: TimeSpan::new(start_secs, stop_secs),
        score: None,
        reported_secs: None,
        repetitions: None,
    }
}

fn stream(clip: &str, duration_secs: f64) -> StreamInfo {
    StreamInfo {
        clip: clip.into(),
        duration_secs,
        unknown: false,
    }
}

fn unknown(clip: &str, duration_secs: f64) -> StreamInfo {
    StreamInfo {
        unknown: true,
        ..stream(clip, duration_secs)
    }
}
