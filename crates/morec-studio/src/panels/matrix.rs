//! The report of a cross-validation: figures, and a confusion matrix whose cells list and play their instances.

use egui::{Align2, FontId, Rect, ScrollArea, Sense, Ui, Vec2, WidgetType, pos2};

use super::{Out, widgets};
use crate::format;
use crate::jobs::judge::Moment;
use crate::state::{Command, LibraryCommand, State, TrainCommand};
use crate::theme::Colours;

pub fn show(ui: &mut Ui, state: &State, out: Out) {
    let c = Colours::now(ui);
    let Some(judged) = &state.train.judged else {
        ui.colored_label(
            c.muted,
            "Cross-validate to see how well this works on people and clips it was not taught.",
        );
        return;
    };
    let e = &judged.evaluation;
    widgets::section(
        ui,
        &format!("CROSS-VALIDATION, WITHOUT {}", judged.by.to_uppercase()),
    );
    let share =
        |value: Option<f64>| value.map_or("–".to_owned(), |v| format!("{:.0} %", 100.0 * v));
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 26.0;
        widgets::figure(ui, share(e.events.f1), "F1 of events");
        let right = judged
            .moments
            .iter()
            .filter(|m| m.truth.is_some() && m.is_right())
            .count();
        widgets::figure(
            ui,
            format!("{right} of {}", e.totals.samples),
            "labels recognised",
        );
        let alarms = judged.moments.iter().filter(|m| m.truth.is_none()).count();
        widgets::figure(ui, alarms.to_string(), "false alarms");
        widgets::figure(
            ui,
            format::duration(e.totals.known_secs),
            "of motion tested",
        );
    });
    ui.add_space(8.0);
    matrix(ui, state, out);
    ui.add_space(8.0);
    let c2 = &e.confusion;
    let missed: usize = (0..c2.rows.len())
        .map(|row| judged.of_cell(row, c2.columns.len()).len())
        .sum();
    let alarms = judged.moments.iter().filter(|m| m.truth.is_none()).count();
    ui.colored_label(c.muted, format!("Rows: what was labelled. Columns: what was recognised. {} and {}: click a cell to see each.", format::count(missed, "miss"), format::count(alarms, "false alarm")));
}

fn matrix(ui: &mut Ui, state: &State, out: Out) {
    let Some(judged) = &state.train.judged else {
        return;
    };
    let c = Colours::now(ui);
    let confusion = &judged.evaluation.confusion;
    let (rows, columns) = (confusion.rows.len() + 1, confusion.columns.len() + 1);
    let names = 128.0;
    let room = ui.available_width() - names - 16.0;
    let cell = (room / columns as f32).clamp(34.0, 64.0);
    let head = 74.0;
    let tall = cell.min(40.0);
    ScrollArea::horizontal().id_salt("matrix").show(ui, |ui| {
        let size = Vec2::new(names + cell * columns as f32, head + tall * rows as f32);
        let (area, _) = ui.allocate_exact_size(size, Sense::hover());
        for column in 0..columns {
            let name = confusion
                .columns
                .get(column)
                .map_or("missed", String::as_str);
            let x = area.left() + names + cell * (column as f32 + 0.5);
            slanted(ui, pos2(x - 10.0, area.top() + head - 16.0), name, &c);
        }
        for row in 0..rows {
            let name = confusion.rows.get(row).map_or("unlabelled", String::as_str);
            let top = area.top() + head + tall * row as f32;
            let text = Rect::from_min_size(pos2(area.left(), top), Vec2::new(names - 10.0, tall));
            widgets::text_in(
                ui,
                text,
                name,
                12.5,
                if row + 1 == rows { c.muted } else { c.text },
                true,
            );
            for column in 0..columns {
                let corner = pos2(area.left() + names + cell * column as f32, top);
                let rect = Rect::from_min_size(corner, Vec2::new(cell, tall)).shrink(1.0);
                one(ui, state, rect, row, column, out);
            }
        }
    });
}

