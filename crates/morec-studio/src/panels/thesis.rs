//! The method of 2009: its parameters, its tree of classes, and the boundary of each branch.

use egui::{RichText, Ui, WidgetType};

use super::{Out, thesis_params, thesis_plane, widgets};
use crate::jobs::thesis::{Boundary, Thesis, TreeNodeView};
use crate::state::{Command, State, TrainCommand};
use crate::theme::Colours;

pub fn show(ui: &mut Ui, state: &State, out: Out) {
    let c = Colours::now(ui);
    ui.add_space(14.0);
    widgets::section(ui, "THE METHOD OF 2009");
    ui.horizontal_wrapped(|ui| {
        let training = state.is_training_thesis();
        let text = if training { "Training …" } else { "Train it on these labels" };
        if ui.add_enabled(!training, egui::Button::new(text)).clicked() {
            out.push(Command::Train(TrainCommand::Thesis));
        }
        let judge = egui::Button::new("Cross-validate it");
        let hint = "Show this method's confusion matrix above";
        if ui.add_enabled(!state.is_judging(), judge).on_hover_text(hint).clicked() {
            out.push(Command::Train(TrainCommand::JudgeThesis));
        }
        let hint = "A tree of support vector machines: each branch distinguishes two groups of classes and rejects other motion.";
        ui.label(RichText::new(hint).size(12.0).color(c.muted));
    });
    thesis_params::show(ui, state, out);
    let Some(thesis) = &state.train.thesis else {
        return;
    };
    if thesis.params != state.train.thesis_params {
        let text = "The parameters have changed since it was trained.";
        ui.colored_label(c.warn, text);
    }
    lengths(ui, thesis);
    ui.horizontal_top(|ui| {
        ui.vertical(|ui| {
            ui.set_width((0.25 * ui.available_width()).clamp(130.0, 260.0));
            node(ui, state, thesis, 0, 0, out);
        });
        if let Some(branch) = thesis.branch(state.train.branch) {
            ui.vertical(|ui| {
                sides(ui, state, branch);
                thesis_plane::show(ui, state, thesis, branch, out);
            });
        }
    });
}

/// Lengths of the samples of each class (Table 5.1).
fn lengths(ui: &mut Ui, thesis: &Thesis) {
    let table = egui::CollapsingHeader::new("Lengths of the classes");
    table.show(ui, |ui| {
        egui::Grid::new("lengths").striped(true).show(ui, |ui| {
            for title in ["", "samples", "people", "shortest", "median", "longest"] {
                ui.label(title);
            }
            ui.end_row();
            for of in &thesis.lengths {
                ui.label(&of.class);
                ui.label(of.samples.to_string());
                ui.label(of.people.to_string());
                for secs in [of.shortest_secs, of.median_secs, of.longest_secs] {
                    ui.label(format!("{secs:.2} s"));
                }
                ui.end_row();
            }
        });
    });
}

/// True if the sample that was chosen comes through a node.
fn is_on_path(state: &State, thesis: &Thesis, node: usize) -> bool {
    let path = state.train.sample.and_then(|at| thesis.paths.get(at));
    path.is_some_and(|path| path.contains(&node))
}

/// A node of the tree, and what is below it; those on the way of the sample that was chosen are marked (Fig. 5.2).
fn node(ui: &mut Ui, state: &State, thesis: &Thesis, at: usize, depth: usize, out: Out) {
    // A tree of this many classes is no deeper; a broken one ends here.
    if depth > 64 {
        return;
    }
    let c = Colours::now(ui);
    match thesis.nodes.get(at) {
        Some(TreeNodeView::Leaf(class)) => {
            ui.horizontal(|ui| {
                ui.add_space(18.0 * depth as f32);
                widgets::chip(ui, state.classes.place(class), class);
                match is_on_path(state, thesis, at) {
                    true => ui.label(RichText::new(format!("→ {class}")).strong()),
                    false => ui.label(class),
                };
            });
        }
        Some(TreeNodeView::Branch(branch)) => {
            ui.horizontal(|ui| {
                ui.add_space(18.0 * depth as f32);
                let on = state.train.branch == at;
                let text = format!(
                    "{} | {}",
                    branch.sides[0].join(", "),
                    branch.sides[1].join(", ")
                );
                let arrow = if is_on_path(state, thesis, at) {
                    "→ "
                } else {
                    ""
                };
                let shown = format!("{arrow}{text}");
                let response = ui.add(egui::Button::selectable(on, shown).truncate());
                widgets::named(&response, WidgetType::Button, format!("Branch {at}"), on);
                // Names of many classes are cut off.
                if response.on_hover_text(text).clicked() {
                    out.push(Command::Train(TrainCommand::Branch(at)));
                }
            });
            for child in branch.children {
                node(ui, state, thesis, child, depth + 1, out);
            }
        }
        None => {
            ui.colored_label(c.muted, "–");
        }
    }
}

/// Legend of the regions' colours.
fn sides(ui: &mut Ui, state: &State, branch: &Boundary) {
    ui.horizontal_wrapped(|ui| {
        for (at, side) in branch.sides.iter().enumerate() {
            if at == 1 {
                ui.label("against");
            }
            for class in side {
                widgets::chip(ui, state.classes.place(class), class);
            }
        }
    });
}
