//! The shelf: a row for each set that was found, with strips of its instances that play together; named, they become proposals.

use egui::{
    Button, CursorIcon, Rect, RichText, ScrollArea, Sense, TextEdit, Ui, Vec2, WidgetType, pos2,
};

use super::strips::{STRIP, go};
use super::{Out, strips, widgets};
use crate::format;
use crate::lists::List;
use crate::state::shelf::{ShelfCommand, ShelfSet};
use crate::state::{Command, State};
use crate::stretch::Stretch;
use crate::theme::Colours;

/// Width of a strip.
const WIDTH: f32 = 150.0;
/// Strips of a set: of a large one the outermost tell whether it is pure.
const SHOWN: usize = 24;
/// Width of the ruler, which shows half a repetition more on either side.
const RULER: f32 = 300.0;
/// Height of a set: a line, its ruler, its strips.
const ROW: f32 = 2.0 * STRIP + 62.0;

/// Looks for what repeats, or shows what was found.
pub fn button(ui: &mut Ui, state: &State, out: Out) {
    let find = ui.button("Find what repeats");
    if find
        .on_hover_text("Find sets of the same motion in all clips, without labels")
        .clicked()
    {
        out.push(Command::Shelf(ShelfCommand::Discover));
    }
    if !state.shelf.sets.is_empty() && ui.button("Back to the sets").clicked() {
        out.push(Command::Shelf(ShelfCommand::Show(true)));
    }
}

/// Title and buttons above the sets.
pub fn tools(ui: &mut Ui, state: &State, out: Out) {
    let (c, shelf) = (Colours::now(ui), &state.shelf);
    let mut push = |command| out.push(Command::Shelf(command));
    ui.label(RichText::new("What repeats").strong());
    let text = format!(
        "{}, {:.0} % of all motion; not repeated: {}",
        format::count(shelf.sets.len(), "set"),
        100.0 * shelf.share_in_sets,
        format::count(shelf.alone.len(), "stretch"),
    );
    ui.colored_label(c.muted, text);
    let play = if shelf.playing {
        "Stop"
    } else {
        "Play together"
    };
    if ui.button(play).clicked() {
        push(ShelfCommand::Play(!shelf.playing));
    }
    if ui
        .add_enabled(shelf.can_take_back(), Button::new("Take back"))
        .clicked()
    {
        push(ShelfCommand::TakeBack);
    }
    if ui.button("Back to classes").clicked() {
        push(ShelfCommand::Show(false));
    }
    if let Some(left_out) = &shelf.left_out {
        ui.colored_label(c.warn, crate::store::sentence(left_out));
    }
}

/// The sets, and what was seen once.
pub fn show(ui: &mut Ui, state: &State, out: Out) {
    let rows = state.shelf.sets.len() + usize::from(!state.shelf.alone.is_empty());
    ScrollArea::vertical()
        .auto_shrink(false)
        .show_rows(ui, ROW, rows, |ui, rows| {
            let list = List::main(ui, "sets", state.shelf.sets.len(), 1, 0);
            list.scroll(ui, list.wanted, rows.start, ROW);
            for row in rows {
                let size = Vec2::new(ui.available_width(), ROW);
                let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
                let place = egui::UiBuilder::new().id_salt(("set", row)).max_rect(rect);
                let mut ui = ui.new_child(place);
                match state.shelf.sets.get(row) {
                    Some(set) => one(&mut ui, state, (&list, row), set, out),
                    None => alone(&mut ui, state, out),
                }
            }
        });
}

fn one(ui: &mut Ui, state: &State, (list, place): (&List, usize), set: &ShelfSet, out: Out) {
    let c = Colours::now(ui);
    let instances = state.set_instances(place);
    ui.horizontal(|ui| {
        ui.label(RichText::new(format!("Set {}", set.number)).strong());
        let text = format!(
            "{} × {:.1} s in {}",
            instances.len(),
            state.shelf.length_secs(place),
            format::count(state.shelf.clips_of(place), "clip"),
        );
        ui.colored_label(c.muted, text);
        match &set.named {
            Some(name) => named(ui, place, name, out),
            None => decisions(ui, state, place, set, out),
        }
    });
    if set.named.is_none() {
        ruler(ui, state, place, set, &instances, out);
    }
    strips_of(ui, state, (list, place), set, &instances, out);
}

fn named(ui: &mut Ui, place: usize, name: &str, out: Out) {
    ui.colored_label(Colours::now(ui).good, format!("proposed as {name}"));
    if ui
        .small_button("Change")
        .on_hover_text(
            "Opens the set to changes; its labels stay until they are undone or rejected",
        )
        .clicked()
    {
        out.push(Command::Shelf(ShelfCommand::Reopen(place)));
    }
}

