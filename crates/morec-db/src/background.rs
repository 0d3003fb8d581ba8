//! Clips marked as background (tag `background`), which contain none of the classes. Training and the studio read them here;
//! a clip with accepted samples is never background.

use std::collections::BTreeSet;

use rusqlite::Connection;

use crate::labels::{SampleFilter, SampleState};
use crate::{BACKGROUND, ClipFilter, ClipInfo, DbError, MotionDb, clips, labels};

/// The clips of a database that are marked as background.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BackgroundClips {
    /// Clips without a sample of the classes, by name: training uses all of their motion as background.
    pub clips: Vec<ClipInfo>,
    /// Clips with accepted samples of the classes, by name. They are labelled clips for training, whatever their mark, so that
    /// no sample is learned as what its class is not.
    pub labelled: Vec<ClipInfo>,
}

impl MotionDb {
    /// The clips with the tag [`BACKGROUND`], apart by whether they hold accepted samples of `classes` (of any class, if none
    /// is named).
    ///
    /// # Errors
    /// The database cannot be read.
    pub fn background(&self, classes: &[String]) -> Result<BackgroundClips, DbError> {
        find(&self.conn, classes)
    }
}

pub(crate) fn find(conn: &Connection, classes: &[String]) -> Result<BackgroundClips, DbError> {
    let tagged = clips::list(
        conn,
        &ClipFilter {
            tag: Some(BACKGROUND.to_owned()),
            ..ClipFilter::default()
        },
    )?;
    if tagged.is_empty() {
        return Ok(BackgroundClips::default());
    }
    let accepted = labels::list(
        conn,
        &SampleFilter {
            state: Some(SampleState::Accepted),
            ..SampleFilter::default()
        },
    )?;
    let with_samples: BTreeSet<_> = accepted
        .iter()
        .filter(|s| classes.is_empty() || classes.contains(&s.class))
        .map(|s| s.clip)
        .collect();
    let (labelled, clips) = tagged
        .into_iter()
        .partition(|clip| with_samples.contains(&clip.id));
    Ok(BackgroundClips { clips, labelled })
}