fn slanted(ui: &Ui, at: egui::Pos2, text: &str, c: &Colours) {
    let mut short: String = text.chars().take(14).collect();
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

fn one(ui: &Ui, state: &State, rect: Rect, row: usize, column: usize, out: Out) {
    let Some(judged) = &state.train.judged else {
        return;
    };
    let c = Colours::now(ui);
    let confusion = &judged.evaluation.confusion;
    let count = confusion.counts[row][column];
    let all: usize = confusion.counts[row].iter().sum();
    let (truth, found) = (confusion.rows.get(row), confusion.columns.get(column));
    let right = match (truth, found) {
        (Some(a), Some(b)) => a == b,
        (None, None) => true,
        _ => false,
    };
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
        "{} taken for {}: {count}",
        name(truth, "unlabelled"),
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
            c.text,
        );
    }
    if on {
        widgets::selected_frame(ui, rect);
    }
    if response.on_hover_text(said).clicked() {
        out.push(Command::Train(TrainCommand::Cell(Some((row, column)))));
        if let Some(first) = judged.of_cell(row, column).first() {
            go(state, first, out);
        }
    }
}

/// The instances of the cell that was clicked; each plays its moment.
pub fn instances(ui: &mut Ui, state: &State, out: Out) {
    let Some(judged) = &state.train.judged else {
        return;
    };
    let c = Colours::now(ui);
    let moments: Vec<&Moment> = match state.train.cell {
        Some((row, column)) => judged.of_cell(row, column),
        None => judged.moments.iter().filter(|m| !m.is_right()).collect(),
    };
    widgets::section(
        ui,
        if state.train.cell.is_some() {
            "IN THIS CELL"
        } else {
            "MISTAKES"
        },
    );
    if moments.is_empty() {
        let right = state.train.cell.is_some_and(|(r, k)| {
            let confusion = &judged.evaluation.confusion;
            r == confusion.rows.len() && k == confusion.columns.len()
        });
        ui.colored_label(
            c.muted,
            if right {
                "Unlabelled stretches that were rightly left alone."
            } else {
                "None."
            },
        );
        return;
    }
    // Rows are of one height: two lines if any has a reason.
    let reasons = moments.iter().any(|m| m.why.is_some());
    let height = if reasons { 42.0 } else { 24.0 };
    ScrollArea::vertical()
        .id_salt("instances")
        .auto_shrink(false)
        .show_rows(ui, height, moments.len(), |ui, rows| {
            for moment in &moments[rows] {
                let what = match (&moment.truth, &moment.found) {
                    (Some(truth), Some(found)) if truth == found => truth.clone(),
                    (Some(truth), Some(found)) => format!("{truth} taken for {found}"),
                    (Some(truth), None) => format!("{truth} missed"),
                    (None, Some(found)) => format!("{found} where nothing is labelled"),
                    (None, None) => String::new(),
                };
                let colour = if moment.is_right() { c.text } else { c.bad };
                let mut text = format!(
                    "{what}, {} {}",
                    moment.clip,
                    format::secs(moment.start_secs)
                );
                if let Some(why) = &moment.why {
                    text += &format!(": {why}");
                }
                let size = Vec2::new(ui.available_width(), height);
                let (rect, mut response) = ui.allocate_exact_size(size, Sense::click());
                widgets::named(&response, WidgetType::Button, &text, false);
                if response.hovered() {
                    ui.painter().rect_filled(rect, 3.0, c.tint(c.accent, 0.12));
                }
                let mut inner = rect.shrink2(Vec2::new(4.0, 0.0));
                if let Some(why) = &moment.why {
                    let below = inner.with_min_y(inner.center().y);
                    widgets::text_in(ui, below, why, 11.5, c.muted, false);
                    inner = inner.with_max_y(inner.center().y);
                    response = response.on_hover_text(why);
                }
                let place = format!("{}  {}", moment.clip, format::secs(moment.start_secs));
                let left = Rect::from_min_max(
                    inner.min,
                    pos2(inner.left() + inner.width() * 0.58, inner.bottom()),
                );
                let right = Rect::from_min_max(pos2(left.right() + 8.0, inner.top()), inner.max);
                widgets::text_in(ui, left, &what, 12.5, colour, false);
                widgets::text_in(ui, right, &place, 11.5, c.muted, true);
                if response.clicked() {
                    go(state, moment, out);
                }
            }
        });
}

/// Jumps to a moment: the clip, a loop around it.
fn go(state: &State, moment: &Moment, out: Out) {
    let Some(store) = &state.store else { return };
    let clip = store.snapshot.clips.iter().find(|k| k.name == moment.clip);
    if let Some(clip) = clip {
        out.push(Command::Library(LibraryCommand::GoTo {
            clip: clip.id,
            start_secs: (moment.start_secs - 0.3).max(0.0),
            stop_secs: (moment.stop_secs + 0.3).min(clip.duration_secs()),
        }));
    }
}
