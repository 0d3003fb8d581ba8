//! Feature rows of the same motion at another speed.

use crate::BoneSet;
use crate::layout::RowLayout;
use crate::params::FeatureParams;
use crate::rows::Rows;

/// Velocities nearer to saturation than this say no more about their size.
const MOST_SATURATED: f64 = 0.98;

/// Feature rows over `bones` of the same motion performed in `factor` times the time: `rows` resampled linearly, velocities
/// divided by the factor; at least 2 rows. O(values).
pub fn retimed_rows(rows: &Rows, bones: BoneSet, params: &FeatureParams, factor: f64) -> Rows {
    let len = ((rows.len() as f64 * factor).round() as usize).max(2);
    let mut out = Rows::new(rows.dim());
    if rows.is_empty() {
        return out;
    }
    let layout = RowLayout::of(bones);
    let mut row = vec![0f32; rows.dim()];
    for i in 0..len {
        let at = i as f64 * (rows.len() - 1) as f64 / (len - 1) as f64;
        let before = (at as usize).min(rows.len().saturating_sub(2));
        let after = (before + 1).min(rows.len() - 1);
        let share = (at - before as f64) as f32;
        for ((out, a), b) in row.iter_mut().zip(rows.row(before)).zip(rows.row(after)) {
            *out = a * (1.0 - share) + b * share;
        }
        for velocity in row[layout.velocities()].chunks_exact_mut(3) {
            slow_down(velocity, params, factor);
        }
        for value in &mut row[layout.root()] {
            *value /= factor as f32;
        }
        out.push(&row);
    }
    out
}

/// Divides a weighted, saturated velocity by `factor` before its saturation.
fn slow_down(velocity: &mut [f32], params: &FeatureParams, factor: f64) {
    let (saturation, weight) = (params.velocity_saturation, params.velocity_weight);
    let stored = [0, 1, 2].map(|axis| f64::from(velocity[axis]) / weight);
    let slower = unsaturated(stored, saturation, MOST_SATURATED).map(|v| v / factor);
    let saturate = 1.0 / (1.0 + length(slower) / saturation);
    for (out, v) in velocity.iter_mut().zip(slower) {
        *out = (v * saturate * weight) as f32;
    }
}

/// `v` from `v / (1 + |v| / saturation)`; a length of more than `most` times the saturation counts as that much.
pub(crate) fn unsaturated(velocity: [f64; 3], saturation: f64, most: f64) -> [f64; 3] {
    let share = (length(velocity) / saturation).min(most);
    velocity.map(|v| v / (1.0 - share))
}

fn length(v: [f64; 3]) -> f64 {
    v.iter().map(|v| v * v).sum::<f64>().sqrt()
}
