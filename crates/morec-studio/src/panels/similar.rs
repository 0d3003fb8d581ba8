//! More like this: what is like an example, nearest first; each plays, stands beside the example, or becomes a label.

use egui::{Rect, RichText, ScrollArea, Sense, Ui, Vec2, WidgetType};
use morec_db::search::Hit;

use super::strips::{STRIP, go};
use super::{Out, strips, widgets};
use crate::format;
use crate::jobs::similar::Similar;
use crate::lists::List;
use crate::state::classes::LIKELY;
use crate::state::{Command, CompareCommand, SimilarCommand, State};
use crate::stretch::Stretch;
use crate::theme::Colours;

const WIDTH: f32 = 236.0;
const CARD: f32 = STRIP + 48.0;

/// Title and options above the cards.
pub fn tools(ui: &mut Ui, state: &State, similar: &Similar, out: Out) {
    let c = Colours::now(ui);
    let name = state
        .store
        .as_ref()
        .and_then(|s| s.snapshot.clip(similar.of.clip))
        .map_or("?", |clip| clip.name.as_str());
    let what = similar.class.as_deref().unwrap_or("this");
    let text = format!(
        "Like {what} in {name}, {} to {}",
        format::secs(similar.of.span.start_secs),
        format::secs(similar.of.span.stop_secs)
    );
    ui.label(RichText::new(text).strong());
    let mut mirror = state.classes.mirror;
    if ui.checkbox(&mut mirror, "Mirror image too").changed() {
        out.push(Command::Similar(SimilarCommand::Mirror(mirror)));
    }
    if ui.button("Back to classes").clicked() {
        out.push(Command::Similar(SimilarCommand::Close));
    }
    at_once(ui, state, similar, out);
    let count = format::count(similar.hits.len(), "stretch");
    let text = match similar.mirror {
        true => format!("{count}, original and mirrored"),
        false => count,
    };
    ui.colored_label(c.muted, text);
}

/// All hits that are like enough become labels of a class.
fn at_once(ui: &mut Ui, state: &State, similar: &Similar, out: Out) {
    if similar.hits.is_empty() {
        return;
    }
    let mut alike = state.classes.alike.unwrap_or(LIKELY);
    ui.spacing_mut().slider_width = 90.0;
    let response = ui.add(egui::Slider::new(&mut alike, 1..=100).suffix(" %"));
    widgets::named(&response, WidgetType::Slider, "Similarity of hits", false);
    if response.changed() {
        out.push(Command::Similar(SimilarCommand::Alike(alike)));
    }
    let count = state.alike_at_once().len();
    let mut all_are = |class: &str| {
        let command = SimilarCommand::LabelAll(class.to_owned());
        out.push(Command::Similar(command));
    };
    ui.add_enabled_ui(count > 0, |ui| match &similar.class {
        Some(class) => {
            if ui
                .button(format!("All {count} above are {class}"))
                .clicked()
            {
                all_are(class);
            }
        }
        None => {
            ui.menu_button(format!("All {count} above are …"), |ui| {
                for class in &state.classes.order {
                    if ui.button(class).clicked() {
                        all_are(class);
                        ui.close();
                    }
                }
                if ui.button("New class").clicked() {
                    all_are(&state.classes.free_name());
                    ui.close();
                }
            });
        }
    });
}

/// The cards, in as many columns as there is room for.
pub fn show(ui: &mut Ui, state: &State, similar: &Similar, out: Out) {
    if similar.hits.is_empty() {
        widgets::nothing(
            ui,
            "No other motion like it",
            "What is like it has labels already, or more clips must be imported.",
        );
        return;
    }
    let columns = ((ui.available_width() / (WIDTH + 8.0)).floor() as usize).max(1);
    let rows = similar.hits.len().div_ceil(columns);
    ScrollArea::vertical()
        .auto_shrink(false)
        .show_rows(ui, CARD, rows, |ui, rows| {
            let list = List::main(ui, "hits", similar.hits.len(), columns, 0);
            let line = list.wanted.map(|at| at / columns);
            list.scroll(ui, line, rows.start, CARD);
            for row in rows {
                ui.horizontal(|ui| {
                    let first = row * columns;
                    let last = (first + columns).min(similar.hits.len());
                    for at in first..last {
                        card(ui, state, similar, (&list, at), out);
                    }
                });
            }
        });
}

