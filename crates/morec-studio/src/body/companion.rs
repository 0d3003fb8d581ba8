//! Places a performer of another clip beside the one that is shown.

use morec::kinematics::WorldPose;
use morec::math::{Axis, Vec3};

use super::{Aligned, ClipMotion};

/// To the left of a performer at a moment: the direction in which companions stand.
pub fn aside(motion: &ClipMotion, secs: f64) -> Vec3 {
    let heading = motion.body.heading(&motion.pose(secs)).unwrap_or(0.0);
    Axis::Y.rotation(heading) * Vec3::x()
}

/// The companion's pose when the performer of `motion` is at `secs`: turned as the performer is turned and standing on the same
/// place where both stretches begin, moved `aside` by this many metres.
pub fn pose(aligned: &Aligned, motion: &ClipMotion, secs: f64, apart: f64) -> WorldPose {
    let (other, of) = (&aligned.motion, aligned.of.span.start_secs);
    let begin = other.pose(aligned.with.span.start_secs);
    let mut pose = other.pose(aligned.at(secs));
    let here = motion.pose(of);
    let (Some(from), Some(to)) = (other.body.centre(&begin), motion.body.centre(&here)) else {
        return pose;
    };
    let turned_from = other.body.heading(&begin).unwrap_or(0.0);
    let turned_to = motion.body.heading(&here).unwrap_or(0.0);
    let (back, forth) = (Axis::Y.rotation(-turned_from), Axis::Y.rotation(turned_to));
    let step = aside(motion, of) * apart;
    for place in &mut pose.positions {
        let height = place.y - other.floor;
        let mut own = back * (*place - from);
        if aligned.mirrored {
            own.x = -own.x;
        }
        let there = forth * own + to + step;
        *place = Vec3::new(there.x, motion.floor + height, there.z);
    }
    pose
}
