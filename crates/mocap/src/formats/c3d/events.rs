//! Events of a recording.

use super::header::C3dHeader;
use super::params::Parameters;
use crate::formats::{Place, Warning};

/// Seconds from the first frame of the file, and names, of the events of the EVENT group, else of the header, in the order of their
/// times.
pub(super) fn list(
    header: &C3dHeader,
    parameters: &Parameters,
    rate_hz: f64,
) -> Vec<(f64, String)> {
    let labels = parameters.all_texts("EVENT", "LABELS");
    let contexts = parameters.all_texts("EVENT", "CONTEXTS");
    // Minutes and seconds of each.
    let times = parameters.numbers("EVENT", "TIMES");
    let mut events: Vec<(f64, String)> = labels
        .iter()
        .zip(times.chunks_exact(2))
        .enumerate()
        .map(|(e, (label, time))| {
            let context = contexts.get(e).map_or("", String::as_str);
            (
                60.0 * time[0] + time[1],
                format!("{context} {label}").trim().to_owned(),
            )
        })
        .collect();
    if events.is_empty() {
        events.clone_from(&header.events);
    }
    events.retain(|(time, name)| time.is_finite() && !name.is_empty());
    // Times count from the recording's frame 1; a clip begins with the first frame of the file.
    let first = f64::from(header.first_frame.max(1) - 1) / rate_hz;
    events.sort_by(|a, b| a.0.total_cmp(&b.0));
    let from_first = |(time, name)| (time - first, name);
    events.into_iter().map(from_first).collect()
}

/// The events in one warning: labels are not among what a clip holds.
pub(super) fn note(
    header: &C3dHeader,
    parameters: &Parameters,
    rate_hz: f64,
    warnings: &mut Vec<Warning>,
) {
    const SHOWN: usize = 12;
    let events = list(header, parameters, rate_hz);
    if events.is_empty() {
        return;
    }
    let shown: Vec<String> = events
        .iter()
        .take(SHOWN)
        .map(|(time, name)| format!("{name} at {time:.3} s"))
        .collect();
    let more = if events.len() > SHOWN { ", …" } else { "" };
    let text = format!("{} events: {}{more}", events.len(), shown.join(", "));
    warnings.push(Warning::new(Place::File, text));
}
