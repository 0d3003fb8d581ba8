//! The history: changes by name, each of which can be undone.

use egui::{Align, Context, Frame, Layout, Margin, RichText, ScrollArea, SidePanel, WidgetType};

use super::{Out, widgets};
use crate::lists::List;
use crate::state::{Command, State};
use crate::store::Edit;
use crate::theme::Colours;

pub fn show(ctx: &Context, state: &State, out: Out) {
    let Some(store) = state.store.as_ref().filter(|_| state.show_history) else {
        return;
    };
    let c = Colours::of(state.dark);
    let frame = Frame::new().fill(c.ground).inner_margin(Margin::same(12));
    SidePanel::right("history")
        .frame(frame)
        .exact_width(280.0)
        .show(ctx, |ui| {
            ui.horizontal(|ui| {
                ui.label(RichText::new("History").size(15.0).strong());
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                    if ui.button("Close").clicked() {
                        out.push(Command::ShowHistory(false));
                    }
                });
            });
            let hint =
                "The newest change is at the top. A change can be undone if no later change depends on it.";
            ui.colored_label(c.muted, hint);
            ui.add_space(6.0);
            let steps = &store.snapshot.history;
            if steps.is_empty() {
                widgets::nothing(ui, "No changes yet", "");
                return;
            }
            // Steps that can be undone.
            let done: Vec<usize> = (0..steps.len()).filter(|&at| !steps[at].undone).collect();
            ScrollArea::vertical().auto_shrink(false).show_rows(
                ui,
                24.0,
                steps.len(),
                |ui, rows| {
                    let list = List::new(ui, "history", done.len());
                    list.scroll(ui, list.wanted.map(|at| done[at]), rows.start, 24.0);
                    for at in rows {
                        let step = &steps[at];
                        ui.horizontal(|ui| {
                            ui.set_height(24.0);
                            let by = match store.snapshot.is_foreign(step) {
                                true => format!(", by {}", step.made_by),
                                false => String::new(),
                            };
                            let text = RichText::new(format!("{}{by}", step.what));
                            let text = if step.undone {
                                text.color(c.muted).strikethrough()
                            } else {
                                text
                            };
                            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                                if !step.undone {
                                    let response = ui.small_button("Undo");
                                    let name = format!("Undo step {}: {}", step.id, step.what);
                                    widgets::named(&response, WidgetType::Button, name, false);
                                    let row = done.partition_point(|done| *done < at);
                                    if list.row(ui, row, &response, false) {
                                        out.push(Command::Edit(Edit::Undo(Some(step.id))));
                                    }
                                }
                                ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                                    ui.add(egui::Label::new(text).truncate());
                                });
                            });
                        });
                    }
                },
            );
        });
}
