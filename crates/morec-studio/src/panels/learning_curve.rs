//! The learning curve: results with fewer samples and fewer people, and what more of them are worth.

use egui::{Align2, Button, FontId, Grid, Rect, RichText, Sense, Ui, Vec2, WidgetType, pos2};
use morec_ops::{CurveFigures, CurvePoint, LearningCurve};

use super::{Out, widgets};
use crate::format;
use crate::state::{Command, State, TrainCommand};
use crate::theme::Colours;

const HEIGHT: f32 = 190.0;
/// Room for the figures at the left, and for the numbers below.
const LEFT: f32 = 34.0;
const BELOW: f32 = 36.0;

/// Measures the learning curve.
pub fn button(ui: &mut Ui, state: &State, out: Out) {
    let measuring = state.is_measuring_curve();
    let label = match measuring {
        true => "Measuring …",
        false => "Learning curve",
    };
    let response = widgets::wide(ui, !measuring, Button::new(label), 26.0);
    let hint = "Cross-validate with 1, 2, 4 … samples of each class and 1, 2, 4 … people: what more labels are worth";
    if response.on_hover_text(hint).clicked() {
        out.push(Command::Train(TrainCommand::Curve));
    }
}

/// The curve, what it says in sentences, and its figures.
pub fn show(ui: &mut Ui, state: &State, out: Out) {
    let Some(curve) = &state.train.curve else {
        return;
    };
    let c = Colours::now(ui);
    widgets::boxed(ui, |ui| {
        ui.horizontal_wrapped(|ui| {
            ui.label(RichText::new("Learning curve").strong());
            ui.colored_label(c.muted, format!("Left out: {}", curve.divided));
            if ui.button("Close the curve").clicked() {
                out.push(Command::Train(TrainCommand::CloseCurve));
            }
        });
        for sentence in &curve.advice {
            ui.label(crate::store::sentence(sentence));
        }
        picture(ui, curve, &c);
        table(ui, curve, &c);
    });
    ui.add_space(10.0);
}

/// What teaches at a point: `4 samples`, `2 people`, `all`.
fn taught(point: &CurvePoint) -> String {
    match (point.samples, point.people) {
        (Some(n), _) => format::count(n, "sample"),
        (None, Some(1)) => "1 person".to_owned(),
        (None, Some(n)) => format!("{n} people"),
        (None, None) => "all".to_owned(),
    }
}

/// Mean and range of a measure, as text.
fn spread(point: &CurvePoint, of: fn(&CurveFigures) -> Option<f64>) -> String {
    match point.spread(of) {
        None => "–".to_owned(),
        Some([_, mean, _]) if point.draws.len() == 1 => format!("{mean:.3}"),
        Some([least, mean, largest]) => format!("{mean:.3} ({least:.3} to {largest:.3})"),
    }
}

/// F1 of events by samples of each class, and by people: means joined by lines, with the range of the draws.
fn picture(ui: &mut Ui, curve: &LearningCurve, c: &Colours) {
    let size = Vec2::new(ui.available_width().min(560.0), HEIGHT);
    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
    let plot = Rect::from_min_max(
        pos2(rect.left() + LEFT, rect.top() + 8.0),
        pos2(rect.right(), rect.bottom() - BELOW),
    );
    let font = FontId::proportional(11.0);
    let y = |share: f64| plot.bottom() - share.clamp(0.0, 1.0) as f32 * plot.height();
    for share in [0.0, 0.25, 0.5, 0.75, 1.0] {
        ui.painter().hline(plot.x_range(), y(share), (1.0, c.line));
        let at = pos2(plot.left() - 6.0, y(share));
        let text = format!("{share:.2}");
        ui.painter()
            .text(at, Align2::RIGHT_CENTER, text, font.clone(), c.muted);
    }
    let step = plot.width() / curve.points.len().max(1) as f32;
    let x = |at: usize| plot.left() + (at as f32 + 0.5) * step;
    let f1 = |point: &CurvePoint| point.spread(|draw| draw.f1);
    // What all teach ends the line of samples and that of people.
    let line = |is_of: fn(&CurvePoint) -> bool| {
        let points = curve.points.iter().enumerate();
        let of = points.filter(|(_, p)| is_of(p) || (p.samples.is_none() && p.people.is_none()));
        let places = of.filter_map(|(at, point)| Some(pos2(x(at), y(f1(point)?[1]))));
        places.collect::<Vec<_>>()
    };
    for (places, colour) in [
        (line(|p| p.samples.is_some()), c.accent),
        (line(|p| p.people.is_some()), c.good),
    ] {
        ui.painter().line(places, (2.0, colour));
    }
    for (at, point) in curve.points.iter().enumerate() {
        let below = pos2(x(at), plot.bottom() + 6.0);
        ui.painter().text(
            below,
            Align2::CENTER_TOP,
            taught(point),
            font.clone(),
            c.muted,
        );
        let Some([least, mean, largest]) = f1(point) else {
            continue;
        };
        let colour = match (point.samples, point.people) {
            (Some(_), _) => c.accent,
            (None, Some(_)) => c.good,
            (None, None) => c.text,
        };
        ui.painter()
            .vline(x(at), y(largest)..=y(least), (1.5, colour));
        let place = pos2(x(at), y(mean));
        ui.painter().circle_filled(place, 4.0, colour);
        let area = Rect::from_center_size(place, Vec2::splat(14.0));
        let response = ui.interact(area, ui.id().with(("curve", at)), Sense::hover());
        let name = format!("{}: F1 {}", taught(point), spread(point, |draw| draw.f1));
        widgets::named(&response, WidgetType::Label, &name, false);
        response.on_hover_text(name);
    }
    let below = pos2(plot.center().x, rect.bottom());
    let text = "F1 of events by samples of each class that teach, and by people who teach";
    ui.painter()
        .text(below, Align2::CENTER_BOTTOM, text, font, c.muted);
}

fn table(ui: &mut Ui, curve: &LearningCurve, c: &Colours) {
    ui.add_space(6.0);
    Grid::new("learning curve").striped(true).show(ui, |ui| {
        for text in [
            "taught by",
            "F1 of events",
            "recall",
            "false alarms a minute",
            "delay s",
        ] {
            ui.colored_label(c.muted, text);
        }
        ui.end_row();
        for point in &curve.points {
            ui.label(taught(point));
            let of: [fn(&CurveFigures) -> Option<f64>; 4] = [
                |draw| draw.f1,
                |draw| draw.recall,
                |draw| draw.alarms_per_minute,
                |draw| draw.delay_secs,
            ];
            for of in of {
                ui.label(spread(point, of));
            }
            ui.end_row();
        }
    });
}
