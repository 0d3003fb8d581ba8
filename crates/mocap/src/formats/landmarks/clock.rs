//! Finds times, frame numbers and rates in fields of any name.

use serde_json::Value;

use crate::formats::cells::{clock, is_among};

/// The time of a frame in seconds, as far as the name of its field says the unit.
pub(super) fn time_of(frame: &Value) -> Option<f64> {
    const KEYS: [&str; 6] = ["t", "ts", "secs", "seconds", "zeit", "stamp"];
    let fields = frame.as_object()?;
    let time = |(key, value): (&String, &Value)| {
        let lower = key.to_lowercase();
        let known = KEYS.contains(&lower.as_str()) || lower.contains("time");
        let other = ["zone", "step", "delta", "total", "frame"]
            .iter()
            .any(|o| lower.contains(o));
        let number = value
            .as_f64()
            .or_else(|| clock(value.as_str()?))
            .filter(|_| known && !other)?;
        let unit = match () {
            // Kinect's ticks of 100 ns.
            () if lower == "relativetime" => 1e-7,
            () if lower == "univtime" || lower.ends_with("ms") || lower.ends_with("millis") => 1e-3,
            () if lower.ends_with("us") || lower.ends_with("usec") || lower.ends_with("micros") => {
                1e-6
            }
            () if lower.ends_with("ns") || lower.ends_with("nanos") => 1e-9,
            () => 1.0,
        };
        Some(number * unit).filter(|time| time.is_finite())
    };
    fields.iter().find_map(time)
}

/// What the frame says of its number, under any of the usual keys.
pub(super) fn number_of(frame: &Value) -> Option<f64> {
    const KEYS: &str = "frame frame_id frameid frame_number framenumber frame_num frame_index frameindex frame_idx frameidx frame_no \
        index";
    let fields = frame.as_object()?;
    let number = |(key, value): (&String, &Value)| {
        let known = is_among(KEYS, &key.to_lowercase());
        value.as_f64().filter(|_| known)
    };
    fields.iter().find_map(number)
}

/// The rate in a field of the document, or of one of its `children`, whatever it is called.
pub(super) fn rate_in<'v>(
    document: &'v Value,
    mut children: impl Iterator<Item = &'v Value>,
) -> Option<f64> {
    const KEYS: &str = "fps framerate rate currentframerate samplingrate samplerate frequency hz framespersecond ratehz frameratehz \
        videofps capturerate samplingfrequency avgframerate recordingrate";
    let found = |value: &Value| {
        let rate = |(key, value): (&String, &Value)| {
            let letters: String = key.chars().filter(|c| c.is_alphabetic()).collect();
            let known = is_among(KEYS, &letters.to_lowercase());
            let text = || value.as_str()?.trim().parse().ok();
            value.as_f64().or_else(text).filter(|_| known)
        };
        value.as_object()?.iter().find_map(rate)
    };
    found(document).or_else(|| children.find_map(found))
}
