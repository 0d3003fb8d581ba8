//! The status line of a session, updated in place.

use std::io::{IsTerminal, Write};
use std::time::{Duration, Instant};

use morec::classes::ClassInfo;
use morec::diagnosis::{Diagnosis, Severity};
use morec::live::Status;

/// Interval between renewals of the line.
const EVERY: Duration = Duration::from_millis(250);

/// The line; silent where standard error is no terminal.
pub struct StatusLine {
    shown: bool,
    last: Instant,
    frames: u64,
    rate_hz: f64,
    drawn: bool,
}

impl StatusLine {
    /// A line, drawn unless `quiet`.
    pub fn new(quiet: bool) -> Self {
        Self {
            shown: !quiet && std::io::stderr().is_terminal(),
            last: Instant::now(),
            frames: 0,
            rate_hz: 0.0,
            drawn: false,
        }
    }

    /// Draws the line if it is time to.
    pub fn draw(&mut self, statuses: &[Status], classes: &[ClassInfo]) {
        let passed = self.last.elapsed();
        if !self.shown || passed < EVERY {
            return;
        }
        let frames: u64 = statuses.iter().map(|s| s.frames).sum();
        let now_hz = (frames - self.frames) as f64 / passed.as_secs_f64();
        // Half new, half old: a rate that can be read.
        self.rate_hz = if self.rate_hz > 0.0 {
            0.5 * (self.rate_hz + now_hz)
        } else {
            now_hz
        };
        (self.frames, self.last, self.drawn) = (frames, Instant::now(), true);
        let text = describe(statuses, classes, self.rate_hz);
        let width = terminal_size::terminal_size().map_or(100, |(width, _)| usize::from(width.0));
        let text: String = text.chars().take(width.saturating_sub(1)).collect();
        let text: String = text
            .chars()
            .map(|c| if c.is_control() { '?' } else { c })
            .collect();
        draw(&format!("\r\x1b[2K{text}"));
    }

    /// Takes the line away, so that something else can be printed.
    pub fn clear(&mut self) {
        if std::mem::take(&mut self.drawn) {
            draw("\r\x1b[2K");
        }
    }
}

/// Writes what moves the cursor. If nobody sees it, nothing is lost.
fn draw(text: &str) {
    let mut out = std::io::stderr();
    let _ = out.write_all(text.as_bytes()).and_then(|()| out.flush());
}

/// Frames lost on the way, as far as anybody can tell.
fn losses(status: &Status) -> u64 {
    status.dropped_frames + status.dropped_events + status.source.late + status.source.malformed
}

fn describe(statuses: &[Status], classes: &[ClassInfo], rate_hz: f64) -> String {
    let sum = |of: fn(&Status) -> u64| statuses.iter().map(of).sum::<u64>();
    let actors: Vec<_> = statuses.iter().flat_map(|s| &s.actors).collect();
    let wait_secs = actors.iter().map(|a| a.wait_secs).fold(0.0, f64::max);
    let mut text = format!(
        "{rate_hz:5.1} Hz  wait {:.1} ms  lost {}  incomplete {}  motions {}",
        1000.0 * wait_secs,
        sum(losses),
        sum(|s| s.source.incomplete),
        sum(|s| s.motions),
    );
    if actors.is_empty() {
        let heard = sum(|s| s.source.packets);
        text += if heard == 0 {
            "  nobody yet"
        } else {
            "  no pose yet"
        };
        if sum(|s| s.source.not_motion) > 0 {
            text += " (only a rest pose, or tracking is lost)";
        }
    }
    for actor in actors {
        let name = |class: morec::classes::ClassId| {
            classes.get(class.index()).map_or("?", |c| c.name.as_str())
        };
        match (actor.early, actor.last) {
            (Some((class, progress)), _) => {
                text += &format!("  | {} {:.0} % …", name(class), 100.0 * progress);
            }
            (None, Some((class, score))) => text += &format!("  | last {} {score:.2}", name(class)),
            (None, None) => text += "  | –",
        }
        if let Some(diagnosis) = actor.diagnosis {
            text += &found(&diagnosis);
        }
    }
    text
}

/// Fault of a stream in a few words, or the size and noise of its body.
fn found(diagnosis: &Diagnosis) -> String {
    let findings = diagnosis.findings();
    let labels: Vec<&str> = findings
        .iter()
        .filter(|finding| finding.severity() >= Severity::Warning)
        .map(|finding| finding.label())
        .collect();
    if !labels.is_empty() {
        return format!("  ! {}", labels.join(", "));
    }
    match (diagnosis.height_m, diagnosis.noise_m) {
        (Some(height), Some(noise)) => format!("  {height:.2} m ± {:.1} cm", 100.0 * noise),
        _ => String::new(),
    }
}
