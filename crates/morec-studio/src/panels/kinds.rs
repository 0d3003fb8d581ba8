//! What a class is, a gesture or an activity, and why; a menu overrules it.

use egui::{Ui, WidgetType};
use morec::train::{ClassKind, ClassLabels, TrainParams};
use morec_db::labels::{DbSample, SampleState};

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
pub fn choose(ui: &mut Ui, state: &State, class: &str, out: Out) {
    let chosen = state.train.kinds.get(class).copied();
    let labels = labels_of(state, class);
    let usual = TrainParams::default().kind(class, &labels);
    let (name, with_article) = words(chosen.unwrap_or(usual));
    let (text, why) = match chosen {
        Some(_) => (format!("{name} ✔"), "so it was chosen".to_owned()),
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
        "{named}. An activity goes on: a window of a few seconds tells what it is, and its repetitions are counted. A gesture has a \
         beginning and an end."
    ));
}

/// What the accepted labels of a class say of it.
fn labels_of(state: &State, class: &str) -> ClassLabels {
    let mut labels = ClassLabels::default();
    let Some(snapshot) = state.store.as_ref().map(|store| &store.snapshot) else {
        return labels;
    };
    let secs = |s: &DbSample| s.start_secs..s.stop_secs;
    for label in snapshot.accepted().filter(|s| s.class == class) {
        let of_clip = snapshot.samples_of(label.clip).iter();
        let accepted = of_clip.filter(|s| s.state == SampleState::Accepted);
        let clip = snapshot.clip(label.clip);
        let clip_secs = clip.map_or(f64::MAX, |clip| clip.duration_secs());
        labels.add(&secs(label), accepted.map(secs), clip_secs);
    }
    labels
}
