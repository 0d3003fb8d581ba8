//! Proposals: the other samples of the classes that a few are labelled of.

use std::path::Path;

use morec_db::{MotionDb, ProposeOptions};

use super::progress::{JobError, JobProgress};

/// Proposes anew, in place of proposals that nobody judged; gives their number.
pub fn propose(path: &Path, progress: &JobProgress) -> Result<usize, JobError> {
    let kept = MotionDb::open(path)
        .and_then(|mut db| db.propose_and_keep(&ProposeOptions::default(), progress));
    kept.map(|kept| kept.len())
        .map_err(|e| JobError::of_db("Nothing was proposed", &e))
}
