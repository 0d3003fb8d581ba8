//! Samples of any length as points of one space, for clustering by distance.

use crate::features::Rows;

/// `points` rows evenly over a sample, interpolated, end to end: `points` × `dim` values. Rows that are missing
/// altogether give zeros.
pub fn resampled(rows: &Rows, points: usize) -> Vec<f32> {
    let mut out = Vec::with_capacity(points * rows.dim());
    for point in 0..points {
        if rows.is_empty() {
            out.resize(points * rows.dim(), 0.0);
            break;
        }
        let at = (rows.len() - 1) as f64 * point as f64 / points.saturating_sub(1).max(1) as f64;
        let (before, share) = (at as usize, at.fract() as f32);
        let after = (before + 1).min(rows.len() - 1);
        out.extend(
            rows.row(before)
                .iter()
                .zip(rows.row(after))
                .map(|(a, b)| a + share * (b - a)),
        );
    }
    out
}

/// Mean squared distance of two such points: their squared Euclidean distance over `points`.
pub fn squared_distance(a: &[f32], b: &[f32], points: usize) -> f64 {
    let sum: f32 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
    f64::from(sum) / points.max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_stay_and_middles_lie_between() {
        let rows = Rows::from_values(1, vec![0.0, 1.0, 4.0]);
        assert_eq!(resampled(&rows, 5), [0.0, 0.5, 1.0, 2.5, 4.0]);
        assert_eq!(resampled(&Rows::from_values(1, vec![3.0]), 2), [3.0, 3.0]);
        assert_eq!(resampled(&Rows::new(2), 2), [0.0; 4]);
        assert_eq!(squared_distance(&[0.0, 2.0], &[0.0, 0.0], 2), 2.0);
    }
}
