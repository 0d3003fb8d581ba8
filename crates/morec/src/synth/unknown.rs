//! Motions between gestures that belong to no class.

use super::actor::Actor;
use super::gait::{self, Gait};
use super::timeline::{HAND, HIPS_TURN, LimbSide, SPINE, SWIVEL};

/// Scratches the head with either hand.
pub fn scratch_head(a: &mut Actor) {
    let (side, up, stay, down) = (any_side(a), a.secs(0.8), a.secs(1.0), a.secs(0.8));
    let t = a.now_secs;
    a.hand(side, t, up, [-0.05, 0.48, 0.1]);
    a.head(t, up, [0.1, 0.0, 0.12 * side.sign()]);
    let hz = a.hz(3.2);
    a.timeline
        .wave(HAND[side.index()] + 1, t + up, stay, (hz, 0.0), 0.03);
    a.timeline
        .wave(HAND[side.index()] + 2, t + up, stay, (hz, 1.0), 0.03);
    a.rest_hand(side, t + up + stay, down);
    a.head(t + up + stay, down, [0.0; 3]);
    a.now_secs = t + up + stay + down;
}

/// Looks to one side, then to the other.
pub fn look_around(a: &mut Actor) {
    let (turn, stay) = (a.secs(0.6), a.secs(0.5));
    let first = any_side(a).sign();
    let mut t = a.now_secs;
    for yaw in [0.8 * first, -0.75 * first, 0.0] {
        let pitch = 0.08 * a.rng.normal();
        a.head(t, turn, [pitch, yaw, 0.0]);
        a.spine(t + 0.1, turn, [0.0, 0.2 * yaw, 0.0]);
        t += turn + stay;
    }
    a.head(t - stay, turn, [0.0; 3]);
    a.now_secs = t;
}

/// Shifts the weight to one leg and back.
pub fn shift_weight(a: &mut Actor) {
    let (over, stay) = (a.secs(0.9), a.secs(1.2));
    let (t, side) = (a.now_secs, any_side(a).sign());
    a.hips(t, over, [0.09 * side, -0.01, 0.0]);
    a.spine(t, over, [0.0, 0.0, 0.1 * side]);
    a.timeline.to(HIPS_TURN + 2, t, over, -0.06 * side);
    a.hips(t + over + stay, over, [0.0; 3]);
    a.spine(t + over + stay, over, [0.0; 3]);
    a.timeline.to(HIPS_TURN + 2, t + over + stay, over, 0.0);
    a.now_secs = t + 2.0 * over + stay;
}

/// Stretches the shoulders: elbows out and back, hands before the chest.
pub fn stretch(a: &mut Actor) {
    let (up, stay, down) = (a.secs(1.0), a.secs(0.9), a.secs(1.0));
    let t = a.now_secs;
    for side in LimbSide::BOTH {
        a.hand(side, t, up, [0.15, 0.02, 0.28]);
        a.timeline.to(SWIVEL[side.index()], t, up, 0.9);
        a.rest_hand(side, t + up + stay, down);
        a.timeline
            .to(SWIVEL[side.index()], t + up + stay, down, 0.0);
        let hz = a.hz(1.1);
        a.timeline
            .wave(HAND[side.index()], t + up, stay, (hz, 0.0), 0.06);
    }
    a.spine(t, up, [-0.15, 0.0, 0.0]);
    a.spine(t + up + stay, down, [0.0; 3]);
    a.now_secs = t + up + stay + down;
}

/// Steps aside and closes the feet.
pub fn step_aside(a: &mut Actor) {
    let left = 0.4 * any_side(a).sign();
    let gait = Gait {
        forward: 0.0,
        left,
        period_secs: 0.6,
        lift: 0.06,
        arms: 0.05,
        ..Gait::WALK
    };
    gait::steps(a, gait, &[0.0]);
}

/// Answers the telephone and puts it away.
pub fn phone(a: &mut Actor) {
    let (side, up, stay, down) = (a.hand, a.secs(0.8), a.secs(2.2), a.secs(0.8));
    let t = a.now_secs;
    a.hand(side, t, up, [-0.08, 0.28, 0.16]);
    a.timeline.to(SWIVEL[side.index()], t, up, -0.6);
    a.head(t, up, [0.05, 0.0, -0.15 * side.sign()]);
    for k in 0..3 {
        let hz = a.rng.range(0.3, 0.8);
        a.timeline.wave(SPINE + k, t + up, stay, (hz, 0.0), 0.05);
    }
    a.rest_hand(side, t + up + stay, down);
    a.timeline
        .to(SWIVEL[side.index()], t + up + stay, down, 0.0);
    a.head(t + up + stay, down, [0.0; 3]);
    a.now_secs = t + up + stay + down;
}

/// Crosses the arms for a while.
pub fn cross_arms(a: &mut Actor) {
    let (fold, stay, open) = (a.secs(0.9), a.secs(1.8), a.secs(0.8));
    let (t, upper) = (a.now_secs, any_side(a));
    for side in LimbSide::BOTH {
        let over = if side == upper { 0.08 } else { -0.02 };
        a.hand(side, t, fold, [-0.38, -0.3 + over, 0.36 + over]);
        a.rest_hand(side, t + fold + stay, open);
    }
    a.now_secs = t + fold + stay + open;
}

/// Wipes the forehead.
pub fn wipe(a: &mut Actor) {
    let (side, up, across, down) = (any_side(a), a.secs(0.6), a.secs(0.5), a.secs(0.7));
    let t = a.now_secs;
    a.hand(side, t, up, [-0.35, 0.33, 0.42]);
    a.hand(side, t + 0.9 * up, across, [0.05, 0.35, 0.38]);
    a.head(t, up, [0.15, 0.0, 0.0]);
    a.head(t + up + across, down, [0.0; 3]);
    a.rest_hand(side, t + 0.9 * up + across, down);
    a.now_secs = t + up + across + down;
}

/// Puts the hands on the hips for a while.
pub fn hands_on_hips(a: &mut Actor) {
    let (up, stay, down) = (a.secs(0.7), a.secs(1.4), a.secs(0.7));
    let t = a.now_secs;
    for side in LimbSide::BOTH {
        a.hand(side, t, up, [0.12, -0.66, 0.1]);
        a.timeline.to(SWIVEL[side.index()], t, up, 0.9);
        a.rest_hand(side, t + up + stay, down);
        a.timeline
            .to(SWIVEL[side.index()], t + up + stay, down, 0.0);
    }
    a.now_secs = t + up + stay + down;
}

/// Looks at a wristwatch.
pub fn look_at_watch(a: &mut Actor) {
    let (side, up, stay, down) = (a.hand.other(), a.secs(0.6), a.secs(0.8), a.secs(0.6));
    let t = a.now_secs;
    a.hand(side, t, up, [-0.28, -0.22, 0.48]);
    a.head(t, up, [0.35, 0.2 * side.sign(), 0.0]);
    a.rest_hand(side, t + up + stay, down);
    a.head(t + up + stay, down, [0.0; 3]);
    a.now_secs = t + up + stay + down;
}

pub fn any_side(a: &mut Actor) -> LimbSide {
    LimbSide::BOTH[a.rng.below(2)]
}
