//! Training the template recogniser from labelled samples and background motion.

mod align;
mod mining;
mod params;
mod scatter;
mod set;
mod templates;

pub use align::align;
pub use params::TrainParams;
pub use set::{Known, Source, TrainSample, TrainSet, TrainStream};
pub use templates::{TrainError, Trained, train};
