//! Small parts that several panels draw.

use egui::text::{CCursor, CCursorRange};
use egui::text_edit::TextEditState;
use egui::{
    Align, Align2, Button, CentralPanel, Color32, FontId, Frame, Key, Label, Layout, Margin, Rect,
    Response, RichText, Sense, SidePanel, Stroke, StrokeKind, TextEdit, TopBottomPanel, Ui, Vec2,
    WidgetInfo, WidgetType,
};

use crate::state::{Command, FileCommand, TrainCommand};
use crate::theme::Colours;

/// Commands that a panel emits.
pub type Out<'a> = &'a mut Vec<Command>;

/// The frame of panels' contents, on the colour with which every frame begins.
pub fn padded() -> Frame {
    Frame::new().inner_margin(Margin::same(12))
}

/// A box over the whole width, on the ground's colour: results within a panel.
pub fn boxed<R>(ui: &mut Ui, contents: impl FnOnce(&mut Ui) -> R) -> R {
    let frame = Frame::new()
        .fill(Colours::now(ui).ground)
        .corner_radius(6.0)
        .inner_margin(Margin::same(12));
    let shown = frame.show(ui, |ui| {
        ui.set_width(ui.available_width());
        contents(ui)
    });
    shown.inner
}

/// Panels inside another area, of which nothing is drawn or clicked outside of it.
pub trait Clipped {
    /// Shows the panel; `egui` alone would let it reach over the edges of an area that scrolls it.
    fn show_clipped(self, ui: &mut Ui, contents: impl FnOnce(&mut Ui));
}

/// Contents of which nothing is drawn or clicked outside of an area.
pub fn within(area: Rect, contents: impl FnOnce(&mut Ui)) -> impl FnOnce(&mut Ui) {
    move |ui| {
        ui.set_clip_rect(ui.clip_rect().intersect(area));
        contents(ui);
    }
}

impl Clipped for SidePanel {
    fn show_clipped(self, ui: &mut Ui, contents: impl FnOnce(&mut Ui)) {
        let area = ui.clip_rect();
        self.show_inside(ui, within(area, contents));
    }
}

impl Clipped for TopBottomPanel {
    fn show_clipped(self, ui: &mut Ui, contents: impl FnOnce(&mut Ui)) {
        let area = ui.clip_rect();
        self.show_inside(ui, within(area, contents));
    }
}

impl Clipped for CentralPanel {
    fn show_clipped(self, ui: &mut Ui, contents: impl FnOnce(&mut Ui)) {
        let area = ui.clip_rect();
        self.show_inside(ui, within(area, contents));
    }
}

/// A heading of a section.
pub fn section(ui: &mut Ui, text: &str) {
    let c = Colours::now(ui);
    ui.add_space(4.0);
    ui.label(RichText::new(text).color(c.muted).size(11.5).strong());
}

/// Fills an empty panel: a sentence, and a hint at what to do.
pub fn nothing(ui: &mut Ui, text: &str, hint: &str) {
    let c = Colours::now(ui);
    ui.add_space(28.0);
    ui.vertical_centered(|ui| {
        ui.label(RichText::new(text).size(15.0));
        ui.add_space(4.0);
        ui.label(RichText::new(hint).color(c.muted));
    });
}

/// The button of a panel's main action.
pub fn main_button(text: &str, c: &Colours) -> Button<'static> {
    let fill = c
        .panel
        .lerp_to_gamma(c.accent, if c.dark { 0.62 } else { 0.9 });
    let colour = Color32::WHITE;
    Button::new(RichText::new(text.to_owned()).color(colour).strong())
        .fill(fill)
        .stroke(Stroke::NONE)
        .min_size(Vec2::new(0.0, 28.0))
}

/// A button as wide as there is room.
pub fn wide(ui: &mut Ui, on: bool, button: Button<'_>, height: f32) -> Response {
    let size = Vec2::new(ui.available_width(), height);
    ui.add_enabled_ui(on, |ui| ui.add_sized(size, button)).inner
}

