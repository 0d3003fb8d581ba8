//! Sets of the same motion, found without labels.

use std::path::Path;

use morec_db::{ClipFilter, MotionDb};
use morec_ops::{DiscoverSettings, DiscoveredSets, OperationError};

use super::progress::{JobError, JobProgress};

/// Looks for what repeats in all clips of the database at `path`.
pub fn discover(
    path: &Path,
    settings: &DiscoverSettings,
    progress: &JobProgress,
) -> Result<DiscoveredSets, JobError> {
    let found = MotionDb::open(path)
        .map_err(OperationError::from)
        .and_then(|db| settings.of_database(&db, &ClipFilter::default(), progress));
    match found {
        Ok(found) if found.sets.is_empty() => {
            let nothing =
                "No repeated motion found in these clips: label motions yourself, or add clips";
            Err(JobError::Failed(nothing.to_owned()))
        }
        Ok(found) => Ok(found),
        Err(error) => Err(JobError::of(
            "The search for repeated motions was stopped",
            error,
        )),
    }
}
