//! What a class is, a gesture or an activity, and why; a menu overrules it.

use egui::{Ui, WidgetType};
use morec::train::{ClassKind, TrainParams};

use super::{Out, widgets};
use crate::state::{Command, State, TrainCommand};

/// A kind's name, and with its article.
fn words(kind: ClassKind) -> (&'static str, &'static str) {
    match kind {
        ClassKind::Gesture => ("gesture", "a gesture"),
        ClassKind::Activity => ("activity", "an activity"),
    }
}

/// The kind of `class` with its reason, and a menu for another.
pub fn choose(ui: &mut Ui, state: &State, class: &String, out: Out) {
    let chosen = state.train.kind(class);
    let snapshot = state.store.as_ref().map(|store| &store.snapshot);
    let labels = snapshot.and_then(|snapshot| snapshot.labels().get(class));
    let labels = labels.copied().unwrap_or_default();
    let usual = TrainParams::default().kind(class, &labels);
    let (name, with_article) = words(chosen.unwrap_or(usual));
    let (text, why) = match chosen {
        Some(_) => (format!("{name} ✔"), "chosen by you".to_owned()),
        None => (name.to_owned(), labels.reason()),
    };
    let menu = ui.menu_button(text, |ui| {
        let by_labels = format!("By its labels: {}", words(usual).1);
        let always = |kind| (Some(kind), format!("Always {}", words(kind).1));
        let kinds = [
            (None, by_labels),
            always(ClassKind::Gesture),
            always(ClassKind::Activity),
        ];
        for (kind, text) in kinds {
            if ui.selectable_label(kind == chosen, text).clicked() {
                let class = class.to_owned();
                out.push(Command::Train(TrainCommand::Kind { class, kind }));
                ui.close();
            }
        }
    });
    let named = format!("{class} is {with_article}: {why}");
    widgets::named(&menu.response, WidgetType::Button, &named, false);
    menu.response.on_hover_text(format!(
        "{named}. An activity is continuous: it is recognised by windows of a few seconds, and its repetitions are counted. A \
         gesture has a beginning and an end."
    ));
}
