//! Opening, saving, importing.

use std::path::{Path, PathBuf};

use morec::labels::Mark;
use morec_db::{ClipId, ClipVideo, DbError};

use super::lines::ShownCommand;
use super::train::INDEX;
use crate::format::file_name;
use crate::jobs::example::MadeDatabase;
use crate::jobs::export::{self, Export};
use crate::jobs::{JobOutcome, Jobs, example, import};
use crate::state::study::StudyState;
use crate::state::{
    Ask, Classes, FileCommand, Library, Live, Motions, PlayCommand, Player, State, TimelineState,
    Train, TypedPath, dialog,
};
use crate::store::{DbPlace, Edit, Store};
use crate::unsaved::{self, Leftover, OwnFolder};

const MAKING: &str = "Creating an example";

impl State {
    /// Opens what was named on the command line: a database, clips, or nothing, which is the example.
    pub fn begin(&mut self, paths: &[PathBuf]) {
        match paths {
            [] => self.make_example(),
            [one] if is_database(one) => self.open(one),
            clips => self.open_clips(clips),
        }
        self.leftovers = unsaved::leftovers(&self.unsaved);
    }

    fn open(&mut self, path: &Path) {
        if !path.exists() {
            self.complain(format!("{}: no such file", file_name(path)));
            return;
        }
        self.open_store(path, false);
    }

    pub(in crate::state) fn open_store(&mut self, path: &Path, temporary: bool) {
        let place = DbPlace {
            path: path.to_owned(),
            signature: self.signature.clone(),
        };
        match Store::open(place, temporary, self.wake.clone()) {
            Ok(store) => {
                let first = store.snapshot.clips.first().map(|c| c.id);
                self.forget();
                self.succeeded();
                self.say(match temporary {
                    true => {
                        "the database is in a temporary folder: save a copy to keep it".to_owned()
                    }
                    false => format!("{} opened", file_name(path)),
                });
                // A file of this run's own is no use to anybody else.
                if !temporary {
                    self.show_line(ShownCommand::new("morec-studio").word(path));
                }
                self.store = Some(store);
                self.use_last_index();
                if let Some(clip) = first {
                    self.open_clip(clip, None);
                }
            }
            Err(error) => {
                let (name, said) = (file_name(path), error.to_string());
                let named = said.contains(&name);
                self.complain(match error {
                    DbError::Damaged(_) => {
                        format!("{name}: {said}; open a copy of it, or import its clips again")
                    }
                    DbError::Disk(_) => {
                        format!("{name}: {said}; check the free space of the disk and the permissions of the folder")
                    }
                    _ if named => crate::store::sentence(&said),
                    _ => format!("{name}: {said}"),
                });
            }
        }
    }

    /// Forgets everything of the database that was open.
    fn forget(&mut self) {
        self.jobs.running.iter().for_each(|job| job.cancel());
        self.store = None;
        self.jobs = Jobs::default();
        self.library = Library::default();
        self.player = Player::new();
        self.timeline = TimelineState::default();
        self.curves = None;
        self.detections = None;
        self.classes = Classes::default();
        // Who sits before the window stays.
        self.study = StudyState {
            annotator: self.study.annotator.take(),
            ..StudyState::default()
        };
        self.train = Train::default();
        self.live = Live::default();
        self.import_report = None;
        self.label_import = None;
        self.motions = Motions::default();
        self.pending = None;
        self.companions.all.clear();
        self.channel = None;
        self.seen_version = 0;
    }

    fn own_folder(&mut self) -> Option<PathBuf> {
        if self.folder.is_none() {
            match OwnFolder::new(&self.unsaved) {
                Ok(folder) => self.folder = Some(folder),
                Err(error) => self.complain(format!(
                    "{}: no folder can be made: {error}",
                    self.unsaved.display()
                )),
            }
        }
        self.folder.as_ref().map(|folder| folder.path().to_owned())
    }

    /// True if what was done would be lost with the database, which nobody has named yet.
    pub fn is_unsaved(&self) -> bool {
        self.store.as_ref().is_some_and(|store| {
            store.temporary && (store.is_busy() || store.snapshot.undo_step().is_some())
        })
    }

    /// Removes the database that nobody has named, and goes on with what waited for that.
    fn leave(&mut self) {
        let Some(then) = self.leaving.take() else {
            return;
        };
        if self.store.as_ref().is_some_and(|s| s.temporary) {
            self.forget();
            self.drop_folder();
        }
        self.apply_file(then);
    }

