//! Places of the files that another file needs.

use std::fs;
use std::io;
use std::path::Path;

use crate::formats::container::Member;

/// Place of files that another file needs.
#[derive(Clone, Copy)]
pub(super) enum Around<'a> {
    /// On disk.
    Folder,
    /// In the same archive.
    Archive(&'a [Member]),
}

impl Around<'_> {
    /// A file by its path.
    pub(super) fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        match self {
            Around::Folder => fs::read(path),
            Around::Archive(members) => members
                .iter()
                .find(|member| Path::new(&member.path) == path)
                .map(|member| member.bytes.clone())
                .ok_or_else(|| io::Error::from(io::ErrorKind::NotFound)),
        }
    }

    /// A file beside another.
    pub(super) fn file(&self, path: &Path, name: &str) -> Option<Vec<u8>> {
        match (self, path == Path::new("-")) {
            (Around::Folder, true) => None,
            _ => self.read(&path.with_file_name(name)).ok(),
        }
    }
}
