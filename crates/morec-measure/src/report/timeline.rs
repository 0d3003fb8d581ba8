//! Timelines: ground truth above, detections below, one clip after the other.

use super::grid;
use super::html::Text;
use super::palette::Palette;
use crate::eval::{DetectionVerdict, GroundTruthVerdict, Timeline};
use morec::TimeSpan;
use morec::labels::{ClipDetection, GroundTruth};

const WIDTH: f64 = 1120.0;
/// Room for the lanes' names on the left, and a little on the right.
const LEFT: f64 = 46.0;
const RIGHT: f64 = 10.0;
const BAR: f64 = 22.0;
const TRUTH_Y: f64 = 14.0;
const FOUND_Y: f64 = TRUTH_Y + BAR + 4.0;
const AXIS_Y: f64 = FOUND_Y + BAR + 16.0;
const HEIGHT: f64 = AXIS_Y + 16.0;
/// A longer clip is broken into rows of about this.
const ROW_SECS: f64 = 30.0;
/// Rows drawn at most: a browser must still open the file.
const MOST_ROWS: usize = 2000;

pub(super) fn push(out: &mut String, timelines: &[Timeline], palette: &Palette) {
    out.push_str("<h2>Timelines</h2>\n");
    push_legend(out, palette);
    let (short, long) = grid::split(timelines);
    let (empty, mut drawn): (Vec<&Timeline>, Vec<_>) = long
        .into_iter()
        .partition(|t| t.truths.is_empty() && t.founds.is_empty());
    drawn.sort_by_key(|t| t.stream.unknown);
    let row_secs = drawn
        .iter()
        .map(|t| t.stream.duration_secs / rows_of(t) as f64)
        .fold(1.0, f64::max);
    let scale = (WIDTH - LEFT - RIGHT) / row_secs;
    let mut rows = 0;
    for timeline in &drawn {
        rows += rows_of(timeline);
        if rows > MOST_ROWS {
            let text = "<p>The timelines of the remaining clips are left out to keep the file small enough to open. All figures \
                include these clips.</p>\n";
            out.push_str(text);
            break;
        }
        push_clip(out, timeline, scale, palette);
    }
    grid::push(out, &short, palette);
    if !empty.is_empty() {
        let names: Vec<String> = empty
            .iter()
            .map(|t| Text(&t.stream.clip).to_string())
            .collect();
        out.push_str(&format!(
            "<p class=\"small\">No labels and no detections in {}.</p>\n",
            names.join(", ")
        ));
    }
}

fn push_legend(out: &mut String, palette: &Palette) {
    out.push_str("<p class=\"legend\">");
    for (name, colour) in palette.classes() {
        out.push_str(&format!(
            "<span><i style=\"background:{colour}\"></i>{}</span> ",
            Text(name)
        ));
    }
    out.push_str(
        "</p>\n<p class=\"small\">Above: labels (<b>○</b> missed, <b>✗</b> detected as another class). Below: \
         detections (<b>✗</b> wrong class, <b>!</b> false alarm, <b>~</b> right class, but inaccurate in time or a duplicate; \
         the small tick \
         is the time of the report).</p>\n",
    );
}

fn rows_of(timeline: &Timeline) -> usize {
    // A clip a little over the length of a row stays whole.
    ((timeline.stream.duration_secs / ROW_SECS - 0.2).ceil() as usize).max(1)
}

fn push_clip(out: &mut String, timeline: &Timeline, scale: f64, palette: &Palette) {
    let stream = &timeline.stream;
    out.push_str(&format!(
        "<figure class=\"clip\"><figcaption><b>{}</b> {:.1} s, {}",
        Text(&stream.clip),
        stream.duration_secs,
        summary(timeline)
    ));
    let rows = rows_of(timeline);
    let row_secs = stream.duration_secs / rows as f64;
    let windows = (0..rows).map(|r| TimeWindow {
        span: TimeSpan::new(r as f64 * row_secs, (r + 1) as f64 * row_secs),
        scale,
    });
    let (shown, blank): (Vec<TimeWindow>, Vec<TimeWindow>) =
        windows.partition(|window| window.holds_any(timeline));
    if !blank.is_empty() {
        out.push_str(&format!("; empty rows are left out: {}", blank.len()));
    }
    out.push_str("</figcaption>\n");
    for window in shown {
        push_row(out, timeline, window, palette);
    }
    out.push_str("</figure>\n");
}

