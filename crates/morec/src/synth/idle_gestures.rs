//! Gestures of everyday life that belong to no class, such as scratching: what is most often mistaken for a gesture.

use super::actor::Actor;
use super::timeline::{HAND, LimbSide, SPINE, WRIST};
use super::unknown::any_side;

/// Greets somebody: a hand raised anywhere between hip and head, moved to and fro a few times, at any pace and size.
pub fn greet(a: &mut Actor) {
    let side = any_side(a);
    let (up, down, hz) = (a.secs(0.6), a.secs(0.7), a.rng.range(0.8, 2.6));
    let at = [
        a.rng.range(-0.1, 0.55),
        a.rng.range(-0.35, 0.6),
        a.rng.range(0.25, 0.6),
    ];
    let (size, secs) = (a.rng.range(0.05, 0.3), a.rng.range(0.6, 2.2));
    let axis = a.rng.below(3);
    let t = a.now_secs;
    a.hand(side, t, up, at);
    let on = t + 0.8 * up;
    a.timeline
        .wave(HAND[side.index()] + axis, on, secs, (hz, 0.0), size);
    let bend = a.rng.range(0.0, 0.4);
    a.timeline
        .wave(WRIST[side.index()], on, secs, (hz, 2.6), bend);
    a.rest_hand(side, on + secs, down);
    a.now_secs = on + secs + down;
}

/// Points somewhere with a half bent arm, for a moment or longer.
pub fn point_out(a: &mut Actor) {
    let side = any_side(a);
    let (out, hold, back) = (a.secs(0.6), a.rng.range(0.1, 1.2), a.secs(0.7));
    let at = [
        a.rng.range(-0.4, 0.7),
        a.rng.range(-0.45, 0.45),
        a.rng.range(0.3, 0.75),
    ];
    let t = a.now_secs;
    a.hand(side, t, out, at);
    a.head(t, out, [-0.2 * at[1], 0.5 * side.sign() * at[0], 0.0]);
    let turn = a.rng.range(0.0, 0.2) * side.sign();
    a.spine(t, out, [0.0, turn, 0.0]);
    let leave = t + out + hold;
    a.rest_hand(side, leave, back);
    a.head(leave, back, [0.0; 3]);
    a.spine(leave, back, [0.0; 3]);
    a.now_secs = leave + back;
}

/// Scratches or rubs: the neck, the other arm, the belly, a hip.
pub fn scratch(a: &mut Actor) {
    const WHERE: [[f64; 3]; 4] = [
        [-0.1, 0.3, -0.05],
        [-0.6, -0.2, 0.3],
        [-0.3, -0.5, 0.3],
        [0.1, -0.7, 0.0],
    ];
    let side = any_side(a);
    let (to, rub, back, hz) = (a.secs(0.7), a.rng.range(0.5, 1.8), a.secs(0.7), a.hz(3.0));
    let (at, axis, t) = (WHERE[a.rng.below(WHERE.len())], a.rng.below(3), a.now_secs);
    a.hand(side, t, to, at);
    a.timeline.wave(
        HAND[side.index()] + axis,
        t + 0.9 * to,
        rub,
        (hz, 0.0),
        0.05,
    );
    a.rest_hand(side, t + to + rub, back);
    a.now_secs = t + to + rub + back;
}

/// Stretches one arm after the other or the back, slowly.
pub fn stretch_out(a: &mut Actor) {
    let (side, up, stay, down) = (any_side(a), a.secs(1.2), a.rng.range(0.4, 1.5), a.secs(1.2));
    let at = [
        a.rng.range(-0.3, 0.8),
        a.rng.range(0.1, 0.9),
        a.rng.range(-0.2, 0.5),
    ];
    let t = a.now_secs;
    a.hand(side, t, up, at);
    let late = a.rng.range(0.3, 1.2);
    let other = [0.9 * at[0], at[1] - 0.2, at[2] + 0.1];
    a.hand(side.other(), t + late, up, other);
    let bend = a.rng.range(-0.2, 0.1);
    a.timeline.to(SPINE, t, up, bend);
    let leave = t + late + up + stay;
    for hand in LimbSide::BOTH {
        a.rest_hand(hand, leave, down);
    }
    a.timeline.to(SPINE, leave, down, 0.0);
    a.now_secs = leave + down;
}
