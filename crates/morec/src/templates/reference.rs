//! Rows with which a stream is compared one by one, with a metric of their own.

use crate::classes::ClassId;
use crate::features::Rows;
use crate::math::portable;

use super::{Metric, PackedSymmetric};

/// Rows of classes and rows of anything else, before the metric.
#[derive(Debug, Clone, PartialEq)]
pub struct ReferenceRows {
    /// Rows of the classes.
    pub rows: Rows,
    /// For each row, its class.
    pub classes: Vec<ClassId>,
    /// Rows of anything else.
    pub others: Rows,
    /// As [`TemplateModel::ridged`](super::TemplateModel::ridged), of these rows.
    pub ridged: PackedSymmetric,
    /// As [`TemplateModel::total`](super::TemplateModel::total), of these rows.
    pub total: PackedSymmetric,
}

impl ReferenceRows {
    /// Checks that all parts fit together, for rows of `dim` values and `classes` classes; `what` they are, for messages.
    ///
    /// # Errors
    /// A sentence about the first part that does not fit.
    pub(super) fn check(&self, what: &str, dim: usize, classes: usize) -> Result<(), String> {
        let widths = [
            self.rows.dim(),
            self.others.dim(),
            self.ridged.dim(),
            self.total.dim(),
        ];
        if let Some(found) = widths.iter().find(|width| **width != dim) {
            return Err(format!("{what} have {found} values, the bones give {dim}"));
        }
        if self.rows.len() != self.classes.len() {
            return Err(format!(
                "{} {what}, classes for {}",
                self.rows.len(),
                self.classes.len()
            ));
        }
        match self.classes.iter().find(|class| class.index() >= classes) {
            Some(class) => Err(format!("{what} of class {}, of {classes}", class.0)),
            None => Ok(()),
        }
    }

    /// The metric that rows are compared under.
    pub fn metric(&self) -> Metric {
        Metric::new(&self.ridged, &self.total)
    }

    /// The classes, each once, in order.
    pub fn distinct_classes(&self) -> Vec<ClassId> {
        let mut classes = self.classes.clone();
        classes.sort_unstable();
        classes.dedup();
        classes
    }

    /// The distinct classes, and the place of each row's class among them.
    pub(super) fn numbered(&self) -> (Vec<ClassId>, Vec<usize>) {
        let distinct = self.distinct_classes();
        let place = |class: &ClassId| distinct.partition_point(|known| known < class);
        let places = self.classes.iter().map(place).collect();
        (distinct, places)
    }

    /// With the columns `kept` alone.
    pub(super) fn restricted(&self, kept: &[usize]) -> Self {
        Self {
            rows: self.rows.columns(kept),
            classes: self.classes.clone(),
            others: self.others.columns(kept),
            ridged: self.ridged.restricted(kept),
            total: self.total.restricted(kept),
        }
    }
}

/// [`TickDetection::separation`](crate::decode::TickDetection::separation) of what is at this share of the distance from anything else.
pub(super) fn separation(share: f64) -> f32 {
    -portable::ln(share.max(1e-3)).clamp(0.0, 1.0) as f32
}
