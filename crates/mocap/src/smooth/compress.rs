//! Compresses a clip to curves.

use super::bound::{self, chord, too_coarse};
use super::errors::Errors;
use super::params::{SmoothError, SmoothParams};
use super::samples::{ChannelSamples, with_continuous_signs};
use super::split::ChannelFit;
use super::{CompressedClip, Curve};
use crate::clip::Clip;
use crate::progress::Progress;

/// Compresses `clip` so that at every frame each channel lies within the thresholds of `params`.
///
/// After §3.3 and Algorithm 1 of the thesis, as corrected: errors are measured from the curve to the samples, not to
/// the chord, and are angles and metres, not shares of the chord's length. Four things differ, each to keep more in
/// less: the four components of a quaternion share their keyframes, so that the error is one of rotation; inner
/// control points keep to the tangent space of their key; a curve is a line or a parabola where that is near enough
/// ("up to cubic"); and control points are rounded to steps before errors are looked at, so that what is stored is
/// what was measured.
///
/// With a bound on world positions, joints with long chains on them start with thresholds that their reach asks
/// for, and wherever a joint is still too far away the ancestor that does most of it is fitted again, more closely.
///
/// Thresholds hold at the frames of `clip`; between them the curves are as smooth as cubics are. O(n log n) for a
/// channel of n frames, times a few for the bound; memory beside the clip is that of the curves. Reports a step for each channel to `progress`.
///
/// # Errors
/// Parameters out of range, a clip whose tables disagree or hold values that are not finite, or
/// [`SmoothError::Cancelled`].
pub fn compress(
    clip: &Clip,
    params: &SmoothParams,
    progress: &dyn Progress,
) -> Result<CompressedClip, SmoothError> {
    params.check()?;
    check(clip)?;
    let signed = with_continuous_signs(clip);
    let clip = &*signed;
    let joints = clip.skeleton.len();
    let mut channels = channels(clip, params);
    let total = channels.len();
    for (done, channel) in channels.iter_mut().enumerate() {
        if progress.cancelled() {
            return Err(SmoothError::Cancelled);
        }
        progress.report("fitting curves", done, total);
        channel
            .fit()
            .map_err(|coarse| too_coarse(clip, done, coarse))?;
    }
    if let Some(metres) = params.joint_position_metres {
        bound::tighten(
            clip,
            &mut channels,
            metres,
            params.metres_per_unit,
            progress,
        )?;
    }
    progress.report("fitting curves", total, total);
    let mut curves = channels.into_iter().enumerate().map(|(c, channel)| {
        let joint = if c < joints {
            c
        } else {
            clip.tracks[c - joints].joint
        };
        Curve::new(joint, channel.lattice, channel.first, channel.pieces)
    });
    let mut compressed = CompressedClip {
        name: clip.name.clone(),
        skeleton: clip.skeleton.clone(),
        rate_hz: clip.rate_hz,
        frames: clip.frames,
        repaired: clip.repaired.clone(),
        points: clip.points.clone(),
        params: *params,
        errors: Errors::default(),
        rotations: curves.by_ref().take(joints).collect(),
        positions: curves.collect(),
    };
    compressed.errors = Errors::of(&compressed, clip);
    Ok(compressed)
}

/// Rotations joint by joint, then tracks, each with its threshold.
fn channels<'a>(clip: &'a Clip, params: &SmoothParams) -> Vec<ChannelFit<'a>> {
    let joints = clip.skeleton.len();
    let thresholds = bound::Thresholds::new(clip, params);
    let mut channels = Vec::with_capacity(joints + clip.tracks.len());
    for joint in 0..joints {
        let samples = ChannelSamples::Rotations {
            table: &clip.rotations,
            joints,
            joint,
        };
        channels.push(ChannelFit::new(samples, chord(thresholds.angle_rad(joint))));
    }
    for track in &clip.tracks {
        let samples = ChannelSamples::Positions(&track.positions);
        channels.push(ChannelFit::new(samples, thresholds.position()));
    }
    channels
}

fn check(clip: &Clip) -> Result<(), SmoothError> {
    let joints = clip.skeleton.len();
    let fail = |text: String| Err(SmoothError::Clip(text));
    if !(1e-3..=1e5).contains(&clip.rate_hz) {
        return fail(format!(
            "{} frames a second; rates are 0.001 to 100000",
            clip.rate_hz
        ));
    }
    if clip.frames > u32::MAX as usize / 2 {
        return fail(format!(
            "{} frames; at most {} are kept",
            clip.frames,
            u32::MAX / 2
        ));
    }
    if clip.rotations.len() != clip.frames * joints {
        return fail(format!(
            "{} rotations for {} frames of {joints} joints",
            clip.rotations.len(),
            clip.frames
        ));
    }
    for (i, track) in clip.tracks.iter().enumerate() {
        if track.joint >= joints || i > 0 && clip.tracks[i - 1].joint >= track.joint {
            return fail(format!(
                "track {i} is of joint {}, of {joints} in increasing order",
                track.joint
            ));
        }
        if track.positions.len() != clip.frames {
            return fail(format!(
                "{} positions for {} frames",
                track.positions.len(),
                clip.frames
            ));
        }
    }
    let value = |joint: usize, frame: usize| {
        let name = clip.skeleton.joints()[joint].name.clone();
        Err(SmoothError::Value {
            joint,
            name,
            frame,
            most: f64::MAX,
        })
    };
    let unit = |q: &crate::math::Quat| (q.coords.norm() - 1.0).abs() < 1e-6;
    if let Some(i) = clip.rotations.iter().position(|q| !unit(q)) {
        return value(i % joints, i / joints);
    }
    for track in &clip.tracks {
        if let Some(frame) = track
            .positions
            .iter()
            .position(|p| !p.iter().all(|x| x.is_finite()))
        {
            return value(track.joint, frame);
        }
    }
    Ok(())
}
