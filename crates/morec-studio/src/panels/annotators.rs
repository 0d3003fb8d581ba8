//! Annotators: whose labels are shown, whose new ones are, and where two of them differ.

use egui::containers::menu::{MenuButton, MenuConfig};
use egui::{
    Button, Grid, PopupCloseBehavior, Response, RichText, ScrollArea, Sense, Ui, Vec2, WidgetType,
};
use morec_db::labels::DbSample;
use morec_measure::eval::{ClassAgreement, LabelAgreement};
use morec_ops::ComparedAnnotators;

use super::{Out, widgets};
use crate::format;
use crate::lists::List;
use crate::state::study::{LabelDecision, StudyCommand, StudyView, UNIT_SECS, samples_of};
use crate::state::{Command, State};
use crate::theme::Colours;

const ROW: f32 = 26.0;
/// Width of the buttons of a difference.
const BUTTONS: f32 = 216.0;

fn push(out: Out, command: StudyCommand) {
    out.push(Command::Study(command));
}

/// The menu above the tracks: whose labels are shown, who makes new ones.
pub fn menu(ui: &mut Ui, state: &State, out: Out) {
    let study = &state.study;
    let shown = study.shown.as_ref().map(|name| format!("Labels of {name}"));
    let by = study.annotator.as_ref().map(|name| format!("by {name}"));
    let text = match (shown, by) {
        (None, None) => "Annotators".to_owned(),
        (shown, by) => {
            let parts: Vec<String> = shown.into_iter().chain(by).collect();
            parts.join(", ")
        }
    };
    // A click into the field of the name must not close it.
    let config = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    let menu = MenuButton::new(text).config(config);
    let (response, _) = menu.ui(ui, |ui| {
        ui.set_min_width(200.0);
        if !study.annotators.is_empty() {
            widgets::section(ui, "SHOW LABELS OF");
            let all = [None].into_iter();
            for name in all.chain(study.annotators.iter().map(Some)) {
                let text = name.map_or("everybody", String::as_str);
                let response = ui.selectable_label(study.shown.as_ref() == name, text);
                let on = study.shown.as_ref() == name;
                let what = format!("Show labels of {text}");
                widgets::named(&response, WidgetType::SelectableLabel, what, on);
                if response.clicked() {
                    push(out, StudyCommand::ShowLabelsOf(name.cloned()));
                    ui.close();
                }
            }
        }
        widgets::section(ui, "NEW LABELS ARE BY");
        let nobody = [None].into_iter();
        for name in nobody.chain(study.annotators.iter().map(Some)) {
            let text = name.map_or("nobody named", String::as_str);
            let on = study.annotator.as_ref() == name;
            let response = ui.selectable_label(on, text);
            let what = format!("New labels are by {text}");
            widgets::named(&response, WidgetType::SelectableLabel, what, on);
            if response.clicked() {
                push(out, StudyCommand::Annotator(name.cloned()));
                ui.close();
            }
        }
        let now = study.annotator.as_deref().unwrap_or_default();
        if let Some(name) = widgets::committed(ui, "Annotator of new labels", now, now) {
            push(out, StudyCommand::Annotator(Some(name)));
            ui.close();
        }
        ui.separator();
        let two = Button::new("Compare two annotators");
        if ui.add_enabled(study.pair.is_some(), two).clicked() {
            let view = Some(StudyView::Annotators);
            push(out, StudyCommand::Show(view));
            ui.close();
        }
    });
    let hint = "Whose labels are shown, and by whom new ones are";
    let response = response.on_hover_text(hint);
    let selected = study.shown.is_some();
    widgets::named(&response, WidgetType::Button, "Annotators", selected);
}

/// The annotators that are compared, above the comparison.
pub fn tools(ui: &mut Ui, state: &State, out: Out) {
    ui.label(RichText::new("Two annotators").strong());
    if let Some([a, b]) = &state.study.pair {
        let with = |name: &String, first: bool| match first {
            true => [name.clone(), b.clone()],
            false => [a.clone(), name.clone()],
        };
        for (letter, now, first) in [("A", a, true), ("B", b, false)] {
            let menu = ui.menu_button(format!("{letter}: {now}"), |ui| {
                let other = if first { b } else { a };
                let names = state.study.annotators.iter().filter(|name| *name != other);
                for name in names {
                    if ui.selectable_label(name == now, name).clicked() {
                        push(out, StudyCommand::Compare(with(name, first)));
                        ui.close();
                    }
                }
            });
            let name = format!("Annotator {letter}: {now}");
            widgets::named(&menu.response, WidgetType::Button, name, false);
        }
    }
    if ui.button("Back to classes").clicked() {
        push(out, StudyCommand::Show(None));
    }
}

/// Figures of agreement, then each difference with what becomes of it.
pub fn show(ui: &mut Ui, state: &State, out: Out) {
    if state.study.pair.is_none() {
        return widgets::nothing(
            ui,
            "Fewer than two annotators",
            "Import labels that name their annotators, or set the annotator of new labels above the tracks of the room Label.",
        );
    }
    let Some(compared) = &state.study.compared else {
        return;
    };
    let Some(agreement) = &compared.agreement else {
        let [a, b] = &compared.names;
        let hint = format!("Labels of {a} and {b} are in different clips.");
        return widgets::nothing(ui, "No clip is labelled by both", &hint);
    };
    figures(ui, agreement);
    classes(ui, state, agreement);
    differences(ui, state, compared, out);
}

fn share(value: Option<f64>) -> String {
    value.map_or_else(|| "–".to_owned(), |value| format!("{value:.3}"))
}

fn millis(secs: Option<f64>) -> String {
    secs.map_or_else(|| "–".to_owned(), |secs| format!("{:.0} ms", 1e3 * secs))
}

