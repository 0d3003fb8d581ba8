//! Motions of the whole body: stepping, walking, running, jumping, sitting down.

use super::actor::Actor;
use super::timeline::{FOOT, HAND, HIPS, HIPS_TURN, LimbSide, SPINE};

/// How somebody steps.
#[derive(Debug, Clone, Copy)]
pub struct Gait {
    /// Seconds from one step to the next.
    pub period_secs: f64,
    /// Length of a step forward, leg lengths.
    pub forward: f64,
    /// Length of a step to the left, leg lengths.
    pub left: f64,
    /// Time in the air of each foot, in periods: below 1 walking, above running.
    pub swing: f64,
    /// Height of the foot in the air, leg lengths.
    pub lift: f64,
    /// Swing of the hands, arm lengths.
    pub arms: f64,
    /// Rise of the hips between steps, leg lengths.
    pub bounce: f64,
}

impl Gait {
    /// Walking at an average pace.
    pub const WALK: Gait = Gait {
        period_secs: 0.52,
        forward: 0.75,
        left: 0.0,
        swing: 0.82,
        lift: 0.1,
        arms: 0.26,
        bounce: 0.0,
    };
    /// Running at an average pace.
    pub const RUN: Gait = Gait {
        period_secs: 0.36,
        forward: 1.1,
        left: 0.0,
        swing: 1.4,
        lift: 0.34,
        arms: 0.32,
        bounce: 0.06,
    };
}

/// Takes one step for each entry of `turns_rad` (turning by it), then closes the feet.
pub fn steps(a: &mut Actor, gait: Gait, turns_rad: &[f64]) {
    let gait = Gait {
        period_secs: a.secs(gait.period_secs),
        ..gait
    };
    // Sideways, the leading foot steps first; otherwise it is chance.
    let first = match gait.left {
        l if l > 0.0 => LimbSide::Left,
        l if l < 0.0 => LimbSide::Right,
        _ => LimbSide::BOTH[a.rng.below(2)],
    };
    let mut side = first;
    for &turn_rad in turns_rad {
        step(a, &gait, side, turn_rad, 1.0);
        a.now_secs += gait.period_secs;
        side = side.other();
    }
    // The last step brings the second foot beside the first.
    step(a, &gait, side, 0.0, 0.0);
    a.now_secs += gait.period_secs * (1.0 + gait.swing.max(1.0));
    let close = a.now_secs - gait.period_secs;
    for side in LimbSide::BOTH {
        a.rest_hand(side, close - gait.period_secs * 0.3, gait.period_secs * 1.6);
    }
    a.timeline.to(HIPS_TURN + 2, close, gait.period_secs, 0.0);
    a.timeline.to(SPINE + 1, close, gait.period_secs, 0.0);
    a.now_secs += gait.period_secs * 0.4;
}

fn step(a: &mut Actor, gait: &Gait, side: LimbSide, turn_rad: f64, share: f64) {
    let (t, period) = (a.now_secs, gait.period_secs);
    let leg = a.body.leg_m();
    let (forward, left) = (gait.forward * share * leg, gait.left * share * leg);
    a.advance(forward, left, turn_rad);
    let heading = a.heading_rad();
    let [x, z] = a.point(0.0, 0.0);
    a.timeline.to(HIPS, t, 2.0 * period, x);
    a.timeline.to(HIPS + 2, t, 2.0 * period, z);
    a.timeline.to(HIPS_TURN + 1, t, 2.0 * period, heading);
    if gait.bounce > 0.0 {
        a.timeline
            .pulse(HIPS + 1, t - 0.2 * period, 0.9 * period, gait.bounce);
    }
    swing_foot(a, gait, side, share);
    swing_arms(a, gait, side, share);
}

/// The foot lands where the hips will be in the middle of its stance.
fn swing_foot(a: &mut Actor, gait: &Gait, side: LimbSide, share: f64) {
    let (t, period) = (a.now_secs, gait.period_secs);
    let (secs, at) = (gait.swing * period, FOOT[side.index()]);
    let leg = a.body.leg_m();
    let lead = (gait.swing / 2.0 - 0.5) * gait.forward * share * leg;
    let base = a.body.hip_m()
        * a.person.stance
        * (1.0 - 0.3 * gait.forward.min(1.0) * share)
        * side.sign();
    let [x, z] = a.point(base, lead);
    a.timeline.to(at, t, secs, x);
    a.timeline.to(at + 2, t, secs, z);
    a.timeline
        .to(at + 3, t, secs, a.heading_rad() + 0.1 * side.sign());
    let lift = (gait.lift * leg * (0.4 + 0.6 * share)).max(0.02);
    // The heel comes up first, the toes last.
    a.timeline.to(at + 1, t, 0.5 * secs, lift);
    a.timeline.to(at + 1, t + 0.4 * secs, 0.6 * secs, 0.0);
    let push_rad = (0.35 + 0.4 * gait.lift) * (0.3 + 0.7 * share);
    a.timeline.to(
        at + 4,
        t - 0.35 * period,
        0.35 * period + 0.35 * secs,
        push_rad,
    );
    a.timeline.to(
        at + 4,
        t + 0.3 * secs,
        0.6 * secs,
        -0.18 * share * gait.forward.min(1.0),
    );
    a.timeline.to(at + 4, t + 0.9 * secs, 0.3 * period, 0.0);
}

