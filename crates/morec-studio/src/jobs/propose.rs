//! Proposals: the other samples of the classes that a few are labelled of.

use std::path::Path;

use morec_db::{MotionDb, Proposal};
use morec_ops::ProposeSettings;

use super::progress::{JobError, JobProgress};
use crate::store::UNLIKELY;

/// Proposes anew, in place of proposals that nobody judged; gives the number of those that are worth an answer.
pub fn propose(path: &Path, progress: &JobProgress) -> Result<usize, JobError> {
    let kept =
        MotionDb::open(path).and_then(|mut db| ProposeSettings::default().run(&mut db, progress));
    let likely = |p: &&Proposal| f64::from(p.score) >= UNLIKELY;
    kept.map(|kept| kept.iter().filter(likely).count())
        .map_err(|e| JobError::of("Nothing was proposed", e))
}
