//! Groups of what is alike, at the depth that the slider says.

use egui::{Button, Rect, RichText, ScrollArea, Sense, Ui, Vec2, WidgetType};

use super::strips::{STRIP, go};
use morec_db::labels::SampleState;

use super::carried::Carried;
use super::{Out, strips, widgets};
use crate::format;
use crate::jobs::group::GroupItem;
use crate::state::{ClassCommand, Command, State};
use crate::theme::Colours;

/// The groups at the depth that the slider says.
pub fn show(ui: &mut Ui, state: &State, out: Out) {
    let Some(groups) = &state.classes.groups else {
        return;
    };
    let c = Colours::now(ui);
    let key = egui::Id::new(("groups", state.classes.grouping, state.classes.depth));
    let all = ui
        .data(|d| d.get_temp::<std::sync::Arc<Vec<crate::jobs::group::Group>>>(key))
        .unwrap_or_else(|| {
            let made = std::sync::Arc::new(groups.at(state.classes.depth));
            ui.data_mut(|d| d.insert_temp(key, made.clone()));
            made
        });
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        for (number, group) in all.iter().enumerate() {
            ui.horizontal(|ui| {
                ui.label(RichText::new(format!("Group {}", number + 1)).strong());
                ui.colored_label(c.muted, format::count(group.members.len(), "stretch"));
                let id = ui.id().with(("name", number));
                let mut name = ui.data(|d| d.get_temp::<String>(id)).unwrap_or_default();
                let edit = ui.add(
                    widgets::line(&mut name)
                        .hint_text("name …")
                        .desired_width(110.0),
                );
                edit.widget_info(|| {
                    let mut info = egui::WidgetInfo::labeled(
                        WidgetType::TextEdit,
                        true,
                        format!("Name of group {}", number + 1),
                    );
                    info.current_text_value = Some(name.clone());
                    info
                });
                let named = !name.trim().is_empty();
                if ui
                    .add_enabled(named, Button::new("Make it a class").small())
                    .clicked()
                {
                    let (group, name) = (number, name.clone());
                    out.push(Command::Classes(ClassCommand::NameGroup { group, name }));
                }
                ui.data_mut(|d| d.insert_temp(id, name));
            });
            ScrollArea::horizontal()
                .id_salt(("group", number))
                .show(ui, |ui| {
                    ui.horizontal(|ui| {
                        for &member in group.members.iter().take(24) {
                            let item = &groups.items[member];
                            let size = Vec2::new(150.0, STRIP);
                            let (rect, response) =
                                ui.allocate_exact_size(size, Sense::click_and_drag());
                            widgets::named(
                                &response,
                                WidgetType::Button,
                                format!("Stretch {member} of group {}", number + 1),
                                false,
                            );
                            strips::draw(ui, state, item.of, rect);
                            if let Some(class) = class_now(state, item) {
                                let place = state.classes.place(class);
                                let mark =
                                    Rect::from_min_size(rect.min, Vec2::new(rect.width(), 3.0));
                                ui.painter().rect_filled(mark, 1.0, c.class(place));
                            }
                            if response.drag_started() {
                                response.dnd_set_drag_payload(carried(item));
                            }
                            if response.clicked() {
                                go(item.of, item.sample, out);
                            }
                        }
                        if group.members.len() > 24 {
                            ui.colored_label(
                                c.muted,
                                format!("and {} more", group.members.len() - 24),
                            );
                        }
                    });
                });
            ui.add_space(6.0);
        }
    });
}

/// A stretch of a group, to be dragged into a class.
fn carried(item: &GroupItem) -> Carried {
    match item.sample {
        Some(id) => Carried::Sample(id),
        None => Carried::Stretch(item.of),
    }
}

/// The class that a stretch has now: since it was grouped it may have been given another.
fn class_now<'a>(state: &'a State, item: &GroupItem) -> Option<&'a str> {
    let snapshot = &state.store.as_ref()?.snapshot;
    let sample = match item.sample {
        Some(id) => snapshot.sample(id),
        None => snapshot
            .samples_of(item.of.clip)
            .iter()
            .find(|s| s.state != SampleState::Rejected && s.span().is_near(item.of.span, 0.02))
            .map(|s| &**s),
    };
    Some(sample?.class.as_str())
}
