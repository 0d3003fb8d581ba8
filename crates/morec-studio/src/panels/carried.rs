//! What is carried with the pointer and dropped on a class.

use egui::{DragAndDrop, Response, Ui};
use morec_db::labels::SampleId;

use super::Out;
use crate::state::{ClassCommand, Command};
use crate::stretch::Stretch;
use crate::theme::Colours;

/// A sample, or a stretch that is not labelled yet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Carried {
    Sample(SampleId),
    Stretch(Stretch),
}

/// True while something is carried.
pub fn any(ui: &Ui) -> bool {
    DragAndDrop::has_payload_of_type::<Carried>(ui.ctx())
}

/// What is dropped on `place` becomes of `class`; a frame shows where it would be dropped.
pub fn accept(ui: &Ui, place: &Response, class: &str, out: Out) {
    if place.contains_pointer() && any(ui) {
        let stroke = (2.0, Colours::now(ui).accent);
        let inside = egui::StrokeKind::Inside;
        ui.painter().rect_stroke(place.rect, 6.0, stroke, inside);
    }
    let Some(carried) = place.dnd_release_payload::<Carried>() else {
        return;
    };
    let class = class.to_owned();
    out.push(Command::Classes(match *carried {
        Carried::Sample(id) => ClassCommand::Move { id, class },
        Carried::Stretch(of) => ClassCommand::LabelStretch { of, class },
    }));
}
