//! Groups of what is alike, and where they end.

use std::sync::Arc;

use egui::{Button, Rect, RichText, ScrollArea, Sense, Ui, Vec2, WidgetType};
use morec::cluster::KwasParams;
use morec_ops::{GroupMethod, Grouping};

use super::strips::{STRIP, go};
use crate::lists::List;
use morec_db::labels::SampleState;

use super::carried::Carried;
use super::{Out, strips, widgets};
use crate::format;
use crate::jobs::group::{ClusteredItems, Group, GroupItem};
use crate::state::{ClassCommand, Command, State};
use crate::theme::Colours;

/// The groups and their stretches.
pub fn show(ui: &mut Ui, state: &State, out: Out) {
    let Some(groups) = &state.classes.groups else {
        return;
    };
    let c = Colours::now(ui);
    let all = made(ui, state, groups);
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        let list = List::main(ui, "groups", all.len(), 1, 0);
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
                branch(ui, groups, group, number, out);
            });
            ScrollArea::horizontal()
                .id_salt(("group", number))
                .show(ui, |ui| {
                    ui.horizontal(|ui| {
                        for (place, &member) in group.members.iter().take(24).enumerate() {
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
                            // The list goes from group to group.
                            let chosen = match place {
                                0 => list.row(
                                    ui,
                                    number,
                                    &response,
                                    state.is_selected_stretch(item.of),
                                ),
                                _ => response.clicked(),
                            };
                            if chosen {
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

/// The groups, made once for each place where they end.
fn made(ui: &Ui, state: &State, groups: &ClusteredItems) -> Arc<Vec<Group>> {
    let key = egui::Id::new("groups");
    let at = state.classes.grouping;
    let known = ui.data(|d| d.get_temp::<(u64, Arc<Vec<Group>>)>(key));
    match known.filter(|(of, _)| *of == at) {
        Some((_, known)) => known,
        None => {
            let made = Arc::new(groups.at(&state.classes.depth));
            ui.data_mut(|d| d.insert_temp(key, (at, made.clone())));
            made
        }
    }
}

/// Buttons that take one branch of a hierarchy a step down or up.
fn branch(ui: &mut Ui, groups: &ClusteredItems, group: &Group, number: usize, out: Out) {
    let Some((nodes, node)) = groups.nodes().zip(group.node) else {
        return;
    };
    let (divides, joins) = nodes.goes_on(node);
    let steps = [
        (
            "Divide",
            divides,
            "Divide this group in two",
            ClassCommand::Divide(node),
        ),
        (
            "Join",
            joins,
            "Join this group with its sibling",
            ClassCommand::Join(node),
        ),
    ];
    for (text, on, hint, command) in steps {
        let response = ui.add_enabled(on, Button::new(text).small());
        let name = format!("{text} group {}", number + 1);
        response.widget_info(|| egui::WidgetInfo::labeled(WidgetType::Button, on, &name));
        if response.on_hover_text(hint).clicked() {
            out.push(Command::Classes(command));
        }
    }
}

/// How the stretches are grouped, where groups end, and how far they agree with the classes.
pub fn tools(ui: &mut Ui, state: &State, groups: &ClusteredItems, out: Out) {
    let c = Colours::now(ui);
    let mut class = |command| out.push(Command::Classes(command));
    ui.label(RichText::new("Groups").strong());
    let cuts = groups.settings.of == Some(Grouping::Cuts);
    for (method, name, hint) in METHODS {
        let on = groups.settings.method == method;
        if ui.selectable_label(on, name).on_hover_text(hint).clicked() && !on {
            class(ClassCommand::Group { cuts, method });
        }
    }
    match groups.settings.method {
        GroupMethod::Kwas => kwas(ui, &state.classes.depth.kwas, &mut class),
        _ => depth(ui, state, groups, &mut class),
    }
    let made = made(ui, state, groups);
    let mut said = format!(
        "{} of {}, outliers first",
        format::count(made.len(), "group"),
        format::count(groups.items.len(), "stretch")
    );
    if let Some((rand, adjusted)) = groups.agreement(&made) {
        said += &format!("; against the classes: Rand index {rand:.3}, adjusted {adjusted:.3}");
    }
    ui.colored_label(c.muted, said);
    if groups.left_out > 0 {
        ui.colored_label(c.warn, format!("{} left out", groups.left_out));
    }
    if ui.button("Back to classes").clicked() {
        class(ClassCommand::CloseGroups);
    }
}

const METHODS: [(GroupMethod, &str, &str); 3] = [
    (
        GroupMethod::Hierarchy,
        "Hierarchy",
        "Average linkage over evenly resampled motion",
    ),
    (
        GroupMethod::Kwas,
        "kWAS",
        "Principal directions of poses (kWAS, thesis of 2009); needs joint rotations",
    ),
    (
        GroupMethod::Tree,
        "Tree of samples",
        "Tree of the classifier of 2009, with each stretch as a class; needs joint rotations",
    ),
];

fn depth(
    ui: &mut Ui,
    state: &State,
    groups: &ClusteredItems,
    class: &mut impl FnMut(ClassCommand),
) {
    let most = groups.items.len().clamp(2, 60);
    let mut depth = state.classes.depth.groups.min(most);
    ui.spacing_mut().slider_width = 220.0;
    let response = ui.add(egui::Slider::new(&mut depth, 1..=most));
    widgets::named(&response, WidgetType::Slider, "Number of groups", false);
    if response.changed() {
        class(ClassCommand::Depth(depth));
    }
}

/// The thesis's own: τ near 1 where much is alike, and directions.
fn kwas(ui: &mut Ui, now: &KwasParams, class: &mut impl FnMut(ClassCommand)) {
    let mut next = *now;
    let tau = egui::DragValue::new(&mut next.tau)
        .range(0.0..=1.0)
        .speed(0.001);
    ui.label("τ");
    let tau = ui.add(tau.max_decimals(3));
    widgets::named(&tau, WidgetType::DragValue, "Similarity τ", false);
    let hint = "Two stretches are linked if their similarity is above this";
    let tau = tau.on_hover_text(hint);
    ui.label("k");
    let k = ui.add(egui::DragValue::new(&mut next.k).range(1..=64).speed(0.1));
    widgets::named(&k, WidgetType::DragValue, "Directions k", false);
    let k = k.on_hover_text("Number of principal directions compared");
    if tau.changed() || k.changed() {
        class(ClassCommand::Kwas(next));
    }
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
