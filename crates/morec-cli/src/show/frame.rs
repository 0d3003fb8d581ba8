//! One picture of the show: the person from the front, the last events, labels and detections over time.

use morec::TimeSpan;
use morec::clip::Clip;
use morec::kinematics::WorldPose;
use morec::live::Detection;
use morec::math::Vec3;

use super::picture::{CharGrid, DIM, Dots, PLAIN, Style, class_style};
use super::shown::{ShownClip, event_line, printable};

/// Seconds that the bottom lines look back.
const BACK_SECS: f64 = 20.0;
/// Seconds that an event is highlighted.
const FRESH_SECS: f64 = 1.2;
/// Below this width there is no room for a figure.
const FIGURE_FROM_COLUMNS: usize = 56;

/// Abilities of the terminal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TerminalStyle {
    pub columns: usize,
    pub rows: usize,
    pub colour: bool,
    /// Braille and line-drawing characters are there.
    pub unicode: bool,
}

/// Scale of a clip's figure, the same throughout.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FigureScale {
    ground: f64,
    height: f64,
    head: Option<usize>,
}

impl FigureScale {
    /// Looks through some hundred frames of `clip`.
    pub fn of(clip: &Clip) -> Self {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut pose = WorldPose::default();
        for frame in (0..clip.frames).step_by((clip.frames / 300).max(1)) {
            pose.set(clip, frame);
            for joint in 0..clip.skeleton.len() {
                let y = pose.tip(clip, joint).y;
                (low, high) = (low.min(y), high.max(y));
            }
        }
        let head = clip
            .skeleton
            .joints()
            .iter()
            .position(|j| j.name.to_lowercase().ends_with("head"));
        let (ground, height) = if high > low {
            (low, high - low)
        } else {
            (0.0, 1.0)
        };
        Self {
            ground,
            height,
            head,
        }
    }
}

/// The picture at `now_secs`: always the same number of lines for the same `look`, none wider than the terminal,
/// all of it one line less than the terminal is high.
pub fn draw(scene: &ShownClip, stage: &FigureScale, now_secs: f64, look: &TerminalStyle) -> String {
    let rows = look.rows.saturating_sub(1).clamp(1, 40);
    // The last column stays free: writing to it makes some terminals wrap.
    let columns = look.columns.saturating_sub(1).max(1);
    let mut picture = CharGrid::new(columns, rows);
    let total = scene.clip.duration_secs();
    let title = format!(
        "{}  {now_secs:.1} s of {total:.1} s",
        printable(scene.title)
    );
    picture.text(0, 0, columns, &title, PLAIN);
    let timeline_rows = if rows >= 8 { 4 } else { 0 };
    let middle = rows.saturating_sub(1 + timeline_rows);
    let said_by_now = &scene.said[..scene.said.partition_point(|s| s.reported_secs <= now_secs)];
    let mut events_from = 0;
    if columns >= FIGURE_FROM_COLUMNS && middle >= 6 {
        let width = (columns / 3).min(2 * middle);
        figure(
            &mut picture,
            scene,
            stage,
            (now_secs, said_by_now),
            (width, middle),
            look.unicode,
        );
        events_from = width + 1;
    }
    events(
        &mut picture,
        scene,
        (now_secs, said_by_now),
        events_from,
        (columns, middle),
    );
    if timeline_rows > 0 {
        timelines(
            &mut picture,
            scene,
            said_by_now,
            now_secs,
            (columns, rows - timeline_rows),
            look,
        );
    }
    picture.render(look.colour)
}

/// The person from the front, hips in the middle, in the colour of what was just said.
fn figure(
    picture: &mut CharGrid,
    scene: &ShownClip,
    stage: &FigureScale,
    (now_secs, said): (f64, &[Detection<String>]),
    (width, height): (usize, usize),
    unicode: bool,
) {
    let clip = scene.clip;
    if clip.frames == 0 || clip.skeleton.is_empty() {
        return;
    }
    let frame = ((now_secs * clip.rate_hz) as usize).min(clip.frames - 1);
    let pose = WorldPose::of(clip, frame);
    let mut dots = Dots::new(width, height);
    let dots_per_unit = (4 * height - 2) as f64 / (stage.height * 1.02);
    let middle = pose.positions[0].x;
    let on_grid = |p: Vec3| {
        [
            width as f64 + (p.x - middle) * dots_per_unit,
            4.0 * height as f64 - 1.5 - (p.y - stage.ground) * dots_per_unit,
        ]
    };
    for (j, joint) in clip.skeleton.joints().iter().enumerate() {
        let from = on_grid(pose.positions[j]);
        if let Some(parent) = joint.parent {
            dots.line(on_grid(pose.positions[parent]), from);
        }
        if Some(j) != stage.head {
            dots.line(from, on_grid(pose.tip(clip, j)));
        }
    }
    if let Some(head) = stage.head {
        let centre = on_grid((pose.positions[head] + pose.tip(clip, head)) / 2.0);
        let radius = 0.045 * stage.height * dots_per_unit;
        for k in 0..24 {
            let (sin, cos) = (k as f64 * std::f64::consts::TAU / 24.0).sin_cos();
            dots.set(centre[0] + radius * cos, centre[1] + radius * sin);
        }
    }
    let style = said
        .last()
        .filter(|s| is_fresh(s, now_secs))
        .map_or(PLAIN, |s| style_of(scene, &s.class));
    dots.draw(picture, (0, 1), unicode, style);
}

