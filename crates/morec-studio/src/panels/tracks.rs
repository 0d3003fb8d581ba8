//! The tracks of labels: drawn, selected, dragged.

use egui::epaint::Mesh;
use egui::{Color32, Rect, Response, Sense, Shape, Stroke, StrokeKind, Ui, Vec2, WidgetType, pos2};
use morec_db::labels::{DbSample, SampleState as Judged};

use super::scale::{NAMES, Scale};
use super::{Out, carried, widgets};
use crate::format;
use crate::state::{Command, Drag, Grip, PlayCommand, State, TimelineCommand};
use crate::theme::Colours;

pub(super) const ROW: f32 = 19.0;
/// More classes than these do not all have a track.
const MANY: usize = 8;
/// Labels narrower than this cannot be held; those that touch are drawn as one.
const NARROW: f32 = 6.0;
/// Width of the part at each end of a label by which it is held, points.
const EDGE: f32 = 6.0;

/// Room for a track: its name at the left, where it lies, and its ground.
pub(super) fn track(
    ui: &mut Ui,
    scale: &Scale,
    name: &str,
    height: f32,
    colour: Option<Color32>,
) -> (Rect, Response) {
    let c = Colours::now(ui);
    let (rect, _) = ui.allocate_exact_size(Vec2::new(ui.available_width(), height), Sense::hover());
    let tracks = Rect::from_min_max(
        pos2(scale.left, rect.top()),
        pos2(scale.right(), rect.bottom()),
    );
    ui.painter().rect_filled(tracks, 0.0, c.well);
    let mut text = Rect::from_min_max(rect.min, pos2(rect.left() + NAMES - 8.0, rect.bottom()));
    if let Some(colour) = colour {
        let square =
            Rect::from_center_size(text.left_center() + Vec2::new(5.0, 0.0), Vec2::splat(10.0));
        ui.painter().rect_filled(square, 2.0, colour);
        text.min.x += 16.0;
    }
    widgets::text_in(ui, text, name, 12.0, c.muted, false);
    let id = ui.id().with(("ground", name));
    let response = ui.interact(tracks, id, Sense::click_and_drag());
    widgets::named(&response, WidgetType::Other, format!("Track {name}"), false);
    (tracks, response)
}

/// A track without anything that could be held.
pub(super) fn plain_track(
    ui: &mut Ui,
    state: &State,
    scale: &Scale,
    name: &str,
    height: f32,
    out: Out,
) -> Rect {
    let (rect, response) = track(ui, scale, name, height, None);
    ground(ui, state, scale, &response, out);
    rect
}

/// Why a track is empty, in the track.
pub(super) fn remark(ui: &Ui, rect: Rect, track: &str, text: &str) {
    let response = ui.interact(rect, ui.id().with(("remark", track)), Sense::hover());
    let name = format!("{track}: {text}");
    widgets::named(&response, WidgetType::Label, name, false);
    let inner = rect.shrink2(Vec2::new(8.0, 0.0));
    widgets::text_in(ui, inner, text, 11.0, Colours::now(ui).muted, false);
}

/// A click on the ground goes to that moment and ends the selection; a drag selects a stretch.
fn ground(ui: &Ui, state: &State, scale: &Scale, response: &Response, out: Out) {
    if response.clicked()
        && let Some(at) = response.interact_pointer_pos()
    {
        out.push(Command::Play(PlayCommand::Seek(scale.secs(at.x))));
        out.push(Command::Timeline(TimelineCommand::SelectNothing));
    }
    swept(ui, state, scale, response, out);
}

/// A drag over the ground selects a stretch, unless something is carried over it.
pub(super) fn swept(ui: &Ui, state: &State, scale: &Scale, response: &Response, out: Out) {
    let pointer = response.interact_pointer_pos();
    if response.dragged_by(egui::PointerButton::Primary)
        && !carried::any(ui)
        && let (Some(at), Some(from)) = (pointer, ui.input(|i| i.pointer.press_origin()))
    {
        let (a, b) = (scale.secs(from.x), scale.secs(at.x));
        let end = state.player.secs();
        let rate = state.player.rate_hz();
        let marks = state.marks();
        let snap = |secs: f64| {
            state
                .timeline
                .snapped(secs, marks.iter().copied(), rate)
                .clamp(0.0, end)
        };
        let range = (snap(a.min(b)), snap(a.max(b)));
        out.push(Command::Timeline(TimelineCommand::Range(Some(range))));
    }
}