/// Name, and what else may become of a set.
fn decisions(ui: &mut Ui, state: &State, place: usize, set: &ShelfSet, out: Out) {
    let id = egui::Id::new(("name of set", set.number));
    let mut name = ui.data(|d| d.get_temp::<String>(id)).unwrap_or_default();
    let edit = ui.add(
        TextEdit::singleline(&mut name)
            .hint_text("name …")
            .desired_width(100.0),
    );
    let entered = edit.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
    edit.widget_info(|| {
        let text = format!("Name of set {}", set.number);
        let mut info = egui::WidgetInfo::labeled(WidgetType::TextEdit, true, text);
        info.current_text_value = Some(name.clone());
        info
    });
    let mut push = |command| out.push(Command::Shelf(command));
    let given = !name.trim().is_empty();
    let button = ui.add_enabled(given, Button::new("Propose").small());
    let of_set = |what: &str| format!("{what} set {}", set.number);
    widgets::named(&button, WidgetType::Button, of_set("Propose"), false);
    if given && (entered || button.clicked()) {
        push(ShelfCommand::Name {
            set: place,
            name: name.clone(),
        });
    }
    ui.data_mut(|d| d.insert_temp(id, name));
    let runs = ui.selectable_label(set.runs, "Whole runs");
    widgets::named(&runs, WidgetType::Button, of_set("Whole runs of"), set.runs);
    let hint = "Make repetitions without a pause one sample";
    if runs.on_hover_text(hint).clicked() {
        push(ShelfCommand::Runs {
            set: place,
            on: !set.runs,
        });
    }
    if !set.marked.is_empty() {
        let split = ui.small_button(format!("Split off {}", set.marked.len()));
        widgets::named(&split, WidgetType::Button, of_set("Split off from"), false);
        if split.clicked() {
            push(ShelfCommand::Split(place));
        }
    }
    let join = ui.menu_button("Join with", |ui| {
        for (into, other) in state.shelf.sets.iter().enumerate() {
            if into != place
                && ui
                    .button(format!("Join with set {}", other.number))
                    .clicked()
            {
                push(ShelfCommand::Join { set: place, into });
                ui.close();
            }
        }
    });
    widgets::named(&join.response, WidgetType::Button, of_set("Join"), false);
    let not = ui.small_button("Not a motion");
    widgets::named(&not, WidgetType::Button, of_set("Not a motion:"), false);
    let hint = "Leave it unlabelled: training uses it as background";
    if not.on_hover_text(hint).clicked() {
        push(ShelfCommand::NotAMotion(place));
    }
}

/// The most central instance with half a repetition on either side; a handle at each end moves that end of all instances, what is between them both.
fn ruler(ui: &mut Ui, state: &State, place: usize, set: &ShelfSet, shown: &[Stretch], out: Out) {
    let Some(central) = shown.last() else { return };
    let left = (1.0 + set.ends.1 - set.ends.0).max(0.1);
    let length = match set.runs {
        true => state.shelf.length_secs(place).max(1e-3),
        false => (central.span.duration_secs() / left).max(1e-3),
    };
    let (start, stop) = (central.span.start_secs, central.span.stop_secs);
    // Where the instance lies unmoved: the ruler stays while its handles move.
    let unmoved = (start - set.ends.0 * length, stop - set.ends.1 * length);
    let first = (unmoved.0 - 0.5 * length).max(0.0);
    let last = unmoved.1 + 0.5 * length;
    let (rect, _) = ui.allocate_exact_size(Vec2::new(RULER, STRIP), Sense::hover());
    strips::draw(ui, state, Stretch::new(central.clip, first..last), rect);
    let x = |secs: f64| rect.left() + ((secs - first) / (last - first)) as f32 * rect.width();
    let id = egui::Id::new(("ends of set", set.number));
    let dragged = ui.data(|d| d.get_temp::<(f64, f64)>(id));
    let ends = dragged.unwrap_or(set.ends);
    let (left, right) = (
        x(unmoved.0 + ends.0 * length),
        x(unmoved.1 + ends.1 * length),
    );
    let (c, painter) = (Colours::now(ui), ui.painter_at(rect));
    for shade in [
        Rect::from_min_max(rect.min, pos2(left, rect.bottom())),
        Rect::from_min_max(pos2(right, rect.top()), rect.max),
    ] {
        painter.rect_filled(shade, 0.0, c.well.gamma_multiply(0.75));
    }
    let grips = [
        (
            "Start of",
            Rect::from_x_y_ranges(left - 5.0..=left + 5.0, rect.y_range()),
            (1.0, 0.0),
        ),
        (
            "Stop of",
            Rect::from_x_y_ranges(right - 5.0..=right + 5.0, rect.y_range()),
            (0.0, 1.0),
        ),
        (
            "Both ends of",
            Rect::from_x_y_ranges(left + 5.0..=right - 5.0, rect.y_range()),
            (1.0, 1.0),
        ),
    ];
    for (name, grip, (of_start, of_stop)) in grips {
        let response = ui.interact(grip, id.with(name), Sense::drag());
        let name = format!("{name} set {}", set.number);
        widgets::named(&response, WidgetType::Slider, name, false);
        if of_start + of_stop < 2.0 {
            painter.rect_filled(grip.shrink2(Vec2::new(3.5, 0.0)), 0.0, c.accent);
        }
        let response = response.on_hover_cursor(CursorIcon::ResizeHorizontal);
        if response.dragged() {
            let by = f64::from(response.drag_delta().x / rect.width()) * (last - first) / length;
            let moved = (ends.0 + of_start * by, ends.1 + of_stop * by);
            ui.data_mut(|d| d.insert_temp(id, moved));
        }
        if response.drag_stopped() {
            out.push(Command::Shelf(ShelfCommand::Ends { set: place, ends }));
            ui.data_mut(|d| d.remove_temp::<(f64, f64)>(id));
        }
    }
}

