//! Many proposals answered at once.

use egui::{Slider, Ui, WidgetType};

use super::{Out, widgets};
use crate::state::classes::LIKELY;
use crate::state::{ClassCommand, Command, State};

/// A threshold, with buttons that accept what is above it and reject what is below; nothing while there are no proposals.
pub fn at_once(ui: &mut Ui, state: &State, out: Out) {
    let (above, below) = (state.judged_at_once(true), state.judged_at_once(false));
    if above.is_empty() && below.is_empty() {
        return;
    }
    let mut class = |command| out.push(Command::Classes(command));
    let mut likely = state.classes.likely.unwrap_or(LIKELY);
    ui.spacing_mut().slider_width = 90.0;
    let response = ui.add(Slider::new(&mut likely, 1..=100).suffix(" %"));
    let name = "Threshold of proposals";
    widgets::named(&response, WidgetType::Slider, name, false);
    if response.changed() {
        class(ClassCommand::Likely(likely));
    }
    for (accept, count, text) in [
        (true, above.len(), format!("Accept {} above", above.len())),
        (false, below.len(), format!("Reject {} below", below.len())),
    ] {
        if ui.add_enabled(count > 0, egui::Button::new(text)).clicked() {
            class(ClassCommand::JudgeAll { accept });
        }
    }
}
