//! How far the last performances were from their samples, while the performer moves.

use egui::{Rect, RichText, Sense, Ui, Vec2, WidgetType};

use super::widgets;
use crate::state::State;
use crate::state::live::LiveDeviation;
use crate::theme::Colours;

const HEIGHT: f32 = 34.0;
const BAR: f32 = 9.0;
/// The tallest bar is at least this many degrees.
const LEAST_DEGREES: f64 = 30.0;

/// The last performance in words, and a bar for each of those of the performer who is watched.
pub fn show(ui: &mut Ui, state: &State) {
    let Some(run) = &state.live.run else { return };
    let watched = run.watched().map(|w| w.actor);
    let of_watched = |d: &&LiveDeviation| watched == Some(d.actor);
    let compared: Vec<&LiveDeviation> = run.compared.iter().filter(of_watched).collect();
    let Some(last) = compared.last() else { return };
    let c = Colours::now(ui);
    let said = words(last);
    ui.label(RichText::new(&said).size(12.5));
    let size = Vec2::new(ui.available_width(), HEIGHT);
    let (area, response) = ui.allocate_exact_size(size, Sense::hover());
    let name = format!("Deviation of the last {}: {said}", compared.len());
    widgets::named(&response, WidgetType::Label, name, false);
    let degrees = compared.iter().map(|d| d.deviation.off_degrees);
    let full = degrees.fold(LEAST_DEGREES, f64::max);
    for (at, one) in compared.iter().rev().enumerate() {
        let right = area.right() - at as f32 * (BAR + 2.0);
        if right - BAR < area.left() {
            break;
        }
        let tall = (one.deviation.off_degrees / full) as f32 * HEIGHT;
        let bar = Rect::from_x_y_ranges(right - BAR..=right, area.bottom() - tall..=area.bottom());
        let colour = c.class(state.classes.place(&one.class));
        ui.painter().rect_filled(bar, 1.5, colour);
    }
    response.on_hover_text("Mean angle from the nearest sample; the newest is on the right");
}

fn words(of: &LiveDeviation) -> String {
    let LiveDeviation {
        class, deviation, ..
    } = of;
    let what = match of.repetition {
        Some(number) => format!("{class} {number}"),
        None => class.clone(),
    };
    format!(
        "{what}: {:.0}° off, {} {:.0}°, {:.2} × the duration",
        deviation.off_degrees,
        deviation.worst_bone.replace('_', " "),
        deviation.worst_degrees,
        deviation.pace
    )
}
