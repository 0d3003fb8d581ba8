//! Proposals: the other samples of the classes that a few are labelled of.

use std::path::Path;

use morec_db::labels::{NewSample, SampleFilter, SampleId, SampleState};
use morec_db::{DbError, MotionDb, ProposeOptions};

use super::{JobOutcome, JobProgress};

/// Who says what the database proposes; `morec db propose` uses the same name, so that each replaces the other's.
const PROPOSED_BY: &str = "propose";

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
    let proposals = db.propose(&ProposeOptions::default(), progress)?;
    let filter = SampleFilter {
        state: Some(SampleState::Proposed),
        ..SampleFilter::default()
    };
    let old: Vec<SampleId> = db
        .samples(&filter)?
        .into_iter()
        .filter(|s| s.set_by == PROPOSED_BY)
        .map(|s| s.id)
        .collect();
    let new: Vec<NewSample> = proposals.into_iter().map(NewSample::from).collect();
    db.replace_proposals(&old, &new, PROPOSED_BY)?;
    Ok(new.len())
}
