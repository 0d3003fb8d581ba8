//! Contents of a show: a clip, its labels and its detections.

use morec::clip::Clip;

/// A stretch that is known to hold a class.
#[derive(Debug, Clone, PartialEq)]
pub struct KnownSpan {
    pub class: String,
    pub start_secs: f64,
    pub stop_secs: f64,
}

/// A detection, and when it was said.
#[derive(Debug, Clone, PartialEq)]
pub struct ReportedDetection {
    pub class: String,
    pub start_secs: f64,
    pub stop_secs: f64,
    pub score: f64,
    pub reported_secs: f64,
}

/// A clip to show, with labels and detections.
#[derive(Debug, Clone, Copy)]
pub struct ShownClip<'a> {
    /// Above the picture: who is seen.
    pub title: &'a str,
    /// The stream, Y up.
    pub clip: &'a Clip,
    /// Labels, in order.
    pub truth: &'a [KnownSpan],
    /// Detections, in the order of `reported_secs`.
    pub said: &'a [ReportedDetection],
}

/// The line of one event: `12.40 s  wave  0.93  (said 0.12 s after its end)`.
pub fn event_line(said: &ReportedDetection) -> String {
    let delay = said.reported_secs - said.stop_secs;
    let (size, side) = (delay.abs(), if delay < 0.0 { "before" } else { "after" });
    format!(
        "{:6.2} s  {}  {:.2}  (said {size:.2} s {side} its end)",
        said.reported_secs,
        printable(&said.class),
        said.score
    )
}

/// `name` without the characters that would move the cursor.
pub(super) fn printable(name: &str) -> String {
    name.chars()
        .map(|c| if c.is_control() { '?' } else { c })
        .collect()
}
