//! A database to begin with: synthetic people who perform a few gestures, as `morec demo` makes them; or clips that were named.

use std::path::{Path, PathBuf};

use morec::files::FileReader;
use morec::formats::bvh;
use morec::progress::Progress;
use morec::synth::{DatabaseSpec, SyntheticTake, database};
use morec_db::labels::NewSample;
use morec_db::{ClipUpdate, MotionDb};

use super::import::ImportSummary;
use super::progress::{JobError, JobProgress};
use crate::store::{BY, DbPlace};

/// Seed of the people: the year of the thesis, as in the demo.
const SEED: u64 = 2009;
/// Name of the example's file.
pub const NAME: &str = "example.mdb";
/// Gestures of the example.
pub const GESTURES: [&str; 4] = ["wave", "raise_hands", "clap", "bow"];

/// Contents of the example.
pub fn spec() -> DatabaseSpec {
    DatabaseSpec {
        people: 4,
        repetitions: 2,
        classes: GESTURES.to_vec(),
        ..DatabaseSpec::default()
    }
}

/// A database that lies in a temporary folder now.
pub struct MadeDatabase {
    pub path: Option<PathBuf>,
    /// Report on the clips that were named.
    pub report: Option<ImportSummary>,
}

/// Makes the example in `folder`; all but the last person's gestures are labelled.
pub fn make(folder: &Path, progress: &JobProgress) -> Result<MadeDatabase, JobError> {
    make_in(folder, progress)
        .map(|path| MadeDatabase {
            path: Some(path),
            report: None,
        })
        .map_err(|why| JobError::Failed(format!("The example cannot be created: {why}")))
}

fn make_in(folder: &Path, progress: &dyn Progress) -> Result<PathBuf, String> {
    let said = |error: &dyn std::fmt::Display| error.to_string();
    progress.report("making people", 0, 3);
    let takes = database(SEED, &spec());
    progress.report("filming them", 1, 3);
    let mut files = Vec::new();
    for take in &takes {
        let path = folder.join(format!("{}.bvh", take.clip.name));
        let mut bytes = Vec::new();
        bvh::write(&take.clip, &mut bytes).map_err(|e| said(&e))?;
        std::fs::write(&path, bytes).map_err(|e| said(&e))?;
        files.push(path);
    }
    progress.report("into the database", 2, 3);
    let path = folder.join(NAME);
    let mut db = MotionDb::create(&path).map_err(|e| said(&e))?;
    db.import(&files, &FileReader::default(), &ClipUpdate::default(), &())
        .map_err(|e| said(&e))?;
    describe(&mut db, &takes).map_err(|e| said(&e))?;
    // There is nothing of the person's own to take back yet.
    db.forget_history().map_err(|e| said(&e))?;
    Ok(path)
}

/// Adds the person of each clip, and the labels of all clips but the last.
fn describe(db: &mut MotionDb, takes: &[SyntheticTake]) -> Result<(), morec_db::DbError> {
    let mut labels = Vec::new();
    for (number, take) in takes.iter().enumerate() {
        let clip = db.find_clip(&take.clip.name)?.id;
        let update = ClipUpdate {
            subject: Some(take.person.clone()),
            source: Some("made by morec".to_owned()),
            ..ClipUpdate::default()
        };
        db.update_clips(&[clip], &update)?;
        if number + 1 < takes.len() {
            labels.extend(
                take.labels
                    .iter()
                    .map(|label| NewSample::accepted(clip, label.class, label.span)),
            );
        }
    }
    db.add_samples(&labels, BY)?;
    Ok(())
}

/// A database in `folder` that holds clips which were named instead of one; without a path if none of them can be read.
pub fn of_clips(
    folder: &Path,
    clips: &[PathBuf],
    progress: &JobProgress,
) -> Result<MadeDatabase, JobError> {
    let failed = |error: morec_db::DbError| JobError::Failed(error.to_string());
    let paths = (1..).map(|n| folder.join(format!("clips_{n}.mdb")));
    let path = paths.into_iter().find(|p| !p.exists()).unwrap_or_default();
    let mut db = MotionDb::create(&path).map_err(failed)?;
    let place = DbPlace {
        path: path.clone(),
        signature: BY.to_owned(),
    };
    let report = super::import::import(&place, clips, progress)?;
    // There is nothing of the person's own to take back yet.
    db.forget_history().map_err(failed)?;
    Ok(MadeDatabase {
        path: (report.imported > 0).then_some(path),
        report: Some(report),
    })
}
