//! How far a performance is from the one beside it, bone by bone, and how well a recognised motion was performed.

use egui::{Color32, Rect, Sense, Ui, Vec2, WidgetType, pos2};
use morec_measure::explain::BoneDeviation;

use super::{Out, widgets};
use crate::state::{Command, CompareCommand, PlayCommand, State};
use crate::theme::Colours;

/// Bones that are listed.
const MOST: usize = 8;
/// The longest bar is at least this many degrees: what is hardly off shall look like it.
const LEAST_DEGREES: f64 = 30.0;
const ROW: f32 = 19.0;

/// The recognised motion that plays, and the way to see how well it was performed.
pub fn recognised(ui: &mut Ui, state: &State, out: Out) {
    let Some((of, found)) = state.chosen_detection() else {
        return;
    };
    let c = Colours::now(ui);
    widgets::section(ui, "RECOGNISED");
    let mut text = format!("{}, score {:.2}", found.class, found.score.unwrap_or(0.0));
    if let Some(count) = found.repetitions {
        text += &format!(", {count} times");
    }
    ui.label(text);
    ui.colored_label(c.muted, format!("{:.2} s long", found.span.duration_secs()));
    let hint =
        "Show the nearest label of this class beside the performer, with the angle between bones";
    if ui.button("How well?").on_hover_text(hint).clicked() {
        let class = found.class.clone();
        out.push(Command::Compare(CompareCommand::NearestOf { of, class }));
    }
    ui.add_space(8.0);
}

/// The bones of the performer against those beside it, the one farthest off first.
pub fn bones(ui: &mut Ui, state: &State, out: Out) {
    let Some((aligned, deviation)) = state.deviation() else {
        return;
    };
    let c = Colours::now(ui);
    widgets::section(ui, "DEVIATION");
    let beside = &aligned.motion.clip.name;
    ui.label(format!(
        "{:.0}° from {beside} on average, {:.2} times its duration",
        deviation.off_degrees, deviation.pace
    ));
    ui.colored_label(c.muted, "Click a bone to go to its largest deviation.");
    let farthest = deviation.bones.first().map_or(0.0, |bone| bone.off_degrees);
    let full = farthest.max(LEAST_DEGREES);
    for bone in deviation.bones.iter().take(MOST) {
        if line(ui, bone, (bone.off_degrees / full) as f32, &c) {
            out.push(Command::Play(PlayCommand::Seek(bone.worst_secs)));
        }
    }
    ui.add_space(8.0);
}

/// A bone, a bar that fills a share of its room, and degrees; true if it was clicked.
fn line(ui: &mut Ui, bone: &BoneDeviation, share: f32, c: &Colours) -> bool {
    let name = bone.bone.replace('_', " ");
    let (off, worst) = (bone.off_degrees, bone.worst_degrees);
    let size = Vec2::new(ui.available_width(), ROW);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    let said = format!(
        "{name}: {off:.0}° on average, at most {worst:.0}° at {:.2} s",
        bone.worst_secs
    );
    widgets::named(&response, WidgetType::Button, &said, false);
    let fill = match response.hovered() {
        true => c.tint(c.accent, 0.12),
        false => Color32::TRANSPARENT,
    };
    ui.painter().rect_filled(rect, 3.0, fill);
    let inner = rect.shrink2(Vec2::new(4.0, 0.0));
    let (left, right) = (inner.left() + 0.44 * inner.width(), inner.right() - 36.0);
    let bar = Rect::from_x_y_ranges(
        left..=left + (right - left) * share.clamp(0.0, 1.0),
        rect.top() + 4.0..=rect.bottom() - 4.0,
    );
    ui.painter().rect_filled(bar, 2.0, c.accent);
    let words = Rect::from_min_max(inner.min, pos2(left - 6.0, inner.bottom()));
    widgets::text_in(ui, words, &name, 12.5, c.text, false);
    widgets::text_in(ui, inner, &format!("{off:.0}°"), 12.5, c.text, true);
    response.on_hover_text(said).clicked()
}
