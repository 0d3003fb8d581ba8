//! Training from labelled samples and background motion, by either method.

mod align;
mod clips;
mod data;
mod examples;
mod from_clips;
mod mining;
mod mirror;
mod operating;
mod options;
mod params;
mod recipe;
mod report;
mod ridge;
mod scatter;
mod set;
pub mod svrdm;
mod templates;
pub mod thesis;
mod thresholds;
mod trainer;
mod trim;
mod verifier;

pub use align::align;
pub use clips::train_clips;
pub use data::{DataError, TrainingData};
pub use from_clips::{LabelSet, Prepared, TrainClip, prepare};
pub use mirror::Mirror;
pub use options::{ENOUGH_BACKGROUND_SECS, EVERYDAY_SEED, Everyday, TrainOptions};
pub use params::TrainParams;
pub use recipe::{Recipe, train_model};
pub use report::TrainingReport;
pub use set::{LabelledSpan, StreamKind, TrainSample, TrainSet, TrainStream, overlap_share};
pub use templates::{TrainError, TrainedTemplates, scatters, train};
pub use trainer::{Trainer, train_index};
pub use trim::moving_part;
