//! Training from labelled samples and background motion, by either method.

mod align;
mod clips;
mod data;
mod examples;
mod from_clips;
mod mining;
mod mirror;
mod notes;
mod operating;
mod options;
mod params;
mod recipe;
mod report;
mod ridge;
mod scatter;
mod set;
mod templates;
mod thresholds;
mod trainer;
mod trim;
mod verifier;

pub use crate::thesis::{train as thesis, train_tree as svrdm};
pub use align::align;
pub use clips::{everyday_clips, train_clips};
pub use data::{DataError, TrainingData};
pub use from_clips::{LabelSet, Prepared, TrainClip, build_train_set};
pub use mirror::{Mirror, add_mirrored};
pub(crate) use notes::class_notes;
pub use options::{ENOUGH_BACKGROUND_SECS, EVERYDAY_SEED, Everyday, TrainOptions};
pub use params::TrainParams;
pub use recipe::{Recipe, train_model};
pub use report::TrainingReport;
pub use set::{LabelledSpan, StreamKind, TrainSample, TrainSet, TrainStream, overlap_share};
pub use templates::{TrainError, TrainedTemplates, scatters, train};
pub use trainer::{Trainer, train_index};
pub use trim::motion_span;