/// The last events that fit, the newest at the bottom.
fn events(
    picture: &mut CharGrid,
    scene: &ShownClip,
    (now_secs, said): (f64, &[Detection<String>]),
    x: usize,
    (columns, rows): (usize, usize),
) {
    let shown = &said[said.len().saturating_sub(rows)..];
    for (row, event) in shown.iter().enumerate() {
        let style = if is_fresh(event, now_secs) {
            style_of(scene, &event.class)
        } else {
            PLAIN
        };
        let line = event_line(event);
        // Where it is too narrow, what the delay is measured from goes first.
        let fits = x + line.chars().count() <= columns;
        let line = if fits {
            line
        } else {
            line.replace(" its end)", ")")
        };
        picture.text(x, 1 + row, columns, &line, style);
    }
}

fn is_fresh(said: &Detection<String>, now_secs: f64) -> bool {
    now_secs - said.reported_secs < FRESH_SECS
}

/// Labels, detections, and a line of seconds below.
fn timelines(
    picture: &mut CharGrid,
    scene: &ShownClip,
    said: &[Detection<String>],
    now_secs: f64,
    (columns, y): (usize, usize),
    look: &TerminalStyle,
) {
    let from = 7.min(columns);
    let ruler = Ruler {
        from,
        columns,
        now_secs,
    };
    picture.text(0, y + 1, from, "truth", DIM);
    picture.text(0, y + 2, from, "said", DIM);
    for truth in scene.truth.iter().filter(|t| t.span.start_secs <= now_secs) {
        bar(
            picture,
            &ruler,
            y + 1,
            &truth.class,
            truth.span,
            style_of(scene, &truth.class),
            look,
        );
    }
    for event in said {
        bar(
            picture,
            &ruler,
            y + 2,
            &event.class,
            event.span,
            style_of(scene, &event.class),
            look,
        );
    }
    let mut second = ((now_secs - BACK_SECS).max(0.0) / 5.0).ceil() * 5.0;
    while second <= now_secs {
        let text = format!("{}{second:.0} s", if look.unicode { '╵' } else { '\'' });
        picture.text(ruler.column(second), y + 3, columns, &text, DIM);
        second += 5.0;
    }
}

/// Columns from `from` to `columns` are the last [`BACK_SECS`] seconds.
struct Ruler {
    from: usize,
    columns: usize,
    now_secs: f64,
}

impl Ruler {
    fn column(&self, secs: f64) -> usize {
        let width = (self.columns - self.from) as f64;
        let share = 1.0 - (self.now_secs - secs) / BACK_SECS;
        self.from + (share.clamp(0.0, 1.0) * width) as usize
    }
}

/// A stretch with its class written into it, as far as it fits.
fn bar(
    picture: &mut CharGrid,
    ruler: &Ruler,
    y: usize,
    class: &str,
    span: TimeSpan,
    style: Style,
    look: &TerminalStyle,
) {
    let (start, stop) = (
        ruler.column(span.start_secs),
        ruler.column(span.stop_secs.min(ruler.now_secs)),
    );
    if stop <= start {
        return;
    }
    let (open, fill, close) = if look.unicode {
        ("├", "─", "┤")
    } else {
        ("[", "-", "]")
    };
    picture.text(start, y, stop, &fill.repeat(stop - start), style);
    // A stretch that began before the window, or that goes on, has no end to show there.
    if start > ruler.from {
        picture.text(start, y, stop, open, style);
    }
    if span.stop_secs <= ruler.now_secs && stop > start + 1 {
        picture.text(stop - 1, y, stop, close, style);
    }
    picture.text(start + 1, y, stop.saturating_sub(1), class, style);
}

