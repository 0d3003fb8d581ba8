//! Plays a stream in the terminal, with its labels and detections.
//!
//! [`frame::draw`] makes one picture as text and knows no terminal. [`play`] writes pictures to one at accelerated
//! real time, or only the events if standard output is no terminal.

mod frame;
pub mod picture;
mod shown;

use std::io::{self, IsTerminal, Write};
use std::time::{Duration, Instant};

use frame::FigureScale;
pub use frame::TerminalStyle;
pub use shown::{ShownClip, event_line};

/// Pictures a second.
const PICTURES_HZ: f64 = 25.0;

/// Writes the events, a line each: for output that is no terminal.
pub fn write_events(scene: &ShownClip, out: &mut impl Write) -> io::Result<()> {
    for said in scene.said {
        writeln!(out, "{}", event_line(said))?;
    }
    out.flush()
}

/// Plays the scene on standard output, `speed` times as fast as it was performed; only the events, at once, if
/// that is not a terminal.
pub fn play(scene: &ShownClip, speed: f64) -> io::Result<()> {
    let mut out = io::stdout().lock();
    if !out.is_terminal() || std::env::var_os("TERM").is_some_and(|term| term == "dumb") {
        return write_events(scene, &mut out);
    }
    let stage = FigureScale::of(scene.clip);
    let (started, length_secs) = (Instant::now(), scene.clip.duration_secs());
    let mut lines = 0;
    loop {
        let now_secs = (started.elapsed().as_secs_f64() * speed.max(0.01)).min(length_secs);
        let picture = frame::draw(scene, &stage, now_secs, &look());
        out.write_all(over(&picture, lines).as_bytes())?;
        out.flush()?;
        lines = picture.lines().count();
        if now_secs >= length_secs {
            return Ok(());
        }
        std::thread::sleep(Duration::from_secs_f64(1.0 / PICTURES_HZ));
    }
}

/// Abilities of this terminal now; asked for every picture, as windows change their size.
pub fn look() -> TerminalStyle {
    let (columns, rows) = match terminal_size::terminal_size() {
        Some((width, height)) => (usize::from(width.0), usize::from(height.0)),
        None => (80, 24),
    };
    let set = |name| {
        std::env::var(name)
            .ok()
            .filter(|value: &String| !value.is_empty())
    };
    let locale = set("LC_ALL")
        .or_else(|| set("LC_CTYPE"))
        .or_else(|| set("LANG"));
    let ascii = locale.is_some_and(|l| matches!(l.as_str(), "C" | "POSIX"));
    TerminalStyle {
        columns,
        rows,
        colour: set("NO_COLOR").is_none(),
        unicode: !ascii,
    }
}

/// The bytes that draw `picture` over the `before` lines of the last one, in one write.
///
/// The cursor is hidden only within the write and is then below the picture: whenever somebody presses Ctrl-C,
/// there is nothing to restore.
fn over(picture: &str, before: usize) -> String {
    let mut bytes = String::from("\x1b[?2026h\x1b[?25l\r");
    if before > 0 {
        bytes += &format!("\x1b[{before}A");
    }
    for line in picture.lines() {
        bytes += line;
        bytes += "\x1b[K\n";
    }
    bytes += "\x1b[J\x1b[?25h\x1b[?2026l";
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use morec::TimeSpan;
    use morec::live::Detection;

    #[test]
    fn an_event_says_what_when_and_how_late() {
        let mut said = Detection {
            class: "wave".to_owned(),
            span: TimeSpan::new(10.0, 12.28),
            score: 0.934,
            reported_secs: 12.40,
            repetitions: None,
        };
        assert_eq!(
            event_line(&said),
            " 12.40 s  wave  0.93  (0.12 s after its end)"
        );
        said.span.stop_secs = 12.5;
        assert!(event_line(&said).ends_with("(0.10 s before its end)"));
        said.class = "a\x1b[2Jb\n".to_owned();
        assert!(event_line(&said).contains("  a?[2Jb?  "));
    }

    #[test]
    fn without_a_terminal_there_are_just_the_events() {
        let take = frame::tests::take();
        let said = frame::tests::said(&take);
        let scene = ShownClip {
            title: "ada",
            clip: &take.clip,
            truth: &[],
            said: &said,
        };
        let mut out = Vec::new();
        write_events(&scene, &mut out).unwrap();
        let text = String::from_utf8(out).unwrap();
        assert_eq!(text.lines().count(), said.len());
        assert!(!text.contains('\x1b'));
    }

    #[test]
    fn a_picture_is_drawn_over_the_last_and_leaves_the_cursor_on() {
        let bytes = over("one\ntwo\n", 5);
        assert!(bytes.contains("\x1b[5A") && bytes.contains("one\x1b[K\ntwo\x1b[K\n"));
        assert!(bytes.rfind("\x1b[?25h").unwrap() > bytes.rfind("\x1b[?25l").unwrap());
        assert!(!over("one\n", 0).contains('A'));
    }
}
