//! Search by example: where in the database a motion like this one is.

use std::path::Path;

use morec_db::search::{Hit, SearchIndex};
use morec_db::{DbError, MotionDb};
use morec_ops::SearchSettings;

use super::progress::{JobError, JobProgress};
use crate::stretch::Stretch;

/// Number of hits that are shown.
const MOST: usize = 40;

/// An example and the stretches most like it.
#[derive(Debug, Clone)]
pub struct Similar {
    pub of: Stretch,
    /// The example's class, if it is a label.
    pub class: Option<String>,
    /// True if the mirror image was searched for, too.
    pub mirror: bool,
    /// The nearest first.
    pub hits: Vec<Hit>,
}

/// How the panel's searches are made.
pub fn settings(mirror: bool) -> SearchSettings {
    SearchSettings {
        limit: MOST,
        mirror,
        ..SearchSettings::default()
    }
}

/// Looks for motions like `of` in the database at `path`.
pub fn find(
    path: &Path,
    of: Stretch,
    class: Option<String>,
    mirror: bool,
    progress: &JobProgress,
) -> Result<Similar, JobError> {
    let found = MotionDb::open(path).and_then(|mut db| hits(&mut db, &of, mirror, MOST, progress));
    match found {
        Ok(Some(hits)) => Ok(Similar {
            of,
            class,
            mirror,
            hits,
        }),
        Ok(None) => Err(JobError::Failed(
            "Search not possible: the stretch is too short, or no body part of its clip is known"
                .to_owned(),
        )),
        Err(error) => Err(JobError::of("The search failed", error)),
    }
}

/// The stretches most like `of`; `None` if it cannot be searched for.
pub fn hits(
    db: &mut MotionDb,
    of: &Stretch,
    mirror: bool,
    limit: usize,
    progress: &JobProgress,
) -> Result<Option<Vec<Hit>>, DbError> {
    let index = SearchIndex::of_db(db, progress)?;
    let settings = SearchSettings {
        limit,
        ..settings(mirror)
    };
    let example = index.example(of.clip, of.span);
    Ok(example.map(|example| index.search(&example.cut_out(), &settings.options())))
}
