//! The parameters of the method of 2009, as controls.

use egui::{ComboBox, DragValue, Ui, WidgetType};
use morec::pca::ComponentCount;
use morec::train::thesis::{Pivots, SvrdmTrainParams};

use super::{Out, widgets};
use crate::state::{Command, State, TrainCommand};

/// Dimensions, and share of the variance, where a control changes from one to the other: the thesis's.
const DIMS: usize = 16;
const TAU: f64 = 0.95;

/// The controls; what is changed counts from the next training on.
pub fn show(ui: &mut Ui, state: &State, out: Out) {
    let now = &state.train.thesis_params;
    let mut wanted = now.clone();
    ui.horizontal_wrapped(|ui| {
        for (text, hint, params) in [
            (
                "Tuned",
                "Made to accept what was not seen",
                SvrdmTrainParams::tuned(),
            ),
            (
                "As in the thesis",
                "Rejects nearly all that was not seen",
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
        number(ui, "k", "Eigenvectors in a feature vector", eigenvectors);
        let penalty = DragValue::new(&mut machine.penalty)
            .range(0.1..=1000.0)
            .speed(0.1);
        number(ui, "C", "Penalty for samples that miss T or t", penalty);
        let own = DragValue::new(&mut machine.own)
            .range(0.1..=2.0)
            .speed(0.01);
        number(
            ui,
            "T",
            "A machine says at least this of its own samples",
            own,
        );
        let other = DragValue::new(&mut machine.other)
            .range(0.0..=1.0)
            .speed(0.01);
        number(
            ui,
            "t",
            "A machine says at most this of the other side's samples",
            other,
        );
    });
    if wanted != *now {
        out.push(Command::Train(TrainCommand::ThesisParams(Box::new(wanted))));
    }
}

fn pivots(ui: &mut Ui, pivots: &mut Pivots) {
    let name = |pivots: Pivots| match pivots {
        Pivots::Thesis => "the 16 of the thesis",
        Pivots::Roles => "parts of the body",
    };
    ui.label("Pivots");
    let combo = ComboBox::from_id_salt("pivots").selected_text(name(*pivots));
    let combo = combo.show_ui(ui, |ui| {
        for choice in [Pivots::Thesis, Pivots::Roles] {
            ui.selectable_value(pivots, choice, name(choice));
        }
    });
    widgets::named(&combo.response, WidgetType::ComboBox, "Pivots", false);
}

/// Principal components that are kept: a number, or as many as hold a share of the variance, τ.
fn components(ui: &mut Ui, keep: &mut ComponentCount) {
    let by_share = matches!(keep, ComponentCount::Quality(_));
    let hint = "Principal components that are kept";
    if ui
        .selectable_label(!by_share, "Dimensions")
        .on_hover_text(hint)
        .clicked()
    {
        *keep = ComponentCount::Dims(DIMS);
    }
    let hint = "As many principal components as hold this share of the variance";
    if ui
        .selectable_label(by_share, "τ")
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

fn number(ui: &mut Ui, text: &str, hint: &str, value: DragValue<'_>) {
    ui.label(text).on_hover_text(hint);
    let response = ui.add(value);
    widgets::named(
        &response,
        WidgetType::DragValue,
        format!("Value of {text}"),
        false,
    );
    response.on_hover_text(hint);
}