fn figures(ui: &mut Ui, agreement: &LabelAgreement) {
    let LabelAgreement { time, events, .. } = agreement;
    let bounds = &events.boundaries;
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 18.0;
        let unit = format!("Cohen's kappa, units of {UNIT_SECS} s");
        widgets::figure(ui, share(time.kappa), &unit);
        widgets::figure(ui, share(events.corrected), "events beyond chance");
        widgets::figure(ui, share(events.f1), "F1 of events");
        let starts = millis(bounds.start_median_abs_secs);
        widgets::figure(ui, starts, "starts apart, median");
        let stops = millis(bounds.stop_median_abs_secs);
        widgets::figure(ui, stops, "stops apart, median");
    });
    let text = format!(
        "{}, {}; {} of A, {} of B, {} in common",
        format::count(agreement.clips, "clip"),
        format::duration(agreement.secs),
        format::count(events.of_a, "event"),
        events.of_b,
        events.matched
    );
    ui.colored_label(Colours::now(ui).muted, text);
}

fn classes(ui: &mut Ui, state: &State, agreement: &LabelAgreement) {
    ui.add_space(4.0);
    ScrollArea::vertical()
        .id_salt("agreement of classes")
        .max_height((0.3 * ui.available_height()).max(60.0))
        .auto_shrink([false, true])
        .show(ui, |ui| {
            Grid::new("agreement")
                .num_columns(7)
                .striped(true)
                .show(ui, |ui| {
                    let c = Colours::now(ui);
                    for text in ["", "class", "A", "B", "both", "kappa", "F1"] {
                        ui.colored_label(c.muted, text);
                    }
                    ui.end_row();
                    for ClassAgreement {
                        class,
                        time,
                        events,
                    } in &agreement.classes
                    {
                        widgets::chip(ui, state.classes.place(class), class);
                        let counts = [events.of_a, events.of_b, events.matched];
                        let texts = [class.clone()].into_iter();
                        let texts = texts.chain(counts.map(|count| count.to_string()));
                        for text in texts.chain([share(time.kappa), share(events.f1)]) {
                            ui.label(text);
                        }
                        ui.end_row();
                    }
                });
        });
}

fn differences(ui: &mut Ui, state: &State, compared: &ComparedAnnotators, out: Out) {
    let open = state.study.undecided();
    let c = Colours::now(ui);
    ui.add_space(4.0);
    widgets::section(ui, "WHERE THEY DIFFER");
    if open.is_empty() {
        ui.colored_label(c.muted, "Nowhere, or everything is decided.");
        return;
    }
    let text = format!(
        "{}. A label that is kept is by “agreed”, too; each decision can be undone.",
        format::count(open.len(), "difference")
    );
    ui.colored_label(c.muted, text);
    ScrollArea::vertical()
        .id_salt("differences")
        .auto_shrink(false)
        .show_rows(ui, ROW, open.len(), |ui, rows| {
            let chosen = |at: &usize| state.study.chosen == Some(*at);
            let now = open.iter().position(chosen);
            widgets::keep_in_view(ui, "differences", now, rows.start, ROW);
            let list = List::main(ui, "differences", open.len(), 1, now.unwrap_or(0));
            list.scroll(ui, list.wanted, rows.start, ROW);
            for row in rows {
                let at = open[row];
                let on = chosen(&at);
                ui.horizontal(|ui| {
                    ui.set_height(ROW);
                    let response = difference(ui, compared, at, on);
                    if list.row(ui, row, &response, on) {
                        push(out, StudyCommand::GoTo(at));
                    }
                    decisions(ui, compared, at, out);
                });
            }
        });
}

/// What each of the two says, in a row that plays the place.
fn difference(ui: &mut Ui, compared: &ComparedAnnotators, at: usize, on: bool) -> Response {
    let c = Colours::now(ui);
    let samples = samples_of(compared, at);
    let first = samples.iter().flatten().next();
    let clip = first.map_or("", |s| s.clip_name.as_str());
    let says = |name: &String, sample: Option<&DbSample>| match sample {
        Some(s) => format!(
            "{name} {} {:.2}–{:.2} s",
            s.class, s.start_secs, s.stop_secs
        ),
        None => format!("{name} nothing"),
    };
    let [a, b] = &compared.names;
    let text = format!("{clip}: {}, {}", says(a, samples[0]), says(b, samples[1]));
    let size = Vec2::new((ui.available_width() - BUTTONS).max(80.0), ROW - 4.0);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    widgets::named(&response, WidgetType::SelectableLabel, &text, on);
    widgets::row_ground(ui, rect, &response, on);
    let inner = rect.shrink2(Vec2::new(4.0, 0.0));
    widgets::text_in(ui, inner, &text, 12.5, c.text, false);
    response.on_hover_text(text)
}

fn decisions(ui: &mut Ui, compared: &ComparedAnnotators, at: usize, out: Out) {
    let number = at + 1;
    for (text, decision) in [
        ("Take A", LabelDecision::A),
        ("Take B", LabelDecision::B),
        ("Keep both", LabelDecision::Both),
    ] {
        let response = ui.button(text);
        let name = format!("{text}, difference {number}");
        widgets::named(&response, WidgetType::Button, name, false);
        let [a, b] = &compared.names;
        let hint = match decision {
            LabelDecision::A => format!("What {a} says; the label of {b} goes  (A)"),
            LabelDecision::B => format!("What {b} says; the label of {a} goes  (B)"),
            LabelDecision::Both => "Both labels stay  (E)".to_owned(),
        };
        if response.on_hover_text(hint).clicked() {
            push(out, StudyCommand::Decide(Some(at), decision));
        }
    }
}
