//! Turns a timeline into a clip: adds sway and sensor noise and samples frames.

use nalgebra::Quaternion;

use super::actor::Actor;
use super::timeline::{CHANNELS, Controls, HAND, HEAD, HIPS, HIPS_TURN, LimbSide, SPINE};
use crate::clip::{Clip, JointTrack};
use crate::math::{Quat, Vec3, same_hemisphere};
use crate::rng::Rng;

/// The sensors' noise has no energy far above 1 / this: what a recording system's filter leaves.
const NOISE_SECS: f64 = 0.03;

/// Films what `actor` has been given to do, from 0 to its present time, `rate_hz` frames a second.
pub fn film(mut actor: Actor, name: &str, rate_hz: f64) -> Clip {
    let frames = (actor.now_secs * rate_hz).round() as usize;
    sway(&mut actor);
    let rows = actor.timeline.render(frames, rate_hz);
    let joints = actor.body.skeleton().len();
    let mut rotations = vec![Quat::identity(); frames * joints];
    let mut noise = Noise::new(joints, actor.person.noise_rad, rate_hz, actor.rng.clone());
    let mut positions = Vec::with_capacity(frames);
    for (f, row) in rows.iter().enumerate() {
        let (before, rest) = rotations.split_at_mut(f * joints);
        let locals = &mut rest[..joints];
        positions.push(pose(&actor, row, &mut noise, locals));
        if f > 0 {
            let previous = &before[(f - 1) * joints..];
            for (local, last) in locals.iter_mut().zip(previous) {
                // `q` and `-q` are one rotation; of neighbours the nearer is kept, so that curves have no jumps.
                *local = same_hemisphere(last, *local);
            }
        }
    }
    Clip {
        name: name.to_owned(),
        skeleton: actor.body.skeleton().clone(),
        rate_hz,
        rotations,
        tracks: vec![JointTrack {
            joint: 0,
            positions,
        }],
        frames,
        repaired: Vec::new(),
        points: None,
    }
}

fn pose(actor: &Actor, row: &Controls, noise: &mut Noise, locals: &mut [Quat]) -> Vec3 {
    let hips = actor.body.pose(row, locals);
    for (local, error) in locals.iter_mut().zip(noise.step()) {
        *local *= error;
    }
    hips
}

/// Nobody stands still: breathing, slow sway of trunk, head and hands, tremor.
fn sway(actor: &mut Actor) {
    let size = actor.person.sway;
    if size == 0.0 {
        return;
    }
    let secs = actor.now_secs + 1.0;
    // Amplitudes of slow waves by channel: metres for the hips' place, radians, arm lengths.
    let mut slow = [0.0; CHANNELS];
    (slow[HIPS], slow[HIPS + 2]) = (0.004, 0.005);
    slow[HIPS_TURN + 1] = 0.012;
    for k in 0..3 {
        slow[SPINE + k] = 0.012;
        slow[HEAD + k] = 0.025;
        for side in LimbSide::BOTH {
            slow[HAND[side.index()] + k] = 0.01;
        }
    }
    for (channel, amplitude) in slow.iter().enumerate().filter(|(_, a)| **a > 0.0) {
        // Waves whose frequencies have no common multiple: their sum does not come back within a clip.
        for octave in [0.1, 0.24, 0.55] {
            let hz = octave * actor.rng.range(0.7, 1.4);
            let phase = actor.rng.range(0.0, std::f64::consts::TAU);
            let share = size * amplitude * actor.rng.range(0.3, 0.9);
            actor
                .timeline
                .wave(channel, -1.0, secs + 2.0, (hz, phase), share);
        }
    }
    // 12 to 19 breaths a minute.
    let breath = actor.rng.range(0.2, 0.32);
    actor
        .timeline
        .wave(SPINE, -1.0, secs + 2.0, (breath, 0.0), 0.008);
    for side in LimbSide::BOTH {
        for k in 0..3 {
            // Physiological tremor of the hand, below a millimetre.
            let hz = actor.rng.range(6.0, 10.0);
            actor.timeline.wave(
                HAND[side.index()] + k,
                -1.0,
                secs + 2.0,
                (hz, 0.0),
                0.0008 * size,
            );
        }
    }
}

/// Errors of every joint's rotation: independent, low-passed, of a given deviation at any frame rate.
struct Noise {
    keep: f64,
    add: f64,
    state: Vec<[f64; 3]>,
    rng: Rng,
}

impl Noise {
    fn new(joints: usize, deviation_rad: f64, rate_hz: f64, mut rng: Rng) -> Self {
        // A low-pass of first order. `add` keeps the deviation what it is, whatever the rate: Var = keep² Var + add².
        let keep = NOISE_SECS / (NOISE_SECS + 1.0 / rate_hz);
        let state = (0..joints)
            .map(|_| [0; 3].map(|_| deviation_rad * rng.normal()))
            .collect();
        Self {
            keep,
            add: deviation_rad * (1.0 - keep * keep).sqrt(),
            state,
            rng,
        }
    }

    fn step(&mut self) -> impl Iterator<Item = Quat> + '_ {
        let (keep, add, rng) = (self.keep, self.add, &mut self.rng);
        self.state.iter_mut().map(move |error| {
            if add == 0.0 {
                return Quat::identity();
            }
            *error = error.map(|e| keep * e + add * rng.normal());
            // A small rotation, to first order in its angle.
            Quat::new_normalize(Quaternion::new(
                1.0,
                error[0] / 2.0,
                error[1] / 2.0,
                error[2] / 2.0,
            ))
        })
    }
}