    fn drop_folder(&mut self) {
        if let Some(folder) = self.folder.take() {
            folder.remove();
        }
    }

    fn open_leftover(&mut self, at: usize) {
        if at >= self.leftovers.len() {
            return;
        }
        let Leftover {
            folder, database, ..
        } = self.leftovers.remove(at);
        self.forget();
        self.drop_folder();
        self.folder = Some(folder);
        self.open_store(&database, true);
    }

    /// Folder for files that are kept for a moment.
    pub(in crate::state) fn scratch(&mut self) -> PathBuf {
        self.own_folder().unwrap_or_else(std::env::temp_dir)
    }

    /// Shows a database that was made of clips, or the example.
    pub(in crate::state) fn show_made(&mut self, made: MadeDatabase) {
        if let Some(path) = &made.path {
            self.open_store(path, true);
        }
        // That all clips are there is seen without a report.
        if let Some(report) = made.report.filter(|report| report.says_anything()) {
            self.show_report(report);
        }
    }

    /// True while the example is open and nothing was done to it.
    fn is_untouched_example(&self) -> bool {
        let example = |store: &Store| store.path().file_name() == Some(example::NAME.as_ref());
        self.store.as_ref().is_some_and(|store| {
            store.temporary && example(store) && store.snapshot.history.is_empty()
        })
    }

    /// What becomes of files that are dropped, in words.
    pub fn if_dropped(&self, paths: &[PathBuf]) -> String {
        let name = |store: &Store| file_name(store.path());
        match (paths, &self.store) {
            ([one], _) if is_database(one) => format!("{} is opened", file_name(one)),
            (_, Some(store)) if !self.is_untouched_example() => {
                format!("into {}", name(store).trim_end_matches(".mdb"))
            }
            _ => "a new database is created".to_owned(),
        }
    }

    fn make_example(&mut self) {
        let Some(folder) = self.own_folder() else {
            return;
        };
        self.show_line(ShownCommand::new("morec-studio"));
        self.jobs.start(
            MAKING,
            true,
            &self.wake,
            JobOutcome::Made,
            move |progress| example::make(&folder, progress),
        );
    }

    fn open_clips(&mut self, clips: &[PathBuf]) {
        let Some(folder) = self.own_folder() else {
            return;
        };
        // The example, if it is not there yet, is not wanted any more.
        self.jobs.running.retain(|job| job.name != MAKING);
        let clips = clips.to_vec();
        let line = ShownCommand::new("morec-studio");
        self.show_line(clips.iter().fold(line, ShownCommand::word));
        self.jobs.start(
            "Importing clips",
            true,
            &self.wake,
            JobOutcome::Made,
            move |progress| example::of_clips(&folder, &clips, progress),
        );
    }