/// A track for each class, with its labels and proposals.
pub fn labels(ui: &mut Ui, state: &State, scale: &Scale, out: Out) {
    let c = Colours::now(ui);
    let samples = state.shown_samples();
    // Labels are sorted by start; the longest says how far before the view one can begin that reaches into it.
    let longest = samples
        .iter()
        .map(|s| s.stop_secs - s.start_secs)
        .fold(0.0, f64::max);
    let first = samples.partition_point(|s| s.start_secs < scale.from - longest);
    let last = samples.partition_point(|s| s.start_secs <= scale.to);
    // What is dragged may come from outside of the view.
    let visible = &samples[first.min(last)..last];
    if state.classes.order.is_empty() {
        plain_track(ui, state, scale, "Labels", ROW, out);
        return;
    }
    let mut drawn = 0;
    for (place, class) in state.classes.placed() {
        if !has_track(state, place, class) {
            continue;
        }
        drawn += 1;
        let colour = c.class(Some(place));
        let (tracks, response) = track(ui, scale, class, ROW, Some(colour));
        ground(ui, state, scale, &response, out);
        carried::accept(ui, &response, class, out);
        if !ui.is_rect_visible(tracks) {
            continue;
        }
        let mut row = TrackRow {
            rect: tracks.shrink2(Vec2::new(0.0, 1.5)),
            colour,
            mesh: Mesh::default(),
            run: None,
        };
        for sample in visible.iter().filter(|s| s.class == *class) {
            label(ui, state, scale, sample, &mut row, &c, out);
        }
        row.flush();
        ui.painter_at(tracks).add(Shape::mesh(row.mesh));
    }
    if drawn == 0 {
        plain_track(ui, state, scale, "Labels", ROW, out);
    }
}

/// True if there are too many classes to leave room for the other tracks.
pub(super) fn are_many(state: &State) -> bool {
    state.classes.order.len() > MANY
}

/// True if a class has a track: of many, those that the clip shows, and the one whose key is held.
fn has_track(state: &State, place: usize, class: &str) -> bool {
    let held = state.classes.held.as_ref().is_some_and(|h| h.slot == place);
    let shows =
        |s: &DbSample| s.class == class && s.state != Judged::Rejected && state.study.shows(s);
    !are_many(state)
        || state.timeline.all_classes
        || held
        || state.shown_samples().iter().any(|s| shows(s))
}

/// The narrow labels of a row, drawn as one mesh; those that touch as one.
struct TrackRow {
    rect: Rect,
    colour: Color32,
    mesh: Mesh,
    run: Option<(f32, f32)>,
}

impl TrackRow {
    fn narrow(&mut self, left: f32, right: f32) {
        let right = right.max(left + 1.0);
        self.run = match self.run {
            Some((from, to)) if left <= to + 0.75 => Some((from, to.max(right))),
            Some((from, to)) => {
                self.bar(from, to);
                Some((left, right))
            }
            None => Some((left, right)),
        };
    }

    fn flush(&mut self) {
        if let Some((from, to)) = self.run.take() {
            self.bar(from, to);
        }
    }

    fn bar(&mut self, left: f32, right: f32) {
        let rect = Rect::from_x_y_ranges(left..=right, self.rect.y_range());
        self.mesh.add_colored_rect(rect, self.colour);
    }
}

