//! Proposals: the other samples of the classes that a few are labelled of.

use morec_db::Proposal;
use morec_ops::ProposeSettings;

use super::progress::{JobError, JobProgress};
use crate::store::{DbPlace, UNLIKELY};

/// Proposes anew, in place of proposals that nobody judged; gives the number of those that are worth an answer.
pub fn propose(db: &DbPlace, progress: &JobProgress) -> Result<usize, JobError> {
    let kept = db
        .open()
        .and_then(|mut db| ProposeSettings::default().run(&mut db, progress));
    let likely = |p: &&Proposal| f64::from(p.score) >= UNLIKELY;
    kept.map(|kept| kept.iter().filter(likely).count())
        .map_err(|e| JobError::of("No proposals found", e))
}
