//! When somebody moved last.

use std::collections::VecDeque;

use morec::live::{Frame, Rig};
use morec::roles::Role;

/// Hands, feet and head slower than this against the hips stand still, metres a second.
const STILL: f32 = 0.12;
/// A rest in which a motion has ended, seconds.
const REST_SECS: f64 = 0.35;
/// A motion that is shorter is none, a longer one is cut, seconds.
const LENGTH_SECS: (f64, f64) = (0.3, 5.0);

/// The fastest of hands, feet and head against the hips.
pub fn speed(last: &Frame, frame: &Frame, rig: &Rig) -> f32 {
    const ENDS: [Role; 5] = [
        Role::LeftHand,
        Role::RightHand,
        Role::LeftFoot,
        Role::RightFoot,
        Role::Head,
    ];
    let dt = frame.time_secs - last.time_secs;
    let (Some(hips), true) = (rig.roles.joint(Role::Hips), dt > 1e-4) else {
        return 0.0;
    };
    let place = |frame: &Frame, joint: usize| {
        Some(frame.pose.positions.get(joint)? - frame.pose.positions.get(hips)?)
    };
    let speeds = ENDS.iter().filter_map(|role| {
        let joint = rig.roles.joint(*role)?;
        let moved = (place(frame, joint)? - place(last, joint)?).norm() / dt;
        moved.is_finite().then_some(moved as f32)
    });
    speeds.fold(0.0, f32::max)
}

/// The last stretch of movement before now, rests at its ends left out.
pub fn last_motion(frames: &VecDeque<Frame>, speeds: &VecDeque<f32>) -> Option<(f64, f64)> {
    let moving = |at: usize| smoothed(speeds, at) > STILL;
    let stop = (0..frames.len()).rev().find(|&at| moving(at))?;
    let stop_secs = frames[stop].time_secs;
    let mut start = stop;
    for at in (0..stop).rev() {
        let (began, now) = (frames[start].time_secs, frames[at].time_secs);
        if stop_secs - now > LENGTH_SECS.1 || began - now > REST_SECS {
            break;
        }
        if moving(at) {
            start = at;
        }
    }
    let start_secs = frames[start].time_secs;
    (stop_secs - start_secs >= LENGTH_SECS.0).then_some((start_secs, stop_secs))
}

/// The mean of a few frames: trackers tremble.
fn smoothed(speeds: &VecDeque<f32>, at: usize) -> f32 {
    let span = at.saturating_sub(2)..(at + 3).min(speeds.len());
    let n = span.len().max(1) as f32;
    span.map(|i| speeds[i]).sum::<f32>() / n
}
