//! Search by example: where in the whole database is a motion like this one?
//!
//! Rows of all clips lie in memory in one layout, so that skeletons, sizes and frame rates do not matter. Every window of
//! about the example's length is first compared by a summary of its rows (prefix sums: nothing of the length of a window
//! is gone through): how much moves at which pace, mean pose, mean travel. The nearest are ranked by their distance and by
//! the company they keep: similarity spreads over a graph of neighbours, so that far styles of a motion are found by way
//! of those between. The first are placed exactly by subsequence dynamic time warping ([`morec::templates::TemplateBank`]). Where
//! samples are labelled, a [`LearnedMetric`] says which differences matter.

mod bound;
mod boxes;
mod candidates;
mod codes;
mod copies;
mod graph;
pub(crate) mod layout;
mod learned;
mod plan;
mod probe;
#[cfg(test)]
mod pruned_tests;
mod rank;
mod sketch;
mod summary;
#[cfg(test)]
mod tests;
mod window_sketch;
mod windows;

pub use bound::{SketchedClip, SketchedClips};
pub use codes::SketchCodes;
pub use copies::{NearCopy, near_duplicates, near_duplicates_of};
pub use learned::LearnedMetric;
pub use plan::SearchPlan;
pub use rank::{Hit, SearchOptions, windows_wanted};

use morec::TimeSpan;
use morec::features::FeatureParams;
use morec::progress::Progress;
use rayon::prelude::*;

use crate::rows::ClipRows;
use crate::{ClipId, DbError, MotionDb};
use layout::{CanonicalRows, to_canonical};
use windows::Sums;

/// The rows of a whole database, ready to be searched. O(rows) memory: 0.5 MB for a minute.
#[derive(Debug, Clone)]
pub struct SearchIndex {
    clips: Vec<Indexed>,
    tick_hz: f64,
}

#[derive(Debug, Clone)]
struct Indexed {
    clip: ClipId,
    laid: CanonicalRows,
    sums: Sums,
}

/// An example to search for.
#[derive(Debug, Clone)]
pub struct Example {
    laid: CanonicalRows,
    /// Its clip and rows, to leave it out of the hits.
    from: Option<(ClipId, std::ops::Range<usize>)>,
    /// True if it is all of its clip.
    whole: bool,
}

impl Example {
    /// The same as a stretch cut from a longer clip.
    #[must_use]
    pub fn cut_out(self) -> Self {
        Self {
            whole: false,
            ..self
        }
    }
}

impl SearchIndex {
    /// Lays out rows of which `tick_hz` make a second.
    pub fn new(rows: &[ClipRows], tick_hz: f64) -> Self {
        let index = |clip: &ClipRows| {
            let laid = to_canonical(&clip.rows, clip.bones);
            Indexed {
                clip: clip.clip,
                sums: Sums::of(&laid.rows),
                laid,
            }
        };
        Self {
            clips: rows
                .par_iter()
                .filter(|clip| !clip.rows.is_empty())
                .map(index)
                .collect(),
            tick_hz,
        }
    }

    /// The search index of a database. Missing feature rows are computed and stored.
    ///
    /// # Errors
    /// As [`MotionDb::rows`].
    pub fn of_db(db: &mut MotionDb, progress: &dyn Progress) -> Result<Self, DbError> {
        let params = FeatureParams::default();
        Ok(Self::new(&db.rows(&params, progress)?, params.tick_hz()))
    }

    /// The search index of a database that is opened for reading only.
    ///
    /// # Errors
    /// As [`MotionDb::rows_kept_if_writable`].
    pub fn of_reader(db: &MotionDb, progress: &dyn Progress) -> Result<Self, DbError> {
        let params = FeatureParams::default();
        let rows = db.rows_kept_if_writable(&params, progress)?;
        Ok(Self::new(&rows, params.tick_hz()))
    }

    /// Rows a second.
    pub fn tick_hz(&self) -> f64 {
        self.tick_hz
    }

    /// Rows in all.
    pub fn ticks(&self) -> usize {
        self.clips.iter().map(|clip| clip.laid.rows.len()).sum()
    }

    /// A stretch of one of the clips as an example; `None` if the clip is not there or the stretch holds no three rows.
    pub fn example(&self, clip: ClipId, span: impl Into<TimeSpan>) -> Option<Example> {
        let found = self.clips.iter().find(|c| c.clip == clip)?;
        let rows = &found.laid.rows;
        let span = span.into().frames_among(rows.len(), self.tick_hz);
        if span.len() < 3 {
            return None;
        }
        let laid = CanonicalRows {
            rows: rows.slice(span.clone()),
            bones: found.laid.bones,
        };
        // Frames and rows do not end at the same instant.
        let whole = span.len() + 2 >= rows.len();
        Some(Example {
            laid,
            from: Some((clip, span)),
            whole,
        })
    }

    /// Rows of a whole clip from elsewhere as an example, of the usual features at the same rate; `None` for less than
    /// three.
    pub fn example_of(
        rows: &morec::features::Rows,
        bones: morec::features::BoneSet,
    ) -> Option<Example> {
        (rows.len() >= 3).then(|| Example {
            laid: to_canonical(rows, bones),
            from: None,
            whole: true,
        })
    }
}

/// The sketch of a clip for a [`SearchPlan`]: 307 bytes, and 43 for two rows; `None` without rows, or of rows out of all measure.
pub fn sketch_of(clip: &ClipRows) -> Option<Vec<u8>> {
    let laid = to_canonical(&clip.rows, clip.bones);
    sketch::sketch(&laid.rows).filter(|_| !clip.rows.is_empty())
}
