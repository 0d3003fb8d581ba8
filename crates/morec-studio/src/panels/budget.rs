//! The time budget: how much time each class takes, for everybody and for each person, and which class follows which.

use egui::{Grid, Rect, RichText, ScrollArea, Sense, Ui, Vec2, WidgetType, pos2};
use morec::labels::{ClassBudget, ClassTransitions, TimeBudget};

use super::{Out, widgets};
use crate::format;
use crate::lists::List;
use crate::state::study::{StudyCommand, StudyView};
use crate::state::{Command, FileCommand, LibraryCommand, State};
use crate::stretch::Stretch;
use crate::theme::Colours;

const ROW: f32 = 24.0;
/// Columns: heading, share of the width.
const COLUMNS: [(&str, f32); 7] = [
    ("Class", 0.24),
    ("Person", 0.18),
    ("Labels", 0.09),
    ("Total", 0.12),
    ("Mean", 0.11),
    ("Share", 0.16),
    ("A minute", 0.10),
];
/// The column with a bar.
const SHARE: usize = 5;

/// Buttons that show time budget and annotators in place of the classes.
pub fn buttons(ui: &mut Ui, out: Out) {
    for (text, hint, view) in [
        (
            "Time budget",
            "Number, duration and share of time of each class and person; which class follows which",
            StudyView::Budget,
        ),
        (
            "Compare annotators",
            "How far two annotators agree, and a decision wherever they differ",
            StudyView::Annotators,
        ),
    ] {
        if ui.button(text).on_hover_text(hint).clicked() {
            out.push(Command::Study(StudyCommand::Show(Some(view))));
        }
    }
}

/// Title and buttons above the table.
pub fn tools(ui: &mut Ui, state: &State, out: Out) {
    let c = Colours::now(ui);
    ui.label(RichText::new("Time budget").strong());
    if let Some((_, budget)) = state.study.budget.as_ref().filter(|(_, b)| b.clips > 0) {
        let text = format!(
            "{}, {}; {:.1} % without a label",
            format::count(budget.clips, "clip"),
            format::duration(budget.secs),
            100.0 * budget.unlabelled_secs / budget.secs.max(f64::MIN_POSITIVE)
        );
        ui.colored_label(c.muted, text);
        let export = ui.button("Export …");
        if export
            .on_hover_text("A table (.tsv) or JSON (.json)")
            .clicked()
        {
            out.push(Command::File(FileCommand::AskExportBudget));
        }
    }
    if ui.button("Back to classes").clicked() {
        out.push(Command::Study(StudyCommand::Show(None)));
    }
}

/// A row: a class, and a person or everybody.
type BudgetRow<'b> = (&'b ClassBudget, Option<&'b str>);

fn rows(budget: &TimeBudget) -> Vec<BudgetRow<'_>> {
    let mut rows = Vec::new();
    for class in &budget.classes {
        rows.push((class, None));
        for person in &budget.people {
            let of_class = person.classes.iter().find(|c| c.class == class.class);
            rows.extend(of_class.map(|c| (c, Some(person.person.as_str()))));
        }
    }
    rows
}

pub fn show(ui: &mut Ui, state: &State, out: Out) {
    let Some((_, budget)) = &state.study.budget else {
        return;
    };
    if budget.clips == 0 {
        return widgets::nothing(ui, "No labels yet", "Label a few motions first.");
    }
    let rows = rows(budget);
    let largest = rows.iter().map(|(of, _)| of.share).fold(0.0, f64::max);
    header(ui);
    ui.spacing_mut().item_spacing.y = 0.0;
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        let list = List::main(ui, "budget", rows.len(), 1, 0);
        list.scroll(ui, list.wanted, 0, ROW);
        for (at, of) in rows.iter().enumerate() {
            row(ui, state, (&list, at), *of, largest, out);
        }
        ui.spacing_mut().item_spacing.y = 4.0;
        transitions(ui, &budget.transitions);
    });
}

