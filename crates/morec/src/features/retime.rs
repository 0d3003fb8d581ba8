//! Feature rows of the same motion at another speed.

use super::bones::BoneSet;
use super::params::FeatureParams;
use super::rows::Rows;

/// Velocities nearer to saturation than this say no more about their size.
const MOST_SATURATED: f64 = 0.98;

/// What `rows` over `bones` would be if the motion took `factor` times as long: resampled linearly, velocities divided by the
/// factor. O(values).
pub fn retimed_rows(rows: &Rows, bones: BoneSet, params: &FeatureParams, factor: f64) -> Rows {
    let len = ((rows.len() as f64 * factor).round() as usize).max(2);
    let mut out = Rows::new(rows.dim());
    if rows.is_empty() {
        return out;
    }
    let (velocities, root) = (3 * bones.len(), 6 * bones.len());
    let mut row = vec![0f32; rows.dim()];
    for i in 0..len {
        let at = i as f64 * (rows.len() - 1) as f64 / (len - 1) as f64;
        let before = (at as usize).min(rows.len().saturating_sub(2));
        let after = (before + 1).min(rows.len() - 1);
        let share = (at - before as f64) as f32;
        for ((out, a), b) in row.iter_mut().zip(rows.row(before)).zip(rows.row(after)) {
            *out = a * (1.0 - share) + b * share;
        }
        for velocity in row[velocities..root].chunks_exact_mut(3) {
            slow_down(velocity, params, factor);
        }
        for value in &mut row[root..] {
            *value /= factor as f32;
        }
        out.push(&row);
    }
    out
}

/// Divides a weighted, saturated velocity by `factor` before its saturation.
fn slow_down(velocity: &mut [f32], params: &FeatureParams, factor: f64) {
    let plain = |v: &f32| f64::from(*v) / params.velocity_weight;
    let size = velocity
        .iter()
        .map(|v| plain(v).powi(2))
        .sum::<f64>()
        .sqrt();
    let share = (size / params.velocity_saturation).min(MOST_SATURATED);
    // v / (1 + |v| / s) has the length s · share: |v| = s · share / (1 − share).
    let slower = params.velocity_saturation * share / (1.0 - share) / factor;
    let saturated = slower / (1.0 + slower / params.velocity_saturation);
    let scale = if size > 0.0 { saturated / size } else { 1.0 };
    velocity.iter_mut().for_each(|v| *v *= scale as f32);
}
