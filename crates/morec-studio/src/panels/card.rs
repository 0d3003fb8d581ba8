//! A sample in a column of its class: its strip, where it is, for proposals yes and no.

use egui::{Button, Rect, RichText, Sense, Ui, Vec2, WidgetType};
use morec_db::labels::{DbSample, SampleId, SampleState as Judged};

use super::carried::Carried;
use super::strips::{STRIP, go};
use super::{Out, strips, widgets};
use crate::format;
use crate::lists::List;
use crate::state::{ClassCommand, Command, Panel, State, TimelineCommand};
use crate::theme::Colours;

/// Width of a column of cards, points.
pub const COLUMN: f32 = 214.0;
pub const HEIGHT: f32 = STRIP + 18.0;
/// Room for the answers to a proposal.
const ANSWERS: f32 = 46.0;

/// A sample, row `at` of its column: its strip, where it is, and for proposals yes and no.
pub fn show(ui: &mut Ui, state: &State, sample: &DbSample, (list, at): (&List, usize), out: Out) {
    let c = Colours::now(ui);
    let (rect, response) =
        ui.allocate_exact_size(Vec2::new(COLUMN - 8.0, HEIGHT), Sense::click_and_drag());
    let selected = state.timeline.selected.contains(&sample.id);
    let class = format::class(sample);
    widgets::named(
        &response,
        WidgetType::Button,
        format!(
            "{class} in {} at {:.2} s",
            sample.clip_name, sample.start_secs
        ),
        selected,
    );
    let picture = Rect::from_min_size(rect.min, Vec2::new(rect.width(), STRIP));
    strips::draw(ui, state, sample.into(), picture);
    let caption = Rect::from_min_max(egui::pos2(rect.left() + 2.0, picture.bottom()), rect.max);
    let text = format!("{}  {}", sample.clip_name, format::secs(sample.start_secs));
    widgets::text_in(ui, caption, &text, 11.0, c.muted, false);
    if sample.state == Judged::Proposed {
        ui.painter()
            .rect_stroke(picture, 3.0, (1.0, c.warn), egui::StrokeKind::Inside);
        let score = format!("{:.0} %", 100.0 * sample.score.unwrap_or(0.0));
        let left = caption.with_max_x(caption.right() - ANSWERS - 4.0);
        widgets::text_in(ui, left, &score, 11.0, c.warn, true);
    }
    if selected {
        widgets::selected_frame(ui, picture);
    }
    if response.drag_started() {
        response.dnd_set_drag_payload(Carried::Sample(sample.id));
    }
    if list.row(ui, at, &response, selected) || response.double_clicked() {
        if ui.input(|i| i.modifiers.command) {
            let (id, add) = (Some(sample.id), true);
            out.push(Command::Timeline(TimelineCommand::Select { id, add }));
        } else {
            go(sample.into(), Some(sample.id), out);
        }
    }
    if response.double_clicked() {
        out.push(Command::Show(Panel::Label));
    }
    if sample.state == Judged::Proposed {
        answers(ui, caption, sample.id, out);
    }
}

/// Yes and no at the right of a caption.
fn answers(ui: &mut Ui, caption: Rect, id: SampleId, out: Out) {
    let corner = caption.right_top() - Vec2::new(ANSWERS, -1.0);
    let area = Rect::from_min_size(corner, Vec2::new(ANSWERS, caption.height()));
    // Over the card, without a place of its own in the column.
    let mut over = ui.new_child(egui::UiBuilder::new().max_rect(area));
    over.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        ui.spacing_mut().button_padding = Vec2::new(5.0, 0.0);
        ui.spacing_mut().interact_size.y = caption.height();
        for (text, name, command) in [
            ("✔", "Accept", ClassCommand::Accept(id)),
            ("✖", "Reject", ClassCommand::Reject(id)),
        ] {
            let response = ui.add(Button::new(RichText::new(text).size(11.0)));
            response.widget_info(|| {
                egui::WidgetInfo::labeled(WidgetType::Button, true, format!("{name} {}", id.0))
            });
            if response.clicked() {
                out.push(Command::Classes(command));
            }
        }
    });
}
