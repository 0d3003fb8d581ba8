//! Whole clips of the library: which class they show, by a menu or by their names.

use egui::{RichText, Ui, WidgetInfo, WidgetType};
use morec_db::labels::WholeClip;
use morec_db::{ClipId, ClipInfo};

use super::{Out, widgets};
use crate::format;
use crate::name_pattern::{NamePattern, guess};
use crate::state::{Command, LibraryCommand, State};
use crate::store::Edit;
use crate::theme::Colours;

/// Number of names that a preview shows.
const SHOWN: usize = 5;

/// The label of whole clips of one class.
fn of_class(clips: &[ClipId], class: &str) -> Command {
    let whole = |clip: &ClipId| WholeClip {
        clip: *clip,
        class: Some(class.to_owned()),
        subject: None,
    };
    Command::Edit(Edit::WholeClips(clips.iter().map(whole).collect()))
}

/// The classes that clips as a whole may show, as entries of a menu.
pub fn menu(ui: &mut Ui, state: &State, clips: &[ClipId], out: Out) {
    let menu = ui.menu_button("Is …", |ui| {
        for class in &state.classes.order {
            if ui.button(class).clicked() {
                out.push(of_class(clips, class));
                ui.close();
            }
        }
        if ui.button("A new class").clicked() {
            out.push(of_class(clips, &state.classes.free_name()));
            ui.close();
        }
    });
    widgets::named(
        &menu.response,
        WidgetType::Button,
        "Whole clips are …",
        false,
    );
    menu.response.on_hover_text(
        "Labels the clips from their beginning to their end. A class's key does the same.",
    );
}

/// A field for a class that is new.
pub fn new_class(ui: &mut Ui, clips: &[ClipId], out: Out) {
    ui.label("or a new class");
    let name = widgets::committed(ui, "New class of whole clips", clips, "");
    if let Some(name) = name.filter(|name| !name.trim().is_empty()) {
        out.push(of_class(clips, name.trim()));
    }
}

/// Class and person from the names of clips, with a look at what they say.
pub fn from_names(ui: &mut Ui, state: &State, clips: &[&ClipInfo], out: Out) {
    let c = Colours::now(ui);
    widgets::section(ui, "CLASS AND PERSON FROM NAMES");
    let text = match &state.library.pattern {
        Some(text) => text.clone(),
        None => guess(clips.iter().map(|clip| clip.name.as_str())),
    };
    let mut now = text.clone();
    let response = ui.add(widgets::line(&mut now).desired_width(260.0));
    response.widget_info(|| {
        let mut info = WidgetInfo::labeled(WidgetType::TextEdit, true, "Pattern of names");
        info.current_text_value = Some(text.clone());
        info
    });
    let hint = "{class} and {person} mark what is read from the name, {} any other text; with /, folders are included";
    response.on_hover_text(hint);
    if now != text {
        out.push(Command::Library(LibraryCommand::Pattern(now.clone())));
    }
    let pattern = match NamePattern::parse(&now) {
        Ok(pattern) => pattern,
        Err(why) => {
            ui.colored_label(c.warn, why);
            return;
        }
    };
    let read = clips
        .iter()
        .map(|clip| (clip.id, &clip.name, pattern.read(clip)));
    let (fitting, others): (Vec<_>, Vec<_>) = read.partition(|(_, _, parts)| parts.is_some());
    for (_, name, parts) in fitting.iter().take(SHOWN) {
        let parts = parts.clone().unwrap_or_default();
        let said: Vec<String> = [parts.class, parts.person].into_iter().flatten().collect();
        let text = format!("{name}: {}", said.join(", by "));
        ui.label(RichText::new(text).size(12.0).color(c.muted));
    }
    let mut classes: Vec<&String> = fitting
        .iter()
        .filter_map(|(_, _, parts)| parts.as_ref()?.class.as_ref())
        .collect();
    classes.sort();
    classes.dedup();
    let mut summary = format::count(classes.len(), "class");
    if let Some((_, name, _)) = others.first() {
        summary += &format!(
            "; {} do not fit, such as {name}",
            format::count(others.len(), "name")
        );
    }
    let colour = if others.is_empty() { c.muted } else { c.warn };
    ui.colored_label(colour, summary);
    let whole = |(clip, _, parts): &(ClipId, &String, Option<_>)| {
        let parts: crate::name_pattern::NamedParts = Option::clone(parts)?;
        Some(WholeClip {
            clip: *clip,
            class: parts.class,
            subject: parts.person,
        })
    };
    let button = format!("Label {}", format::count(fitting.len(), "whole clip"));
    if ui
        .add_enabled(!fitting.is_empty(), widgets::main_button(&button, &c))
        .clicked()
    {
        let whole = fitting.iter().filter_map(whole).collect();
        out.push(Command::Edit(Edit::WholeClips(whole)));
    }
}