fn cells(rect: Rect) -> [Rect; 7] {
    let inner = rect.shrink2(Vec2::new(6.0, 0.0));
    let mut x = inner.left();
    COLUMNS.map(|(_, share)| {
        let width = share * inner.width();
        let cell = Rect::from_min_max(pos2(x, inner.top()), pos2(x + width - 10.0, inner.bottom()));
        x += width;
        cell
    })
}

fn header(ui: &mut Ui) {
    let c = Colours::now(ui);
    let size = Vec2::new(ui.available_width(), ROW);
    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
    for (at, (cell, (name, _))) in cells(rect).into_iter().zip(COLUMNS).enumerate() {
        widgets::text_in(ui, cell, name, 12.0, c.muted, at > 1);
    }
}

fn row(
    ui: &mut Ui,
    state: &State,
    (list, at): (&List, usize),
    (of, person): BudgetRow<'_>,
    largest: f64,
    out: Out,
) {
    let c = Colours::now(ui);
    let size = Vec2::new(ui.available_width(), ROW);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    let texts = [
        of.class.clone(),
        person.unwrap_or("everybody").to_owned(),
        of.count.to_string(),
        format::duration(of.total_secs),
        format!("{:.2} s", of.mean_secs),
        format!("{:.1} %", 100.0 * of.share),
        format!("{:.2}", of.per_minute),
    ];
    let name = format!(
        "{}, {}: {}, {} in all, {} on average, {} of the time, {} a minute",
        texts[0],
        texts[1],
        format::count(of.count, "label"),
        texts[3],
        texts[4],
        texts[5],
        texts[6]
    );
    widgets::named(&response, WidgetType::Button, &name, false);
    if response.hovered() {
        ui.painter().rect_filled(rect, 3.0, c.tint(c.accent, 0.10));
    }
    let cells = cells(rect);
    let colour = c.class(state.classes.place(&of.class));
    let bar = cells[SHARE].shrink2(Vec2::new(0.0, 4.0));
    let length = bar.width() * (of.share / largest.max(f64::MIN_POSITIVE)) as f32;
    let bar = bar.with_max_x(bar.left() + length);
    ui.painter().rect_filled(bar, 2.0, c.tint(colour, 0.45));
    for (at, (cell, text)) in cells.into_iter().zip(&texts).enumerate() {
        let strong = person.is_none();
        let colour = if strong { c.text } else { c.muted };
        // The class is written once, above its people.
        if at > 0 || strong {
            widgets::text_in(ui, cell, text, 13.0, colour, at > 1);
        }
    }
    if list.row(ui, at, &response, false) {
        out.extend(first_label(state, &of.class, person));
    }
}

/// Plays the first label of a class, and of a person if one is named.
fn first_label(state: &State, class: &str, person: Option<&str>) -> Option<Command> {
    let snapshot = &state.store.as_ref()?.snapshot;
    let mut labels = snapshot.accepted();
    let first = labels.find(|s| {
        s.class == class && person.is_none_or(|person| s.subject.as_deref() == Some(person))
    })?;
    Some(Command::Library(LibraryCommand::GoTo(Stretch::from(first))))
}

fn transitions(ui: &mut Ui, of: &ClassTransitions) {
    if of.counts.iter().flatten().all(|count| *count == 0) {
        return;
    }
    let c = Colours::now(ui);
    ui.add_space(10.0);
    widgets::section(ui, "NEXT LABEL IN THE SAME CLIP");
    ScrollArea::horizontal()
        .id_salt("transitions")
        .show(ui, |ui| {
            Grid::new("transitions").striped(true).show(ui, |ui| {
                ui.colored_label(c.muted, "class, followed by");
                for class in &of.classes {
                    ui.colored_label(c.muted, class);
                }
                ui.end_row();
                for (class, counts) in of.classes.iter().zip(&of.counts) {
                    ui.label(class);
                    for count in counts {
                        let text = if *count == 0 {
                            "–".to_owned()
                        } else {
                            count.to_string()
                        };
                        ui.label(text);
                    }
                    ui.end_row();
                }
            });
        });
}
