//! The method of 2009: its tree of classes, and the boundary of each branch, where a point plays its sample.

use egui::epaint::Mesh;
use egui::{Pos2, Rect, RichText, Sense, Shape, Ui, Vec2, WidgetType, pos2};

use super::{Out, widgets};
use crate::jobs::thesis::{Boundary, GRID, Thesis, TreeNodeView};
use crate::state::{Command, State, TrainCommand};
use crate::theme::Colours;

/// Size of the picture of a branch, points.
const SIDE: f32 = 300.0;
/// A point can be clicked so far from its middle.
const REACH: f32 = 7.0;

pub fn show(ui: &mut Ui, state: &State, out: Out) {
    let c = Colours::now(ui);
    ui.add_space(14.0);
    widgets::section(ui, "THE METHOD OF 2009");
    ui.horizontal_wrapped(|ui| {
        let training = state.is_training_thesis();
        let text = if training { "Training …" } else { "Train it on these labels" };
        if ui.add_enabled(!training, egui::Button::new(text)).clicked() {
            out.push(Command::Train(TrainCommand::Thesis));
        }
        let hint = "A tree of support vector machines: each branch tells two groups of classes apart, or neither.";
        ui.label(RichText::new(hint).size(12.0).color(c.muted));
    });
    let Some(thesis) = &state.train.thesis else {
        return;
    };
    ui.horizontal_top(|ui| {
        ui.vertical(|ui| {
            ui.set_width((ui.available_width() - SIDE - 24.0).clamp(150.0, 420.0));
            node(ui, state, thesis, 0, 0, out);
        });
        if let Some(branch) = thesis.branch(state.train.branch) {
            ui.vertical(|ui| {
                sides(ui, state, branch);
                boundary(ui, state, thesis, branch, out);
            });
        }
    });
}

/// A node of the tree, and what is below it.
fn node(ui: &mut Ui, state: &State, thesis: &Thesis, at: usize, depth: usize, out: Out) {
    // A tree of this many classes is no deeper; a broken one ends here.
    if depth > 64 {
        return;
    }
    let c = Colours::now(ui);
    match thesis.nodes.get(at) {
        Some(TreeNodeView::Leaf(class)) => {
            ui.horizontal(|ui| {
                ui.add_space(18.0 * depth as f32);
                widgets::chip(ui, state.classes.place(class), class);
                ui.label(class);
            });
        }
        Some(TreeNodeView::Branch(branch)) => {
            ui.horizontal(|ui| {
                ui.add_space(18.0 * depth as f32);
                let on = state.train.branch == at;
                let text = format!(
                    "{} | {}",
                    branch.sides[0].join(", "),
                    branch.sides[1].join(", ")
                );
                let response = ui.add(egui::Button::selectable(on, &text).truncate());
                widgets::named(&response, WidgetType::Button, format!("Branch {at}"), on);
                // Names of many classes are cut off.
                if response.on_hover_text(text).clicked() {
                    out.push(Command::Train(TrainCommand::Branch(at)));
                }
            });
            for child in branch.children {
                node(ui, state, thesis, child, depth + 1, out);
            }
        }
        None => {
            ui.colored_label(c.muted, "–");
        }
    }
}

/// Legend of the regions' colours.
fn sides(ui: &mut Ui, state: &State, branch: &Boundary) {
    ui.horizontal_wrapped(|ui| {
        ui.set_max_width(SIDE);
        for (at, side) in branch.sides.iter().enumerate() {
            if at == 1 {
                ui.label("against");
            }
            for class in side {
                widgets::chip(ui, state.classes.place(class), class);
            }
        }
    });
}

fn boundary(ui: &mut Ui, state: &State, thesis: &Thesis, branch: &Boundary, out: Out) {
    let c = Colours::now(ui);
    let (rect, _) = ui.allocate_exact_size(Vec2::splat(SIDE), Sense::hover());
    ui.painter().rect_filled(rect, 3.0, c.well);
    ui.painter_at(rect)
        .add(Shape::mesh(regions(rect, branch, &c)));
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
            taught.class, taught.clip, taught.start_secs
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
}

/// Regions in which one side accepts, or both do.
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
