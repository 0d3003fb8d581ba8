//! Training: what is learned, how it went, how good it is on what it was not taught.

use egui::{CentralPanel, ComboBox, RichText, ScrollArea, SidePanel, Ui, WidgetType};

use super::widgets::Clipped;
use super::{
    Out, background, kinds, learning_curve, matrix, moments, padded, reports, thesis, view, widgets,
};
use crate::lists::List;
use morec::features::BoneSet;
use morec_ops::training_in_words;

use crate::format;
use crate::jobs::judge::only_part;
use crate::state::{Command, CrossvalView, FileCommand, State, TrainCommand};
use crate::theme::Colours;

pub fn show(ui: &mut Ui, state: &State, out: Out) {
    SidePanel::left("what to learn")
        .frame(padded())
        .default_width(220.0)
        .width_range(180.0..=320.0)
        .show_clipped(ui, |ui| {
            // Above the lists, which scroll when there are many classes.
            buttons(ui, state, out);
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                choose(ui, state, out);
                indexes(ui, state, out);
                reports::list(ui, state, out);
            });
        });
    SidePanel::right("the moment")
        .frame(padded())
        .default_width(340.0)
        .width_range(280.0..=620.0)
        .show_clipped(ui, |ui| {
            let height = (0.52 * ui.available_height()).clamp(160.0, 420.0);
            view::clip_over_transport(ui, state, height, out);
            moments::show(ui, state, out);
        });
    CentralPanel::default()
        .frame(padded())
        .show_clipped(ui, |ui| {
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                // An index of the method of 2009 comes after its tree, which says more.
                let index = state.train.index.as_ref();
                let of_2009 = index.is_some_and(|index| index.model.needs_rotations());
                let first = of_2009 && state.train.thesis.is_some();
                if first {
                    thesis::show(ui, state, out);
                    ui.add_space(14.0);
                }
                learning_curve::show(ui, state, out);
                reports::opened(ui, state, out);
                let train = &state.train;
                let nothing = train.index.is_none() && train.judged.is_none();
                if nothing
                    && train.curve.is_none()
                    && state.train.thesis.is_none()
                    && state.train.opened.is_none()
                {
                    widgets::nothing(ui, "No index yet", "Choose classes at the left and train.");
                } else {
                    trained(ui, state, out);
                    matrix::show(ui, state, out);
                }
                if !first {
                    thesis::show(ui, state, out);
                }
            });
        });
}

fn buttons(ui: &mut Ui, state: &State, out: Out) {
    let c = Colours::now(ui);
    if state.store.is_none() {
        return;
    }
    let label = if state.is_training() {
        "Training …"
    } else {
        "Train"
    };
    let button = widgets::main_button(label, &c);
    let response = widgets::wide(ui, !state.is_training(), button, 30.0);
    widgets::named(&response, egui::WidgetType::Button, "Start training", false);
    if response.clicked() {
        out.push(Command::Train(TrainCommand::Train));
    }
    let label = if state.is_judging() {
        "Judging …"
    } else {
        "Cross-validate"
    };
    let response = widgets::wide(ui, !state.is_judging(), egui::Button::new(label), 26.0);
    if response
        .on_hover_text("Leave out each person in turn, train without this person, and count what is recognised")
        .clicked()
    {
        out.push(Command::Train(TrainCommand::Judge));
    }
    learning_curve::button(ui, state, out);
    ui.add_space(4.0);
}

fn choose(ui: &mut Ui, state: &State, out: Out) {
    let c = Colours::now(ui);
    let Some(store) = &state.store else { return };
    widgets::section(ui, "LEARN");
    if store.snapshot.classes.is_empty() {
        ui.colored_label(c.muted, "No class has a label yet.");
    }
    let list = List::new(ui, "learn", store.snapshot.classes.len());
    for (at, class) in store.snapshot.classes.iter().enumerate() {
        let mut on = !state.train.without.contains(&class.name);
        ui.horizontal(|ui| {
            let tick = ui.checkbox(&mut on, &class.name);
            list.row(ui, at, &tick, false);
            if tick.changed() {
                let class = class.name.clone();
                out.push(Command::Train(TrainCommand::Choose { class, on }));
            }
            let colour = if class.accepted < 3 { c.warn } else { c.muted };
            ui.colored_label(colour, class.accepted.to_string());
            kinds::choose(ui, state, &class.name, out);
        });
    }
    parts(ui, state, out);
    background::list(ui, state, out);
    teach_next(ui, state);
}

/// The parts of the body that count.
fn parts(ui: &mut Ui, state: &State, out: Out) {
    let chosen = state.train.settings.bones;
    ui.horizontal(|ui| {
        ui.label("Parts");
        let name = |bones: BoneSet| bones.to_string().replace('_', " ");
        let combo = ComboBox::from_id_salt("parts").selected_text(name(chosen));
        let combo = combo.show_ui(ui, |ui| {
            for (_, bones) in BoneSet::NAMED {
                if ui.selectable_label(bones == chosen, name(bones)).clicked() {
                    out.push(Command::Train(TrainCommand::Parts(bones)));
                }
            }
        });
        widgets::named(&combo.response, WidgetType::ComboBox, "Body parts to use", false);
        combo.response.on_hover_text(
            "Body parts that are compared. All: the body, or the hands if the clips contain nothing else",
        );
    });
}

