//! Names of classes that keys have made.

use egui::{TextEdit, Ui, WidgetType};

use super::{Out, widgets};
use crate::state::classes::is_free_name;
use crate::state::{ClassCommand, Command, State};

/// Offers to name the newest class that a key has made. A button opens the field: in a field that appeared by itself, users could not
/// tell whether a key types a letter or is a shortcut. `listed` says that the list of classes is shown, where a name is typed.
pub fn unnamed(ui: &mut Ui, state: &State, listed: bool, out: Out) {
    let mut classes = state.classes.order.iter();
    let Some(class) = classes.rfind(|class| is_free_name(class)) else {
        return;
    };
    let renaming = state.classes.renaming.as_ref();
    ui.horizontal_wrapped(|ui| {
        if let Some((from, now)) = renaming.filter(|(from, _)| from == class) {
            if !listed {
                ui.label(format!("What is {class} called?"));
                field(ui, from, now, out);
            }
            return;
        }
        ui.label(format!("{class} has no name yet"));
        if ui.button(format!("Name {class} …")).clicked() {
            let empty = Some((class.clone(), String::new()));
            out.push(Command::Classes(ClassCommand::Renaming(empty)));
        }
    });
}

/// A field for the new name of a class, which has the keyboard until Enter, Escape or a click elsewhere.
pub fn field(ui: &mut Ui, from: &str, now: &str, out: Out) {
    let mut text = now.to_owned();
    let response = ui.add(TextEdit::singleline(&mut text).desired_width(180.0));
    response.widget_info(|| {
        let name_of = format!("New name of {from}");
        let mut info = egui::WidgetInfo::labeled(WidgetType::TextEdit, true, name_of);
        info.current_text_value = Some(now.to_owned());
        info
    });
    let ended = response.lost_focus() || ui.input(|i| i.key_pressed(egui::Key::Enter));
    // Whoever has typed the name has the keys back.
    match ended {
        true => response.surrender_focus(),
        false if response.has_focus() => {}
        false => widgets::focus_selected(ui, &response, now),
    }
    let given_up = text.trim().is_empty() || ui.input(|i| i.key_pressed(egui::Key::Escape));
    let from = from.to_owned();
    let command = match ended {
        true if given_up => ClassCommand::Renaming(None),
        true => ClassCommand::Rename { from, to: text },
        false if text == now => return,
        false => ClassCommand::Renaming(Some((from, text))),
    };
    out.push(Command::Classes(command));
}
