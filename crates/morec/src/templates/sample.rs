//! A labelled sample as templates are made of it.

use crate::classes::ClassId;
use crate::features::Rows;

/// One labelled sample's rows, before the metric.
#[derive(Debug, Clone, PartialEq)]
pub struct TemplateSample {
    /// Number of the class.
    pub class: ClassId,
    /// One row for each tick.
    pub rows: Rows,
}