/// A class keeps its colour: that of its place among the names in alphabetical order.
fn style_of(scene: &ShownClip, class: &str) -> Style {
    let names = scene
        .truth
        .iter()
        .map(|t| &t.class)
        .chain(scene.said.iter().map(|s| &s.class));
    let before: std::collections::BTreeSet<&String> =
        names.filter(|name| name.as_str() < class).collect();
    class_style(before.len())
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use morec::labels::Mark;
    use morec::synth::{Person, Script, SyntheticTake};

    pub fn take() -> SyntheticTake {
        let script = Script::new(1, Person::draw(1, 0))
            .rest(1.0)
            .play("raise_hands")
            .rest(1.0)
            .play("wave");
        script.rest(0.5).film("two", 30.0).unwrap()
    }

    /// Every label, found with an end 0.1 s early and said 0.2 s later.
    pub fn said(take: &SyntheticTake) -> Vec<Detection<String>> {
        let said = |l: &Mark<&str>| Detection {
            class: l.class.to_owned(),
            span: TimeSpan::new(l.span.start_secs, l.span.stop_secs - 0.1),
            score: 0.8,
            reported_secs: l.span.stop_secs + 0.1,
            repetitions: None,
        };
        take.labels.iter().map(said).collect()
    }

    fn truth(take: &SyntheticTake) -> Vec<Mark> {
        let truth = |l: &Mark<&str>| Mark::new(l.class, l.span);
        take.labels.iter().map(truth).collect()
    }

    const LOOK: TerminalStyle = TerminalStyle {
        columns: 80,
        rows: 24,
        colour: false,
        unicode: true,
    };

    fn shown(now_secs: f64, look: TerminalStyle) -> String {
        let take = take();
        let (truth, said) = (truth(&take), said(&take));
        let scene = ShownClip {
            title: "ada",
            clip: &take.clip,
            truth: &truth,
            said: &said,
        };
        draw(&scene, &FigureScale::of(&take.clip), now_secs, &look)
    }

    #[test]
    fn it_fits_every_terminal() {
        for (columns, rows) in [
            (80, 24),
            (200, 60),
            (60, 20),
            (40, 12),
            (20, 8),
            (10, 4),
            (1, 1),
            (0, 0),
        ] {
            for now_secs in [0.0, 2.0, 3.9, 99.0] {
                let picture = shown(
                    now_secs,
                    TerminalStyle {
                        columns,
                        rows,
                        ..LOOK
                    },
                );
                let lines = rows.saturating_sub(1).clamp(1, 40);
                assert_eq!(
                    picture.lines().count(),
                    lines,
                    "{columns}x{rows} at {now_secs}"
                );
                let widest = picture.lines().map(|l| l.chars().count()).max().unwrap();
                assert!(
                    widest <= columns.saturating_sub(1).max(1),
                    "{columns}x{rows}: {widest}"
                );
            }
        }
    }

    #[test]
    fn events_appear_when_they_are_said_and_not_before() {
        let at = said(&take())[0].reported_secs;
        assert!(!shown(at - 0.01, LOOK).contains("s after"));
        let after = shown(at + 0.01, LOOK);
        assert!(
            after.contains("raise_hands  0.80  (0.20 s after its end)"),
            "{after}"
        );
        assert!(shown(99.0, LOOK).contains("wave  0.80  (0.20 s after its end)"));
        assert_eq!(shown(99.0, LOOK).matches("s after").count(), 2);
    }

    #[test]
    fn the_figure_raises_its_hands() {
        let take = take();
        let middle = take.labels[0].span.middle_secs();
        let ink = |now_secs: f64| {
            let picture = shown(now_secs, LOOK);
            picture
                .lines()
                .skip(1)
                .take(3)
                .flat_map(str::chars)
                .filter(|c| ('⠁'..='⣿').contains(c))
                .count()
        };
        assert_eq!(ink(0.0), 0, "nothing is above the head of somebody at rest");
        assert!(ink(middle) >= 4, "{}", shown(middle, LOOK));
    }

    #[test]
    fn truth_and_detections_stand_below_each_other() {
        let picture = shown(99.0f64.min(take().clip.duration_secs()), LOOK);
        let line = |start: &str| {
            picture
                .lines()
                .find(|l| l.starts_with(start))
                .unwrap()
                .to_owned()
        };
        assert!(
            line("truth").contains("├raise_") && line("truth").contains("├wave"),
            "{picture}"
        );
        assert!(
            line("said").contains("├raise_") && line("said").contains("├wave"),
            "{picture}"
        );
        assert!(!shown(0.5, LOOK).contains('├'));
    }

    #[test]
    fn colour_and_unicode_can_be_left_out() {
        assert!(!shown(3.0, LOOK).contains('\x1b'));
        assert!(
            shown(
                3.9,
                TerminalStyle {
                    colour: true,
                    ..LOOK
                }
            )
            .contains("\x1b[0;1;")
        );
        let plain = shown(
            3.9,
            TerminalStyle {
                unicode: false,
                ..LOOK
            },
        );
        assert!(
            plain.is_ascii() && plain.contains('*') && plain.contains('['),
            "{plain}"
        );
    }
}
