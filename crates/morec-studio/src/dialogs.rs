//! File dialogs of the system, on threads of their own; and files that are dropped on the window.

use std::path::PathBuf;
use std::sync::mpsc::{Receiver, channel};

use morec_db::exchange::LabelFormat;

use crate::state::{Ask, Command, FileCommand};

/// Dialogs that are open.
#[derive(Default)]
pub struct Dialogs {
    open: Vec<Receiver<Command>>,
}

impl Dialogs {
    /// Opens a dialog; the window goes on meanwhile.
    pub fn ask(&mut self, ask: Ask, ctx: &egui::Context) {
        let (sender, answer) = channel();
        let ctx = ctx.clone();
        let job = move || {
            if let Some(command) = answered(ask) {
                // The window may be gone by now.
                let _ = sender.send(command);
                ctx.request_repaint();
            }
        };
        if std::thread::Builder::new()
            .name("file dialog".to_owned())
            .spawn(job)
            .is_ok()
        {
            self.open.push(answer);
        }
    }

    /// What has been answered since.
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

fn answered(ask: Ask) -> Option<Command> {
    let databases = || rfd::FileDialog::new().add_filter("motion databases", &["mdb"]);
    let file = match ask {
        Ask::Open => FileCommand::Open(databases().pick_file()?),
        Ask::New => FileCommand::New(databases().set_file_name("motions.mdb").save_file()?),
        Ask::Import => FileCommand::Import(rfd::FileDialog::new().pick_files()?),
        Ask::ImportFolder => FileCommand::Import(rfd::FileDialog::new().pick_folders()?),
        Ask::Save => FileCommand::Save(databases().set_file_name("motions.mdb").save_file()?),
        Ask::ExportIndex => FileCommand::ExportIndex(
            rfd::FileDialog::new()
                .add_filter("indexes", &["index"])
                .set_file_name("studio.index")
                .save_file()?,
        ),
        Ask::ExportLabels(form) if form.is_of_one_clip() => {
            let dialog = rfd::FileDialog::new().set_title("A folder for the labels of each clip");
            FileCommand::ExportLabels(form, dialog.pick_folder()?)
        }
        Ask::ExportLabels(form) => {
            let ending = match form {
                LabelFormat::Tsv => "tsv",
                LabelFormat::Csv => "csv",
                _ => "json",
            };
            let dialog = rfd::FileDialog::new().add_filter("labels", &[ending]);
            let name = format!("labels.{ending}");
            FileCommand::ExportLabels(form, dialog.set_file_name(name).save_file()?)
        }
        Ask::ExportClip(name) => {
            let dialog = rfd::FileDialog::new().add_filter("BVH", &["bvh"]);
            FileCommand::ExportClip(dialog.set_file_name(format!("{name}.bvh")).save_file()?)
        }
        Ask::ExportPage(name) => {
            let dialog = rfd::FileDialog::new().add_filter("pages", &["html"]);
            FileCommand::ExportPage(dialog.set_file_name(format!("{name}.html")).save_file()?)
        }
    };
    Some(Command::File(file))
}

/// Files that were dropped on the window are imported.
pub fn dropped(ctx: &egui::Context, out: &mut Vec<Command>) {
    let paths: Vec<PathBuf> = ctx.input(|i| {
        let files = i.raw.dropped_files.iter();
        files.filter_map(|file| file.path.clone()).collect()
    });
    if !paths.is_empty() {
        out.push(Command::File(FileCommand::Import(paths)));
    }
}
