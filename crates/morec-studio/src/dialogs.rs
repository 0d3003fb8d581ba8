//! File dialogs on threads of their own, and files that are dropped on the window.
//!
//! A dialog is a value ([`Dialog`]) that a [`Chooser`] answers with paths: the system's, or one that a test gives.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};

use crate::state::{Ask, Command, Dialog, DialogKind, FileCommand, dialog};

/// Shows dialogs.
pub trait Chooser: Send + Sync {
    /// The paths that were chosen, empty if the dialog was cancelled; `None` if none can be opened. Called on a thread of its own.
    fn choose(&self, dialog: &Dialog) -> Option<Vec<PathBuf>>;
}

/// File dialogs of the operating system, with the feature `window`.
pub struct SystemDialogs;

#[cfg(not(feature = "window"))]
impl Chooser for SystemDialogs {
    fn choose(&self, _: &Dialog) -> Option<Vec<PathBuf>> {
        None
    }
}

#[cfg(feature = "window")]
impl Chooser for SystemDialogs {
    fn choose(&self, dialog: &Dialog) -> Option<Vec<PathBuf>> {
        // `rfd` reports a dialog that was cancelled and one that could not be opened alike. Nobody sees a dialog and closes it in so
        // short a time.
        const SOONEST: std::time::Duration = std::time::Duration::from_millis(250);
        let begun = std::time::Instant::now();
        let one = |path: Option<PathBuf>| match path {
            None if begun.elapsed() < SOONEST => None,
            path => Some(path.into_iter().collect()),
        };
        let mut shown = rfd::FileDialog::new().set_title(dialog.title);
        if let Some((name, ending)) = dialog.filter {
            shown = shown.add_filter(name, &[ending]);
        }
        if !dialog.file_name.is_empty() {
            shown = shown.set_file_name(&dialog.file_name);
        }
        match dialog.choice {
            DialogKind::Files => shown.pick_files(),
            DialogKind::Folders => shown.pick_folders(),
            DialogKind::File => one(shown.pick_file()),
            DialogKind::Folder => one(shown.pick_folder()),
            DialogKind::Save => one(shown.save_file()),
        }
    }
}

/// Dialogs that are open.
pub struct Dialogs {
    chooser: Arc<dyn Chooser>,
    open: Vec<Receiver<Command>>,
}

impl Dialogs {
    /// Dialogs that `chooser` answers.
    pub fn of(chooser: Arc<dyn Chooser>) -> Self {
        Self {
            chooser,
            open: Vec::new(),
        }
    }

    /// Opens a dialog; the window goes on meanwhile.
    pub fn ask(&mut self, ask: Ask, ctx: &egui::Context) {
        let (sender, answer) = channel();
        let (ctx, chooser) = (ctx.clone(), self.chooser.clone());
        let job = move || {
            let file = match chooser.choose(&dialog(&ask)) {
                Some(paths) => command(&ask, paths),
                None => Some(FileCommand::NoDialog(ask)),
            };
            if let Some(file) = file {
                // The window may be gone by now.
                let _ = sender.send(Command::File(file));
            }
            drop(sender);
            ctx.request_repaint();
        };
        if std::thread::Builder::new()
            .name("file dialog".to_owned())
            .spawn(job)
            .is_ok()
        {
            self.open.push(answer);
        }
    }

    /// True while a dialog waits for an answer.
    pub fn is_open(&self) -> bool {
        !self.open.is_empty()
    }

    /// The commands of the dialogs that were answered since the last frame.
    pub fn answers(&mut self) -> Vec<Command> {
        use std::sync::mpsc::TryRecvError;
        let mut answers = Vec::new();
        self.open.retain(|dialog| match dialog.try_recv() {
            Ok(command) => {
                answers.push(command);
                false
            }
            Err(TryRecvError::Empty) => true,
            Err(TryRecvError::Disconnected) => false,
        });
        answers
    }
}

/// A path as it is typed, with `~` for the home folder; `None` for nothing.
pub fn typed_path(text: &str) -> Option<PathBuf> {
    let text = text.trim();
    let home = || std::env::var_os("HOME").map(PathBuf::from);
    match text.strip_prefix("~/") {
        Some(rest) => Some(home()?.join(rest)),
        None => (!text.is_empty()).then(|| PathBuf::from(text)),
    }
}

/// What speaks against a path that is typed, and the name of the button that takes it all the same, else `OK`.
pub fn verdict(kind: DialogKind, path: &Path) -> (Option<String>, &'static str) {
    let no = |text: &str| (Some(text.to_owned()), "OK");
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty());
    match kind {
        DialogKind::File | DialogKind::Files if !path.exists() => no("There is no such file."),
        DialogKind::Folders if !path.is_dir() => no("There is no such folder."),
        DialogKind::Save if path.is_dir() => no("This is a folder: add a file name."),
        DialogKind::Save if path.exists() => {
            let text = "This file exists and will be replaced.";
            (Some(text.to_owned()), "Replace it")
        }
        DialogKind::Save if folder.is_some_and(|f| !f.is_dir()) => no("There is no such folder."),
        _ => (None, "OK"),
    }
}

/// The command of an answer; `None` if nothing was chosen.
pub fn command(ask: &Ask, paths: Vec<PathBuf>) -> Option<FileCommand> {
    let first = paths.first()?.clone();
    Some(match ask {
        Ask::Open => FileCommand::Open(first),
        Ask::New => FileCommand::New(first),
        Ask::Import | Ask::ImportFolder => FileCommand::Import(paths),
        Ask::ImportLabels => FileCommand::ImportLabels(paths),
        Ask::Video(clip) => FileCommand::Video(clip.clone(), first),
        Ask::Captions => FileCommand::Captions(paths),
        Ask::Save => FileCommand::Save(first),
        Ask::ExportIndex => FileCommand::ExportIndex(first),
        Ask::ExportReport(id) => FileCommand::ExportReport(*id, first),
        Ask::ExportLabels(form) => FileCommand::ExportLabels(*form, first),
        Ask::ExportClip(_) => FileCommand::ExportClip(first),
        Ask::ExportStretch(_) => FileCommand::ExportStretch(first),
        Ask::ExportClass(class) => FileCommand::ExportClass(class.clone(), first),
        Ask::ExportBudget => FileCommand::ExportBudget(first),
        Ask::ExportPage(_) => FileCommand::ExportPage(first),
    })
}

/// Imports files that were dropped on the window.
pub fn dropped(ctx: &egui::Context, out: &mut Vec<Command>) {
    let paths: Vec<PathBuf> = ctx.input(|i| {
        let files = i.raw.dropped_files.iter();
        files.filter_map(|file| file.path.clone()).collect()
    });
    if !paths.is_empty() {
        out.push(Command::File(FileCommand::Import(paths)));
    }
}
