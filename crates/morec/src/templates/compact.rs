//! Rounds rows to steps of a byte, which makes index files small.

use crate::features::Rows;

use super::bytes::{snapped, steps};
use super::{TemplateModel, TemplateSample};

impl TemplateModel {
    /// The model with every stored row moved to the nearest step, column by column, of the column's largest value
    /// over 127. Recognition then sees what the file holds, bit for bit.
    #[must_use]
    pub fn compacted(mut self) -> Self {
        let shapes = self
            .verifier
            .iter()
            .flat_map(|v| v.classes.iter().map(|c| &c.shapes));
        let all = self
            .samples
            .iter()
            .map(|s| &s.rows)
            .chain(&self.negatives)
            .chain(shapes);
        let step = steps(all, self.ridged.dim());
        let snap = |rows: &Rows| snapped(rows, &step);
        self.samples = self
            .samples
            .iter()
            .map(|s| TemplateSample {
                class: s.class,
                rows: snap(&s.rows),
            })
            .collect();
        self.negatives = self.negatives.iter().map(snap).collect();
        if let Some(verifier) = &mut self.verifier {
            verifier
                .classes
                .iter_mut()
                .for_each(|c| c.shapes = snap(&c.shapes));
        }
        self.step = Some(step);
        self
    }
}