fn summary(timeline: &Timeline) -> String {
    let found = timeline.founds.len();
    if timeline.stream.unknown {
        return format!("unknown motion: {found} found");
    }
    let lost = timeline
        .truths
        .iter()
        .filter(|(_, v)| *v != GroundTruthVerdict::Right)
        .count();
    let alarms = timeline
        .founds
        .iter()
        .filter(|(_, v)| *v == DetectionVerdict::FalseAlarm)
        .count();
    format!(
        "{} labelled, {lost} not recognised, {found} found, {alarms} false",
        timeline.truths.len()
    )
}

/// The part of a clip that a row shows.
#[derive(Clone, Copy)]
struct TimeWindow {
    span: TimeSpan,
    scale: f64,
}

impl TimeWindow {
    fn x(self, secs: f64) -> f64 {
        let TimeSpan {
            start_secs,
            stop_secs,
        } = self.span;
        LEFT + (secs.clamp(start_secs, stop_secs) - start_secs) * self.scale
    }

    fn holds_any(self, timeline: &Timeline) -> bool {
        timeline
            .truths
            .iter()
            .any(|(t, _)| t.span.overlaps(self.span))
            || timeline
                .founds
                .iter()
                .any(|(f, _)| f.span.overlaps(self.span))
    }
}

fn push_row(out: &mut String, timeline: &Timeline, window: TimeWindow, palette: &Palette) {
    let (right, name) = (window.x(window.span.stop_secs), Text(&timeline.stream.clip));
    out.push_str(&format!(
        "<svg viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\"><title>{name}, {:.1} s to {:.1} s</title>\n\
         <rect class=\"ground\" x=\"{LEFT}\" y=\"{TRUTH_Y}\" width=\"{:.1}\" height=\"{BAR}\"/>\
         <rect class=\"ground\" x=\"{LEFT}\" y=\"{FOUND_Y}\" width=\"{:.1}\" height=\"{BAR}\"/>\n\
         <text x=\"0\" y=\"{}\">labels</text><text x=\"0\" y=\"{}\">found</text>\n",
        window.span.start_secs,
        window.span.stop_secs,
        right - LEFT,
        right - LEFT,
        TRUTH_Y + 15.0,
        FOUND_Y + 15.0,
    ));
    let truths = timeline
        .truths
        .iter()
        .filter(|(t, _)| t.span.overlaps(window.span));
    let founds = timeline
        .founds
        .iter()
        .filter(|(f, _)| f.span.overlaps(window.span));
    let mut truth_names = Names::new(TRUTH_Y, right);
    for (truth, verdict) in truths {
        push_truth(out, truth, verdict, window, palette);
        truth_names.add(
            &truth.class,
            window.x(truth.span.start_secs),
            window.x(truth.span.stop_secs),
        );
    }
    let mut found_names = Names::new(FOUND_Y, right);
    for (found, verdict) in founds {
        push_found(out, found, *verdict, window, palette);
        let counted = found.repetitions.map(|n| format!("{} × {n}", found.class));
        found_names.add(
            counted.as_deref().unwrap_or(&found.class),
            window.x(found.span.start_secs),
            window.x(found.span.stop_secs),
        );
    }
    truth_names.push(out);
    found_names.push(out);
    push_axis(out, window);
    out.push_str("</svg>\n");
}

fn push_truth(
    out: &mut String,
    truth: &GroundTruth,
    verdict: &GroundTruthVerdict,
    window: TimeWindow,
    palette: &Palette,
) {
    let (class, mark, text) = match verdict {
        GroundTruthVerdict::Right => ("bar", "", "recognised".to_owned()),
        GroundTruthVerdict::Mistaken(other) => ("bar mistaken", "✗", format!("taken for {other}")),
        GroundTruthVerdict::Missed => ("bar missed", "○", "missed".to_owned()),
    };
    let title = format!("{} {:.2}: {text}", truth.class, truth.span);
    let (from, to) = (
        window.x(truth.span.start_secs),
        window.x(truth.span.stop_secs),
    );
    push_bar(
        out,
        class,
        (from, to, TRUTH_Y),
        palette.colour(&truth.class),
        &title,
    );
    push_mark(out, mark, (from + to) / 2.0, TRUTH_Y - 3.0);
}