/// A square of a class's colour with its key.
pub fn chip(ui: &mut Ui, place: Option<usize>, name: &str) -> Response {
    let c = Colours::now(ui);
    let (rect, response) = ui.allocate_exact_size(Vec2::splat(18.0), Sense::hover());
    ui.painter().rect_filled(rect, 3.0, c.class(place));
    if let Some(place) = place.filter(|p| *p < 9) {
        let key = (place + 1).to_string();
        let font = FontId::proportional(12.0);
        ui.painter().text(
            rect.center(),
            Align2::CENTER_CENTER,
            key,
            font,
            c.text_on(c.class(Some(place))),
        );
    }
    response.on_hover_text(name)
}

/// A frame around what is selected.
pub fn selected_frame(ui: &Ui, rect: Rect) {
    let c = Colours::now(ui);
    ui.painter()
        .rect_stroke(rect, 4.0, Stroke::new(1.5, c.accent), StrokeKind::Inside);
}

/// Text cut off at the right where it does not fit.
pub fn text_in(ui: &Ui, rect: Rect, text: &str, size: f32, colour: Color32, right: bool) {
    let mut job = egui::text::LayoutJob::simple_singleline(
        text.to_owned(),
        FontId::proportional(size),
        colour,
    );
    job.wrap.max_width = rect.width().max(1.0);
    job.wrap.max_rows = 1;
    job.wrap.break_anywhere = true;
    let galley = ui.fonts_mut(|fonts| fonts.layout_job(job));
    let x = match right {
        true => rect.right() - galley.size().x,
        false => rect.left(),
    };
    let y = rect.center().y - galley.size().y / 2.0;
    ui.painter().galley(egui::pos2(x, y), galley, colour);
}

/// The ground of a row in a list: chosen if `on`, under the pointer, or neither.
pub fn row_ground(ui: &Ui, rect: Rect, response: &Response, on: bool) {
    let c = Colours::now(ui);
    if on {
        let fill = ui.visuals().selection.bg_fill;
        ui.painter().rect_filled(rect, 3.0, fill);
    } else if response.hovered() {
        ui.painter().rect_filled(rect, 3.0, c.tint(c.accent, 0.10));
    }
}

/// Names a painted part for screen readers and tests.
pub fn named(response: &Response, kind: WidgetType, name: impl ToString, selected: bool) {
    response.widget_info(|| WidgetInfo::selected(kind, true, selected, name.to_string()));
}

/// A figure with what it counts.
pub fn figure(ui: &mut Ui, value: impl Into<String>, what: &str) {
    let c = Colours::now(ui);
    let value: String = value.into();
    let width = |text: &str, size: f32| {
        let font = FontId::proportional(size);
        let galley = ui.painter().layout_no_wrap(text.to_owned(), font, c.text);
        galley.size().x.ceil()
    };
    // As wide as it is, so that it goes to the next line whole.
    let size = Vec2::new(width(&value, 19.0).max(width(what, 11.0)), 36.0);
    ui.allocate_ui_with_layout(size, Layout::top_down(Align::Min), |ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        let value = RichText::new(value).size(19.0).strong();
        ui.add(Label::new(value).extend());
        let what = RichText::new(what).size(11.0).color(c.muted);
        ui.add(Label::new(what).extend());
    });
}

/// Open, new, import.
pub fn file_buttons(ui: &mut Ui, out: Out) {
    let c = Colours::now(ui);
    let buttons = [
        ("Open a database …", FileCommand::AskOpen),
        ("New database …", FileCommand::AskNew),
        ("Import clips …", FileCommand::AskImport),
    ];
    for (at, (text, command)) in buttons.into_iter().enumerate() {
        let button = match at {
            0 => main_button(text, &c),
            _ => Button::new(text),
        };
        if ui.add(button.min_size(Vec2::new(180.0, 28.0))).clicked() {
            out.push(Command::File(command));
        }
    }
}