    pub(in crate::state) fn apply_file(&mut self, command: FileCommand) {
        // What cannot be opened is refused before anything is discarded for it.
        let refused = match &command {
            FileCommand::Open(path) => !path.exists(),
            FileCommand::New(path) => path.exists(),
            _ => false,
        };
        if command.leaves() && !refused && self.is_unsaved() {
            self.leaving = Some(command);
            return;
        }
        match command {
            FileCommand::Close => self.closing = true,
            FileCommand::LeaveSaving => self.ask = Some(Ask::Save),
            FileCommand::LeaveDiscarding => self.leave(),
            FileCommand::Stay => self.leaving = None,
            FileCommand::OpenLeftover(at) => self.open_leftover(at),
            FileCommand::LeaveLeftover(at) => {
                if at < self.leftovers.len() {
                    self.leftovers.remove(at);
                }
            }
            FileCommand::AskDiscard(at) => self.discarding = at,
            FileCommand::DiscardLeftover(at) => {
                if self.discarding.take() == Some(at) && at < self.leftovers.len() {
                    self.leftovers.remove(at).folder.remove();
                }
            }
            FileCommand::AskImportLabels => self.ask = Some(Ask::ImportLabels),
            FileCommand::AskVideo => self.ask = self.shown_name().map(Ask::Video),
            FileCommand::Video(clip, path) => {
                let video = ClipVideo {
                    path: path.display().to_string(),
                    offset_secs: 0.0,
                };
                let video = Some(video);
                self.edit(Edit::Video { clip, video });
            }
            FileCommand::AskCaptions => self.ask = Some(Ask::Captions),
            FileCommand::Captions(paths) => self.read_captions(paths),
            FileCommand::ImportLabels(paths) => self.read_labels(paths),
            FileCommand::ReplaceLabels(replace) => self.replace_labels(replace),
            FileCommand::ApplyLabels => self.apply_labels(),
            FileCommand::DismissLabels => self.label_import = None,
            FileCommand::NoDialog(ask) => {
                self.typed = Some(TypedPath {
                    text: dialog(&ask).file_name,
                    ask,
                    begun: false,
                });
            }
            FileCommand::Typing(None) => self.typed = None,
            FileCommand::Typing(Some(text)) => {
                if let Some(typed) = &mut self.typed {
                    (typed.text, typed.begun) = (text, true);
                }
            }
            FileCommand::AskOpen => self.ask = Some(Ask::Open),
            FileCommand::AskNew => self.ask = Some(Ask::New),
            FileCommand::AskImport => self.ask = Some(Ask::Import),
            FileCommand::AskImportFolder => self.ask = Some(Ask::ImportFolder),
            FileCommand::AskSave => self.ask = Some(Ask::Save),
            FileCommand::AskExportReport(id) => self.ask = Some(Ask::ExportReport(id)),
            FileCommand::AskExportIndex => self.ask = Some(Ask::ExportIndex),
            FileCommand::Open(path) => self.open(&path),
            FileCommand::New(path) => match path.exists() {
                true => self.complain(format!("{}: this file exists already", file_name(&path))),
                false => self.open_store(&path, false),
            },
            FileCommand::Import(paths) => self.import(paths),
            FileCommand::Save(path) => self.save(&path),
            FileCommand::ExportReport(id, path) => self.export_report(id, &path),
            FileCommand::ExportIndex(path) => self.export_index(&path),
            FileCommand::AskExportLabels(form) => self.ask = Some(Ask::ExportLabels(form)),
            FileCommand::AskExportClip => self.ask = self.shown_name().map(Ask::ExportClip),
            FileCommand::AskExportStretch => {
                self.ask = self.shown_name().map(Ask::ExportStretch);
            }
            FileCommand::AskExportClass(class) => self.ask = Some(Ask::ExportClass(class)),
            FileCommand::ExportStretch(path) => match self.selected_stretch() {
                Some((of, _)) => self.export(Export::Stretch(of), path),
                None => self.say("select a label or a stretch first"),
            },
            FileCommand::ExportClass(class, path) => self.export(Export::Class(class), path),
            FileCommand::AskExportPage => self.ask = self.shown_name().map(Ask::ExportPage),
            FileCommand::ExportLabels(form, path) => self.export(Export::Labels(form), path),
            FileCommand::ExportClip(path) => {
                if let Some(clip) = self.player.motion.as_ref().map(|m| m.id) {
                    self.export(Export::Clip(clip), path);
                }
            }
            FileCommand::AskExportBudget => self.ask = Some(Ask::ExportBudget),
            FileCommand::ExportBudget(path) => self.export_budget(&path),
            FileCommand::ExportPage(path) => self.export_page(path),
        }
    }

    fn import(&mut self, paths: Vec<PathBuf>) {
        let databases = paths.iter().filter(|p| is_database(p)).count();
        if databases == 1 && paths.len() == 1 {
            self.apply_file(FileCommand::Open(paths[0].clone()));
            return;
        }
        let Some(store) = self.store.as_ref().filter(|_| !self.is_untouched_example()) else {
            self.open_clips(&paths);
            return;
        };
        let db = store.place();
        let line = ShownCommand::new("morec db import").word(&db.path);
        self.show_line(paths.iter().fold(line, ShownCommand::word));
        self.jobs.start(
            "Importing clips",
            true,
            &self.wake,
            JobOutcome::Imported,
            move |progress| import::import(&db, &paths, progress),
        );
    }

    fn shown_name(&self) -> Option<String> {
        Some(self.shown_clip()?.name.clone())
    }

