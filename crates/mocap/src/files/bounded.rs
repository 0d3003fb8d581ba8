//! Reads whole files into memory up to a limit, and writes whole files at once.

use std::fs::{self, File};
use std::io::{self, ErrorKind, Read};
use std::path::Path;

/// The largest file that is read, bytes. The largest clips in use are a few hundred megabytes.
pub const LARGEST_FILE: u64 = 2 << 30;

/// The most that is read of something without a length: a pipe, a device, standard input.
pub const LARGEST_STREAM: u64 = 512 << 20;

/// The bytes of this file alone.
///
/// # Errors
/// The file cannot be read, or is larger than [`LARGEST_FILE`] or [`LARGEST_STREAM`]; nothing of a file that is too large
/// is read.
pub(super) fn read_whole(path: &Path) -> io::Result<Vec<u8>> {
    let file = File::open(path)?;
    let about = file.metadata()?;
    if about.is_file() {
        return read_up_to(file, about.len(), LARGEST_FILE);
    }
    read_stream(file)
}

/// The bytes of a file that another one needs. Nobody named it, so it must be a file: a pipe may never be written to, a
/// device may never end.
///
/// # Errors
/// It is no file, and those of [`read_whole`].
pub(super) fn read_regular(path: &Path) -> io::Result<Vec<u8>> {
    // Looked at before it is opened, which would wait for the writer of a pipe.
    let about = fs::metadata(path)?;
    if about.is_file() {
        return read_whole(path);
    }
    let found = match about.is_dir() {
        true => "a folder",
        false => "a pipe or a device",
    };
    let text = format!("expected a file, found {found}");
    Err(io::Error::new(ErrorKind::InvalidInput, text))
}

/// A file of this many bytes is not held as a whole where there is another way.
const LARGE_FILE: u64 = 8 << 20;

/// True if `path` is a file on disk so large that it is better not held as a whole, and not too large to be read.
pub fn is_large(path: &Path) -> bool {
    fs::metadata(path)
        .is_ok_and(|about| about.is_file() && (LARGE_FILE..=LARGEST_FILE).contains(&about.len()))
}

/// Gives the bytes of a file to `take`, a piece at a time; returns how many there were.
///
/// # Errors
/// The file cannot be read, or is larger than [`LARGEST_FILE`].
pub fn each_piece(path: &Path, mut take: impl FnMut(&[u8])) -> io::Result<u64> {
    let mut file = File::open(path)?;
    let mut piece = vec![0; 1 << 16];
    let mut total = 0;
    loop {
        match file.read(&mut piece) {
            Ok(0) => return Ok(total),
            Ok(read) => {
                total += read as u64;
                if total > LARGEST_FILE {
                    return Err(too_large(LARGEST_FILE));
                }
                take(&piece[..read]);
            }
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
}

/// All of a stream.
///
/// # Errors
/// It cannot be read, or does not end within [`LARGEST_STREAM`].
pub fn read_stream(stream: impl Read) -> io::Result<Vec<u8>> {
    read_up_to(stream, 0, LARGEST_STREAM)
}

/// Writes a file beside its target and renames it: the target is whole or as it was.
///
/// # Errors
/// The file cannot be written.
pub fn write_whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
    use std::io::Write;

    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{}.partial", std::process::id()));
    let partial = path.with_file_name(name);
    let write = || {
        let mut file = File::create_new(&partial)?;
        file.write_all(bytes)?;
        file.sync_all()?;
        fs::rename(&partial, path)
    };
    let written = write();
    if written
        .as_ref()
        .is_err_and(|error| error.kind() != ErrorKind::AlreadyExists)
    {
        // What is half written is of no use; that it cannot be removed is the lesser error.
        let _ = fs::remove_file(&partial);
    }
    written
}

pub(super) fn too_large(most: u64) -> io::Error {
    let text = format!("expected at most {} MB, found more", most >> 20);
    io::Error::new(ErrorKind::FileTooLarge, text)
}

fn read_up_to(from: impl Read, length: u64, most: u64) -> io::Result<Vec<u8>> {
    if length > most {
        return Err(too_large(most));
    }
    let mut bytes = Vec::new();
    bytes.try_reserve_exact(length as usize)?;
    from.take(most + 1).read_to_end(&mut bytes)?;
    match bytes.len() as u64 > most {
        true => Err(too_large(most)),
        false => Ok(bytes),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_end_is_refused() {
        assert_eq!(read_up_to(&b"four"[..], 4, 4).unwrap(), b"four");
        assert!(read_up_to(&b"fives"[..], 0, 4).is_err());
        assert!(read_up_to(io::repeat(0), 0, 1 << 16).is_err());
    }

    /// A file with a hole in place of three gigabytes: its length alone is enough to refuse it.
    #[test]
    fn a_file_too_large_is_refused_unread() {
        let folder = tempfile::TempDir::new().unwrap();
        let path = folder.path().join("large.bvh");
        let file = File::create(&path).unwrap();
        if file.set_len(3 << 30).is_err() {
            return;
        }
        let error = read_whole(&path).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::FileTooLarge);
    }
}