/// Each arm swings with the other leg; the trunk turns against the hips.
fn swing_arms(a: &mut Actor, gait: &Gait, side: LimbSide, share: f64) {
    let (t, period) = (a.now_secs, gait.period_secs);
    let reach = gait.arms * a.size() * share;
    let bent = gait.swing > 1.0;
    for arm in LimbSide::BOTH {
        let swing = if arm == side { -reach } else { reach };
        let [out, up, ahead] = if bent {
            [0.1, -0.42, 0.2]
        } else {
            a.person.rest_hand
        };
        let at = HAND[arm.index()];
        let up = up
            + if bent {
                0.3 * swing.max(0.0)
            } else {
                0.12 * reach
            };
        for (k, value) in [out - 0.1 * swing.max(0.0), up, ahead + swing]
            .into_iter()
            .enumerate()
        {
            a.timeline.to(at + k, t, 1.3 * period, value);
        }
    }
    let twist = 0.12 * share * gait.forward.min(1.0) * side.sign();
    a.timeline.to(SPINE + 1, t, 1.3 * period, twist * 1.4);
    a.timeline
        .to(HIPS_TURN + 2, t, 1.2 * period, -0.03 * share * side.sign());
}

/// Jumps on the spot or forward, `height` in leg lengths, hands thrown up by `arms`.
pub fn jump(a: &mut Actor, height: f64, forward: f64, arms: f64) {
    let (down, flight, land) = (a.secs(0.45), 0.36 + 0.5 * height, a.secs(0.5));
    let t = a.now_secs;
    let crouch = -0.16 - 0.15 * height;
    a.hips(t, down, [0.0, crouch, -0.06]);
    a.spine(t, down, [0.45, 0.0, 0.0]);
    for side in LimbSide::BOTH {
        a.hand(side, t, down, [0.2, -0.8, -0.3]);
    }
    let up = t + 0.85 * down;
    a.advance(forward * a.body.leg_m(), 0.0, 0.0);
    a.hips(up, flight * 0.75, [0.0, height, 0.0]);
    a.spine(up, flight * 0.7, [-0.05, 0.0, 0.0]);
    for side in LimbSide::BOTH {
        a.hand(side, up, flight, [0.25, -0.5 + arms, 0.6 - 0.3 * arms]);
        a.foot(
            side,
            up + 0.25 * flight,
            flight * 0.5,
            [0.0, height, 0.0],
            0.55,
        );
        a.foot(side, up + 0.75 * flight, flight * 0.5, [0.0, 0.0, 0.0], 0.0);
        a.rest_hand(side, up + flight, land + 0.2);
    }
    a.hips(up + 0.75 * flight, flight * 0.8, [0.0, -0.14, -0.03]);
    a.spine(up + 0.8 * flight, flight * 0.7, [0.3, 0.0, 0.0]);
    a.hips(up + 1.4 * flight, land, [0.0, 0.0, 0.0]);
    a.spine(up + 1.4 * flight, land, [0.0, 0.0, 0.0]);
    a.now_secs = up + 1.4 * flight + land;
}

/// Sits down on something `depth` leg lengths below standing hips, stays, gets up.
pub fn sit(a: &mut Actor, depth: f64, stay_secs: f64) {
    let (down, up) = (a.secs(1.3), a.secs(1.2));
    let t = a.now_secs;
    let seat = [0.0, -depth, -0.5];
    a.hips(t + 0.1 * down, down, seat);
    a.spine(t, 0.7 * down, [0.6, 0.0, 0.0]);
    a.spine(t + 0.65 * down, 0.6 * down, [0.05, 0.0, 0.0]);
    for side in LimbSide::BOTH {
        a.hand(side, t + 0.2 * down, 0.9 * down, [0.0, -0.6, 0.55]);
    }
    let leave = t + 1.25 * down + stay_secs;
    a.spine(leave, 0.6 * up, [0.65, 0.0, 0.0]);
    a.spine(leave + 0.5 * up, 0.7 * up, [0.0, 0.0, 0.0]);
    a.hips(leave + 0.2 * up, up, [0.0, 0.0, 0.0]);
    for side in LimbSide::BOTH {
        a.rest_hand(side, leave + 0.4 * up, 0.9 * up);
    }
    a.now_secs = leave + 1.3 * up;
}
