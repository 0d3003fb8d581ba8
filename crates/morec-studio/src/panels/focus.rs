//! The keyboard's place: outlined, and brought into view when it moves.

use egui::accesskit::{Action, ActionRequest, NodeId};
use egui::{Context, Event, Id, Response, Stroke, StrokeKind, Ui};

use crate::theme::Colours;

/// Frames in which what got the keyboard is brought into view: areas within each other scroll one after the other.
const FRAMES: u8 = 4;
/// Width of each of the two lines of the outline, points.
const LINE: f32 = 1.5;

/// What has the keyboard, and the frames for which it is followed.
#[derive(Debug, Clone, Copy)]
struct FollowedFocus {
    id: Option<Id>,
    left: u8,
}

fn focused(ctx: &Context) -> Option<Response> {
    let id = ctx.memory(|memory| memory.focused())?;
    ctx.read_response(id)
}

/// True if a part of it lies outside of the area that shows it.
fn is_cut(response: &Response) -> bool {
    !response
        .interact_rect
        .expand(1.0)
        .contains_rect(response.rect)
}

/// Before a frame is drawn: areas scroll to what got the keyboard, where a part of it is not seen.
pub fn follow(ctx: &Context) {
    let id = ctx.memory(|memory| memory.focused());
    let before: Option<FollowedFocus> = ctx.data(|data| data.get_temp(Id::NULL));
    let left = match before.filter(|before| before.id == id) {
        Some(before) => before.left.saturating_sub(1),
        None => FRAMES,
    };
    ctx.data_mut(|data| data.insert_temp(Id::NULL, FollowedFocus { id, left }));
    let Some(response) = focused(ctx).filter(|response| left > 0 && is_cut(response)) else {
        return;
    };
    let request = ActionRequest {
        action: Action::ScrollIntoView,
        target: NodeId(response.id.value()),
        data: None,
    };
    ctx.input_mut(|i| i.events.push(Event::AccessKitActionRequest(request)));
    ctx.request_repaint();
}

/// At the end of an area with areas inside: scrolls it to what got the keyboard.
pub fn follow_around(ui: &Ui) {
    let followed: Option<FollowedFocus> = ui.data(|data| data.get_temp(Id::NULL));
    let is_new = followed.is_some_and(|followed| followed.left > 0);
    let here = focused(ui.ctx()).filter(|response| is_new && response.layer_id == ui.layer_id());
    if let Some(response) = here.filter(is_cut) {
        let still = egui::style::ScrollAnimation::none();
        ui.scroll_to_rect_animation(response.rect, None, still);
    }
}

/// Outlines what has the keyboard by two lines, of which one is seen on any ground.
pub fn outline(ctx: &Context, dark: bool) {
    let Some(response) = focused(ctx).filter(|r| r.interact_rect.is_positive()) else {
        return;
    };
    let c = Colours::of(dark);
    let seen = response.interact_rect;
    let painter = ctx.layer_painter(response.layer_id);
    let painter = painter.with_clip_rect(seen.expand(2.0 * LINE));
    for (out, colour) in [(LINE, c.playhead), (0.0, c.ground)] {
        let stroke = Stroke::new(LINE, colour);
        painter.rect_stroke(seen.expand(out), 4.0, stroke, StrokeKind::Outside);
    }
}
