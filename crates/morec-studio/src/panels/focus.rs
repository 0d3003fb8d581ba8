//! The widget that has the keyboard: outlined, brought into view when it changes, and kept inside an open menu.

use egui::accesskit::{Action, ActionRequest, NodeId};
use egui::{Context, Event, Id, Order, Popup, Response, Stroke, StrokeKind, Ui};

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

/// What had the keyboard before a menu was opened.
#[derive(Debug, Clone, Copy, Default)]
struct BehindMenu(Option<Id>);

/// Before a frame is drawn: while a menu is open, the keyboard stays in it, and a click outside closes it alone. True if one is open.
pub fn keep_in_menus(ctx: &Context) -> bool {
    if !Popup::is_any_open(ctx) {
        return false;
    }
    let lowest = ctx.memory(|memory| {
        let mut menus = memory.layer_ids().filter(|l| l.order == Order::Foreground);
        menus.find(|layer| memory.areas().is_visible(layer))
    });
    if let Some(lowest) = lowest {
        ctx.memory_mut(|memory| memory.set_modal_layer(lowest));
    }
    // What lies below a menu loses the keyboard when it is drawn.
    let is_below = |r: &Response| r.layer_id.order < Order::Foreground;
    if let Some(response) = focused(ctx).filter(is_below) {
        ctx.data_mut(|data| data.insert_temp(Id::NULL, BehindMenu(Some(response.id))));
    }
    true
}

/// After a frame without a menu: the keyboard is again where it was before the menu was opened, if that is still drawn.
pub fn come_back_from_menus(ctx: &Context) {
    let behind: Option<BehindMenu> = ctx.data_mut(|data| data.remove_temp(Id::NULL));
    let is_free = ctx.memory(|memory| memory.focused().is_none());
    let Some(id) = behind.and_then(|behind| behind.0).filter(|_| is_free) else {
        return;
    };
    if ctx.viewport(|viewport| viewport.this_pass.widgets.contains(id)) {
        ctx.memory_mut(|memory| memory.request_focus(id));
        ctx.request_repaint();
    }
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