fn card(ui: &mut Ui, state: &State, similar: &Similar, (list, at): (&List, usize), out: Out) {
    let c = Colours::now(ui);
    let hit: &Hit = &similar.hits[at];
    let (rect, _) = ui.allocate_exact_size(Vec2::new(WIDTH, CARD), Sense::hover());
    let picture = Rect::from_min_size(rect.min, Vec2::new(WIDTH, STRIP));
    let response = ui.interact(picture, ui.id().with(("hit", at)), Sense::click());
    let clip = state.store.as_ref().and_then(|s| s.snapshot.clip(hit.clip));
    let name = clip.map_or("?", |clip| clip.name.as_str());
    let image = if hit.mirrored { ", mirrored" } else { "" };
    widgets::named(
        &response,
        WidgetType::Button,
        format!("Like it: {name} at {:.2} s{image}", hit.span.start_secs),
        false,
    );
    strips::draw(ui, state, hit.into(), picture);
    let caption = Rect::from_min_size(picture.left_bottom(), Vec2::new(WIDTH, 18.0));
    let text = format!("{name}  {}{image}", format::secs(hit.span.start_secs));
    widgets::text_in(ui, caption, &text, 11.5, c.muted, false);
    let score = format!("{:.0} %", 100.0 * hit.score);
    widgets::text_in(ui, caption, &score, 11.5, c.text, true);
    let on = state.is_selected_stretch(hit.into());
    if on {
        widgets::selected_frame(ui, picture);
    }
    if list.row(ui, at, &response, on) {
        go(hit.into(), None, out);
    }
    let area = Rect::from_min_max(caption.left_bottom(), rect.max);
    let mut below = ui.new_child(egui::UiBuilder::new().max_rect(area));
    below.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        ui.style_mut().override_text_style = Some(egui::TextStyle::Small);
        let stretch = Stretch::from(hit);
        let compare = ui.button("Compare");
        widgets::named(
            &compare,
            WidgetType::Button,
            format!("Compare with hit {}", at + 1),
            false,
        );
        if compare
            .on_hover_text("Beside the example, aligned in time")
            .clicked()
        {
            out.push(Command::Compare(CompareCommand::With {
                of: similar.of,
                with: stretch,
                mirrored: hit.mirrored,
            }));
        }
        let more = ui.button("More");
        widgets::named(
            &more,
            WidgetType::Button,
            format!("More like hit {}", at + 1),
            false,
        );
        if more
            .on_hover_text("Search for motions like this hit")
            .clicked()
        {
            let class = similar.class.clone();
            out.push(Command::Similar(SimilarCommand::Of(stretch, class)));
        }
        label(ui, state, similar, at, out);
    });
}

/// The hit becomes a label: of the example's class by one click, of another by two.
fn label(ui: &mut Ui, state: &State, similar: &Similar, at: usize, out: Out) {
    let mut as_class = |class: &str| {
        let command = SimilarCommand::Label(at, class.to_owned());
        out.push(Command::Similar(command));
    };
    if let Some(class) = &similar.class {
        let response = ui.button(format!("Is {class}"));
        widgets::named(
            &response,
            WidgetType::Button,
            format!("Hit {} is {class}", at + 1),
            false,
        );
        if response.clicked() {
            as_class(class);
        }
    }
    let menu = ui.menu_button("Is …", |ui| {
        for class in &state.classes.order {
            if ui.button(class).clicked() {
                as_class(class);
                ui.close();
            }
        }
        let hint = "Make a class of these hits, which you can rename";
        if ui.button("New class").on_hover_text(hint).clicked() {
            as_class(&state.classes.free_name());
            ui.close();
        }
    });
    let name = format!("Hit {} is …", at + 1);
    widgets::named(&menu.response, WidgetType::Button, name, false);
}
