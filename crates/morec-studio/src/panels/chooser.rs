//! The chooser of the class of the key Q: the first letters of its name, then Enter.

use egui::{Align2, Context, Key, RichText, TextEdit, Ui, WidgetType, Window};

use super::Out;
use crate::state::{ClassCommand, Command, State};
use crate::theme::Colours;

/// Number of classes that are listed.
const LISTED: usize = 9;
const TITLE: &str = "Class of the key Q";

pub fn show(ctx: &Context, state: &State, out: Out) {
    let Some(text) = &state.classes.choosing else {
        return;
    };
    let mut open = true;
    Window::new(TITLE)
        .open(&mut open)
        .collapsible(false)
        .resizable(false)
        .anchor(Align2::CENTER_TOP, [0.0, 90.0])
        .show(ctx, |ui| contents(ui, state, text, out));
    if !open {
        out.push(Command::Classes(ClassCommand::Choosing(None)));
    }
}

fn contents(ui: &mut Ui, state: &State, text: &str, out: Out) {
    let c = Colours::now(ui);
    let mut typed = text.to_owned();
    let field = TextEdit::singleline(&mut typed).hint_text("first letters, then Enter");
    let response = ui.add(field.desired_width(240.0));
    response.widget_info(|| {
        let mut info = egui::WidgetInfo::labeled(WidgetType::TextEdit, true, TITLE);
        info.current_text_value = Some(text.to_owned());
        info
    });
    response.request_focus();
    let matching = state.classes.matching(&typed);
    let mut choose = |class: &str| {
        let class = class.to_owned();
        out.push(Command::Classes(ClassCommand::Choose(class)));
    };
    if matching.is_empty() {
        ui.colored_label(c.muted, "No class has this name.");
    }
    for (at, class) in matching.iter().take(LISTED).enumerate() {
        // The first is what Enter chooses.
        let response = ui.selectable_label(at == 0, *class);
        super::widgets::named(
            &response,
            WidgetType::SelectableLabel,
            format!("Choose {class}"),
            at == 0,
        );
        if response.clicked() {
            choose(class);
        }
    }
    if matching.len() > LISTED {
        let more = format!("and {} more", matching.len() - LISTED);
        ui.label(RichText::new(more).size(12.0).color(c.muted));
    }
    if ui.input(|i| i.key_pressed(Key::Enter))
        && let Some(first) = matching.first()
    {
        choose(first);
    } else if typed != text {
        out.push(Command::Classes(ClassCommand::Choosing(Some(typed))));
    }
}
