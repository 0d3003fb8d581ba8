//! Index files by path.

use std::path::Path;

use crate::files;
use crate::index::MotionIndex;

use super::Error;

impl MotionIndex {
    /// Reads the index at `path`; see [`from_bytes`](Self::from_bytes).
    ///
    /// # Errors
    /// A file that cannot be read, or is no index that this release knows.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let bytes = files::read_file(path);
        let bytes = bytes.map_err(|error| files::FileErrorKind::Io(error).at(path))?;
        Ok(Self::from_bytes(&bytes)?)
    }

    /// Writes the index to `path`, whole or not at all; see [`to_bytes`](Self::to_bytes).
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        let path = path.as_ref();
        let written = files::write_whole(path, &self.to_bytes()?);
        Ok(written.map_err(|error| files::FileErrorKind::Io(error).at(path))?)
    }
}
