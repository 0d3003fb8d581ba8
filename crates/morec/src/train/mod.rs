//! Training the template recogniser from labelled samples and background motion.

mod align;
mod clips;
mod examples;
mod from_clips;
mod mining;
mod options;
mod params;
mod report;
mod ridge;
mod scatter;
mod set;
mod templates;
mod thresholds;
mod trim;
mod verifier;

pub use align::align;
pub use clips::train_clips;
pub use from_clips::{Labelling, Prepared, TrainClip, prepare};
pub use options::{ENOUGH_BACKGROUND_SECS, EVERYDAY_SEED, Everyday, TrainOptions};
pub use params::TrainParams;
pub use report::TrainingReport;
pub use set::{Known, Source, TrainSample, TrainSet, TrainStream};
pub use templates::{TrainError, Trained, train};
