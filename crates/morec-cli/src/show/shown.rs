//! Contents of a show: a clip, its labels and its detections.

use morec::clip::Clip;
use morec::labels::Mark;
use morec::live::Detection;

/// A clip to show, with labels and detections.
#[derive(Debug, Clone, Copy)]
pub struct ShownClip<'a> {
    /// Above the picture: who is seen.
    pub title: &'a str,
    /// The stream, Y up.
    pub clip: &'a Clip,
    /// Labels, in order.
    pub truth: &'a [Mark],
    /// Detections, in the order of `reported_secs`.
    pub said: &'a [Detection<String>],
}

/// The line of one event: `12.40 s  wave  0.93  (0.12 s after its end)`.
pub fn event_line(said: &Detection<String>) -> String {
    let delay = said.reported_secs - said.span.stop_secs;
    let (size, side) = (delay.abs(), if delay < 0.0 { "before" } else { "after" });
    format!(
        "{:6.2} s  {}  {:.2}  ({size:.2} s {side} its end)",
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
