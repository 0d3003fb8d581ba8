//! The parameters of the method of 2009, as controls.

use egui::{Checkbox, ComboBox, DragValue, Ui, WidgetType};
use morec::pca::ComponentCount;
use morec::pivots::PivotSet;
use morec::train::thesis::{Pivots, SvrdmTrainParams, ThresholdRule};

use super::{Out, widgets};
use crate::state::{Command, State, TrainCommand};

/// Dimensions, and share of the variance, where a control changes from one to the other: the thesis's.
const DIMS: usize = 16;
const TAU: f64 = 0.95;

/// Width of a label with its menu, points.
const LINE: f32 = 230.0;

/// The controls; what is changed counts from the next training on.
pub fn show(ui: &mut Ui, state: &State, out: Out) {
    let now = &state.train.thesis_params;
    let mut wanted = now.clone();
    ui.horizontal_wrapped(|ui| {
        for (text, hint, params) in [
            (
                "Tuned",
                "Tuned for people outside the training data",
                SvrdmTrainParams::tuned(),
            ),
            (
                "As in the thesis",
                "The values printed in the thesis",
                SvrdmTrainParams::faithful(),
            ),
        ] {
            let on = *now == params;
            if ui.selectable_label(on, text).on_hover_text(hint).clicked() {
                wanted = params;
            }
        }
        ui.separator();
        pivots(ui, &mut wanted.pivots);
        components(ui, &mut wanted.keep);
        let machine = &mut wanted.tree.machine;
        let eigenvectors = DragValue::new(&mut wanted.stages.eigenvectors).range(1..=8);
        number(ui, "k", "eigenvectors", eigenvectors);
        let penalty = DragValue::new(&mut machine.penalty)
            .range(0.1..=1000.0)
            .speed(0.1);
        number(ui, "C", "penalty", penalty);
        let own = DragValue::new(&mut machine.own)
            .range(0.1..=2.0)
            .speed(0.01);
        number(ui, "T", "own samples, at least", own);
        let other = DragValue::new(&mut machine.other)
            .range(0.0..=1.0)
            .speed(0.01);
        number(ui, "t", "other samples, at most", other);
        recognition(ui, &mut wanted);
    });
    if let Pivots::Chosen(names) = &mut wanted.pivots {
        joints(ui, names);
    }
    if wanted != *now {
        out.push(Command::Train(TrainCommand::ThesisParams(Box::new(wanted))));
    }
}

fn pivots(ui: &mut Ui, pivots: &mut Pivots) {
    let all = || {
        PivotSet::thesis()
            .pivots()
            .iter()
            .map(|p| p.name.clone())
            .collect()
    };
    let choices = [
        ("the 16 of the thesis", Pivots::Thesis),
        ("parts of the body", Pivots::Roles),
        ("joint by joint", Pivots::Chosen(all())),
    ];
    let same = |a: &Pivots, b: &Pivots| std::mem::discriminant(a) == std::mem::discriminant(b);
    let chosen = choices.iter().find(|(_, choice)| same(choice, pivots));
    // A menu goes to the next line only with its label.
    if ui.available_size_before_wrap().x < LINE {
        ui.end_row();
    }
    ui.label("Pivots");
    let combo = ComboBox::from_id_salt("pivots");
    let combo = combo.selected_text(chosen.map_or("a list", |(name, _)| name));
    let combo = combo.show_ui(ui, |ui| {
        for (name, choice) in &choices {
            let on = same(choice, pivots);
            if ui.selectable_label(on, *name).clicked() && !on {
                *pivots = choice.clone();
            }
        }
    });
    widgets::named(&combo.response, WidgetType::ComboBox, "Pivots", false);
}

/// A box for each of the thesis's pivots; the root is always one.
fn joints(ui: &mut Ui, names: &mut Vec<String>) {
    ui.horizontal_wrapped(|ui| {
        for pivot in PivotSet::thesis().pivots() {
            let mut on = pivot.parent.is_none() || names.contains(&pivot.name);
            let can_be_left_out = pivot.parent.is_some();
            let response = ui.add_enabled(can_be_left_out, Checkbox::new(&mut on, &pivot.name));
            if response.changed() {
                names.retain(|name| *name != pivot.name);
                names.extend(on.then(|| pivot.name.clone()));
            }
        }
    });
}

/// The `T` of recognition: estimated with the least confidence, or a figure.
fn recognition(ui: &mut Ui, params: &mut SvrdmTrainParams) {
    let estimated = matches!(params.thresholds, ThresholdRule::Estimated { .. });
    ui.label("T of recognition:");
    let hint = "From samples left out of training, and from background";
    if ui
        .selectable_label(estimated, "estimated")
        .on_hover_text(hint)
        .clicked()
    {
        params.thresholds = SvrdmTrainParams::tuned().thresholds;
    }
    let hint = "A branch of the tree is followed if its machine's output is at least this value";
    if ui
        .selectable_label(!estimated, "fixed")
        .on_hover_text(hint)
        .clicked()
    {
        params.thresholds = ThresholdRule::Fixed;
    }
    if !estimated {
        let accept = DragValue::new(&mut params.stages.accept)
            .range(0.1..=1.5)
            .speed(0.005);
        let response = ui.add(accept);
        let name = "Value of T of recognition";
        widgets::named(&response, WidgetType::DragValue, name, false);
    }
}

/// Number of principal components: a number, or as many as hold a share of the variance, τ.
fn components(ui: &mut Ui, keep: &mut ComponentCount) {
    let by_share = matches!(keep, ComponentCount::Quality(_));
    let hint = "Number of principal components";
    if ui
        .selectable_label(!by_share, "Dimensions")
        .on_hover_text(hint)
        .clicked()
    {
        *keep = ComponentCount::Dims(DIMS);
    }
    let hint = "As many principal components as are needed for this share of the variance";
    if ui
        .selectable_label(by_share, "τ: share of variance")
        .on_hover_text(hint)
        .clicked()
    {
        *keep = ComponentCount::Quality(TAU);
    }
    let response = match keep {
        ComponentCount::Dims(dims) => ui.add(DragValue::new(dims).range(1..=64)),
        ComponentCount::Quality(tau) => ui.add(DragValue::new(tau).range(0.5..=1.0).speed(0.002)),
    };
    let name = if by_share {
        "Value of τ"
    } else {
        "Number of dimensions"
    };
    widgets::named(&response, WidgetType::DragValue, name, false);
}

/// A figure under its letter in the thesis, with what that is.
fn number(ui: &mut Ui, letter: &str, is: &str, value: DragValue<'_>) {
    ui.label(format!("{letter}: {is}"));
    let response = ui.add(value);
    let name = format!("Value of {letter}");
    widgets::named(&response, WidgetType::DragValue, name, false);
}
