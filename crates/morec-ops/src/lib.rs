//! Operations of morec as values: what the command `morec`, the studio and the Python package do alike.
//!
//! The settings of an operation are one struct. Its fields are the options of the command line (`clap::Args`), the keywords of the
//! Python function and what the studio's panel sets (serde), and [`arguments`] writes them as the command line that does the
//! same. The operation is a method of them: material in, progress on the way, a report out.
//!
//! ```no_run
//! use morec_db::MotionDb;
//! use morec_ops::{MaterialBeside, TrainSettings, arguments, training_data};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let settings = TrainSettings { classes: vec!["wave".to_owned()], ..TrainSettings::default() };
//! let db = MotionDb::open_read_only("moves.mdb".as_ref())?;
//! let data = training_data(&db, &settings.classes, MaterialBeside::default())?;
//! let (index, report) = settings.train(&data, &())?;
//! println!("{} classes; the same: morec train --db moves.mdb {:?}", report.classes.len(), arguments(&settings));
//! index.save("wave.index")?;
//! # Ok(())
//! # }
//! ```

mod arguments;
mod crossval;
mod curve;
mod cut;
mod discover;
mod error;
mod evaluate;
mod group;
mod import;
mod material;
mod params;
mod propose;
mod recognize;
mod search;
mod text;
mod train;
mod words;

pub use arguments::arguments;
pub use crossval::{CrossvalMeasures, CrossvalSettings, LeftOut};
pub use curve::{CurveFigures, CurvePoint, LearningCurve};
pub use cut::{CutMethod, CutSettings};
pub use discover::{
    AloneStretch, DiscoverClip, DiscoverSettings, DiscoveredSet, DiscoveredSets, DiscoveredStretch,
};
pub use error::OperationError;
pub use evaluate::{EvaluateMeasures, EvaluateSettings};
pub use group::{GroupMethod, GroupSettings, GroupedStretch, Grouping, Shapes, largest_first};
pub use import::{CopiedClip, ImportSettings, ImportedFiles};
pub use material::{MaterialBeside, accepted_labels, training_data};
pub use params::{Param, ParamError, from_fields};
pub use propose::ProposeSettings;
pub use recognize::{RecognizeSettings, StreamSettings};
pub use search::{SearchSettings, example_of_clip, example_of_database};
pub use train::{Method, TrainSettings, Unlabelled};
pub use words::share;
