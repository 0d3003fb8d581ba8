//! The plane in which a branch of the tree of 2009 tells its sides apart: regions, thresholds, samples.

use egui::epaint::{Mesh, TextShape};
use egui::{Align2, FontId, Pos2, Rect, RichText, Sense, Shape, Ui, Vec2, WidgetType, pos2};

use super::{Out, widgets};
use crate::jobs::thesis::{Boundary, GRID, Thesis};
use crate::state::{Command, State, TrainCommand};
use crate::theme::Colours;

/// Room for the axes at the left and below, points.
const AXIS: Vec2 = Vec2::new(52.0, 38.0);
/// Room for the legend below, points.
const LEGEND: f32 = 34.0;
/// A point can be clicked so far from its middle.
const REACH: f32 = 7.0;

/// The picture, as large as there is room for.
pub fn show(ui: &mut Ui, state: &State, thesis: &Thesis, branch: &Boundary, out: Out) {
    let c = Colours::now(ui);
    // As much as is seen at once; where little is left below, after scrolling.
    let seen = ui.clip_rect();
    let left = seen.bottom() - ui.cursor().top();
    let tall = left.max(0.7 * seen.height()) - AXIS.y - LEGEND;
    let side = (ui.available_width() - AXIS.x - 8.0)
        .min(tall)
        .clamp(300.0, 620.0);
    let (area, _) = ui.allocate_exact_size(Vec2::splat(side) + AXIS, Sense::hover());
    let rect = Rect::from_min_size(area.min + Vec2::new(AXIS.x, 0.0), Vec2::splat(side));
    let whole = ui.interact(rect, ui.id().with("plane"), Sense::hover());
    widgets::named(&whole, WidgetType::Image, "Plane of the branch", false);
    ui.painter().rect_filled(rect, 3.0, c.well);
    let painter = ui.painter_at(rect);
    painter.add(Shape::mesh(regions(rect, branch, &c)));
    let (machine, accept) = (&thesis.params.tree.machine, thesis.model.params.accept);
    for (machine_side, colour) in [(0, c.accent), (1, c.bad)] {
        for (level, width) in [(machine.own, 2.0), (accept, 1.0)] {
            for line in contour(rect, branch, machine_side, level) {
                painter.line_segment(line, (width, colour));
            }
        }
    }
    axes(ui, rect, branch, &c);
    let [left, lower, right, upper] = branch.edges;
    let place = |[x, y]: [f64; 2]| -> Pos2 {
        let share =
            |value: f64, low: f64, high: f64| ((value - low) / (high - low).max(1e-12)) as f32;
        pos2(
            rect.left() + share(x, left, right) * rect.width(),
            rect.bottom() - share(y, lower, upper) * rect.height(),
        )
    };
    for (number, (sample, at, side)) in branch.points.iter().enumerate() {
        let Some(taught) = thesis.samples.get(*sample) else {
            continue;
        };
        let at = place(*at);
        let area = Rect::from_center_size(at, Vec2::splat(2.0 * REACH));
        let response = ui.interact(area, ui.id().with(("point", number)), Sense::click());
        let said = format!(
            "{} in {} at {:.2} s",
            taught.class, taught.clip, taught.span.start_secs
        );
        let on = state.train.sample == Some(*sample);
        widgets::named(&response, WidgetType::Button, format!("Point: {said}"), on);
        let colour = c.class(state.classes.place(&taught.class));
        let radius = if response.hovered() { 6.0 } else { 4.0 };
        // Sides are distinguished by shape too.
        match side {
            0 => ui.painter().circle(at, radius, colour, (1.0, c.text)),
            _ => {
                let square = Rect::from_center_size(at, Vec2::splat(1.8 * radius));
                let inside = egui::StrokeKind::Inside;
                ui.painter()
                    .rect(square, 1.0, colour, (1.0, c.text), inside)
            }
        };
        if on {
            ui.painter().circle_stroke(at, 9.0, (2.0, c.text));
        }
        if response.on_hover_text(said).clicked() {
            out.push(Command::Train(TrainCommand::Sample(*sample)));
        }
    }
    legend(ui, thesis, &c);
}

