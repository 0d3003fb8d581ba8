//! Lists by keys: Up and Down go from row to row, Page Up and Page Down by ten lines, Home and End to the first and the last, Left and
//! Right between rows that lie side by side. Enter chooses the row that has the keyboard.

use egui::{Context, FocusDirection, Id, Key, Modifiers, Rect, Response, Ui, Vec2, pos2};

/// A step through a list.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Step {
    /// So many lines on.
    Lines(isize),
    /// So many rows on.
    Rows(isize),
    First,
    Last,
}

/// Lines of a page.
const PAGE: isize = 10;

const KEYS: [(Key, Step); 8] = [
    (Key::ArrowUp, Step::Lines(-1)),
    (Key::ArrowDown, Step::Lines(1)),
    (Key::PageUp, Step::Lines(-PAGE)),
    (Key::PageDown, Step::Lines(PAGE)),
    (Key::Home, Step::First),
    (Key::End, Step::Last),
    (Key::ArrowLeft, Step::Rows(-1)),
    (Key::ArrowRight, Step::Rows(1)),
];

/// The row that had the keyboard when it was drawn last.
#[derive(Debug, Clone, Copy)]
struct Current {
    list: Id,
    row: Id,
    at: usize,
    selected: bool,
    columns: usize,
}

/// A step that its list has not been drawn with yet; without a list, into the panel's own.
#[derive(Debug, Clone, Copy)]
struct Pending {
    list: Option<Id>,
    step: Step,
    pass: u64,
}

/// A row that gets the keyboard once it is drawn, as of the pass in which its list was drawn last.
#[derive(Debug, Clone, Copy)]
struct WantedRow {
    list: Id,
    at: usize,
    pass: u64,
}

fn current(ctx: &Context) -> Option<Current> {
    let current: Option<Current> = ctx.data(|data| data.get_temp(Id::NULL));
    current.filter(|current| ctx.memory(|memory| memory.has_focus(current.row)))
}

/// True if the keyboard is on the selected row of a list, which keys of the panel act on.
pub fn is_on_selected(ctx: &Context) -> bool {
    current(ctx).is_some_and(|current| current.selected)
}

/// Reads the keys of the list that has the keyboard; without one Up and Down enter the panel's own list, if `enters`.
pub fn read(ctx: &Context, enters: bool) {
    let current = current(ctx);
    let is_free = ctx.memory(|memory| memory.focused().is_none());
    let keys = match current {
        Some(current) if current.columns > 1 => &KEYS[..],
        Some(_) => &KEYS[..6],
        None if enters && is_free => &KEYS[..2],
        None => return,
    };
    let pressed = |i: &mut egui::InputState| {
        let mut keys = keys.iter();
        let found = keys.find(|(key, _)| i.consume_key(Modifiers::NONE, *key))?;
        Some(found.1)
    };
    if let Some(step) = ctx.input_mut(pressed) {
        let pending = Pending {
            list: current.map(|current| current.list),
            step,
            pass: ctx.cumulative_pass_nr(),
        };
        ctx.data_mut(|data| data.insert_temp(Id::NULL, pending));
        // Not to whatever lies nearest.
        ctx.memory_mut(|memory| memory.move_focus(FocusDirection::None));
    }
}

/// Down, in the field that searches a list which is drawn after it, goes to the first row that was found.
pub fn enter_by_down(ui: &Ui, field: &Response, name: &str) {
    let down = |i: &mut egui::InputState| i.consume_key(Modifiers::NONE, Key::ArrowDown);
    if field.has_focus() && ui.input_mut(down) {
        let wanted = WantedRow {
            list: list_id(name),
            at: 0,
            pass: ui.ctx().cumulative_pass_nr(),
        };
        ui.data_mut(|data| data.insert_temp(Id::NULL, wanted));
        ui.memory_mut(|memory| memory.move_focus(FocusDirection::None));
    }
}

fn list_id(name: impl std::hash::Hash) -> Id {
    Id::new(("list", name))
}

/// A list while it is drawn.
#[derive(Debug, Clone, Copy)]
pub struct List {
    id: Id,
    columns: usize,
    /// Rows are chosen when keys go to them; otherwise Enter chooses.
    follows: bool,
    /// The row that keys have gone to, which is to be drawn.
    pub wanted: Option<usize>,
}

