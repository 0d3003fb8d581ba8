//! Stretches without motion, and T-poses among them.

use std::ops::Range;

use crate::features::{ALL_BONES, BONE_WEIGHTS, BoneSet, FeatureParams, Rows};

/// Kind of stillness.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum StillKind {
    /// A pose is held.
    Still,
    /// Arms straight out to the sides, legs down: the pose that calibration and conversion leave behind.
    TPose,
}

/// Parameters of [`still_stretches`].
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct StillParams {
    /// Still is slower than this: root mean square of the bones' angular speed, radians a second.
    pub speed_rad: f64,
    /// Shorter rests are part of moving.
    pub least_secs: f64,
    /// A T-pose is as short as this.
    pub least_t_pose_secs: f64,
}

impl Default for StillParams {
    fn default() -> Self {
        Self {
            speed_rad: 0.15,
            least_secs: 0.5,
            least_t_pose_secs: 0.1,
        }
    }
}

/// Still stretches of feature rows over `bones`, in order, in ticks. O(rows · values).
pub fn still_stretches(
    rows: &Rows,
    bones: BoneSet,
    features: &FeatureParams,
    params: &StillParams,
) -> Vec<(Range<usize>, StillKind)> {
    let weights: Vec<f64> = bones.indices().map(|b| BONE_WEIGHTS[b]).collect();
    let speed = |t: usize| -> f64 {
        let (before, after) = (t.saturating_sub(1), (t + 1).min(rows.len() - 1));
        let secs = (after - before).max(1) as f64 / features.tick_hz();
        let squares = weights.iter().enumerate().map(|(b, weight)| {
            let moved = (3 * b..3 * b + 3)
                .map(|i| f64::from(rows.row(after)[i] - rows.row(before)[i]).powi(2));
            moved.sum::<f64>() / (weight * secs).powi(2)
        });
        (squares.sum::<f64>() / weights.len().max(1) as f64).sqrt()
    };
    let kind = |t: usize| match speed(t) < params.speed_rad {
        true if is_t_pose(rows.row(t), bones) => Some(StillKind::TPose),
        true => Some(StillKind::Still),
        false => None,
    };
    let kinds: Vec<Option<StillKind>> = (0..rows.len()).map(kind).collect();
    let mut found = Vec::new();
    let mut start = 0;
    for t in 1..=kinds.len() {
        if t < kinds.len() && kinds[t] == kinds[start] {
            continue;
        }
        let least = match kinds[start] {
            Some(StillKind::TPose) => params.least_t_pose_secs,
            _ => params.least_secs,
        };
        if let Some(kind) =
            kinds[start].filter(|_| (t - start) as f64 >= least * features.tick_hz())
        {
            found.push((start..t, kind));
        }
        start = t;
    }
    found
}

/// Upper and forearms within 25° of the lateral axis, away from each other, thighs within 25° of straight down.
fn is_t_pose(row: &[f32], bones: BoneSet) -> bool {
    let near = 25f32.to_radians().cos();
    let direction = |name: &str| -> Option<[f32; 3]> {
        let bone = ALL_BONES
            .iter()
            .position(|b| b.name == name)
            .filter(|b| bones.contains(*b))?;
        let at = bones.indices().position(|b| b == bone)?;
        let weight = BONE_WEIGHTS[bone] as f32;
        Some([0, 1, 2].map(|i| row[3 * at + i] / weight))
    };
    let along =
        |name: &str, axis: usize, sign: f32| direction(name).is_some_and(|d| sign * d[axis] > near);
    along("left_arm", 0, 1.0)
        && along("left_forearm", 0, 1.0)
        && along("right_arm", 0, -1.0)
        && along("right_forearm", 0, -1.0)
        && along("left_thigh", 1, -1.0)
        && along("right_thigh", 1, -1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(arms_out: bool, swing: f32) -> Vec<f32> {
        let mut row = vec![0f32; 6 * ALL_BONES.len() + 4];
        for (b, bone) in ALL_BONES.iter().enumerate() {
            let side = if bone.name.starts_with("left") {
                1.0
            } else {
                -1.0
            };
            let arm = bone.name.ends_with("arm");
            let direction = if arm && arms_out {
                [side, 0.0, 0.0]
            } else {
                [swing.sin(), -swing.cos(), 0.0]
            };
            for i in 0..3 {
                row[3 * b + i] = BONE_WEIGHTS[b] as f32 * direction[i];
            }
        }
        row
    }

    #[test]
    fn held_poses_and_t_poses_are_told_apart() {
        let mut rows = Rows::new(6 * ALL_BONES.len() + 4);
        for t in 0..90 {
            let swing = if (50..70).contains(&t) {
                (t as f32 * 0.8).sin() * 0.5
            } else {
                0.0
            };
            rows.push(&row(t < 10, swing));
        }
        let params = FeatureParams::default();
        let found = still_stretches(&rows, BoneSet::BODY, &params, &StillParams::default());
        let kinds: Vec<StillKind> = found.iter().map(|f| f.1).collect();
        assert_eq!(
            kinds,
            [StillKind::TPose, StillKind::Still, StillKind::Still],
            "{found:?}"
        );
        assert_eq!(found[0].0, 0..9);
        assert!(found[2].0.start >= 70);
    }
}
