//! The command line that does what an edit does.

use morec::roles::Role;
use morec_db::labels::SampleState as Judged;

use super::State;
use super::files::quoted;
use crate::store::Edit;

/// A word as it is typed in a shell.
fn word(text: &str) -> String {
    quoted(std::path::Path::new(text))
}

impl State {
    /// `None` where no command does the same in one line.
    pub(super) fn line_of(&self, edit: &Edit) -> Option<String> {
        let store = self.store.as_ref()?;
        let db = quoted(store.path());
        let clip = |id| Some(word(&store.snapshot.clip(id)?.name));
        let numbers = |ids: &[morec_db::labels::SampleId]| {
            let numbers: Vec<String> = ids.iter().take(8).map(|id| id.0.to_string()).collect();
            numbers.join(",")
        };
        Some(match edit {
            Edit::Label(samples) => {
                let s = samples.first()?;
                format!(
                    "morec db label {db} --clip {} --class {} --start {:.3} --stop {:.3}",
                    clip(s.clip)?,
                    word(&s.class),
                    s.start_secs,
                    s.stop_secs
                )
            }
            Edit::Move {
                id,
                start_secs,
                stop_secs,
            } => format!(
                "morec db samples {db} --move {} --start {start_secs:.3} --stop {stop_secs:.3}",
                id.0
            ),
            Edit::Replace { old, new, .. } => {
                let mut line = format!("morec db samples {db} --remove {}", numbers(old));
                for s in new.iter().take(2) {
                    line += &format!(
                        " && morec db label {db} --clip {} --class {} --start {:.3} --stop {:.3}",
                        clip(s.clip)?,
                        word(&s.class),
                        s.start_secs,
                        s.stop_secs
                    );
                }
                line
            }
            Edit::Cuts { clip, cuts, .. } => {
                let mut cuts = cuts.clone();
                cuts.sort_by(f64::total_cmp);
                let at: Vec<String> = cuts.iter().map(|cut| format!("{cut:.3}")).collect();
                let name = word(&clip.name);
                format!("morec cut {db} --name {name} --at {}", at.join(","))
            }
            Edit::ForgetCuts(_) => return None,
            Edit::Roles(clips) => {
                let (id, roles) = clips.first()?;
                let before = store.snapshot.roles.get(id)?;
                let joints = self.player.motion.as_ref().filter(|m| m.id == *id)?;
                let joints = joints.clip.skeleton.joints();
                let mut line = format!("morec db clips {db} --name {}", clip(*id)?);
                for role in Role::ALL {
                    let joint = roles.joint(role);
                    if joint != before.joint(role) {
                        let name = joint.and_then(|j| joints.get(j)).map_or("", |j| &j.name);
                        line += &format!(" --set-role {}", word(&format!("{role}={name}")));
                    }
                }
                line
            }
            Edit::Reclass { ids, class } => format!(
                "morec db classes {db} --split {} --into {}",
                numbers(ids),
                word(class)
            ),
            Edit::Remove(ids) => format!("morec db samples {db} --remove {}", numbers(ids)),
            Edit::Judge { ids, state } => {
                let s = store.snapshot.sample(*ids.first()?)?;
                let state = match state {
                    Judged::Accepted => "accepted",
                    Judged::Proposed => "proposed",
                    Judged::Rejected => "rejected",
                };
                format!(
                    "morec db label {db} --clip {} --class {} --start {:.3} --stop {:.3} --state {state}",
                    word(&s.clip_name),
                    word(&s.class),
                    s.start_secs,
                    s.stop_secs
                )
            }
            Edit::RenameClass { from, to } => {
                format!("morec db classes {db} --rename {} {}", word(from), word(to))
            }
            Edit::RemoveClass(name) => {
                format!("morec db classes {db} --forget {}", word(name))
            }
            Edit::Describe { clips, update } => {
                let name = clip(*clips.first()?)?;
                let mut line = format!("morec db clips {db} --name {name}");
                let parts = [
                    ("--set-subject", &update.subject),
                    ("--set-source", &update.source),
                    ("--set-licence", &update.licence),
                ];
                for (option, text) in parts {
                    if let Some(text) = text {
                        line += &format!(" {option} {}", word(text));
                    }
                }
                for tag in &update.add_tags {
                    line += &format!(" --add-tag {}", word(tag));
                }
                for tag in &update.remove_tags {
                    line += &format!(" --remove-tag {}", word(tag));
                }
                line
            }
            Edit::RenameClip { from, to } => {
                format!("morec db clips {db} --rename {} {}", word(from), word(to))
            }
            Edit::RemoveClips(clips) => {
                let name = clip(*clips.first()?)?;
                format!("morec db clips {db} --name {name} --remove")
            }
            Edit::KeepIndex { name, .. } => {
                format!("morec train --db {db} -o {}.index", word(name))
            }
            Edit::Undo(None) => format!("morec db undo {db}"),
            Edit::Undo(Some(step)) => format!("morec db undo {db} {step}"),
            Edit::Redo => format!("morec db redo {db}"),
        })
    }
}