fn push_found(
    out: &mut String,
    found: &ClipDetection,
    verdict: DetectionVerdict,
    window: TimeWindow,
    palette: &Palette,
) {
    let (class, mark, text) = match verdict {
        DetectionVerdict::Right => ("bar", "", "right"),
        DetectionVerdict::Loose => (
            "bar loose",
            "~",
            "right class, but inaccurate in time or a duplicate",
        ),
        DetectionVerdict::WrongClass => ("bar wrong", "✗", "wrong class"),
        DetectionVerdict::FalseAlarm => ("bar alarm", "!", "false alarm"),
    };
    let mut title = format!("{} {:.2}: {text}", found.class, found.span);
    if let Some(score) = found.score {
        title.push_str(&format!(", score {score:.3}"));
    }
    if let Some(count) = found.repetitions {
        title.push_str(&format!(", {count} repetitions"));
    }
    if let Some(reported) = found.reported_secs {
        title.push_str(&format!(", reported at {reported:.2} s"));
        if (window.span.start_secs..=window.span.stop_secs).contains(&reported) {
            let x = window.x(reported);
            let (top, bottom) = (FOUND_Y + BAR, FOUND_Y + BAR + 5.0);
            out.push_str(&format!(
                "<path class=\"report\" d=\"M{x:.1} {top}V{bottom}\"/>"
            ));
        }
    }
    let (from, to) = (
        window.x(found.span.start_secs),
        window.x(found.span.stop_secs),
    );
    push_bar(
        out,
        class,
        (from, to, FOUND_Y),
        palette.colour(&found.class),
        &title,
    );
    push_mark(out, mark, (from + to) / 2.0, FOUND_Y + BAR + 13.0);
}

fn push_bar(
    out: &mut String,
    class: &str,
    (from, to, y): (f64, f64, f64),
    colour: &str,
    title: &str,
) {
    let width = (to - from).max(1.0);
    out.push_str(&format!(
        "<rect class=\"{class}\" x=\"{from:.1}\" y=\"{y}\" width=\"{width:.1}\" height=\"{BAR}\" fill=\"{colour}\">\
         <title>{}</title></rect>\n",
        Text(title)
    ));
}

fn push_mark(out: &mut String, mark: &str, x: f64, y: f64) {
    if !mark.is_empty() {
        out.push_str(&format!(
            "<text class=\"mark\" x=\"{x:.1}\" y=\"{y}\">{mark}</text>"
        ));
    }
}

fn push_axis(out: &mut String, window: TimeWindow) {
    let right = window.x(window.span.stop_secs);
    out.push_str(&format!(
        "<path class=\"axis\" d=\"M{LEFT} {AXIS_Y}H{right:.1}\"/>"
    ));
    let shown = window.span.duration_secs();
    let step = [0.5, 1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .find(|s| shown / s <= 16.0)
        .unwrap_or(30.0);
    let first = (window.span.start_secs / step - 1e-9).ceil() as u64;
    let last = (window.span.stop_secs / step + 1e-9).floor() as u64;
    for tick in first..=last {
        let secs = tick as f64 * step;
        let x = window.x(secs);
        out.push_str(&format!(
            "<path class=\"axis\" d=\"M{x:.1} {AXIS_Y}v4\"/><text class=\"tick\" x=\"{x:.1}\" y=\"{}\">{secs}</text>",
            AXIS_Y + 14.0
        ));
    }
    out.push('\n');
}

/// Class names on the bars, or beside them where there is room. Bars that follow each other closely share one.
struct Names {
    y: f64,
    end: f64,
    runs: Vec<(String, f64, f64)>,
}

impl Names {
    /// Pixels between bars that still count as one run, and pixels a letter takes.
    const CLOSE: f64 = 6.0;
    const LETTER: f64 = 5.9;

    fn new(lane_y: f64, end: f64) -> Self {
        Self {
            y: lane_y + 15.0,
            end,
            runs: Vec::new(),
        }
    }

    fn add(&mut self, class: &str, from: f64, to: f64) {
        match self.runs.last_mut() {
            Some((name, _, end)) if name == class && from - *end <= Self::CLOSE => {
                *end = to.max(*end)
            }
            _ => self.runs.push((class.to_owned(), from, to)),
        }
    }

    fn push(&self, out: &mut String) {
        for (i, (name, from, to)) in self.runs.iter().enumerate() {
            let next = self
                .runs
                .get(i + 1)
                .map_or(self.end, |(_, start, _)| *start);
            let width = name.chars().count() as f64 * Self::LETTER + 6.0;
            let (class, x) = if width <= to.min(next) - from {
                ("name", from + 4.0)
            } else if width <= next - to {
                ("beside", to + 3.0)
            } else {
                continue;
            };
            out.push_str(&format!(
                "<text class=\"{class}\" x=\"{x:.1}\" y=\"{}\">{}</text>\n",
                self.y,
                Text(name)
            ));
        }
    }
}
