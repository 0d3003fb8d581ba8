//! The gesture classes of the demo.
//!
//! Each leaves rest, does its movement and returns. Numbers are positions of the wrist from the shoulder in arm
//! lengths: outward, up, forward.

use super::actor::Actor;
use super::timeline::{HAND, LimbSide, WRIST};

/// Waves hello with a raised hand, two or three times.
pub fn wave(a: &mut Actor) {
    let (side, raise, lower) = (a.hand, a.secs(0.6), a.secs(0.65));
    let (t, hz, cycles) = (a.now_secs, a.hz(1.7), 2.5);
    a.hand(side, t, raise, [0.42, 0.42, 0.36]);
    a.head(t, raise, [0.0, 0.0, -0.06 * side.sign()]);
    let (on, secs) = (t + 0.75 * raise, cycles / hz);
    let at = HAND[side.index()];
    a.timeline.wave(at, on, secs, (hz, 0.0), 0.24 * a.size());
    a.timeline
        .wave(at + 1, on, secs, (2.0 * hz, 1.6), 0.05 * a.size());
    a.timeline
        .wave(WRIST[side.index()], on, secs, (hz, 2.6), 0.35 * a.size());
    let back = on + secs - 0.1;
    a.rest_hand(side, back, lower);
    a.head(back, lower, [0.0; 3]);
    a.now_secs = back + lower;
}

/// Raises both hands overhead and lowers them.
pub fn raise_hands(a: &mut Actor) {
    let (up, hold, down) = (a.secs(0.8), a.secs(0.3), a.secs(0.85));
    let t = a.now_secs;
    for side in LimbSide::BOTH {
        let late = 0.03 * a.rng.unit();
        a.hand(side, t + late, up, [0.2, 1.02, 0.12]);
        a.rest_hand(side, t + up + hold + late, down);
    }
    a.head(t, up, [-0.15, 0.0, 0.0]);
    a.head(t + up + hold, down, [0.0; 3]);
    a.now_secs = t + up + hold + down + 0.03;
}

/// Points to the side with a straight arm and looks there.
pub fn point_side(a: &mut Actor) {
    let (side, out, hold, back) = (a.hand, a.secs(0.6), a.secs(0.45), a.secs(0.65));
    let t = a.now_secs;
    a.hand(side, t, out, [1.05, 0.03, 0.22]);
    a.head(t, out, [0.0, 0.6 * side.sign(), 0.0]);
    a.spine(t, out, [0.0, 0.12 * side.sign(), 0.0]);
    let leave = t + out + hold;
    a.rest_hand(side, leave, back);
    a.head(leave, back, [0.0; 3]);
    a.spine(leave, back, [0.0; 3]);
    a.now_secs = leave + back;
}

/// Three wide claps before the chest.
pub fn clap(a: &mut Actor) {
    let (up, down) = (a.secs(0.5), a.secs(0.6));
    let (t, claps) = (a.now_secs, 3);
    let (apart, together) = ([0.42, -0.08, 0.66], [-0.36, -0.08, 0.64]);
    let stroke = a.secs(0.27);
    for side in LimbSide::BOTH {
        a.hand(side, t, up, apart);
    }
    let mut at = t + 0.85 * up;
    for _ in 0..claps {
        for side in LimbSide::BOTH {
            a.hand(side, at, stroke, together);
            a.hand(side, at + stroke, stroke, apart);
        }
        at += 2.0 * stroke;
    }
    for side in LimbSide::BOTH {
        a.rest_hand(side, at - 0.1, down);
    }
    a.now_secs = at - 0.1 + down;
}

