//! Proposals: the other samples of the classes that a few are labelled of.

use std::path::Path;

use morec_db::{DbError, MotionDb, ProposeOptions};

use super::{JobOutcome, JobProgress};

/// Proposes anew, in place of proposals that nobody judged.
pub fn propose(path: &Path, progress: &JobProgress) -> JobOutcome {
    match proposed(path, progress) {
        Ok(count) => JobOutcome::Proposed(count),
        Err(DbError::Cancelled) => JobOutcome::Cancelled,
        Err(error) => JobOutcome::Failed(format!("Nothing was proposed: {error}")),
    }
}

fn proposed(path: &Path, progress: &JobProgress) -> Result<usize, DbError> {
    let mut db = MotionDb::open(path)?;
    let kept = db.propose_and_keep(&ProposeOptions::default(), progress)?;
    Ok(kept.len())
}