/// Hints about the labels that would help most.
fn teach_next(ui: &mut Ui, state: &State) {
    let Some(store) = &state.store else { return };
    let c = Colours::now(ui);
    let mut hints = Vec::new();
    for class in store.snapshot.classes.iter().filter(|k| k.accepted < 3) {
        hints.push(format!(
            "{}: {}, add labels until there are at least three",
            class.name,
            format::count(class.accepted, "label")
        ));
    }
    if let Some(judged) = &state.train.judged {
        let mut worst: Vec<_> = judged
            .evaluation
            .classes
            .iter()
            .filter(|k| k.missed > 0 && k.samples > 0)
            .collect();
        worst.sort_by(|a, b| (b.missed * a.samples).cmp(&(a.missed * b.samples)));
        for class in worst.iter().take(3) {
            hints.push(format!(
                "{}: {} of {} missed, add labels of other people",
                class.class, class.missed, class.samples
            ));
        }
        for class in &judged.untested {
            hints.push(format!(
                "{class}: labels of {} only, add labels of another person",
                only_part(judged.by)
            ));
        }
        if let Some(hint) = unlabelled(judged) {
            hints.push(hint);
        }
    }
    if hints.is_empty() {
        return;
    }
    ui.add_space(8.0);
    widgets::section(ui, "WHAT TO ADD NEXT");
    for hint in hints.iter().take(5) {
        ui.label(RichText::new(hint).size(12.0).color(c.muted));
    }
}

/// A hint at detections where nothing is labelled, which may be right.
fn unlabelled(judged: &CrossvalView) -> Option<String> {
    let found = judged.false_detections();
    (found > 0).then(|| {
        format!(
            "{} in unlabelled motion: check them, and label those that are right",
            format::count(found, "detection")
        )
    })
}

fn indexes(ui: &mut Ui, state: &State, out: Out) {
    let Some(store) = &state.store else { return };
    let c = Colours::now(ui);
    ui.add_space(8.0);
    widgets::section(ui, "INDEXES IN THE DATABASE");
    if store.snapshot.indexes.is_empty() {
        ui.colored_label(c.muted, "No index is stored yet.");
    }
    let list = List::new(ui, "indexes", store.snapshot.indexes.len());
    for (at, index) in store.snapshot.indexes.iter().enumerate() {
        ui.horizontal(|ui| {
            let response = ui.small_button("Use");
            let name = format!("Use {}", index.name);
            widgets::named(&response, egui::WidgetType::Button, name, false);
            if list.row(ui, at, &response, false) {
                out.push(Command::Train(TrainCommand::UseIndex(index.name.clone())));
            }
            ui.label(&index.name);
            let text = if store.snapshot.is_stale(index) {
                "labels or background have changed since"
            } else {
                "up to date"
            };
            ui.label(RichText::new(text).size(11.0).color(c.muted));
        });
    }
    let trained = !state.train.bytes.is_empty();
    ui.horizontal(|ui| {
        if ui.add_enabled(trained, egui::Button::new("Keep")).clicked() {
            out.push(Command::Train(TrainCommand::Keep("studio".to_owned())));
        }
        if ui
            .add_enabled(trained, egui::Button::new("Export …"))
            .clicked()
        {
            out.push(Command::File(FileCommand::AskExportIndex));
        }
    });
}

fn trained(ui: &mut Ui, state: &State, out: Out) {
    let c = Colours::now(ui);
    let Some(index) = &state.train.index else {
        return;
    };
    widgets::boxed(ui, |ui| {
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing.x = 26.0;
            widgets::figure(ui, index.model.classes().len().to_string(), "classes");
            widgets::figure(ui, index.provenance.samples.to_string(), "labels");
            widgets::figure(ui, index.provenance.clips.len().to_string(), "clips");
            widgets::figure(
                ui,
                format!("{} kB", state.train.bytes.len().div_ceil(1024)),
                "index",
            );
            if state.train.report.is_some() {
                widgets::figure(ui, format!("{:.1} s", state.train.secs), "training");
            }
        });
        if state.train.is_stale() {
            ui.add_space(4.0);
            widgets::train_again(ui, out);
        }
        if let Some(report) = &state.train.report {
            ui.add_space(4.0);
            for line in training_in_words(report) {
                ui.label(RichText::new(line).size(12.0).color(c.muted));
            }
            for note in &report.notes {
                ui.label(RichText::new(format!("• {note}")).size(12.0));
            }
        }
    });
    ui.add_space(10.0);
}
