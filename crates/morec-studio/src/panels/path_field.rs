//! A field for a path, where no file dialog can be opened.

use egui::{Align2, Context, Key, RichText, WidgetInfo, WidgetType, Window};

use super::{Out, widgets};
use crate::dialogs;
use crate::state::{self, Command, DialogKind, FileCommand, State, TypedPath};
use crate::theme::Colours;

pub fn show(ctx: &Context, state: &State, out: Out) {
    let Some(typed) = &state.typed else { return };
    let dialog = state::dialog(&typed.ask);
    let mut open = true;
    Window::new(dialog.title)
        .open(&mut open)
        .collapsible(false)
        .resizable(false)
        .anchor(Align2::CENTER_TOP, [0.0, 90.0])
        .show(ctx, |ui| contents(ui, state, typed, dialog.choice, out));
    if !open || ctx.input(|i| i.key_pressed(Key::Escape)) {
        out.push(Command::File(FileCommand::Typing(None)));
    }
}

fn contents(ui: &mut egui::Ui, state: &State, typed: &TypedPath, kind: DialogKind, out: Out) {
    let c = Colours::of(state.dark);
    ui.set_width(460.0);
    ui.colored_label(
        c.warn,
        "No file dialog can be opened: neither a desktop portal nor zenity was found.",
    );
    ui.label(match kind {
        DialogKind::Save => "Path of the file to write:",
        DialogKind::Folder | DialogKind::Folders => "Path of the folder:",
        DialogKind::File | DialogKind::Files => "Path of the file:",
    });
    let mut text = typed.text.clone();
    let response = ui.add(widgets::line(&mut text).desired_width(f32::INFINITY));
    response.widget_info(|| {
        let mut info = WidgetInfo::labeled(WidgetType::TextEdit, true, "Path");
        info.current_text_value = Some(typed.text.clone());
        info
    });
    if !typed.begun {
        widgets::focus_selected(ui, &response, &text);
    }
    let entered = widgets::entered(ui, &response);
    let path = dialogs::typed_path(&text);
    let (why, action) = match &path {
        None => (None, "OK"),
        Some(path) => dialogs::verdict(kind, path),
    };
    ui.label(RichText::new(why.as_deref().unwrap_or(" ")).color(c.warn));
    let refused = path.is_none() || (why.is_some() && action == "OK");
    ui.horizontal(|ui| {
        let ok = ui.add_enabled(!refused, widgets::main_button(action, &c));
        // What would be written over takes a click.
        let accepted = ok.clicked() || (entered && why.is_none());
        if let Some(path) = path.filter(|_| accepted && !refused) {
            out.push(Command::File(FileCommand::Typing(None)));
            if let Some(command) = dialogs::command(&typed.ask, vec![path]) {
                out.push(Command::File(command));
            }
        } else if text != typed.text || !typed.begun {
            out.push(Command::File(FileCommand::Typing(Some(text))));
        }
        if ui.button("Cancel").clicked() {
            out.push(Command::File(FileCommand::Typing(None)));
        }
    });
}