    /// A page of the clip that is shown, with what the index in use recognises in it.
    fn export_page(&mut self, path: PathBuf) {
        let Some(clip) = self.player.motion.as_ref().map(|m| m.id) else {
            return;
        };
        let found = self.detections.iter().filter(|(of, _)| *of == clip);
        let detections = found.flat_map(|(_, found)| found);
        let detections = detections.map(|f| Mark::new(f.class.as_str(), f.span));
        let detections = detections.collect();
        self.export(Export::Page(clip, detections), path);
    }

    fn export(&mut self, what: Export, path: PathBuf) {
        let Some(store) = &self.store else { return };
        let line = export_line(store, self.train.index.is_some(), &what, &path);
        let db = store.path().to_owned();
        self.show_line(line);
        self.jobs.start(
            "Exporting",
            true,
            &self.wake,
            JobOutcome::Written,
            move |_| export::export(&db, &what, &path),
        );
    }

    /// A copy of the database somewhere else, which is then the one that is open.
    fn save(&mut self, path: &Path) {
        let Some(store) = &self.store else { return };
        if store.is_busy() || !self.jobs.running.iter().all(|j| !j.shown) {
            self.complain(
                "Not saved yet: wait until the work at the bottom is done, then save again",
            );
            return;
        }
        let (from, temporary) = (store.path().to_owned(), store.temporary);
        let shown = self.player.motion.clone();
        let at_secs = self.player.at_secs;
        // The log is empty once the last connection closes.
        self.store = None;
        let copied = settle(&from).and_then(|()| copy_whole(&from, path));
        match copied {
            Ok(()) => {
                self.open_store(path, false);
                if temporary && self.store.is_some() {
                    self.drop_folder();
                }
                self.leave();
            }
            Err(error) => {
                self.open_store(&from, temporary);
                self.complain(format!("{}: not saved: {error}", file_name(path)));
            }
        }
        // Clips have the same numbers in the copy.
        if let Some(motion) = shown.filter(|_| self.store.is_some()) {
            let clip = motion.id;
            self.motions.keep(motion);
            self.open_clip(clip, None);
            self.player.apply(&PlayCommand::Seek(at_secs));
        }
    }
}

/// Brings what is in the log into the file.
fn settle(path: &Path) -> Result<(), String> {
    let mut db = morec_db::MotionDb::open(path).map_err(|e| e.to_string())?;
    db.vacuum(false).map_err(|e| e.to_string())
}

/// Copies a file so that there is all of it or none.
fn copy_whole(from: &Path, to: &Path) -> Result<(), String> {
    let beside = to.with_extension("mdb-part");
    let copied = std::fs::copy(from, &beside).and_then(|_| std::fs::rename(&beside, to));
    copied.map_err(|error| {
        // What is there of it is of no use.
        let _ = std::fs::remove_file(&beside);
        error.to_string()
    })
}

pub(in crate::state) fn is_database(path: &Path) -> bool {
    let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
    ["mdb", "db", "sqlite"].iter().any(|known| ending == *known)
}

/// The command that writes the same.
fn export_line(store: &Store, has_index: bool, what: &Export, path: &Path) -> Option<ShownCommand> {
    let export = ShownCommand::new("morec db export").word(store.path());
    let clip = |id: &ClipId| store.snapshot.clip(*id);
    Some(match what {
        Export::Labels(form) => export.word(path).with("--form", form.name()),
        Export::Clip(id) => export.word(path).with("--motion", &clip(id)?.name),
        // No command writes a part of a clip.
        Export::Stretch(_) | Export::Class(_) => return None,
        Export::Page(id, _) => {
            let labels = export.word("labels.tsv").with("--clip", &clip(id)?.name);
            let play = ShownCommand::new("morec play").word(&clip(id)?.path);
            let play = play.with("--labels", "labels.tsv");
            let play = match has_index {
                true => play.with("--index", format!("{INDEX}.index")),
                false => play,
            };
            let play = match store.snapshot.videos.get(id) {
                Some(video) => play
                    .with("--video", &video.path)
                    .secs("--video-offset", video.offset_secs),
                None => play,
            };
            labels.and(play.with("-o", path))
        }
    })
}

impl Drop for State {
    /// Leaves nothing of this run's own behind, but for what was neither saved nor discarded: the next run offers it.
    fn drop(&mut self) {
        self.jobs.running.iter().for_each(|job| job.cancel());
        let kept = self.is_unsaved();
        self.store = None;
        if !kept {
            self.drop_folder();
        }
    }
}