fn label(
    ui: &Ui,
    state: &State,
    scale: &Scale,
    sample: &DbSample,
    row: &mut TrackRow,
    c: &Colours,
    out: Out,
) {
    if sample.state == Judged::Rejected || !state.study.shows(sample) {
        return;
    }
    let (start, stop) = state.timeline.extent(sample);
    let (left, right) = (scale.x(start), scale.x(stop));
    let held = state
        .timeline
        .drag
        .as_ref()
        .is_some_and(|d| d.id == sample.id);
    if right - left < NARROW && !held {
        return row.narrow(left, right);
    }
    let rect = Rect::from_x_y_ranges(left + 0.5..=right - 0.5, row.rect.y_range());
    let clip = Rect::from_x_y_ranges(scale.left..=scale.right(), rect.y_range());
    let painter = ui.painter_at(clip);
    let selected = state.timeline.selected.contains(&sample.id);
    let response = ui.interact(
        rect.intersect(clip),
        ui.id().with(sample.id),
        Sense::click_and_drag(),
    );
    let class = format::class(sample);
    widgets::named(
        &response,
        WidgetType::Button,
        format!("{class} {start:.2}–{stop:.2} s"),
        selected,
    );
    if sample.state == Judged::Proposed {
        let sure = sample.score.unwrap_or(0.5).clamp(0.0, 1.0) as f32;
        painter.rect_filled(rect, 3.0, c.tint(row.colour, 0.10 + 0.30 * sure));
        painter.rect_stroke(rect, 3.0, Stroke::new(1.0, row.colour), StrokeKind::Inside);
        if rect.width() > 18.0 {
            painter.text(
                rect.center(),
                egui::Align2::CENTER_CENTER,
                "?",
                egui::FontId::proportional(12.0),
                c.text,
            );
        }
    } else {
        let fill = if response.hovered() || held {
            row.colour.lerp_to_gamma(c.text, 0.15)
        } else {
            row.colour
        };
        painter.rect_filled(rect, 3.0, fill);
    }
    if selected {
        painter.rect_stroke(
            rect.expand(1.0),
            3.0,
            Stroke::new(2.0, c.text),
            StrokeKind::Inside,
        );
    }
    held_by(ui, state, scale, sample, rect, &response, out);
}

/// Clicks select, drags move: an end, or all of it.
fn held_by(
    ui: &Ui,
    state: &State,
    scale: &Scale,
    sample: &DbSample,
    rect: Rect,
    response: &Response,
    out: Out,
) {
    let grip = |x: f32| match rect.width() > 3.0 * EDGE {
        true if x < rect.left() + EDGE => Grip::Start,
        true if x > rect.right() - EDGE => Grip::Stop,
        _ => Grip::Whole,
    };
    if let Some(at) = response.hover_pos() {
        ui.ctx().set_cursor_icon(match grip(at.x) {
            Grip::Whole => egui::CursorIcon::Grab,
            _ => egui::CursorIcon::ResizeHorizontal,
        });
    }
    if response.double_clicked() {
        out.push(Command::Play(PlayCommand::Stretch(
            sample.start_secs,
            sample.stop_secs,
        )));
    } else if response.clicked() {
        let add = ui.input(|i| i.modifiers.command || i.modifiers.shift);
        out.push(Command::Timeline(TimelineCommand::Select {
            id: Some(sample.id),
            add,
        }));
        out.push(Command::Timeline(TimelineCommand::Range(None)));
    }
    let origin = ui.input(|i| i.pointer.press_origin());
    if response.drag_started_by(egui::PointerButton::Primary)
        && let Some(origin) = origin
    {
        out.push(Command::Timeline(TimelineCommand::Grab(Drag {
            id: sample.id,
            grip: grip(origin.x),
            held_secs: scale.secs(origin.x) - sample.start_secs,
            span: sample.span(),
            dropped: false,
        })));
    }
    let mine = state
        .timeline
        .drag
        .as_ref()
        .is_some_and(|d| d.id == sample.id && !d.dropped);
    if response.dragged()
        && mine
        && let Some(at) = response.interact_pointer_pos()
    {
        out.push(Command::Timeline(TimelineCommand::Drag(scale.secs(at.x))));
    }
    if response.drag_stopped() {
        if let Some(at) = response.interact_pointer_pos() {
            out.push(Command::Timeline(TimelineCommand::Drag(scale.secs(at.x))));
        }
        out.push(Command::Timeline(TimelineCommand::Drop));
    }
}