impl List {
    /// A list of `len` rows, which are chosen by Enter.
    pub fn new(ui: &Ui, name: impl std::hash::Hash, len: usize) -> Self {
        Self::drawn(ui, name, len, 1, false, None)
    }

    /// A list whose rows are chosen when keys go to them.
    pub fn following(ui: &Ui, name: impl std::hash::Hash, len: usize) -> Self {
        Self::drawn(ui, name, len, 1, true, None)
    }

    /// Rows that lie side by side in so many columns.
    pub fn grid(ui: &Ui, name: impl std::hash::Hash, len: usize, columns: usize) -> Self {
        Self::drawn(ui, name, len, columns, false, None)
    }

    /// The panel's own list, which Up and Down enter at `at`: rows are chosen when keys go to them.
    pub fn main(
        ui: &Ui,
        name: impl std::hash::Hash,
        len: usize,
        columns: usize,
        at: usize,
    ) -> Self {
        Self::drawn(ui, name, len, columns, true, Some(at))
    }

    fn drawn(
        ui: &Ui,
        name: impl std::hash::Hash,
        len: usize,
        columns: usize,
        follows: bool,
        entry: Option<usize>,
    ) -> Self {
        let id = list_id(name);
        let now = ui.ctx().cumulative_pass_nr();
        let current = current(ui.ctx()).filter(|current| current.list == id);
        let wanted = ui.data_mut(|data| {
            let pending: Option<Pending> = data.get_temp(Id::NULL);
            let is_here = |p: &Pending| match p.list {
                Some(list) => list == id,
                None => entry.is_some(),
            };
            let pending = pending.filter(|p| p.pass == now && len > 0 && is_here(p));
            let before: Option<WantedRow> = data.get_temp(Id::NULL);
            let before = before.filter(|w| w.list == id && w.pass + 2 > now);
            let at = match (pending, current) {
                (Some(pending), Some(current)) => {
                    Some(pending.step.after(current.at, columns, len))
                }
                (Some(_), None) => entry,
                (None, _) => before.map(|wanted| wanted.at),
            };
            let at = at.map(|at| at.min(len.saturating_sub(1)));
            if pending.is_some() {
                data.remove::<Pending>(Id::NULL);
            }
            if let Some(at) = at {
                let pass = now;
                data.insert_temp(Id::NULL, WantedRow { list: id, at, pass });
            }
            at
        });
        Self {
            id,
            columns,
            follows,
            wanted,
        }
    }

    /// Scrolls so that the row is drawn that keys have gone to: on line `line` of lines of one height, of which `first` is drawn first.
    pub fn scroll(&self, ui: &Ui, line: Option<usize>, first: usize, height: f32) {
        let Some(line) = line else { return };
        let pitch = height + ui.spacing().item_spacing.y;
        let area = ui.max_rect();
        let top = area.top() + (line as f32 - first as f32) * pitch;
        let row = Rect::from_min_size(pos2(area.left(), top), Vec2::splat(height));
        ui.scroll_to_rect_animation(row, None, egui::style::ScrollAnimation::none());
        ui.ctx().request_repaint();
    }

    /// Takes part in the list with row `at`; true if it was chosen, by a click, by Enter, or because keys went to it.
    pub fn row(&self, ui: &Ui, at: usize, response: &Response, selected: bool) -> bool {
        let came = self.wanted == Some(at);
        if came {
            response.request_focus();
            ui.data_mut(|data| data.remove::<WantedRow>(Id::NULL));
        }
        if came || response.has_focus() {
            let current = Current {
                list: self.id,
                row: response.id,
                at,
                selected: selected || (came && self.follows),
                columns: self.columns,
            };
            ui.data_mut(|data| data.insert_temp(Id::NULL, current));
        }
        response.clicked() || (came && self.follows)
    }
}

impl Step {
    fn after(self, at: usize, columns: usize, len: usize) -> usize {
        let last = len.saturating_sub(1);
        let moved = |by: isize| at.saturating_add_signed(by);
        match self {
            Self::First => 0,
            Self::Last => last,
            Self::Rows(by) => moved(by).min(last),
            // Beyond the first and the last line there is nothing.
            Self::Lines(by) if by < 0 && at < columns => at,
            Self::Lines(by) => {
                let to = moved(by * columns.cast_signed());
                match to > last && at / columns == last / columns {
                    true => at,
                    false => to.min(last),
                }
            }
        }
    }
}
