//! Matching a stream against labelled samples, elastically in time.

mod bank;
mod engine;
mod metric;
mod model;

pub use bank::{Bank, Match};
pub use engine::TemplateEngine;
pub use metric::{Metric, Symmetric};
pub use model::{Sample, TemplateModel, TemplateModelError};
