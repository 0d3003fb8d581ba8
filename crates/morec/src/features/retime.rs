//! Feature rows of the same motion at another speed.

use super::BoneSet;
use super::layout::RowLayout;
use super::params::FeatureParams;
use super::rows::Rows;

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
pub(super) fn unsaturated(velocity: [f64; 3], saturation: f64, most: f64) -> [f64; 3] {
    let share = (length(velocity) / saturation).min(most);
    velocity.map(|v| v / (1.0 - share))
}

fn length(v: [f64; 3]) -> f64 {
    v.iter().map(|v| v * v).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::features::{FeatureStream, KeyPose, for_each_pose};
    use crate::roles::RoleMap;
    use crate::synth::{Person, Script};

    fn rows(poses: &[(f64, KeyPose)], duration: f64) -> Rows {
        let mut stream = FeatureStream::new(BoneSet::BODY, &FeatureParams::default());
        let mut rows = Rows::new(stream.dim());
        for (t, pose) in poses {
            stream.push(t * duration, pose, &mut |row| rows.push(row));
        }
        stream.finish(&mut |row| rows.push(row));
        rows
    }

    /// Mean squared difference over some columns.
    fn difference(a: &Rows, b: &Rows, columns: std::ops::Range<usize>) -> f64 {
        let len = a.len().min(b.len());
        let squares = (0..len).flat_map(|i| {
            let (a, b) = (&a.row(i)[columns.clone()], &b.row(i)[columns.clone()]);
            a.iter()
                .zip(b)
                .map(|(a, b)| f64::from(a - b).powi(2))
                .collect::<Vec<_>>()
        });
        squares.sum::<f64>() / (len * columns.len()) as f64
    }

    #[test]
    fn retimed_rows_are_the_rows_of_a_faster_performer() {
        let person = Person::draw(1, 0);
        let script = Script::new(1, person).play("walk").play("wave");
        let take = script.film("m", 60.0).unwrap();
        let roles = RoleMap::find(&take.clip.skeleton);
        let mut poses = Vec::new();
        for_each_pose(&take.clip, &roles, &(0..0), |t, pose| {
            poses.push((t, *pose))
        });
        let (usual, fast) = (rows(&poses, 1.0), rows(&poses, 0.7));
        let params = FeatureParams::default();
        let retimed = retimed_rows(&usual, BoneSet::BODY, &params, 0.7);
        assert!(retimed.len().abs_diff(fast.len()) <= 1);
        // The same poses at the same velocities: without dividing by the factor velocities are far off.
        let velocities = RowLayout::BODY.velocities();
        let slow = FeatureParams {
            velocity_saturation: 1e9,
            ..params
        };
        let resampled = retimed_rows(&usual, BoneSet::BODY, &slow, 0.7);
        let zero = Rows::from_values(fast.dim(), vec![0.0; fast.values().len()]);
        let size = difference(&fast, &zero, velocities.clone());
        let error = difference(&fast, &retimed, velocities.clone());
        assert!(error < 0.1 * size, "{error} of {size}");
        assert!(error < difference(&fast, &resampled, velocities.clone()));
        let directions = 0..velocities.start;
        let error = difference(&fast, &retimed, directions);
        assert!(error < 0.01, "{error}");
    }
}
