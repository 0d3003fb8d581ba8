//! A labelled sample, from which templates are made.

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

impl TemplateSample {
    /// Rows of those of `samples` that are of `class`.
    pub fn rows_of(samples: &[Self], class: ClassId) -> impl Iterator<Item = &Rows> + Clone {
        let of_class = samples.iter().filter(move |s| s.class == class);
        of_class.map(|s| &s.rows)
    }
}
