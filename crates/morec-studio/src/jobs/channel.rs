//! One channel of a clip as the database keeps it: Bézier curves between keyframes.

use std::path::Path;

use morec::smooth::{Bezier, ChannelKind, CompressedClip};
use morec_db::{ClipId, MotionDb};

use super::progress::JobError;

/// The curves of a joint's rotation (x, y, z, w of a quaternion) or position (x, y, z, metres).
#[derive(Debug, Clone, PartialEq)]
pub struct ChannelCurve {
    pub clip: ClipId,
    pub joint: usize,
    pub kind: ChannelKind,
    /// End to end; none where the channel stands still.
    pub curves: Vec<Bezier>,
}

impl ChannelCurve {
    /// Number of values at a moment: 4 of a rotation, 3 of a position.
    pub fn components(&self) -> usize {
        match self.kind {
            ChannelKind::Rotation => 4,
            ChannelKind::Position => 3,
        }
    }

    /// The values at the share `t` of a curve's time.
    pub fn value(&self, curve: &Bezier, t: f64) -> [f64; 4] {
        let s = 1.0 - t;
        let weights = [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t];
        let mut value = [0.0; 4];
        for (weight, point) in weights.iter().zip(&curve.points) {
            for (sum, part) in value.iter_mut().zip(point) {
                *sum += weight * part;
            }
        }
        if self.kind == ChannelKind::Rotation {
            let norm = value.iter().map(|v| v * v).sum::<f64>().sqrt().max(1e-12);
            value.iter_mut().for_each(|v| *v /= norm);
        }
        value
    }

    /// The middle of each component, and the extent of the one that varies most, over keys and control points.
    pub fn middles(&self) -> ([f64; 4], f64) {
        let (mut middles, mut extent) = ([0.0; 4], 0.0f64);
        for (component, middle) in middles.iter_mut().enumerate().take(self.components()) {
            let points = || self.curves.iter().flat_map(|c| c.points);
            let low = points().map(|p| p[component]).fold(f64::MAX, f64::min);
            let high = points().map(|p| p[component]).fold(f64::MIN, f64::max);
            *middle = 0.5 * (low + high);
            extent = extent.max(high - low);
        }
        (middles, extent)
    }
}

/// Reads a channel of a clip in the database at `path`.
pub fn read(
    path: &Path,
    clip: ClipId,
    joint: usize,
    kind: ChannelKind,
) -> Result<ChannelCurve, JobError> {
    let read = MotionDb::open_read_only(path)
        .and_then(|db| db.motion_bytes(clip))
        .map_err(|error| error.to_string())
        .and_then(|bytes| CompressedClip::from_bytes(&bytes).map_err(|e| e.to_string()));
    match read {
        Ok(compressed) => {
            let curve = compressed.curve(joint, kind);
            Ok(ChannelCurve {
                clip,
                joint,
                kind,
                curves: curve.map_or_else(Vec::new, |c| compressed.beziers(c).collect()),
            })
        }
        Err(why) => Err(JobError::Failed(format!(
            "The channel cannot be read: {why}"
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use morec::TimeSpan;

    #[test]
    fn a_curve_begins_and_ends_at_its_keys() {
        let curve = Bezier {
            span: TimeSpan::new(1.0, 2.0),
            degree: 3,
            points: [
                [0.0, 1.0, 0.0, 0.0],
                [0.3, 1.0, 0.0, 0.0],
                [0.7, 2.0, 0.0, 0.0],
                [1.0, 2.0, -1.0, 0.0],
            ],
        };
        let channel = ChannelCurve {
            clip: ClipId(1),
            joint: 0,
            kind: ChannelKind::Position,
            curves: vec![curve],
        };
        assert_eq!(channel.value(&curve, 0.0)[..3], curve.points[0][..3]);
        assert_eq!(channel.value(&curve, 1.0)[..3], curve.points[3][..3]);
        let (middles, extent) = channel.middles();
        assert_eq!(middles, [0.5, 1.5, -0.5, 0.0]);
        assert_eq!(extent, 1.0, "of the one that varies most");
    }
}
