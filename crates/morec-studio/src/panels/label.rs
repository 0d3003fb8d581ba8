//! Labelling: clips at the left, the performer in the middle, classes at the right, the timeline below.

use egui::{
    Button, CentralPanel, Rect, RichText, ScrollArea, Sense, SidePanel, TopBottomPanel, Ui, Vec2,
    WidgetType,
};
use morec_db::labels::SampleState as Judged;

use super::widgets::Clipped;
use super::{
    Out, carried, class_name, deviation, library, padded, player, proposals, timeline, view,
    widgets,
};
use crate::format;
use crate::lists::List;
use crate::state::{
    ClassCommand, Command, CompareCommand, FileCommand, LibraryCommand, SimilarCommand, State,
    TimelineCommand,
};
use crate::theme::Colours;

const LIST: &str = "clips to label";

pub fn show(ui: &mut Ui, state: &State, out: Out) {
    let height = ui.available_height();
    TopBottomPanel::bottom("timeline")
        .frame(padded())
        .resizable(true)
        .default_height((height * 0.40).clamp(240.0, 420.0))
        .height_range(160.0..=height * 0.65)
        .show_clipped(ui, |ui| timeline::show(ui, state, out));
    SidePanel::left("clips")
        .frame(padded())
        .default_width(190.0)
        .width_range(140.0..=320.0)
        .show_clipped(ui, |ui| clips(ui, state, out));
    SidePanel::right("classes")
        .frame(padded())
        .default_width(250.0)
        .width_range(220.0..=340.0)
        .show_clipped(ui, |ui| {
            ScrollArea::vertical()
                .auto_shrink(false)
                .show(ui, |ui| classes(ui, state, out));
        });
    CentralPanel::default()
        .frame(padded())
        .show_clipped(ui, |ui| {
            let room = Vec2::new(0.0, player::HEIGHT + 6.0);
            let rect = Rect::from_min_size(ui.cursor().min, ui.available_size() - room);
            ui.scope_builder(egui::UiBuilder::new().max_rect(rect), |ui| {
                view::clip(ui, state, out)
            });
            ui.advance_cursor_after_rect(rect);
            player::transport(ui, state, out);
        });
}

fn clips(ui: &mut Ui, state: &State, out: Out) {
    const ROW: f32 = 24.0;
    let Some(store) = &state.store else { return };
    let c = Colours::now(ui);
    widgets::section(ui, "CLIPS");
    library::search(ui, state, ui.available_width() - 8.0, LIST, out);
    ui.spacing_mut().item_spacing.y = 0.0;
    let shown = state.library.shown();
    let now = state.player.motion.as_ref().map(|m| m.id);
    ScrollArea::vertical()
        .auto_shrink(false)
        .show_rows(ui, ROW, shown.len(), |ui, rows| {
            let is_now = |place: &usize| store.snapshot.clips.get(*place).map(|c| c.id) == now;
            let at = shown.iter().position(is_now);
            widgets::keep_in_view(ui, LIST, at, rows.start, ROW);
            let list = List::following(ui, LIST, shown.len());
            list.scroll(ui, list.wanted, rows.start, ROW);
            for at in rows {
                let Some(clip) = store.snapshot.clips.get(shown[at]) else {
                    continue;
                };
                let size = Vec2::new(ui.available_width(), ROW);
                let (rect, response) = ui.allocate_exact_size(size, Sense::click());
                let on = now == Some(clip.id);
                widgets::named(
                    &response,
                    WidgetType::SelectableLabel,
                    format!("Show {}", clip.name),
                    on,
                );
                widgets::row_ground(ui, rect, &response, on);
                let inner = rect.shrink2(Vec2::new(6.0, 0.0));
                let left =
                    Rect::from_min_max(inner.min, egui::pos2(inner.right() - 34.0, inner.bottom()));
                // Clips that are background hold nothing to label.
                let colour = match clip.is_background() {
                    true => c.muted,
                    false => c.text,
                };
                widgets::text_in(ui, left, &clip.name, 13.0, colour, false);
                if clip.samples > 0 {
                    widgets::text_in(ui, inner, &clip.samples.to_string(), 12.0, c.muted, true);
                }
                if list.row(ui, at, &response, on) {
                    out.push(Command::Library(LibraryCommand::Open(clip.id)));
                }
            }
        });
}

fn classes(ui: &mut Ui, state: &State, out: Out) {
    widgets::section(ui, "CLASSES");
    class_name::unnamed(ui, state, true, out);
    let list = List::new(ui, "classes", state.classes.placed().count());
    for (at, (place, name)) in state.classes.placed().enumerate() {
        class(ui, state, (place, name), (&list, at), out);
    }
    add_class(ui, state, out);
    ui.add_space(8.0);
    deviation::recognised(ui, state, out);
    deviation::bones(ui, state, out);
    selection(ui, state, out);
    ui.add_space(8.0);
    help(ui, state, out);
}

