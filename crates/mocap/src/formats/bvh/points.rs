//! Clips of points in BVH, which has skeletons only: every point is a child of one root that never moves.

use crate::clip::{Clip, Joint, JointTrack, Points, Skeleton};
use crate::math::{Quat, Vec3};

/// Name of that root; it marks the others as points.
const ROOT: &str = "points";
/// Rotations below the precision of printed angles count as none.
const NO_TURN_RAD: f64 = 1e-6;

/// The clip with its points under one root.
pub(super) fn under_one_root(clip: &Clip) -> Clip {
    let joint = |name: &str, parent, offset| Joint {
        name: name.to_owned(),
        parent,
        offset,
        tip: None,
    };
    let mut joints = vec![joint(ROOT, None, Vec3::zeros())];
    let points = clip.skeleton.joints().iter();
    joints.extend(points.map(|point| joint(&point.name, Some(0), point.offset)));
    let track = |track: &JointTrack| JointTrack {
        joint: track.joint + 1,
        positions: track.positions.clone(),
    };
    Clip {
        name: clip.name.clone(),
        rotations: vec![Quat::identity(); clip.frames * joints.len()],
        // One root before all others: parents do come first.
        skeleton: Skeleton::new(joints).unwrap_or_default(),
        rate_hz: clip.rate_hz,
        tracks: clip.tracks.iter().map(track).collect(),
        frames: clip.frames,
        repaired: clip.repaired.clone(),
        points: None,
    }
}

/// A clip that was written so as points again; any other as it is.
pub(super) fn from_under_root(clip: Clip) -> Clip {
    let joints = clip.skeleton.joints();
    let is_flat = |(j, joint): (usize, &Joint)| joint.parent == (j > 0).then_some(0);
    let written_so = joints.len() > 1
        && joints[0].name == ROOT
        && joints.iter().enumerate().all(is_flat)
        && clip.rotations.iter().all(|q| q.angle() < NO_TURN_RAD);
    if !written_so {
        return clip;
    }
    let points = joints.iter().enumerate().skip(1).map(|(j, joint)| {
        // A point that never moves is its OFFSET.
        let positions = clip.track(j).map(|track| track.positions.clone());
        let still = || vec![joint.offset; clip.frames];
        (joint.name.clone(), positions.unwrap_or_else(still))
    });
    let mut read = Clip::of_points(clip.name.clone(), clip.rate_hz, points, Points::default());
    read.repaired.clone_from(&clip.repaired);
    read
}
