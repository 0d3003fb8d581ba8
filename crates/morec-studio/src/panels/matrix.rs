//! The report of a cross-validation: figures, and a confusion matrix whose cells list and play their moments.

use egui::{Align2, FontId, Rect, ScrollArea, Sense, Ui, Vec2, WidgetType, pos2};

use super::{Out, widgets};
use crate::format;
use crate::jobs::judge::only_part;
use crate::lists::List;
use crate::state::{Command, State, TrainCommand};
use crate::theme::Colours;

/// Name of the last row: detections that match no label.
const NO_LABEL: &str = "no label";

pub fn show(ui: &mut Ui, state: &State, out: Out) {
    let c = Colours::now(ui);
    let Some(judged) = &state.train.judged else {
        ui.colored_label(
            c.muted,
            "Cross-validate to measure how well people and clips outside the training data are recognised.",
        );
        return;
    };
    let e = &judged.evaluation;
    let method = match judged.thesis {
        true => " OF THE METHOD OF 2009",
        false => "",
    };
    let by = judged.by.said().to_uppercase();
    widgets::section(ui, &format!("CROSS-VALIDATION{method}, WITHOUT {by}"));
    let share =
        |value: Option<f64>| value.map_or("–".to_owned(), |v| format!("{:.0} %", 100.0 * v));
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 26.0;
        let recognised = format!("{} of {}", judged.recognised(), e.totals.samples);
        widgets::figure(ui, recognised, "labels recognised");
        widgets::figure(ui, judged.missed().to_string(), "missed");
        let mistaken = e
            .totals
            .samples
            .saturating_sub(judged.recognised() + judged.missed());
        widgets::figure(ui, mistaken.to_string(), "taken for another class");
        let alarms = judged.false_detections().to_string();
        widgets::figure(ui, alarms, "false detections");
        let found = format!("F1 of events, {} found", e.events.matched);
        widgets::figure(ui, share(e.events.f1), &found);
        widgets::figure(
            ui,
            format::duration(e.totals.known_secs),
            "of motion tested",
        );
    });
    if !judged.untested.is_empty() {
        let text = format!(
            "Not tested: {}. All its labels are of {}, so nothing is left to train on.",
            judged.untested.join(", "),
            only_part(judged.by)
        );
        ui.colored_label(c.warn, text);
    }
    ui.add_space(8.0);
    matrix(ui, state, out);
    ui.add_space(8.0);
    ui.colored_label(
        c.muted,
        "Rows: labelled class. Columns: recognised class. Last row: detections that match no label. Click a cell to list its \
         motions on the right.",
    );
}

fn matrix(ui: &mut Ui, state: &State, out: Out) {
    let Some(judged) = &state.train.judged else {
        return;
    };
    let c = Colours::now(ui);
    let (rows, columns) = (judged.rows.len() + 1, judged.columns.len() + 1);
    let names = 128.0;
    let room = ui.available_width() - names - 16.0;
    let cell = (room / columns as f32).clamp(34.0, 64.0);
    let head = 92.0;
    let tall = cell.min(40.0);
    ScrollArea::horizontal().id_salt("matrix").show(ui, |ui| {
        let size = Vec2::new(names + cell * columns as f32, head + tall * rows as f32);
        let (area, _) = ui.allocate_exact_size(size, Sense::hover());
        // Names of rows and columns stay in view while the cells are scrolled.
        let seen = ui.clip_rect();
        let left = area.left().max(seen.left());
        let top = area.top().max(seen.top()).min(area.bottom() - tall - head);
        let first = pos2(left + names, top + head);
        let columns_area = seen.with_min_x(first.x);
        ui.scope(widgets::within(columns_area, |ui| {
            for column in 0..columns {
                let name = judged.columns.get(column).map_or("missed", String::as_str);
                let x = area.left() + names + cell * (column as f32 + 0.5);
                slanted(ui, pos2(x - 10.0, first.y - 16.0), name, &c);
            }
        }));
        let row_top = |row: usize| area.top() + head + tall * row as f32;
        let rows_area = seen.with_min_y(first.y);
        ui.scope(widgets::within(rows_area, |ui| {
            let size = Vec2::new(names - 10.0, tall);
            for row in 0..rows {
                let name = judged.rows.get(row).map_or(NO_LABEL, String::as_str);
                let colour = if row + 1 == rows { c.muted } else { c.text };
                let text = Rect::from_min_size(pos2(left, row_top(row)), size);
                widgets::text_in(ui, text, name, 12.5, colour, true);
            }
        }));
        // Neither labelled nor recognised is nothing that could be counted.
        let list = List::grid(ui, "matrix", rows * columns - 1, columns);
        let cells_area = Rect::from_min_max(first, area.max);
        ui.scope(widgets::within(cells_area, |ui| {
            for at in 0..rows * columns - 1 {
                let (row, column) = (at / columns, at % columns);
                let corner = pos2(area.left() + names + cell * column as f32, row_top(row));
                let rect = Rect::from_min_size(corner, Vec2::new(cell, tall)).shrink(1.0);
                one(ui, state, rect, (row, column), (&list, at), out);
            }
        }));
    });
}

fn slanted(ui: &Ui, at: egui::Pos2, text: &str, c: &Colours) {
    let mut short: String = text.chars().take(16).collect();
    if short.len() < text.len() {
        short.push('…');
    }
    let galley = ui
        .painter()
        .layout_no_wrap(short, FontId::proportional(12.0), c.text);
    let mut shape = egui::epaint::TextShape::new(at, galley, c.text);
    shape.angle = -0.9;
    ui.painter().add(shape);
}

fn one(
    ui: &Ui,
    state: &State,
    rect: Rect,
    (row, column): (usize, usize),
    (list, at): (&List, usize),
    out: Out,
) {
    let Some(judged) = &state.train.judged else {
        return;
    };
    let c = Colours::now(ui);
    let count = judged.counts[row][column];
    let all: usize = judged.counts[row].iter().sum();
    let (truth, found) = (judged.rows.get(row), judged.columns.get(column));
    let right = truth == found;
    let base = if right { c.good } else { c.bad };
    let share = if all > 0 {
        count as f32 / all as f32
    } else {
        0.0
    };
    let fill = match count {
        0 => c.ground,
        _ => c.tint(base, 0.18 + 0.62 * share),
    };
    let response = ui.interact(rect, ui.id().with(("cell", row, column)), Sense::click());
    let name = |n: Option<&String>, none: &str| n.map_or(none.to_owned(), Clone::clone);
    let said = format!(
        "{} recognised as {}: {count}",
        name(truth, NO_LABEL),
        name(found, "nothing")
    );
    let on = state.train.cell == Some((row, column));
    widgets::named(&response, WidgetType::Button, &said, on);
    ui.painter().rect_filled(rect, 3.0, fill);
    if count > 0 {
        ui.painter().text(
            rect.center(),
            Align2::CENTER_CENTER,
            count.to_string(),
            FontId::proportional(13.0),
            c.text_on(fill),
        );
    }
    if on {
        widgets::selected_frame(ui, rect);
    }
    let response = response.on_hover_text(said);
    if list.row(ui, at, &response, on) {
        out.push(Command::Train(TrainCommand::Cell(Some((row, column)))));
    }
}
