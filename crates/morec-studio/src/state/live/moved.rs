//! When somebody moved last.

use std::collections::VecDeque;

use morec::features::{Hand, Profile};
use morec::live::{Frame, Rig};
use morec::roles::Role;

/// Hands, feet and head slower than this against the hips stand still, metres a second.
const STILL: f32 = 0.12;
/// Movement slower than this share of the fastest of the last seconds is swaying.
const SHARE: f32 = 0.15;
/// A rest in which a motion has ended, seconds.
const REST_SECS: f64 = 0.35;
/// Shorter motions are ignored, longer ones are cut, seconds.
const LENGTH_SECS: (f64, f64) = (0.3, 5.0);

/// Speeds are taken over so long: from frame to frame a tracker's noise alone is as fast as a hand.
const OVER_SECS: f64 = 0.1;

/// The fastest of hands, feet and head against the hips, over the last tenth of a second; of hands without a body, of the wrist and the
/// fingertips.
pub fn speed(frames: &VecDeque<Frame>, frame: &Frame, rig: &Rig) -> f32 {
    const ENDS: [Role; 5] = [
        Role::LeftHand,
        Role::RightHand,
        Role::LeftFoot,
        Role::RightFoot,
        Role::Head,
    ];
    let old = frame.time_secs - OVER_SECS;
    let before = frames.iter().rev().find(|f| f.time_secs <= old);
    let Some(last) = before else { return 0.0 };
    let hips = rig.roles.joint(Role::Hips);
    let ends: Vec<Role> = match rig.roles.profile() {
        Profile::Hand | Profile::Hands => Hand::BOTH.into_iter().flat_map(ends_of).collect(),
        _ => ENDS.to_vec(),
    };
    let dt = frame.time_secs - last.time_secs;
    let place = |frame: &Frame, joint: usize| {
        let at = *frame.pose.positions.get(joint)?;
        // Without hips, places are those in the room.
        match hips {
            Some(hips) => Some(at - frame.pose.positions.get(hips)?),
            None => Some(at),
        }
    };
    let speeds = ends.iter().filter_map(|role| {
        let joint = rig.roles.joint(*role)?;
        let moved = (place(frame, joint)? - place(last, joint)?).norm() / dt;
        moved.is_finite().then_some(moved as f32)
    });
    speeds.fold(0.0, f32::max)
}

/// What moves of a hand: its wrist and the tips of its fingers.
fn ends_of(hand: Hand) -> Vec<Role> {
    let points = hand.points();
    let tips = points.fingers.iter().map(|finger| finger[finger.len() - 1]);
    tips.chain([points.wrist]).collect()
}

/// Start and stop of the last movement that is long enough for a motion, without the rest before and after it, in seconds.
pub fn last_motion(frames: &VecDeque<Frame>, speeds: &VecDeque<f32>) -> Option<(f64, f64)> {
    let last = frames.back()?.time_secs;
    let recent = frames.partition_point(|f| f.time_secs < last - LENGTH_SECS.1);
    let fastest = speeds.range(recent..).copied().fold(0.0, f32::max);
    // Nobody stands quite still: what counts is the share of the fastest.
    let least = (SHARE * fastest).max(STILL);
    let moving = |at: usize| smoothed(speeds, at) > least;
    let mut before = frames.len();
    loop {
        let stop = (0..before).rev().find(|&at| moving(at))?;
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
        if stop_secs - start_secs >= LENGTH_SECS.0 {
            return Some((start_secs, stop_secs));
        }
        // Too short for a motion: the stretch before it is looked at.
        before = start;
    }
}

/// The mean of a few frames: trackers tremble.
fn smoothed(speeds: &VecDeque<f32>, at: usize) -> f32 {
    let span = at.saturating_sub(2)..(at + 3).min(speeds.len());
    let n = span.len().max(1) as f32;
    span.map(|i| speeds[i]).sum::<f32>() / n
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_twitch_after_a_motion_is_not_the_last_motion() {
        // At 100 Hz: still, a motion of a second, still, a twitch of 0.1 s, still.
        let parts = [(50, 0.0), (100, 1.5), (60, 0.0), (10, 1.5), (50, 0.0)];
        let speeds = parts.iter().flat_map(|&(n, speed)| vec![speed; n]);
        let speeds: VecDeque<f32> = speeds.collect();
        let frame = |at: usize| Frame {
            time_secs: 0.01 * at as f64,
            ..Frame::default()
        };
        let frames: VecDeque<Frame> = (0..speeds.len()).map(frame).collect();
        let (start, stop) = last_motion(&frames, &speeds).unwrap();
        assert!((start - 0.5).abs() < 0.05, "{start}");
        assert!((stop - 1.5).abs() < 0.05, "{stop}");
        let still = VecDeque::from(vec![0.0; speeds.len()]);
        assert_eq!(last_motion(&frames, &still), None);
    }
}
