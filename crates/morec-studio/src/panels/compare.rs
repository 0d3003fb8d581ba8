//! Companions of the performer, and the buttons that place them.

use egui::Ui;
use morec::kinematics::WorldPose;

use super::Out;
use crate::body::ClipMotion;
use crate::body::mesh::BodyColours;
use crate::body::{Body, companion};
use crate::format;
use crate::state::compare::Placement;
use crate::state::{Command, CompareCommand, State};
use crate::theme::Colours;

/// Somebody beside the performer.
pub struct Other<'a> {
    pub body: &'a Body,
    pub pose: WorldPose,
    pub palette: BodyColours,
    /// Said at their feet.
    pub caption: String,
}

/// The companions at the present moment.
pub fn others<'a>(state: &'a State, motion: &ClipMotion, c: &Colours) -> Vec<Other<'a>> {
    let at = state.player.at_secs;
    let on_top = state.companions.placement == Placement::OnTop;
    let here = state
        .companions
        .all
        .iter()
        .filter(|a| a.of.clip == motion.id);
    here.enumerate()
        .map(|(number, aligned)| {
            let apart = state.apart() * (number + 1) as f64;
            let name = &aligned.motion.clip.name;
            let image = if aligned.mirrored { ", mirrored" } else { "" };
            Other {
                body: &aligned.motion.body,
                pose: companion::pose(aligned, motion, at, apart),
                // Bodies in one place are distinguished by their colour.
                palette: match on_top {
                    true => c.body().mixed(c.good, 0.75),
                    false => c.body().mixed(c.good, 0.25),
                },
                caption: format!(
                    "{name}, {}{image}",
                    format::secs(aligned.with.span.start_secs)
                ),
            }
        })
        .collect()
}

/// Caption of the performer where there are companions.
pub fn caption(state: &State, motion: &ClipMotion) -> Option<String> {
    let first = state.companions.all.first()?;
    let start = format::secs(first.of.span.start_secs);
    Some(format!("{}, {start}", motion.clip.name))
}

/// Beside or on top; alone again.
pub fn controls(ui: &mut Ui, state: &State, out: Out) {
    if state.companions.all.is_empty() {
        return;
    }
    let mut compare = |command| out.push(Command::Compare(command));
    ui.separator();
    for (text, placement) in [("Beside", Placement::Beside), ("On top", Placement::OnTop)] {
        let on = state.companions.placement == placement;
        if ui.selectable_label(on, text).clicked() {
            compare(CompareCommand::Place(placement));
        }
    }
    if ui.button("Alone").clicked() {
        compare(CompareCommand::Clear);
    }
}
