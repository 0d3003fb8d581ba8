//! Operations of morec as values: what the command `morec`, the studio and the Python package do alike.
//!
//! The settings of an operation are one struct. Its fields are the options of the command line (`clap::Args`), the keywords of the
//! Python function and what the studio's panel sets (serde), and [`arguments`] writes them as the command line that does the
//! same. The operation is a method of them: material in, progress on the way, a report out.
//!
#![cfg_attr(feature = "db", doc = "```no_run")]
#![cfg_attr(not(feature = "db"), doc = "```ignore")]
//! use morec_db::MotionDb; use morec_ops::{MaterialBeside, TrainSettings, arguments, training_data};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let settings = TrainSettings { classes: vec!["wave".to_owned()], ..TrainSettings::default() }; let db =
//! MotionDb::open_read_only("moves.mdb".as_ref())?; let data = training_data(&db, &settings.classes,
//! MaterialBeside::default())?; let (index, report) = settings.train(&data, &())?; println!("{} classes; the same: morec
//! train --db moves.mdb {:?}", report.classes.len(), arguments(&settings)); index.save("wave.index")?;
//! # Ok(())
//! # }
//! ```

#[cfg(feature = "db")]
mod arguments;
#[cfg(feature = "db")]
mod captions;
#[cfg(feature = "db")]
mod crossval;
#[cfg(feature = "db")]
mod curve;
#[cfg(feature = "db")]
mod cut;
#[cfg(feature = "db")]
mod discover;
mod error;
#[cfg(feature = "db")]
mod evaluate;
#[cfg(feature = "db")]
mod group;
#[cfg(feature = "db")]
mod import;
#[cfg(feature = "db")]
mod kept;
#[cfg(feature = "db")]
mod material;
mod params;
#[cfg(feature = "db")]
mod propose;
mod recognize;
#[cfg(feature = "db")]
mod reduce;
#[cfg(feature = "db")]
mod search;
#[cfg(feature = "db")]
mod shapes;
#[cfg(feature = "db")]
mod sound;
#[cfg(feature = "db")]
mod study;
mod text;
mod train;
#[cfg(feature = "db")]
mod unlearned;
#[cfg(feature = "db")]
mod video;
#[cfg(feature = "clap")]
mod words;

#[cfg(feature = "db")]
pub use arguments::arguments;
#[cfg(feature = "db")]
pub use captions::captions_of;
#[cfg(feature = "db")]
pub use crossval::{CrossvalMeasures, CrossvalSettings, LeftOut};
#[cfg(feature = "db")]
pub use curve::{CurveFigures, CurvePoint, LearningCurve};
#[cfg(feature = "db")]
pub use cut::{CutMethod, CutSettings};
#[cfg(feature = "db")]
pub use discover::{
    AloneStretch, DiscoverClip, DiscoverSettings, DiscoveredSet, DiscoveredSets, DiscoveredStretch,
};
pub use error::OperationError;
#[cfg(feature = "db")]
pub use evaluate::{EvaluateMeasures, EvaluateSettings};
#[cfg(feature = "db")]
pub use group::{
    Centre, GroupMethod, GroupSettings, GroupedStretch, Grouping, MOST_IN_TREE, largest_first,
};
#[cfg(feature = "db")]
pub use import::{CopiedClip, ImportSettings, ImportedFiles};
#[cfg(feature = "db")]
pub use kept::{KeptCrossval, KeptTraining, MissedLabel, tested_together, training_in_words};
#[cfg(feature = "db")]
pub use material::{MaterialBeside, accepted_labels, training_data};
pub use params::{Param, ParamError, from_fields};
#[cfg(feature = "db")]
pub use propose::ProposeSettings;
pub use recognize::RecognizeSettings;
#[cfg(feature = "clap")]
pub use recognize::StreamSettings;
#[cfg(feature = "db")]
pub use reduce::rebuilt_from;
#[cfg(feature = "db")]
pub use search::{SearchSettings, example_of_clip, example_of_database};
#[cfg(feature = "db")]
pub use shapes::Shapes;
#[cfg(feature = "db")]
pub use sound::{ClapMatch, SoundEnvelope};
#[cfg(feature = "db")]
pub use study::{ComparedAnnotators, time_budget};
pub use train::{Method, TrainSettings, Unlabelled};
#[cfg(feature = "db")]
pub use unlearned::Unlearned;
#[cfg(feature = "db")]
pub use video::video_of_page;
#[cfg(feature = "clap")]
pub use words::share;

/// The version of all JSON that the command prints. Fields may be added under a version; what one means, or that it is there,
/// does not change without another.
pub const FORMAT_VERSION: u32 = 1;
