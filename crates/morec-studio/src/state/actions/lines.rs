//! The command line that does what was just done. Tests parse every kind of line with the command's own parser.

use std::path::Path;

use morec::roles::Role;
use morec_db::labels::{DbSample, NewSample, SampleId, SampleState, WholeClip};
use morec_db::{ClipId, ClipUpdate};
use morec_ops::TrainSettings;
use serde::Serialize;

use crate::state::State;
use crate::store::{Edit, Snapshot};

/// Lines for more clips or labels than these would be of no use to anybody.
const MOST: usize = 50;

/// A command line in the making; values are quoted for a POSIX shell.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(in crate::state) struct ShownCommand(String);

impl ShownCommand {
    /// The program and its subcommands, as `morec db clips`.
    pub fn new(command: &str) -> Self {
        Self(command.to_owned())
    }

    /// Adds a value.
    pub fn word(mut self, value: impl AsRef<Path>) -> Self {
        self.0 += &format!(" {}", quoted(value.as_ref()));
        self
    }

    /// Adds an option with its value.
    pub fn with(mut self, option: &str, value: impl AsRef<Path>) -> Self {
        let value = quoted(value.as_ref());
        // A value that begins like an option would be taken for one.
        let between = if value.starts_with('-') { '=' } else { ' ' };
        self.0 += &format!(" {option}{between}{value}");
        self
    }

    /// Adds an option with a time in seconds.
    pub fn secs(self, option: &str, secs: f64) -> Self {
        self.with(option, format!("{secs:.3}"))
    }

    /// Adds an option with values separated by commas; nothing if there is none.
    pub fn list<S: AsRef<str>>(self, option: &str, values: &[S]) -> Self {
        let values: Vec<&str> = values.iter().map(AsRef::as_ref).collect();
        match values.is_empty() {
            true => self,
            false => self.with(option, values.join(",")),
        }
    }

    /// Adds the options of an operation's settings that are not as usual.
    pub fn settings<S: Serialize + Default + clap::Args>(self, settings: &S) -> Self {
        let options = morec_ops::arguments(settings).into_iter();
        options.fold(self, |line, (option, value)| match value {
            Some(value) => line.with(&option, value),
            None => line.flag(&option, true),
        })
    }

    /// Adds an option without a value, if `on`.
    pub fn flag(mut self, option: &str, on: bool) -> Self {
        if on {
            self.0 += &format!(" {option}");
        }
        self
    }

    /// Another command after this one, if this one succeeds.
    pub fn and(self, next: ShownCommand) -> Self {
        Self(format!("{} && {}", self.0, next.0))
    }

    /// Several commands, one after the other; `None` for none and for too many.
    pub fn all(lines: impl ExactSizeIterator<Item = ShownCommand>) -> Option<ShownCommand> {
        (lines.len() <= MOST).then(|| lines.reduce(ShownCommand::and))?
    }
}

/// A path, or another value, as it is typed in a shell.
fn quoted(value: &Path) -> String {
    let text = value.display().to_string();
    let plain = |c: char| c.is_alphanumeric() || "/._-+=:,@".contains(c);
    match !text.is_empty() && text.chars().all(plain) {
        true => text,
        false => format!("'{}'", text.replace('\'', r"'\''")),
    }
}

fn numbers(ids: impl IntoIterator<Item = SampleId>) -> Vec<String> {
    ids.into_iter().map(|id| id.0.to_string()).collect()
}

/// The command that trains an index.
pub(super) fn train_line(
    db: &Path,
    settings: &TrainSettings,
    output: impl AsRef<Path>,
) -> ShownCommand {
    let line = ShownCommand::new("morec train").with("--db", db);
    line.settings(settings).with("-o", output)
}

/// The command that labels a stretch, without the label's state.
fn stretch_line(db: &Path, snapshot: &Snapshot, sample: &NewSample) -> Option<ShownCommand> {
    let line = ShownCommand::new("morec db label").word(db);
    let line = line
        .with("--clip", &snapshot.clip(sample.clip)?.name)
        .with("--class", &sample.class)
        .secs("--start", sample.start_secs)
        .secs("--stop", sample.stop_secs);
    Some(line)
}

/// The command that sets a label.
fn label_line(
    db: &Path,
    snapshot: &Snapshot,
    sample: &NewSample,
    annotator: Option<&String>,
) -> Option<ShownCommand> {
    let line = by(stretch_line(db, snapshot, sample)?, annotator);
    Some(match sample.state {
        SampleState::Accepted => line,
        state => line.with("--state", state.name()),
    })
}

/// Names the annotator of a label, if there is one.
fn by(line: ShownCommand, annotator: Option<&String>) -> ShownCommand {
    annotator
        .into_iter()
        .fold(line, |line, name| line.with("--annotator", name))
}

