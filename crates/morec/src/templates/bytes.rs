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
pub fn snapped(rows: &Rows, step: &[f32]) -> Rows {
    let snap = |(v, s): (&f32, &f32)| if *s > 0.0 { (v / s).round() * s } else { 0.0 };
    let values = rows.iter().flat_map(|row| row.iter().zip(step).map(snap));
    Rows::from_values(rows.dim(), values.collect())
}