/// The instances, outermost first: a click shows one, with Ctrl marks it; a cross throws it out.
fn strips_of(
    ui: &mut Ui,
    state: &State,
    (list, place): (&List, usize),
    set: &ShelfSet,
    shown: &[Stretch],
    out: Out,
) {
    let c = Colours::now(ui);
    let area = ScrollArea::horizontal().id_salt(("strips of set", set.number));
    area.show(ui, |ui| {
        ui.horizontal(|ui| {
            for (number, of) in shown.iter().take(SHOWN).enumerate() {
                let (rect, response) =
                    ui.allocate_exact_size(Vec2::new(WIDTH, STRIP), Sense::click());
                let name = format!("Instance {} of set {}", number + 1, set.number);
                let is_marked = set.marked.contains(of);
                widgets::named(&response, WidgetType::Button, &name, is_marked);
                strips::draw(ui, state, *of, rect);
                if state.shelf.playing {
                    let secs = state.shelf.length_secs(place);
                    strips::play(ui, state, *of, rect, secs);
                }
                if is_marked {
                    widgets::selected_frame(ui, rect);
                }
                // The list goes from set to set, to the outermost instance of each.
                let chosen = match number {
                    0 => list.row(ui, place, &response, state.is_selected_stretch(*of)),
                    _ => response.clicked(),
                };
                if chosen {
                    match ui.input(|i| i.modifiers.command) {
                        true if set.named.is_none() => {
                            out.push(Command::Shelf(ShelfCommand::Mark {
                                set: place,
                                of: *of,
                            }));
                        }
                        _ => go(*of, None, out),
                    }
                }
                if set.named.is_none() {
                    let corner = Rect::from_min_size(
                        rect.right_top() - Vec2::new(17.0, 0.0),
                        Vec2::splat(17.0),
                    );
                    let cross = ui.put(corner, Button::new("×").small().frame(false));
                    widgets::named(
                        &cross,
                        WidgetType::Button,
                        format!("Throw out {name}"),
                        false,
                    );
                    if cross.clicked() {
                        out.push(Command::Shelf(ShelfCommand::ThrowOut {
                            set: place,
                            of: *of,
                        }));
                    }
                }
            }
            if shown.len() > SHOWN {
                ui.colored_label(c.muted, format!("and {} more", shown.len() - SHOWN));
            }
        });
    });
}

/// What no set explains, with the nearest set.
fn alone(ui: &mut Ui, state: &State, out: Out) {
    let c = Colours::now(ui);
    ui.colored_label(
        c.muted,
        "Not repeated: a motion performed once is in no set",
    );
    ScrollArea::horizontal()
        .id_salt("seen once")
        .show(ui, |ui| {
            ui.horizontal(|ui| {
                for (number, of) in state.shelf.alone.iter().take(SHOWN).enumerate() {
                    let Some(clip) = of.id else { continue };
                    let stretch = Stretch::new(clip, of.span);
                    ui.vertical(|ui| {
                        let (rect, response) =
                            ui.allocate_exact_size(Vec2::new(WIDTH, STRIP), Sense::click());
                        let name = format!("Seen once {}", number + 1);
                        widgets::named(&response, WidgetType::Button, name, false);
                        strips::draw(ui, state, stretch, rect);
                        ui.painter()
                            .rect_filled(rect, 3.0, c.well.gamma_multiply(0.5));
                        let near = of
                            .nearest_set
                            .map_or_else(String::new, |set| format!("near set {set}"));
                        ui.colored_label(c.muted, near);
                        if response.clicked() {
                            go(stretch, None, out);
                        }
                    });
                }
                let more = state.shelf.alone.len().saturating_sub(SHOWN);
                if more > 0 {
                    ui.colored_label(c.muted, format!("and {more} more"));
                }
            });
        });
}