/// The commands that set labels.
fn label_lines(
    db: &Path,
    snapshot: &Snapshot,
    samples: &[NewSample],
    annotator: Option<&String>,
) -> Option<ShownCommand> {
    let lines: Option<Vec<ShownCommand>> = samples
        .iter()
        .map(|sample| label_line(db, snapshot, sample, annotator))
        .collect();
    ShownCommand::all(lines?.into_iter())
}

/// The commands that put labels in place of others: one for each label and annotator.
fn replace_lines(
    db: &Path,
    snapshot: &Snapshot,
    old: &[DbSample],
    new: &[(NewSample, Vec<String>)],
) -> Option<ShownCommand> {
    let remove = ShownCommand::new("morec db samples").word(db);
    let remove = remove.list("--remove", &numbers(old.iter().map(|s| s.id)));
    let mut lines = vec![Some(remove)];
    for (sample, annotators) in new {
        let line = |name| label_line(db, snapshot, sample, name);
        match annotators.is_empty() {
            true => lines.push(line(None)),
            false => lines.extend(annotators.iter().map(|name| line(Some(name)))),
        }
    }
    let lines: Option<Vec<ShownCommand>> = lines.into_iter().collect();
    ShownCommand::all(lines?.into_iter())
}

/// The commands that say what whole clips show, and who is in them.
fn whole_lines(
    db: &Path,
    snapshot: &Snapshot,
    clips: &[WholeClip],
    annotator: Option<&String>,
) -> Option<ShownCommand> {
    let line = |whole: &WholeClip| {
        let name = &snapshot.clip(whole.clip)?.name;
        let of_clip = |command: &str| ShownCommand::new(command).word(db).with("--clip", name);
        let label = whole.class.as_ref();
        let label = label.map(|class| {
            let line = of_clip("morec db label").with("--class", class);
            by(line, annotator)
        });
        let about = whole.subject.as_ref();
        let about = about.map(|name| of_clip("morec db clips").with("--set-subject", name));
        label.into_iter().chain(about).reduce(ShownCommand::and)
    };
    let lines: Option<Vec<ShownCommand>> = clips.iter().map(line).collect();
    ShownCommand::all(lines?.into_iter())
}

/// The commands that do the same to each of several clips: one for all clips of the database, else one for each.
fn each_clip(
    db: &Path,
    snapshot: &Snapshot,
    clips: impl ExactSizeIterator<Item = ClipId>,
    rest: impl Fn(ShownCommand) -> ShownCommand,
) -> Option<ShownCommand> {
    let line = |name: &str| {
        rest(
            ShownCommand::new("morec db clips")
                .word(db)
                .with("--clip", name),
        )
    };
    if clips.len() > 1 && clips.len() == snapshot.clips.len() {
        return Some(line("*"));
    }
    let names: Option<Vec<&str>> = clips
        .map(|id| Some(snapshot.clip(id)?.name.as_str()))
        .collect();
    ShownCommand::all(names?.into_iter().map(line))
}

/// The commands that change what is known about clips.
fn describe_line(
    db: &Path,
    snapshot: &Snapshot,
    clips: &[ClipId],
    update: &ClipUpdate,
) -> Option<ShownCommand> {
    let about = |mut line: ShownCommand| {
        let parts = [
            ("--set-subject", &update.subject),
            ("--set-source", &update.source),
            ("--set-licence", &update.licence),
        ];
        for (option, text) in parts {
            if let Some(text) = text {
                line = line.with(option, text);
            }
        }
        for tag in &update.add_tags {
            line = line.with("--add-tag", tag);
        }
        for tag in &update.remove_tags {
            line = line.with("--remove-tag", tag);
        }
        line
    };
    each_clip(db, snapshot, clips.iter().copied(), about)
}

impl State {
    /// Shows the command line of what was asked for.
    pub(in crate::state) fn show_line(&mut self, line: impl Into<Option<ShownCommand>>) {
        self.command_line = line.into().map_or_else(String::new, |line| line.0);
    }

