//! Details of the chosen clip, which can be changed.

use egui::{Grid, Ui};
use morec_db::{ClipId, ClipInfo, ClipUpdate};

use super::{Out, background, roles, video, whole, widgets};
use crate::format;
use crate::state::{Command, State};
use crate::store::Edit;
use crate::theme::Colours;

pub fn show(ui: &mut Ui, state: &State, out: Out) {
    let Some(store) = &state.store else { return };
    let selected = &state.library.selected;
    if selected.len() > 1 {
        return several(ui, state, out);
    }
    let Some(clip) = selected.first().and_then(|id| store.snapshot.clip(*id)) else {
        return;
    };
    known(ui, clip, out);
    ui.add_space(2.0);
    ui.horizontal(|ui| {
        whole::menu(ui, state, &[clip.id], out);
        whole::new_class(ui, &[clip.id], out);
    });
    if ui.button("Remove this clip").clicked() {
        out.push(Command::Edit(Edit::RemoveClips(vec![clip.id])));
    }
    video::show(ui, state, clip, out);
    widgets::section(ui, "PARTS OF THE BODY");
    roles::show(ui, state, out);
}

fn several(ui: &mut Ui, state: &State, out: Out) {
    let selected = &state.library.selected;
    ui.label(format!("{} clips are selected", selected.len()));
    ui.horizontal(|ui| {
        ui.label("Person");
        if let Some(name) = widgets::committed(ui, "Person of all", selected, "") {
            let update = ClipUpdate {
                subject: Some(name),
                ..ClipUpdate::default()
            };
            out.push(Command::Edit(Edit::Describe {
                clips: selected.clone(),
                update,
            }));
        }
    });
    let clips: Vec<&ClipInfo> = match &state.store {
        Some(store) => selected
            .iter()
            .filter_map(|id| store.snapshot.clip(*id))
            .collect(),
        None => Vec::new(),
    };
    ui.horizontal(|ui| {
        ui.label("Background");
        background::mark(ui, &clips, out);
    });
    ui.horizontal(|ui| {
        ui.label("Add tags");
        if let Some(text) = widgets::committed(ui, "Tags of all", selected, "") {
            let update = ClipUpdate {
                add_tags: tags_of(&text),
                ..ClipUpdate::default()
            };
            if !update.add_tags.is_empty() {
                out.push(Command::Edit(Edit::Describe {
                    clips: selected.clone(),
                    update,
                }));
            }
        }
    });
    ui.horizontal(|ui| {
        whole::menu(ui, state, selected, out);
        whole::new_class(ui, selected, out);
    });
    whole::from_names(ui, state, &clips, out);
    ui.add_space(4.0);
    remove(ui, &clips, out);
}

/// Removes clips at the second click, which says how much goes.
fn remove(ui: &mut Ui, clips: &[&ClipInfo], out: Out) {
    let ids: Vec<ClipId> = clips.iter().map(|clip| clip.id).collect();
    let asked = egui::Id::new("remove these clips");
    let labels = clips.iter().map(|clip| clip.samples).sum();
    let sure = format!(
        "Remove {} and {}",
        format::count(ids.len(), "clip"),
        format::count(labels, "label")
    );
    // The question ends when other clips are selected or another panel is shown.
    let pass = ui.ctx().cumulative_pass_nr();
    let question: Option<(Vec<ClipId>, u64)> = ui.data(|data| data.get_temp(asked));
    let is_asked = question.is_some_and(|(of, shown)| of == ids && shown + 1 >= pass);
    let stays = if is_asked {
        let answer = ui.horizontal(|ui| {
            let goes = ui.button(sure).clicked();
            if goes {
                out.push(Command::Edit(Edit::RemoveClips(ids.clone())));
            }
            goes || ui.button("Keep them").clicked()
        });
        !answer.inner
    } else {
        ui.button("Remove these clips …").clicked()
    };
    ui.data_mut(|data| match stays {
        true => data.insert_temp(asked, (ids, pass)),
        false => data.remove::<(Vec<ClipId>, u64)>(asked),
    });
}

/// Tags as they are typed, parted by commas.
fn tags_of(text: &str) -> Vec<String> {
    let tags = text.split(',').map(|tag| tag.trim().to_owned());
    tags.filter(|tag| !tag.is_empty()).collect()
}

fn known(ui: &mut Ui, clip: &ClipInfo, out: Out) {
    let c = Colours::now(ui);
    Grid::new("known")
        .num_columns(2)
        .spacing([12.0, 2.0])
        .show(ui, |ui| {
            // Facts are lines of text, which need less room than buttons.
            ui.spacing_mut().interact_size.y = 19.0;
            let name = |ui: &mut Ui, text: &str| ui.colored_label(c.muted, text);
            name(ui, "Name");
            if let Some(to) = widgets::committed(ui, "Clip name", clip.id, &clip.name) {
                let from = clip.name.clone();
                out.push(Command::Edit(Edit::RenameClip { from, to }));
            }
            ui.end_row();
            let mut describe = |update| {
                out.push(Command::Edit(Edit::Describe {
                    clips: vec![clip.id],
                    update,
                }));
            };
            name(ui, "Person");
            if let Some(subject) =
                widgets::committed(ui, "Person", clip.id, clip.subject.as_deref().unwrap_or(""))
            {
                describe(ClipUpdate {
                    subject: Some(subject),
                    ..ClipUpdate::default()
                });
            }
            ui.end_row();
            name(ui, "Tags");
            let tags = clip.tags.join(", ");
            if let Some(text) = widgets::committed(ui, "Tags", clip.id, &tags) {
                let wanted = tags_of(&text);
                let gone = clip.tags.iter().filter(|t| !wanted.contains(t)).cloned();
                describe(ClipUpdate {
                    remove_tags: gone.collect(),
                    add_tags: wanted.clone(),
                    ..ClipUpdate::default()
                });
            }
            ui.end_row();
            name(ui, "Background");
            ui.vertical(|ui| background::mark(ui, &[clip], out));
            ui.end_row();
            let fact = |ui: &mut Ui, what: &str, text: String| {
                ui.colored_label(c.muted, what);
                let label = ui.add(egui::Label::new(text).truncate());
                ui.end_row();
                label
            };
            let frames = format!(
                "{}, {} frames at {:.0} Hz, {} joints",
                format::duration(clip.duration_secs()),
                format::grouped(clip.frames),
                clip.rate_hz,
                clip.joints
            );
            fact(ui, "Motion", frames);
            if clip.repaired_frames > 0 {
                fact(
                    ui,
                    "Repaired",
                    format!("{} frames were filled in", clip.repaired_frames),
                );
            }
            if let Some(source) = &clip.source {
                fact(ui, "Source", source.clone());
            }
            let file = format::file_name(std::path::Path::new(&clip.path));
            fact(ui, "File", file).on_hover_text(&clip.path);
        });
}
