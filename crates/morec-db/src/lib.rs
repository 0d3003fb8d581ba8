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
//! | clips of no class | [`MotionDb::background`] |
//! | labels in other programs' forms | [`exchange`] |
//! | cuts where behaviour changes | [`MotionDb::cut`] |
//! | rows, search by example, near copies | [`rows`], [`search`] |
//! | search by words, by vectors | [`WordIndex`], [`EmbeddingTable`] |
//! | videos beside clips | [`ClipVideo`] |
//! | the other samples of classes that a few are labelled of | [`MotionDb::propose`], [`most_informative`] |
//!
//! ```no_run
//! use morec::files::FileReader;
//! use morec_db::labels::{NewSample, SampleState};
//! use morec_db::{ClipFilter, ClipUpdate, MotionDb, ProposeOptions};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let mut db = MotionDb::create("moves.mdb".as_ref())?;
//! let clips = morec::files::list(&["recordings/".into()])?.clips;
//! let log = db.import(&clips, &FileReader::default(), &ClipUpdate::default(), &())?;
//! println!("{} files imported, {} refused", log.counts().imported, log.counts().refused);
//!
//! let walk = db.find_clip("walk_01")?;
//! let label = NewSample {
//!     clip: walk.id,
//!     class: "step".to_owned(),
//!     start_secs: 1.0,
//!     stop_secs: 1.6,
//!     whole_clip: false,
//!     state: SampleState::Accepted,
//!     score: None,
//! };
//! db.add_samples(&[label], "ada")?;
//! for proposal in db.propose_and_keep(&ProposeOptions::default(), &())? {       // the surest first
//!     println!("{proposal:?}");
//! }
//! db.undo(None)?;                                                                // takes the proposals back
//! println!("{} clips with steps", db.clips(&ClipFilter { class: Some("step".to_owned()), ..Default::default() })?.len());
//! # Ok(())
//! # }
//! ```

mod background;
mod body;
mod clips;
mod cut;
mod db;
mod digest;
mod embeddings;
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
mod reports;
pub mod rows;
mod schema;
pub mod search;
mod segments;
#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;
mod time;
mod tracked;
mod videos;
mod words;

pub use background::BackgroundClips;
pub use clips::{BACKGROUND, ClipFilter, ClipId, ClipInfo, ClipUpdate};
pub use cut::{BY_HAND, ClipCuts, CutReport, Cutter, Still};
pub use db::{DbSummary, MotionDb};
pub use embeddings::{EmbeddingHit, EmbeddingHits, EmbeddingTable};
pub use error::DbError;
pub use health::Health;
pub use history::{Effect, HistoryStep, ReplayedStep, STEPS_KEPT};
pub use import::{ImportCounts, ImportLog, ImportOutcome, Refused};
pub use indexes::{IndexInfo, training_data};
pub use kept::{KeptClip, KeptFile, NotKept, clip_rows, packed_rows, rows_recipe, stored_clip};
pub use motion::StoredClip;
pub use propose::{Proposal, ProposeOptions, most_informative};
pub use replace::Replaced;
pub use reports::{REPORTS_KEPT, ReportInfo, ReportKind};
pub use rows::bones_of_bits;
pub use schema::{APPLICATION_ID, SCHEMA};
pub use segments::{Segment, SegmentKind};
pub use videos::ClipVideo;
pub use words::{WordHit, WordHits, WordIndex, WordPlace};