/// What is tinted and which line is which.
fn legend(ui: &mut Ui, thesis: &Thesis, c: &Colours) {
    let machine = &thesis.params.tree.machine;
    let text = format!(
        "Tinted: the output of a side's machine is above the other side's limit, t = {:.2}. Thick lines: the output is T = \
         {:.2}, as for its own samples. Thin lines: the output is {:.2}, from which recognition follows the branch.",
        machine.other, machine.own, thesis.model.params.accept
    );
    ui.label(RichText::new(text).size(12.0).color(c.muted));
}

/// Both coordinates of the plane, with figures at the ends and in the middle.
fn axes(ui: &Ui, rect: Rect, branch: &Boundary, c: &Colours) {
    let font = FontId::proportional(11.0);
    let [left, lower, right, upper] = branch.edges;
    let painter = ui.painter();
    for share in [0.0, 0.25, 0.5, 0.75, 1.0f32] {
        let value = |low: f64, high: f64| format!("{:.2}", low + (high - low) * f64::from(share));
        let x = rect.left() + share * rect.width();
        painter.vline(x, rect.bottom()..=rect.bottom() + 4.0, (1.0, c.muted));
        let at = pos2(x, rect.bottom() + 5.0);
        painter.text(
            at,
            Align2::CENTER_TOP,
            value(left, right),
            font.clone(),
            c.muted,
        );
        let y = rect.bottom() - share * rect.height();
        painter.hline(rect.left() - 4.0..=rect.left(), y, (1.0, c.muted));
        let at = pos2(rect.left() - 6.0, y);
        painter.text(
            at,
            Align2::RIGHT_CENTER,
            value(lower, upper),
            font.clone(),
            c.muted,
        );
    }
    let below = pos2(rect.center().x, rect.bottom() + 20.0);
    let text = "first direction of the plane";
    painter.text(below, Align2::CENTER_TOP, text, font.clone(), c.muted);
    let galley = painter.layout_no_wrap("second direction".to_owned(), font, c.muted);
    let at = pos2(
        rect.left() - AXIS.x,
        rect.center().y + 0.5 * galley.size().x,
    );
    let mut shape = TextShape::new(at, galley, c.muted);
    shape.angle = -std::f32::consts::FRAC_PI_2;
    painter.add(shape);
}

/// The line along which the machine of a side says `level`: marching squares between the places of the picture.
fn contour(rect: Rect, branch: &Boundary, side: usize, level: f64) -> Vec<[Pos2; 2]> {
    let says = |column: usize, row: usize| branch.outputs[row * GRID + column][side] - level;
    let step = rect.width() / GRID as f32;
    let at = |column: f32, row: f32| {
        pos2(
            rect.left() + step * (column + 0.5),
            rect.bottom() - step * (row + 0.5),
        )
    };
    let mut lines = Vec::new();
    for row in 0..GRID - 1 {
        for column in 0..GRID - 1 {
            let corners = [(0, 0), (1, 0), (1, 1), (0, 1)];
            let mut crossings: Vec<Pos2> = Vec::with_capacity(4);
            for edge in 0..4 {
                let (a, b) = (corners[edge], corners[(edge + 1) % 4]);
                let (from, to) = (says(column + a.0, row + a.1), says(column + b.0, row + b.1));
                if (from < 0.0) != (to < 0.0) {
                    let share = (from / (from - to)) as f32;
                    let place = |a: usize, b: usize| a as f32 + share * (b as f32 - a as f32);
                    let (x, y) = (place(a.0, b.0), place(a.1, b.1));
                    crossings.push(at(column as f32 + x, row as f32 + y));
                }
            }
            lines.extend(crossings.chunks_exact(2).map(|pair| [pair[0], pair[1]]));
        }
    }
    lines
}

/// Regions in which the machine of one side says `t` or more, or those of both do.
fn regions(rect: Rect, branch: &Boundary, c: &Colours) -> Mesh {
    let mut mesh = Mesh::default();
    let step = rect.width() / GRID as f32;
    for (place, says) in branch.regions.iter().enumerate() {
        let colour = match says {
            1 => c.tint(c.accent, 0.30),
            2 => c.tint(c.bad, 0.30),
            3 => c.tint(c.warn, 0.45),
            _ => continue,
        };
        let (column, row) = ((place % GRID) as f32, (place / GRID) as f32);
        let corner = pos2(
            rect.left() + step * column,
            rect.bottom() - step * (row + 1.0),
        );
        mesh.add_colored_rect(Rect::from_min_size(corner, Vec2::splat(step)), colour);
    }
    mesh
}
