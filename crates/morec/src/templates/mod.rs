//! Matching a stream against labelled samples, elastically in time.

mod activities;
mod adaptation;
pub(crate) mod align;
mod bank;
mod bytes;
mod class_matcher;
mod class_matches;
mod compact;
mod deviation;
mod dot;
mod early;
mod engine;
mod gestures;
mod held;
pub(crate) mod kernel;
mod matcher;
mod metric;
mod model;
mod operating;
mod performer;
mod recent_rows;
mod reference;
mod sample;
pub mod second_look;
mod spread_norm;
mod stretches;
mod trace;
mod units;
mod verifier;

pub use activities::Activities;
#[cfg(feature = "train")]
pub(crate) use activities::{STEP_TICKS, windows_of};
#[cfg(feature = "train")]
pub use align::align;
pub use bank::{Match, PartialMatch, TemplateBank};
pub use class_matcher::ClassMatcher;
pub use class_matches::{ClassMatches, ClassMatchesError};

#[cfg(feature = "train")]
pub(crate) use bytes::{snapped, steps};
pub use deviation::{
    BoneDeviation, Deviation, DeviationMeter, MotionDeviation, angle_at, deviation_from,
};
pub use dot::AT_ONCE;
pub use early::{EarlyDetectionParams, OngoingMatch};
pub use engine::TemplateEngine;
pub use held::HeldPoses;
#[cfg(feature = "train")]
pub(crate) use held::distance_from;
pub use matcher::{MatchGate, Matcher, NormalizedMatch, mean_and_spread};
pub use metric::{Metric, PackedSymmetric};
pub use model::{TemplateModel, TemplateModelError};
pub use operating::{ALARM_RATES, Calibration, OperatingPoint, threshold_at};
pub use performer::{PerformerKind, PerformerLevel, StrangerGate};
pub(crate) use recent_rows::RecentRows;
pub use reference::ReferenceRows;
pub use sample::TemplateSample;
pub use stretches::Stretches;
pub use trace::{Nearest, Trace};
#[cfg(feature = "train")]
pub(crate) use units::{StreamRows, Units};
pub use verifier::{
    Evidence, Exemplars, LinearScore, SHAPE_ROWS, Verifier, shape_distance, shape_of,
    squared_distance,
};
