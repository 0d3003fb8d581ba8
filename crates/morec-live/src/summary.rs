//! A summary of a session in one line, printed at its end.

use morec::live::Status;

/// Summary of a session, at its end.
pub fn summary(source: &str, status: &Status) -> String {
    let mut text = format!(
        "{source}: {} frames, {} motions",
        status.frames, status.motions
    );
    let counts = &status.source;
    let parts = [
        (counts.packets, "packets"),
        (counts.malformed, "malformed packets"),
        (counts.late, "late packets"),
        (
            counts.refused,
            "packets of senders beyond the limit of --actors",
        ),
        (counts.incomplete, "incomplete frames"),
        (
            counts.not_motion,
            "frames in a rest pose or without tracking",
        ),
        (counts.interruptions, "interruptions"),
        (
            status.dropped_frames,
            "frames dropped because recognition is too slow",
        ),
        (
            status.unusable_frames,
            "frames without any bone of the index",
        ),
        (status.dropped_events, "events dropped"),
        (status.suppressed, "motions within the refractory time"),
    ];
    for (count, what) in parts.into_iter().filter(|(count, _)| *count > 0) {
        text += &format!(", {count} {what}");
    }
    text + &format!("; longest wait {:.1} ms", 1000.0 * status.longest_wait_secs)
}