    /// The command line of an edit; `None` where no command does the same.
    pub(in crate::state) fn line_of(&self, edit: &Edit) -> Option<ShownCommand> {
        let store = self.store.as_ref()?;
        let (db, snapshot) = (store.path(), &*store.snapshot);
        let annotator = self.study.annotator.as_ref();
        let morec = |command: &str| ShownCommand::new(&format!("morec {command}")).word(db);
        Some(match edit {
            Edit::Label(samples) => label_lines(db, snapshot, samples, annotator)?,
            Edit::WholeClips(clips) => whole_lines(db, snapshot, clips, annotator)?,
            Edit::LabelFiles { paths, replace, .. } => {
                let line = paths.iter().fold(morec("db label"), ShownCommand::word);
                line.flag("--replace", *replace)
            }
            Edit::Move {
                id,
                start_secs,
                stop_secs,
            } => morec("db samples")
                .with("--move", id.0.to_string())
                .secs("--start", *start_secs)
                .secs("--stop", *stop_secs),
            Edit::Replace { old, new, .. } => replace_lines(db, snapshot, old, new)?,
            Edit::Cuts { cuts, .. } if cuts.is_empty() => return None,
            Edit::Cuts { clip, cuts, .. } => {
                let mut cuts = cuts.clone();
                cuts.sort_by(f64::total_cmp);
                let at: Vec<String> = cuts.iter().map(|cut| format!("{cut:.3}")).collect();
                morec("cut").with("--clip", &clip.name).list("--at", &at)
            }
            Edit::ForgetCuts(_) => return None,
            Edit::Roles(clips) => return self.roles_line(db, snapshot, clips),
            Edit::Reclass { ids, class } => morec("db classes")
                .list("--split", &numbers(ids.iter().copied()))
                .with("--into", class),
            Edit::Remove(ids) => {
                morec("db samples").list("--remove", &numbers(ids.iter().copied()))
            }
            Edit::Judge { ids, state } => {
                let accepts = *state == SampleState::Accepted;
                let line = |id: &SampleId| {
                    let s = snapshot.sample(*id)?;
                    let line = stretch_line(db, snapshot, &NewSample::from(s))?;
                    let line = by(line, annotator.filter(|_| accepts));
                    Some(line.with("--state", state.name()))
                };
                let lines: Option<Vec<ShownCommand>> = ids.iter().map(line).collect();
                ShownCommand::all(lines?.into_iter())?
            }
            Edit::RenameClass { from, to } => morec("db classes").with("--rename", from).word(to),
            Edit::MergeClass { from, into } => {
                let line = morec("db classes").with("--merge", from);
                line.with("--into", into)
            }
            // Tags follow from what the classes of each clip are.
            Edit::ClassIsBackground(_) => return None,
            Edit::RemoveClass(name) => morec("db classes").with("--forget", name),
            Edit::Describe { clips, update } => describe_line(db, snapshot, clips, update)?,
            Edit::Background { clips, on } => {
                describe_line(db, snapshot, clips, &crate::store::background(*on))?
            }
            Edit::RenameClip { from, to } => morec("db clips").with("--rename", from).word(to),
            Edit::Video { clip, video } => {
                let line = morec("db clips").with("--clip", clip);
                match video {
                    Some(video) => line
                        .with("--set-video", &video.path)
                        .secs("--video-offset", video.offset_secs),
                    None => line.with("--set-video", ""),
                }
            }
            Edit::RemoveClips(clips) => {
                let remove = |line: ShownCommand| line.flag("--remove", true);
                each_clip(db, snapshot, clips.iter().copied(), remove)?
            }
            Edit::KeepIndex { name, .. } => {
                train_line(db, &self.train_settings(), format!("{name}.index"))
            }
            Edit::Undo(None) => morec("db undo"),
            Edit::Undo(Some(step)) => morec("db undo").word(step.to_string()),
            Edit::Redo => morec("db redo"),
        })
    }

    /// The command that gives parts of the body to other joints.
    fn roles_line(
        &self,
        db: &Path,
        snapshot: &Snapshot,
        clips: &[(ClipId, morec::roles::RoleMap)],
    ) -> Option<ShownCommand> {
        let (id, roles) = clips.first()?;
        let before = snapshot.roles.get(id)?;
        let motion = self.player.motion.as_ref().filter(|m| m.id == *id);
        let joints = motion
            .or(self.player.motion.as_ref())?
            .clip
            .skeleton
            .joints();
        let set = |mut line: ShownCommand| {
            for role in Role::ALL {
                let joint = roles.joint(role);
                if joint != before.joint(role) {
                    let name = joint.and_then(|j| joints.get(j)).map_or("", |j| &j.name);
                    line = line.with("--set-role", format!("{role}={name}"));
                }
            }
            line
        };
        each_clip(db, snapshot, clips.iter().map(|(id, _)| *id), set)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_quoted_where_a_shell_would_read_them_otherwise() {
        let line = ShownCommand::new("morec train")
            .with("--db", Path::new("my moves.mdb"))
            .list("--classes", &["gesture 1", "it's"])
            .with("-o", "-x.index")
            .flag("--json", false);
        let said = r"morec train --db 'my moves.mdb' --classes 'gesture 1,it'\''s' -o=-x.index";
        assert_eq!(line.0, said);
        assert_eq!(
            ShownCommand::new("morec").list::<&str>("--classes", &[]).0,
            "morec"
        );
    }

    #[test]
    fn lines_follow_one_another_and_too_many_are_none() {
        let lines = |n: usize| ShownCommand::all(vec![ShownCommand::new("a"); n].into_iter());
        assert_eq!(lines(2).unwrap().0, "a && a");
        assert_eq!(lines(0), None);
        assert_eq!(lines(MOST + 1), None);
    }
}
