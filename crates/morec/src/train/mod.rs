//! Training the template recogniser from labelled samples and background motion.

mod align;
mod from_clips;
mod mining;
mod params;
mod scatter;
mod set;
mod templates;
mod trim;

pub use align::align;
pub use from_clips::{Labelling, Prepared, TrainClip, prepare};
pub use params::TrainParams;
pub use set::{Known, Source, TrainSample, TrainSet, TrainStream};
pub use templates::{TrainError, Trained, train};
