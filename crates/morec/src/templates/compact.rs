//! Rows in steps of a byte, so that index files are small.

use crate::features::Rows;

use super::{TemplateModel, TemplateSample};

/// Steps from zero to the largest value of a column: signed bytes.
const STEPS: f32 = 127.0;

/// The step of each column of these tables of `dim` columns.
pub fn steps<'r>(tables: impl Iterator<Item = &'r Rows>, dim: usize) -> Vec<f32> {
    let mut step = vec![0.0f32; dim];
    for row in tables.flat_map(Rows::iter) {
        step.iter_mut()
            .zip(row)
            .for_each(|(s, v)| *s = s.max(v.abs() / STEPS));
    }
    step
}

/// `rows` with every value moved to the nearest whole multiple of its column's step.
pub fn snapped(rows: &Rows, step: &[f32]) -> Rows {
    let snap = |(v, s): (&f32, &f32)| if *s > 0.0 { (v / s).round() * s } else { 0.0 };
    let values = rows.iter().flat_map(|row| row.iter().zip(step).map(snap));
    Rows::from_values(rows.dim(), values.collect())
}

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
