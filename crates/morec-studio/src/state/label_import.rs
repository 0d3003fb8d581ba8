//! Labels of files that wait to be applied.

use morec_db::labels::Labelled;

use crate::jobs::label_files::LabelFiles;

/// Labels of files, read and looked at.
#[derive(Debug, Clone)]
pub struct LabelImport {
    pub files: LabelFiles,
    /// They take the place of the labels of the clips that they name.
    pub replace: bool,
}

impl LabelImport {
    /// What they would change.
    pub fn changes(&self) -> &Labelled {
        match self.replace {
            true => &self.files.replaced,
            false => &self.files.added,
        }
    }
}
