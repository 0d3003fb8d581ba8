//! Rounds rows to steps of a byte, which makes index files small.

use crate::features::Rows;

use super::TemplateModel;
use super::bytes::{snapped, steps};

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
        let snap = |rows: &mut Rows| *rows = snapped(std::mem::take(rows), &step);
        let samples = self.samples.iter_mut().map(|s| &mut s.rows);
        let verifier = self.verifier.iter_mut();
        let shapes = verifier.flat_map(|v| v.classes.iter_mut().map(|c| &mut c.shapes));
        samples
            .chain(&mut self.negatives)
            .chain(shapes)
            .for_each(snap);
        self.step = Some(step);
        self
    }
}
