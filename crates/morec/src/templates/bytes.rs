//! Rows as whole multiples of a step for each column, stored in bytes.

use crate::features::Rows;

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
pub fn snapped(rows: Rows, step: &[f32]) -> Rows {
    let dim = rows.dim();
    let mut values = rows.into_values();
    for row in values.chunks_exact_mut(dim.max(1)) {
        for (value, step) in row.iter_mut().zip(step) {
            *value = match *step > 0.0 {
                true => (*value / step).round() * step,
                false => 0.0,
            };
        }
    }
    Rows::from_values(dim, values)
}