fn class(
    ui: &mut Ui,
    state: &State,
    (place, name): (usize, &str),
    (list, at): (&List, usize),
    out: Out,
) {
    let c = Colours::now(ui);
    let held = state.classes.held.as_ref().is_some_and(|h| h.slot == place);
    if let Some((from, now)) = state
        .classes
        .renaming
        .as_ref()
        .filter(|(from, _)| from == name)
    {
        return class_name::field(ui, from, now, out);
    }
    let size = Vec2::new(ui.available_width(), 26.0);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    widgets::named(&response, WidgetType::Button, format!("Class {name}"), held);
    let fill = if held {
        c.panel.lerp_to_gamma(c.class(Some(place)), 0.5)
    } else if response.hovered() {
        c.tint(c.accent, 0.10)
    } else {
        egui::Color32::TRANSPARENT
    };
    ui.painter().rect_filled(rect, 4.0, fill);
    let square =
        Rect::from_center_size(rect.left_center() + Vec2::new(14.0, 0.0), Vec2::splat(18.0));
    ui.painter().rect_filled(square, 3.0, c.class(Some(place)));
    let font = egui::FontId::proportional(12.0);
    ui.painter().text(
        square.center(),
        egui::Align2::CENTER_CENTER,
        state.classes.key_of(place),
        font,
        c.text_on(c.class(Some(place))),
    );
    let info = state
        .store
        .as_ref()
        .and_then(|s| s.snapshot.classes.iter().find(|i| i.name == name));
    let count = match info {
        Some(i) if i.proposed > 0 => format!("{} + {}?", i.accepted, i.proposed),
        Some(i) => i.accepted.to_string(),
        None => "new".to_owned(),
    };
    let inner = rect.shrink2(Vec2::new(6.0, 0.0));
    let text = Rect::from_min_max(
        egui::pos2(square.right() + 8.0, inner.top()),
        egui::pos2(inner.right() - 44.0, inner.bottom()),
    );
    widgets::text_in(ui, text, name, 13.5, c.text, false);
    widgets::text_in(ui, inner, &count, 12.0, c.muted, true);
    let response = response.on_hover_text("Click labels the selected stretch, or changes the selected label. Right click renames, removes.");
    if list.row(ui, at, &response, false) {
        let command = match state.timeline.range {
            Some(_) => Command::Timeline(TimelineCommand::LabelRange(name.to_owned())),
            None => Command::Classes(ClassCommand::Key {
                slot: place,
                down: true,
            }),
        };
        out.push(command);
        out.push(Command::Classes(ClassCommand::Key {
            slot: place,
            down: false,
        }));
    }
    carried::accept(ui, &response, name, out);
    response.context_menu(|ui| {
        if ui.button("Rename").clicked() {
            let now = Some((name.to_owned(), name.to_owned()));
            out.push(Command::Classes(ClassCommand::Renaming(now)));
            ui.close();
        }
        ui.menu_button("Give it the key …", |ui| {
            for key in 0..9 {
                let whose = state.classes.at(key).unwrap_or("free");
                if ui.button(format!("{}  {whose}", key + 1)).clicked() {
                    let (class, place) = (name.to_owned(), key);
                    let command = ClassCommand::GiveKey { class, place };
                    out.push(Command::Classes(command));
                    ui.close();
                }
            }
        });
        if ui.button("Give it the key Q").clicked() {
            out.push(Command::Classes(ClassCommand::Choose(name.to_owned())));
            ui.close();
        }
        ui.menu_button("Merge into …", |ui| {
            // Of many classes the list is higher than the window.
            let height = 0.6 * ui.ctx().content_rect().height();
            ScrollArea::vertical().max_height(height).show(ui, |ui| {
                for into in state.classes.order.iter().filter(|into| *into != name) {
                    if ui.button(into).clicked() {
                        let (from, into) = (name.to_owned(), into.clone());
                        out.push(Command::Classes(ClassCommand::Merge { from, into }));
                        ui.close();
                    }
                }
            });
        });
        if ui.button("Export its labels as clips …").clicked() {
            let class = name.to_owned();
            out.push(Command::File(FileCommand::AskExportClass(class)));
            ui.close();
        }
        let background = ui.button("Mark as background");
        let hint = "Removes the class and its labels; clips without other labels become background";
        if background.on_hover_text(hint).clicked() {
            out.push(Command::Classes(ClassCommand::IsBackground(
                name.to_owned(),
            )));
            ui.close();
        }
        if ui.button("Remove the class and its labels").clicked() {
            out.push(Command::Classes(ClassCommand::Remove(name.to_owned())));
            ui.close();
        }
    });
}

fn add_class(ui: &mut Ui, state: &State, out: Out) {
    ui.horizontal(|ui| {
        let mut text = state.classes.adding.clone();
        let width = ui.available_width() - 62.0;
        let response = ui.add(
            widgets::line(&mut text)
                .hint_text("New class …")
                .desired_width(width),
        );
        response.widget_info(|| {
            let mut info = egui::WidgetInfo::labeled(WidgetType::TextEdit, true, "New class");
            info.current_text_value = Some(state.classes.adding.clone());
            info
        });
        let entered = widgets::entered(ui, &response);
        let add = ui
            .add_enabled(!text.trim().is_empty(), Button::new("Add"))
            .clicked();
        if text != state.classes.adding {
            out.push(Command::Classes(ClassCommand::Adding(text.clone())));
        }
        if entered || add {
            out.push(Command::Classes(ClassCommand::Add(text)));
        }
    });
}

