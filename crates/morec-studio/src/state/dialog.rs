//! The dialog that asks for the paths of a question.

use super::Ask;

/// Kind of what a dialog chooses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DialogKind {
    /// One file that exists.
    File,
    /// Files that exist.
    Files,
    /// Folders that exist.
    Folders,
    /// One folder, which may be new.
    Folder,
    /// A file to write.
    Save,
}

/// A dialog as it is shown.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Dialog {
    pub choice: DialogKind,
    pub title: &'static str,
    /// Name and ending of the files that are offered; `None` offers all.
    pub filter: Option<(&'static str, &'static str)>,
    /// The file name that is proposed for saving.
    pub file_name: String,
}

/// The dialog of a question.
pub fn dialog(ask: &Ask) -> Dialog {
    const DATABASES: (&str, &str) = ("motion databases", "mdb");
    let shown = |choice, title, filter, name: &str| Dialog {
        choice,
        title,
        filter,
        file_name: name.to_owned(),
    };
    let open = |choice, title, filter| shown(choice, title, filter, "");
    let save = |title, filter, name: &str| shown(DialogKind::Save, title, Some(filter), name);
    match ask {
        Ask::Open => open(DialogKind::File, "Open a database", Some(DATABASES)),
        Ask::New => save("New database", DATABASES, "motions.mdb"),
        Ask::Import => open(DialogKind::Files, "Import clips", None),
        Ask::ImportFolder => open(DialogKind::Folders, "Import folders of clips", None),
        Ask::ImportLabels => open(DialogKind::Files, "Import labels", None),
        Ask::Video(_) => open(DialogKind::File, "A video of the clip", None),
        Ask::Captions => open(DialogKind::Files, "Captions of clips", None),
        Ask::Save => save("Save a copy of the database", DATABASES, "motions.mdb"),
        Ask::ExportIndex => save("Export the index", ("indexes", "index"), "studio.index"),
        Ask::ExportReport(id) => save(
            "Export the report",
            ("reports", "json"),
            &format!("report_{id}.json"),
        ),
        Ask::ExportLabels(form) if form.is_of_one_clip() => open(
            DialogKind::Folder,
            "A folder for the labels of each clip",
            None,
        ),
        Ask::ExportLabels(form) => {
            let ending = form.ending();
            save(
                "Export labels",
                ("labels", ending),
                &format!("labels.{ending}"),
            )
        }
        Ask::ExportClip(name) => save("Export the clip", ("BVH", "bvh"), &format!("{name}.bvh")),
        Ask::ExportStretch(name) => save(
            "Export the stretch",
            ("BVH", "bvh"),
            &format!("{name}_part.bvh"),
        ),
        Ask::ExportClass(_) => open(
            DialogKind::Folder,
            "A folder for a clip of each label",
            None,
        ),
        // The ending says the form.
        Ask::ExportBudget => shown(
            DialogKind::Save,
            "Export the time budget as a table (tsv) or JSON",
            None,
            "budget.tsv",
        ),
        Ask::ExportPage(name) => save(
            "Web page of the clip",
            ("pages", "html"),
            &format!("{name}.html"),
        ),
    }
}
