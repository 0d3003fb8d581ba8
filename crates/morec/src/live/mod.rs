//! Live recognition: poses in, detections out, nothing taken back.
//!
//! Real-time contract: construction allocates and may fail with a reason; `push` afterwards does not allocate,
//! lock, log or fail. A recogniser is owned by one thread at a time. Detections are the same however the stream
//! is cut into pushes.

mod model;
mod of_clip;
mod paths;
mod pose;
mod recognizer;

pub use model::{Model, StartError};
pub use of_clip::recognize_clip;
pub use pose::{Pose, PoseReader};
pub use recognizer::{Detection, Recognizer};
