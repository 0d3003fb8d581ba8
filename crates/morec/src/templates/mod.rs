//! Matching a stream against labelled samples, elastically in time.

mod bank;
mod class_matcher;
mod class_matches;
mod compact;
mod early;
mod engine;
mod kernel;
mod matcher;
mod metric;
mod model;
mod operating;
mod stretches;
mod trace;
mod verifier;

pub use bank::{Bank, Match, PartialMatch};
pub use class_matcher::ClassMatcher;
pub use class_matches::{ClassMatches, ClassMatchesError, reach_of};
pub use early::{EarlyParams, Underway};
pub use engine::TemplateEngine;
pub use matcher::{Comparison, Matcher, TYPICAL_SPREAD, mean_and_spread};
pub use metric::{Metric, Symmetric};
pub use model::{Sample, TemplateModel, TemplateModelError};
pub use operating::{ALARM_RATES, Calibration, OperatingPoint, threshold_at};
pub use stretches::Stretches;
pub use trace::{Nearest, Trace};
pub use verifier::{
    Evidence, Exemplars, Generic, SHAPE_ROWS, Verifier, shape_distance, shape_of, squared_distance,
};
