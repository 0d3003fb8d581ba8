//! The motion database: clips, segments, classes, labels and indexes in one SQLite file.
//!
//! One program writes, any number read beside it (write-ahead log); a crash at any moment leaves a database that opens,
//! with whole clips in it. Motion is kept as curves within half a degree and five millimetres of the file's, in metres and
//! Y up; where the original lies is remembered by path and hash. Feature rows are kept ready for searching and made again
//! when the recipe changes.
//!
//! The library prints nothing and knows no terminal; files are read by a [`FileReader`](morec::files::FileReader).
//!
//! | job | begins at |
//! |---|---|
//! | open, make, check, shrink | [`MotionDb`] |
//! | clips in | [`MotionDb::import`] |
//! | classes and samples | [`labels`] |
//! | what was changed, taking it back | [`MotionDb::history`], [`MotionDb::undo`] |
//! | clips that are none of the classes | [`MotionDb::background`] |
//! | labels in other programs' forms | [`exchange`] |
//! | cuts where behaviour changes | [`MotionDb::cut`] |
//! | rows, search by example, near copies | [`rows`], [`search`] |
//! | the other samples of classes that a few are labelled of | [`MotionDb::propose`], [`most_informative`] |

mod background;
mod body;
mod clips;
mod cut;
mod db;
mod error;
pub mod exchange;
mod health;
mod history;
mod import;
mod indexes;
mod kept;
pub mod labels;
mod motion;
mod names;
mod places;
mod propose;
mod replace;
pub mod rows;
mod schema;
pub mod search;
mod segments;
#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;
mod time;

pub use background::{BACKGROUND, BackgroundClips};
pub use clips::{ClipFilter, ClipId, ClipInfo, ClipUpdate};
pub use cut::{BY_HAND, ClipCuts, CutReport, Cutter, Still};
pub use db::{DbSummary, MotionDb};
pub use error::DbError;
pub use health::Health;
pub use history::{Effect, HistoryStep, ReplayedStep, STEPS_KEPT};
pub use import::{ImportCounts, ImportLog, ImportOutcome, Refused};
pub use indexes::{IndexInfo, training_data};
pub use kept::{KeptClip, KeptFile, NotKept, clip_rows, packed_rows, rows_recipe, stored_clip};
pub use motion::StoredClip;
pub use propose::{Proposal, ProposeOptions, most_informative};
pub use replace::Replaced;
pub use rows::bones_of_bits;
pub use schema::{APPLICATION_ID, SCHEMA};
pub use segments::{Segment, SegmentKind};
