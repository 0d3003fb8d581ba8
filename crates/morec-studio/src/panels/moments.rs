//! The list of mistakes, or of the moments of a cell of the confusion matrix: a line plays its moment, which can then be
//! compared with the nearest label.

use egui::{Rect, Response, RichText, ScrollArea, Sense, Ui, Vec2, WidgetType, pos2};

use super::{Out, widgets};
use crate::format;
use crate::jobs::judge::Moment;
use crate::lists::List;
use crate::state::{Command, CompareCommand, State, TrainCommand};
use crate::theme::Colours;

pub fn show(ui: &mut Ui, state: &State, out: Out) {
    let Some(judged) = &state.train.judged else {
        return;
    };
    let c = Colours::now(ui);
    let places = state.listed_moments();
    let title = match state.train.cell {
        Some(_) => "IN THIS CELL",
        None => "MISTAKES",
    };
    ui.horizontal(|ui| {
        widgets::section(ui, title);
        let back = state.train.cell.is_some();
        if back && ui.small_button("All mistakes").clicked() {
            out.push(Command::Train(TrainCommand::Cell(None)));
        }
    });
    if places.is_empty() {
        ui.colored_label(c.muted, "None.");
        return;
    }
    compare(ui, state, out);
    if let Some(why) = state.chosen_moment().and_then(|m| m.why.as_ref()) {
        ui.label(RichText::new(why).size(12.0));
    }
    // Rows are of one height: two lines if any has a reason.
    let moments = || places.iter().map(|&at| (at, &judged.moments[at]));
    let reasons = moments().any(|(_, m)| m.why.is_some());
    let height = if reasons { 42.0 } else { 24.0 };
    ScrollArea::vertical()
        .id_salt("moments")
        .auto_shrink(false)
        .show_rows(ui, height, places.len(), |ui, rows| {
            let chosen = state.train.moment;
            let at = places.iter().position(|place| Some(*place) == chosen);
            widgets::keep_in_view(ui, "moments", at, rows.start, height);
            let list = List::following(ui, "moments", places.len());
            list.scroll(ui, list.wanted, rows.start, height);
            let first = rows.start;
            for (row, (at, moment)) in moments().enumerate().skip(first).take(rows.len()) {
                let on = state.train.moment == Some(at);
                let response = line(ui, (at, moment), height, on);
                if list.row(ui, row, &response, on) {
                    out.push(Command::Train(TrainCommand::Moment(at)));
                }
            }
        });
}

/// The chosen moment beside the nearest label of the class that was recognised, or that is labelled.
fn compare(ui: &mut Ui, state: &State, out: Out) {
    let Some(moment) = state.chosen_moment() else {
        return;
    };
    ui.horizontal_wrapped(|ui| {
        ui.label("Compare with the nearest");
        for class in moment.compared_with() {
            let response = ui.button(class);
            let name = format!("Compare with the nearest {class}");
            widgets::named(&response, WidgetType::Button, name, false);
            let hint =
                "Show the nearest label of this class beside the performer, aligned in time  (C)";
            if response.on_hover_text(hint).clicked() {
                let class = Some(class.to_owned());
                out.push(Command::Compare(CompareCommand::Moment(class)));
            }
        }
    });
}

/// A moment of the list.
fn line(ui: &mut Ui, (at, moment): (usize, &Moment), height: f32, on: bool) -> Response {
    let c = Colours::now(ui);
    let said = moment.said();
    let start = format::secs(moment.span.start_secs);
    let mut name = format!("{said}, {} {start}", moment.clip);
    if let Some(why) = &moment.why {
        name += &format!(": {why}");
    }
    let size = Vec2::new(ui.available_width(), height);
    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
    // What is chosen changes what lies above, and with it the numbers of widgets.
    let id = egui::Id::new(("moment", at));
    let mut response = ui.interact(rect, id, Sense::click());
    widgets::named(&response, WidgetType::Button, &name, on);
    if on {
        let fill = ui.visuals().selection.bg_fill;
        ui.painter().rect_filled(rect, 3.0, fill);
    } else if response.hovered() {
        ui.painter().rect_filled(rect, 3.0, c.tint(c.accent, 0.12));
    }
    // On the colour of the selection only the colour of plain text is read well.
    let (strong, weak) = match (on, moment.is_right()) {
        (true, _) => (c.text, c.text),
        (false, true) => (c.text, c.muted),
        (false, false) => (c.bad, c.muted),
    };
    let mut inner = rect.shrink2(Vec2::new(4.0, 0.0));
    if let Some(why) = &moment.why {
        let below = inner.with_min_y(inner.center().y);
        widgets::text_in(ui, below, why, 11.5, weak, false);
        inner = inner.with_max_y(inner.center().y);
        response = response.on_hover_text(why);
    }
    let middle = inner.left() + inner.width() * 0.58;
    let left = Rect::from_min_max(inner.min, pos2(middle, inner.bottom()));
    let right = Rect::from_min_max(pos2(middle + 8.0, inner.top()), inner.max);
    widgets::text_in(ui, left, &said, 12.5, strong, false);
    let place = format!("{}  {start}", moment.clip);
    widgets::text_in(ui, right, &place, 11.5, weak, true);
    response
}
