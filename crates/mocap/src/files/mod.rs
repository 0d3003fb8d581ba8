//! Clip files on disk: from a path to [`Take`]s. Behind the feature `files`; all else in this library takes bytes.
//!
//! ```no_run
//! let takes = mocap::files::open_all("clips/")?;
//! for file in &takes.refused {
//!     eprintln!("left out: {file}");
//! }
//! # Ok::<(), mocap::files::FileError>(())
//! ```
//!
//! A file may hold several clips; `FILE#2` and `FILE#name` choose one of them. Files of one frame each are one clip, which the
//! first of them stands for. Zip archives and gzip files are unpacked.
//! An AMC motion is read with the ASF skeleton that lies beside it or a folder above. [`FileReader`] has what can be
//! set; [`open`] and [`open_all`] are its defaults.

mod archives;
mod bounded;
mod choice;
mod error;
mod folder;
mod neighbours;
mod paired;
mod reader;
mod sequence;
mod skeletons;
mod takes;

use std::path::Path;

#[doc(hidden)] // How the crates of this repository write; it has nothing to do with motion.
pub use bounded::write_whole;
pub use bounded::{LARGEST_FILE, LARGEST_STREAM, each_piece, is_large, read_stream};
pub use choice::split_choice;
pub use error::{FileError, FileErrorKind};
pub use folder::{Listing, list, list_as};
pub use reader::{ClipFile, FileReader};
pub use sequence::read_file;
pub use takes::Takes;

use crate::import::Take;

/// The clips in the bytes of a file, in its units and axes. `name` is the file's path or name, as [`FileReader::parse`] takes it:
/// it names the clips, and tells where the skeleton of an AMC or OpenSim motion is looked for.
///
/// # Errors
/// Bytes in no format that is read, or damaged.
pub fn read(bytes: &[u8], name: impl AsRef<Path>) -> Result<ClipFile, FileError> {
    FileReader::default().parse(name.as_ref(), bytes)
}

/// The takes in one file, one for each character of each clip in it. See [`FileReader::open`].
///
/// # Errors
/// The file cannot be read, is in no format that is read, or is damaged.
pub fn open(path: impl AsRef<Path>) -> Result<Vec<Take>, FileError> {
    FileReader::default().open(path.as_ref())
}

/// The takes in a file, or in all files of a folder and the folders below. See [`FileReader::open_all`].
///
/// # Errors
/// There is no clip that can be read. What else cannot be read is listed in [`Takes::refused`].
pub fn open_all(path: impl AsRef<Path>) -> Result<Takes, FileError> {
    FileReader::default().open_all(&[path.as_ref().to_owned()])
}