/// The index in use is not that of the labels of now.
pub fn train_again(ui: &mut Ui, out: Out) {
    let c = Colours::now(ui);
    ui.horizontal_wrapped(|ui| {
        ui.colored_label(c.warn, "Labels or background have changed since training.");
        if ui.button("Train again").clicked() {
            out.push(Command::Train(TrainCommand::Train));
        }
    });
}

/// Scrolls a list to row `at` once that is another than before; `first` is the row that is drawn first, `height` that of each.
pub fn keep_in_view(ui: &Ui, list: &str, at: Option<usize>, first: usize, height: f32) {
    let id = egui::Id::new(("in view", list));
    let before = ui.data(|data| data.get_temp::<Option<usize>>(id));
    ui.data_mut(|data| data.insert_temp(id, at));
    let Some(at) = at.filter(|_| before != Some(at)) else {
        return;
    };
    let pitch = height + ui.spacing().item_spacing.y;
    let top = ui.max_rect().top() + (at as f32 - first as f32) * pitch;
    let row = Rect::from_min_size(egui::pos2(ui.max_rect().left(), top), Vec2::splat(height));
    ui.scroll_to_rect(row, None);
}

/// A field of one line, which keeps the keyboard when Enter is pressed: what is typed next is text, and no key of the window.
pub fn line(text: &mut String) -> TextEdit<'_> {
    TextEdit::singleline(text).return_key(None)
}

/// The default button of a dialog: true if it is clicked, or Enter is pressed while no widget has the focus.
pub fn default_button(ui: &mut Ui, text: &str, colours: &Colours) -> bool {
    let is_free = ui.is_enabled() && ui.memory(|memory| memory.focused().is_none());
    let entered = is_free && ui.input(|i| i.key_pressed(Key::Enter));
    ui.add(main_button(text, colours)).clicked() || entered
}

/// Focuses a text field with its text selected, so that typing replaces it.
pub fn focus_selected(ui: &Ui, field: &Response, text: &str) {
    field.request_focus();
    let mut state = TextEditState::load(ui.ctx(), field.id).unwrap_or_default();
    let whole = CCursorRange::two(CCursor::default(), CCursor::new(text.chars().count()));
    state.cursor.set_char_range(Some(whole));
    state.store(ui.ctx(), field.id);
}

/// True if Enter was pressed in a field.
pub fn entered(ui: &Ui, field: &Response) -> bool {
    field.has_focus() && ui.input(|i| i.key_pressed(Key::Enter))
}

/// A field whose text counts once Enter is pressed or it is left; Escape gives it up.
/// `of` is what the text belongs to: typed for one thing it never becomes another's.
pub fn committed(ui: &mut Ui, name: &str, of: impl std::hash::Hash, text: &str) -> Option<String> {
    let id = ui.make_persistent_id((name, of));
    let mut now = ui
        .data(|d| d.get_temp::<String>(id))
        .unwrap_or_else(|| text.to_owned());
    let edit = line(&mut now).id(id.with("edit")).desired_width(220.0);
    let response = ui.add(edit);
    response.widget_info(|| {
        let mut info = WidgetInfo::labeled(WidgetType::TextEdit, true, name);
        info.current_text_value = Some(now.clone());
        info
    });
    if response.changed() {
        ui.data_mut(|d| d.insert_temp(id, now.clone()));
    }
    if response.lost_focus() || entered(ui, &response) {
        ui.data_mut(|d| d.remove::<String>(id));
        let given_up = ui.input(|i| i.key_pressed(Key::Escape));
        return (now != text && !given_up).then_some(now);
    }
    if !response.has_focus() {
        // It was not drawn when it was left.
        ui.data_mut(|d| d.remove::<String>(id));
    }
    None
}
