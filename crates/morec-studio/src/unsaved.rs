//! Folders of databases that have no name yet: one for each run, locked while the run lasts. What a run that was killed leaves
//! behind is found by the next one.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

use morec_db::{DbError, MotionDb};

const LOCK: &str = "lock";

/// A folder that is locked by this run.
#[derive(Debug)]
pub struct OwnFolder {
    path: PathBuf,
    /// The system takes the lock off when the program ends, however it ends.
    _lock: File,
}

impl OwnFolder {
    /// A new folder in `root`, which is made if it is not there.
    pub fn new(root: &Path) -> io::Result<Self> {
        fs::create_dir_all(root)?;
        for number in 0.. {
            let path = root.join(format!("morec-studio-{}-{number}", std::process::id()));
            match fs::create_dir(&path) {
                Ok(()) => return locked(path),
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
            }
        }
        Err(io::ErrorKind::AlreadyExists.into())
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    pub fn remove(self) {
        // What cannot be removed now is found by the next run.
        let _ = fs::remove_dir_all(&self.path);
    }
}

/// Locks a folder; fails if another run has it.
fn locked(path: PathBuf) -> io::Result<OwnFolder> {
    let lock = File::create(path.join(LOCK))?;
    lock.try_lock()?;
    Ok(OwnFolder { path, _lock: lock })
}

/// A database that was changed and not saved by a run that ended without a question.
#[derive(Debug)]
pub struct Leftover {
    pub folder: OwnFolder,
    pub database: PathBuf,
    /// Number of its clips and of its labels; `None` if it cannot be read.
    pub contents: Option<(u64, u64)>,
    /// Time of its last change, seconds since 1970.
    pub changed_secs: Option<i64>,
}

/// What runs that have ended left in `root`, the oldest first. Folders in which nothing was done are removed.
pub fn leftovers(root: &Path) -> Vec<Leftover> {
    let Ok(entries) = fs::read_dir(root) else {
        return Vec::new();
    };
    let folders = entries.filter_map(|entry| Some(entry.ok()?.path()));
    // A folder without a lock was made by another program.
    let ours = folders.filter(|path| path.join(LOCK).is_file());
    let mut found: Vec<Leftover> = ours
        .filter_map(|path| leftover(locked(path).ok()?))
        .collect();
    found.sort_by(|a, b| (a.changed_secs, &a.database).cmp(&(b.changed_secs, &b.database)));
    found
}

fn leftover(folder: OwnFolder) -> Option<Leftover> {
    let Some(database) = database_in(folder.path()) else {
        folder.remove();
        return None;
    };
    match looked_at(&database) {
        Ok((None, _)) => {
            folder.remove();
            None
        }
        Ok((changed_secs, contents)) => Some(Leftover {
            folder,
            database,
            contents: Some(contents),
            changed_secs,
        }),
        // What cannot be read may still be mended by hand.
        Err(_) => Some(Leftover {
            folder,
            database,
            contents: None,
            changed_secs: None,
        }),
    }
}

fn database_in(folder: &Path) -> Option<PathBuf> {
    let files = fs::read_dir(folder).ok()?;
    let mut files = files.filter_map(|entry| Some(entry.ok()?.path()));
    files.find(|path| path.extension().is_some_and(|ending| ending == "mdb"))
}

/// Time of the last step, `None` without one; clips and labels.
fn looked_at(path: &Path) -> Result<(Option<i64>, (u64, u64)), DbError> {
    let db = MotionDb::open(path)?;
    let last = db.last_step()?.map(|step| step.set_secs);
    let summary = db.summary()?;
    Ok((last, (summary.clips, summary.accepted)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_of_a_run_that_lasts_is_not_offered_and_an_empty_one_is_removed() {
        let root = tempfile::tempdir().unwrap();
        let own = OwnFolder::new(root.path()).unwrap();
        let other = OwnFolder::new(root.path()).unwrap();
        assert_ne!(own.path(), other.path());
        MotionDb::create(&own.path().join("clips.mdb")).unwrap();
        assert!(leftovers(root.path()).is_empty());
        let path = own.path().to_owned();
        assert!(path.exists());
        drop(own);
        assert!(leftovers(root.path()).is_empty(), "nothing was done");
        assert!(!path.exists() && other.path().exists());
    }
}
