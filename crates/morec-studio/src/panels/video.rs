//! The video beside a clip: its file, and the time of it at which the clip begins.

use egui::Ui;
use morec_db::{ClipInfo, ClipVideo};

use super::{Out, widgets};
use crate::format;
use crate::state::video::VideoCommand;
use crate::state::{Command, FileCommand, State};
use crate::store::Edit;
use crate::theme::Colours;

pub fn show(ui: &mut Ui, state: &State, clip: &ClipInfo, out: Out) {
    let Some(store) = &state.store else { return };
    widgets::section(ui, "VIDEO");
    let Some(video) = store.snapshot.videos.get(&clip.id) else {
        ui.horizontal(|ui| {
            if ui.button("Choose a video …").clicked() {
                out.push(Command::File(FileCommand::AskVideo));
            }
            let muted = Colours::now(ui).muted;
            ui.colored_label(
                muted,
                "It plays in step with the clip, here and in its page.",
            );
        });
        return;
    };
    let set = |video: Option<ClipVideo>| {
        let clip = clip.name.clone();
        Command::Edit(Edit::Video { clip, video })
    };
    ui.horizontal_wrapped(|ui| {
        let name = format::file_name(video.path.as_ref());
        ui.label(name).on_hover_text(&video.path);
        let page = ui.button("A page with the video …");
        let hint = "A page that plays clip and video in step; it names the video's file and does not hold it";
        if page.on_hover_text(hint).clicked() {
            out.push(Command::File(FileCommand::AskExportPage));
        }
        if ui.button("Choose another …").clicked() {
            out.push(Command::File(FileCommand::AskVideo));
        }
        if ui.button("Remove the video").clicked() {
            out.push(set(None));
        }
    });
    let moved = |offset_secs: f64| ClipVideo {
        offset_secs,
        ..video.clone()
    };
    if state.shown_clip().is_some_and(|shown| shown.id == clip.id) {
        of_shown(ui, state, |offset_secs| set(Some(moved(offset_secs))), out);
    }
    let secs = |text: &str| text.trim().trim_end_matches('s').trim().parse::<f64>().ok();
    ui.horizontal(|ui| {
        ui.label("The clip begins at");
        let now = format!("{:.3}", video.offset_secs);
        let field = "Time of the video at which the clip begins";
        let typed = widgets::committed(ui, field, clip.id, &now);
        if let Some(at) = typed.as_deref().and_then(secs) {
            out.push(set(Some(moved(at))));
        }
        ui.label("s");
    });
    ui.horizontal(|ui| {
        ui.label("The video at the playhead is at");
        let at = state.player.at_secs;
        let now = format!("{:.3}", video.offset_secs + at);
        let field = "Time of the video at the playhead";
        let typed = widgets::committed(ui, field, (clip.id, at.to_bits()), &now);
        if let Some(there) = typed.as_deref().and_then(secs) {
            out.push(set(Some(moved(there - at))));
        }
        ui.label("s");
    });
}

/// What needs the motion of the clip and the sound of its video.
fn of_shown(ui: &mut Ui, state: &State, set: impl Fn(f64) -> Command, out: Out) {
    ui.horizontal_wrapped(|ui| {
        let along = state.video.along.is_some();
        let text = ["Play video along", "Close the video"][usize::from(along)];
        let hint =
            "Shows the video in a window of its own, by the program mpv; it follows the playhead";
        if ui.button(text).on_hover_text(hint).clicked() {
            out.push(Command::Video(VideoCommand::Along(!along)));
        }
        let hint = "The loudest onset of the sound is when the hands meet in the clip";
        if ui
            .button("Offset from a clap")
            .on_hover_text(hint)
            .clicked()
        {
            out.push(Command::Video(VideoCommand::FromClap(true)));
        }
    });
    let clap = state
        .shown_sound()
        .and_then(|sound| sound.clap.as_ref().ok());
    if let Some(clap) = clap.filter(|_| state.video.proposed) {
        let offset_secs = clap.offset_secs();
        ui.label(format!(
            "The hands meet at {:.2} s of the clip, the loudest onset is at {:.2} s of the video: the clip begins at {offset_secs:.3} s.",
            clap.hands_secs, clap.sound_secs
        ));
        ui.horizontal(|ui| {
            if ui.button("Use this offset").clicked() {
                out.push(set(offset_secs));
                out.push(Command::Video(VideoCommand::FromClap(false)));
            }
            if ui.button("Leave the offset").clicked() {
                out.push(Command::Video(VideoCommand::FromClap(false)));
            }
        });
    }
}