/// The selection and its actions.
fn selection(ui: &mut Ui, state: &State, out: Out) {
    let c = Colours::now(ui);
    let selected = state.selected();
    if state.timeline.range.is_some() {
        return stretch(ui, state, out);
    }
    let timeline = |out: Out, command| out.push(Command::Timeline(command));
    let [sample] = selected[..] else {
        if selected.len() > 1 {
            widgets::section(ui, "SELECTED LABELS");
            ui.label(format::count(selected.len(), "label"));
            ui.horizontal(|ui| {
                if ui.button("Merge").clicked() {
                    timeline(out, TimelineCommand::Merge);
                }
                if ui.button("Remove").clicked() {
                    timeline(out, TimelineCommand::Remove);
                }
            });
        }
        return;
    };
    widgets::section(ui, "SELECTED LABEL");
    let (start, stop) = (sample.start_secs, sample.stop_secs);
    ui.label(RichText::new(&sample.class).strong());
    ui.label(format!(
        "{} to {}, {:.2} s",
        format::secs(start),
        format::secs(stop),
        stop - start
    ));
    if !sample.annotators.is_empty() {
        let names = sample.annotators.join(", ");
        ui.colored_label(c.muted, format!("By {names}"));
    }
    like_this(ui, out);
    if sample.state == Judged::Proposed {
        let score = sample
            .score
            .map_or_else(String::new, |s| format!(", score {s:.2}"));
        ui.colored_label(c.muted, format!("Proposed{score}"));
        ui.horizontal(|ui| {
            if ui.button("Accept  A").clicked() {
                out.push(Command::Classes(ClassCommand::Accept(sample.id)));
            }
            if ui.button("Reject  R").clicked() {
                out.push(Command::Classes(ClassCommand::Reject(sample.id)));
            }
        });
        return;
    }
    ui.horizontal(|ui| {
        if ui.button("Split  S").clicked() {
            timeline(out, TimelineCommand::Split);
        }
        if ui.button("Remove").clicked() {
            timeline(out, TimelineCommand::Remove);
        }
    });
}

/// The selected stretch and its actions.
pub(super) fn stretch(ui: &mut Ui, state: &State, out: Out) {
    let Some((start, stop)) = state.timeline.range else {
        return;
    };
    widgets::section(ui, "SELECTED STRETCH");
    ui.label(format!("{} to {}", format::secs(start), format::secs(stop)));
    let hint = "Press a class's key or click a class to label it, playing or not. Escape ends the selection.";
    ui.colored_label(Colours::now(ui).muted, hint);
    like_this(ui, out);
}

/// Numbers of principal components to compare a motion with.
const COMPONENTS: [usize; 5] = [1, 2, 4, 8, 16];

/// Buttons that search for what is like the selection and compare it with the nearest.
pub(super) fn like_this(ui: &mut Ui, out: Out) {
    ui.horizontal_wrapped(|ui| {
        if ui
            .button("More like this  F")
            .on_hover_text("Search all clips for similar motions, mirrored ones too if chosen")
            .clicked()
        {
            out.push(Command::Similar(SimilarCommand::OfSelection));
        }
        if ui
            .button("Compare  C")
            .on_hover_text("Show the most similar motion beside the performer, aligned in time")
            .clicked()
        {
            out.push(Command::Compare(CompareCommand::Nearest));
        }
        let reduced = ui.menu_button("Reduced", |ui| {
            for dims in COMPONENTS {
                if ui.button(format::count(dims, "component")).clicked() {
                    out.push(Command::Compare(CompareCommand::Reduced(dims)));
                }
            }
        });
        let hint = "Show the motion rebuilt from a few principal components of its poses beside the performer";
        reduced.response.on_hover_text(hint);
    });
}

fn help(ui: &mut Ui, state: &State, out: Out) {
    let c = Colours::now(ui);
    let Some(store) = &state.store else { return };
    if store.snapshot.accepted().next().is_none() {
        widgets::section(ui, "FIRST LABELS");
        ui.colored_label(c.muted, "Play with Space. Hold 1 while the first gesture is performed, 2 for the second. Two or three \
            labels of each are enough to begin with; then train.");
        return;
    }
    widgets::section(ui, "MORE LIKE THESE");
    ui.horizontal_wrapped(|ui| {
        if ui
            .button("Propose")
            .on_hover_text("Search all clips for more samples of the labelled classes")
            .clicked()
        {
            out.push(Command::Classes(ClassCommand::Propose));
        }
        if ui.button("Next doubtful  N").clicked() {
            out.push(Command::Classes(ClassCommand::NextDoubtful));
        }
    });
    ui.horizontal_wrapped(|ui| proposals::at_once(ui, state, out));
}