/// Pushes something away with both hands.
pub fn push(a: &mut Actor) {
    let (lift, out, hold, back) = (a.secs(0.55), a.secs(0.5), a.secs(0.2), a.secs(0.75));
    let t = a.now_secs;
    let leave = t + 0.95 * lift + out + hold;
    for side in LimbSide::BOTH {
        a.hand(side, t, lift, [-0.02, -0.12, 0.34]);
        a.hand(side, t + 0.95 * lift, out, [-0.04, -0.02, 0.97]);
        a.rest_hand(side, leave, back);
        for (start, secs, bend) in [(t, lift, -0.9), (leave, back, 0.9)] {
            let goal = a.timeline.goal(WRIST[side.index()]) + bend;
            a.timeline.to(WRIST[side.index()], start, secs, goal);
        }
    }
    a.spine(t, lift, [-0.05, 0.0, 0.0]);
    a.spine(t + 0.95 * lift, out, [0.2, 0.0, 0.0]);
    a.spine(leave, back, [0.0; 3]);
    a.now_secs = leave + back;
}

/// Draws two large circles before the body with one hand.
pub fn circle(a: &mut Actor) {
    let (side, up, down) = (a.hand, a.secs(0.55), a.secs(0.65));
    let (t, hz) = (a.now_secs, a.hz(0.95));
    let (on, secs) = (t + 0.7 * up, 2.0 / hz + 0.2);
    let (at, radius) = (HAND[side.index()], 0.33 * a.size());
    a.hand(side, t, up, [0.05, -0.05, 0.78]);
    a.timeline.wave(at, on, secs, (hz, 0.0), radius);
    a.timeline.wave(at + 1, on, secs, (hz, 1.57), radius);
    a.rest_hand(side, on + secs - 0.15, down);
    a.now_secs = on + secs - 0.15 + down;
}

/// Bows like an actor: deep from the hips, one hand before the belly, the other spread.
pub fn bow(a: &mut Actor) {
    let (side, down, hold, up) = (a.hand, a.secs(0.95), a.secs(0.35), a.secs(0.95));
    let t = a.now_secs;
    let leave = t + down + hold;
    for (start, secs, share) in [(t, down, 1.0), (leave, up, 0.0)] {
        a.hips_pitch(start, secs, 0.65 * share);
        a.hips(start, secs, [0.0, 0.0, -0.16 * share]);
        a.spine(start, secs, [0.5 * share, 0.0, 0.0]);
        a.head(start, secs, [0.2 * share, 0.0, 0.0]);
    }
    a.hand(side, t, 0.9 * down, [-0.35, -0.5, 0.34]);
    a.hand(side.other(), t, 0.9 * down, [0.75, -0.5, -0.05]);
    for hand in LimbSide::BOTH {
        a.rest_hand(hand, leave, up);
    }
    a.now_secs = leave + up;
}

/// Kicks to the front.
pub fn kick(a: &mut Actor) {
    let (side, lift, out, back) = (a.hand, a.secs(0.4), a.secs(0.34), a.secs(0.6));
    let t = a.now_secs;
    let shift = -0.1 * side.sign();
    let strike = t + 0.85 * lift;
    let leave = strike + out + 0.05;
    a.hips(t, lift, [shift, 0.0, 0.0]);
    a.hips(leave, 1.2 * back, [0.0, 0.0, 0.0]);
    a.foot(side, t + 0.1, lift, [0.0, 0.22, -0.3], 0.7);
    a.foot(side, strike, out, [0.0, 0.5 * a.size(), 0.8], 0.1);
    a.foot(side, leave, back, [0.0, 0.0, 0.0], 0.0);
    a.spine(t, lift, [0.15, 0.0, 0.0]);
    a.spine(strike, out, [-0.1, 0.0, 0.0]);
    a.spine(leave, back, [0.0; 3]);
    let other = side.other();
    a.hand(other, strike - 0.1, out, [0.35, -0.75, 0.4]);
    a.hand(side, strike - 0.1, out, [0.4, -0.8, -0.25]);
    for hand in LimbSide::BOTH {
        a.rest_hand(hand, leave, 1.1 * back);
    }
    a.now_secs = leave + 1.2 * back;
}
