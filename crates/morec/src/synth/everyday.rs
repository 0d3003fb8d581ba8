//! Everyday motion, at which a recogniser must not report anything.
//!
//! Broad and random on purpose: walking, reaching and gesticulating of all sizes and speeds. None of it is one
//! of the demo's gesture classes, and what people choose as signals is left out: both arms raised alike, one arm
//! held out by a standing body. A class that lay within the library would be refused together with it.

use rayon::prelude::*;

use super::actor::Actor;
use super::actor::Perform;
use super::film::film;
use super::gait::{self, Gait};
use super::idle_gestures;
use super::person::Person;
use super::timeline::{FOOT, HAND, HEAD, HIPS_TURN, LimbSide, SPINE, SWIVEL, WRIST};
use super::unknown::{self, any_side};
use crate::clip::Clip;
use crate::rng::Rng;

/// People in the library.
const PEOPLE: usize = 4;
/// Length of each clip, at least.
const CLIP_SECS: f64 = 10.0;
/// Length of the clips of gesticulating and flailing: arms are the most various, and the most often indexed.
const ARMS_SECS: f64 = 36.0;
/// Frame rate of the library.
const RATE_HZ: f64 = 60.0;

/// Motions of the library, each by every person.
pub const CONTENTS: [(&str, Perform); 16] = [
    ("stand", stand),
    ("walk", walk),
    ("run", run),
    ("jog_on_the_spot", jog_on_the_spot),
    ("sit_down", sit_down),
    ("reach", reach),
    ("pick_up", pick_up),
    ("exercise", exercise),
    ("jump", jump),
    ("football", football),
    ("throw", throw),
    ("turn_round", turn_round),
    ("talk", talk),
    ("flail", flail),
    ("swing_arms", swing_arms),
    ("applaud", applaud),
];

/// Gestures of the library, each by every person.
const GESTURES: [(&str, Perform); 4] = [
    ("greet", idle_gestures::greet),
    ("indicate", idle_gestures::point_out),
    ("scratch", idle_gestures::scratch),
    ("stretch", idle_gestures::stretch_out),
];

/// The library: clips of everyday motion by several people at 60 Hz, about 17 minutes in all. Each is named
/// `everyday_<content>_<person>`. The same seed gives the same clips on every platform.
pub fn everyday(seed: u64) -> Vec<Clip> {
    clips(seed, &CONTENTS, 0)
}

/// Gestures of everyday life by the same people, about 6 minutes: greeting, pointing, scratching, stretching.
pub fn everyday_gestures(seed: u64) -> Vec<Clip> {
    clips(seed, &GESTURES, PEOPLE * CONTENTS.len())
}

/// Each of `contents` by every person; the draws of the clips are numbered from `first`.
fn clips(seed: u64, contents: &[(&str, Perform)], first: usize) -> Vec<Clip> {
    let people: Vec<Person> = (0..PEOPLE)
        .map(|number| Person::draw(seed ^ 0xe7e7, number))
        .collect();
    // Each clip draws from numbers of its own: it does not matter which thread makes it.
    let clip = |at: usize| {
        let person = &people[at / contents.len()];
        let (content, perform) = contents[at % contents.len()];
        let mut actor = Actor::new(person, Rng::for_part(seed, (first + at) as u64));
        actor.wait(0.4);
        let secs = match content {
            "talk" | "flail" | "greet" | "indicate" => ARMS_SECS,
            _ => CLIP_SECS,
        };
        while actor.now_secs < secs {
            actor.vary();
            perform(&mut actor);
            let pause = actor.rng.range(0.1, 0.8);
            actor.wait(pause);
        }
        let name = format!("everyday_{content}_{}", person.name);
        film(actor, &name, RATE_HZ)
    };
    let clips = 0..PEOPLE * contents.len();
    clips.into_par_iter().map(clip).collect()
}

/// Stands about: shifting weight, looking, small movements of the hands.
pub fn stand(a: &mut Actor) {
    match a.rng.below(5) {
        0 => unknown::shift_weight(a),
        1 => unknown::look_around(a),
        2 => unknown::hands_on_hips(a),
        3 => fold_hands(a),
        _ => a.wait(1.5),
    }
}

fn fold_hands(a: &mut Actor) {
    let (up, stay, down) = (a.secs(0.8), a.secs(1.5), a.secs(0.8));
    let (t, behind) = (a.now_secs, a.rng.chance(0.4));
    let hold = if behind {
        [-0.2, -0.8, -0.3]
    } else {
        [-0.3, -0.72, 0.36]
    };
    for side in LimbSide::BOTH {
        a.hand(side, t, up, hold);
        a.rest_hand(side, t + up + stay, down);
    }
    a.now_secs = t + up + stay + down;
}

/// Walks some steps, straight or along a curve, at any pace.
pub fn walk(a: &mut Actor) {
    let count = 4 + a.rng.below(6);
    let curve = a.rng.range(-0.25, 0.25);
    let turns: Vec<f64> = (0..count).map(|_| curve + 0.06 * a.rng.normal()).collect();
    let pace = a.rng.range(0.75, 1.3);
    let gait = Gait {
        period_secs: Gait::WALK.period_secs / pace,
        forward: Gait::WALK.forward * a.rng.range(0.7, 1.15),
        arms: a.rng.range(0.08, 0.4),
        ..Gait::WALK
    };
    gait::steps(a, gait, &turns);
}

/// Runs some steps.
pub fn run(a: &mut Actor) {
    let count = 6 + a.rng.below(6);
    let curve = a.rng.range(-0.15, 0.15);
    let gait = Gait {
        forward: a.rng.range(0.8, 1.3),
        arms: a.rng.range(0.2, 0.4),
        ..Gait::RUN
    };
    let t = a.now_secs;
    a.spine(t, 0.6, [0.18, 0.0, 0.0]);
    gait::steps(a, gait, &vec![curve; count]);
    a.spine(a.now_secs - 0.8, 0.7, [0.0; 3]);
}

/// Jogs on the spot.
pub fn jog_on_the_spot(a: &mut Actor) {
    let count = 8 + 2 * a.rng.below(6);
    let gait = Gait {
        forward: 0.0,
        lift: a.rng.range(0.15, 0.4),
        arms: a.rng.range(0.1, 0.35),
        bounce: 0.04,
        ..Gait::RUN
    };
    gait::steps(a, gait, &vec![0.0; count]);
}

/// Sits down, stays, perhaps talks, and gets up.
pub fn sit_down(a: &mut Actor) {
    let (depth, stay) = (a.rng.range(0.38, 0.5), a.rng.range(0.8, 2.5));
    gait::sit(a, depth, stay);
}

/// Reaches for something high, low, to the side or across: a foot goes ahead, the trunk leans after the hand, the
/// other hand holds on. (An arm just held out from a standing body is a signal, and no background.)
pub fn reach(a: &mut Actor) {
    let (side, out, hold, back) = (any_side(a), a.secs(0.9), a.rng.range(0.0, 0.4), a.secs(0.9));
    let t = a.now_secs;
    let target = direction(a, 0.6, 0.9);
    let outward = side.sign() * target[0];
    a.hand(side, t + 0.1, out, target);
    let near = [
        a.rng.range(-0.2, 0.3),
        a.rng.range(-0.6, -0.3),
        a.rng.range(0.2, 0.5),
    ];
    a.hand(side.other(), t, out, near);
    let (ahead, low) = (a.rng.range(0.12, 0.4), (-target[1]).max(0.0));
    a.foot(
        side,
        t,
        0.7 * out,
        [0.2 * target[0].max(0.0), 0.0, ahead],
        0.0,
    );
    let foot = FOOT[side.index()];
    a.timeline.pulse(foot + 1, t, 0.7 * out, 0.06);
    a.hips(t, out, [0.15 * outward, -0.04 - 0.25 * low, 0.5 * ahead]);
    a.spine(
        t,
        out,
        [
            0.15 + 0.5 * low,
            -0.3 * side.sign() + 0.4 * outward,
            -0.2 * outward,
        ],
    );
    a.head(t, 0.6 * out, [-0.4 * target[1], 0.5 * outward, 0.0]);
    let leave = t + out + hold;
    a.foot(side, leave + 0.2 * back, 0.7 * back, [0.0; 3], 0.0);
    a.timeline
        .pulse(foot + 1, leave + 0.2 * back, 0.7 * back, 0.06);
    a.hips(leave, back, [0.0; 3]);
    for hand in LimbSide::BOTH {
        a.rest_hand(hand, leave, back);
    }
    a.spine(leave, back, [0.0; 3]);
    a.head(leave, back, [0.0; 3]);
    a.now_secs = leave + back;
}

/// Picks something up from the floor: knees bent, one hand down, up again.
pub fn pick_up(a: &mut Actor) {
    let (side, down, up) = (any_side(a), a.secs(1.1), a.secs(1.1));
    let (t, deep) = (a.now_secs, a.rng.range(0.3, 0.5));
    a.hips(t, down, [0.0, -deep, -0.3]);
    a.hips_pitch(t, down, 0.7);
    a.spine(t, down, [0.75, 0.1 * side.sign(), 0.0]);
    a.head(t, down, [0.1, 0.0, 0.0]);
    a.hand(side, t + 0.1, down, [-0.1, -0.55, 0.75]);
    a.hand(side.other(), t + 0.1, down, [0.1, -0.75, 0.45]);
    let leave = t + 1.15 * down;
    a.hips(leave, up, [0.0; 3]);
    a.hips_pitch(leave, up, 0.0);
    a.spine(leave, up, [0.0; 3]);
    a.head(leave, up, [0.0; 3]);
    // What was picked up is carried before the body for a moment.
    let keep = a.secs(0.8);
    a.hand(side, leave, up, [-0.05, -0.45, 0.5]);
    a.rest_hand(side.other(), leave, up);
    a.rest_hand(side, leave + up + keep, 0.8);
    a.now_secs = leave + up + keep + 0.8;
}

/// Loosens up: one arm over the head and a bend to the side, twists with bent arms, one arm circling.
pub fn exercise(a: &mut Actor) {
    let (t, secs, hz) = (a.now_secs, a.rng.range(3.0, 5.0), a.rng.range(0.35, 0.7));
    let (side, up, down, kind) = (any_side(a), a.secs(0.8), a.secs(0.9), a.rng.below(3));
    let on = t + 0.9 * up;
    let (first, second) = match kind {
        0 => ([-0.35, 0.75, 0.1], [0.12, -0.66, 0.1]),
        1 => ([-0.1, -0.25, 0.45], [-0.1, -0.4, 0.4]),
        _ => ([0.4, -0.1, 0.35], [0.12, -0.66, 0.1]),
    };
    a.hand(side, t, up, first);
    a.hand(side.other(), t, up, second);
    match kind {
        0 => a.timeline.wave(SPINE + 2, on, secs, (hz, 0.0), 0.35),
        1 => a.timeline.wave(SPINE + 1, on, secs, (hz, 0.0), 0.6),
        _ => {
            let (at, phase) = (HAND[side.index()], a.rng.range(0.0, 6.0));
            a.timeline.wave(at + 1, on, secs, (hz * 2.0, phase), 0.55);
            a.timeline
                .wave(at + 2, on, secs, (hz * 2.0, phase + 1.57), 0.4);
            a.timeline
                .wave(SPINE + 1, on, secs, (hz * 2.0, phase), 0.15);
        }
    }
    for hand in LimbSide::BOTH {
        a.rest_hand(hand, on + secs, down);
    }
    a.now_secs = on + secs + down;
}

/// Jumps up or forward.
pub fn jump(a: &mut Actor) {
    let (height, arms) = (a.rng.range(0.12, 0.4), a.rng.range(0.0, 1.2));
    let forward = if a.rng.chance(0.4) {
        a.rng.range(0.3, 0.9)
    } else {
        0.0
    };
    gait::jump(a, height, forward, arms);
}

/// Runs up to a ball and strikes it low with either foot, running on.
pub fn football(a: &mut Actor) {
    let side = any_side(a);
    gait::steps(
        a,
        Gait {
            forward: 0.8,
            ..Gait::RUN
        },
        &[0.0, 0.0, 0.0],
    );
    let (swing, through) = (a.secs(0.3), a.secs(0.28));
    let t = a.now_secs;
    let (aside, high) = (a.rng.range(-0.15, 0.1), a.rng.range(0.08, 0.2));
    a.hips(t, swing, [-0.08 * side.sign(), -0.05, 0.1]);
    a.foot(side, t, swing, [0.08, 0.2, -0.4], 0.8);
    a.foot(side, t + 0.9 * swing, through, [aside, high, 0.45], 0.3);
    let away = direction(a, 0.7, 0.9);
    a.hand(side.other(), t, swing + through, away);
    a.spine(t, swing, [0.2, 0.3 * side.sign(), 0.0]);
    a.spine(t + swing, through, [0.1, -0.3 * side.sign(), 0.0]);
    let back = t + swing + through;
    a.foot(side, back, 0.5, [0.0; 3], 0.0);
    a.hips(back, 0.6, [0.0; 3]);
    a.spine(back, 0.6, [0.0; 3]);
    a.rest_hand(side.other(), back, 0.7);
    a.now_secs = back + 0.7;
}

/// Throws: over the shoulder, sidearm or from below.
pub fn throw(a: &mut Actor) {
    let (side, wind, fling, back) = (any_side(a), a.secs(0.6), a.secs(0.32), a.secs(0.8));
    let t = a.now_secs;
    let (from, to) = match a.rng.below(3) {
        0 => ([0.45, 0.45, -0.3], [-0.1, 0.25, 0.92]),
        1 => ([0.75, -0.2, -0.45], [-0.3, -0.1, 0.85]),
        _ => ([0.15, -0.8, -0.5], [0.0, 0.1, 0.9]),
    };
    let twist = 0.5 * side.sign();
    a.hand(side, t, wind, from);
    a.hand(side.other(), t, wind, [0.1, -0.4, 0.6]);
    a.spine(t, wind, [-0.08, -twist, 0.0]);
    a.hand(side, t + wind, fling, to);
    a.spine(t + 0.9 * wind, fling, [0.25, twist, 0.0]);
    let leave = t + wind + fling + 0.1;
    for hand in LimbSide::BOTH {
        a.rest_hand(hand, leave, back);
    }
    a.spine(leave, back, [0.0; 3]);
    a.now_secs = leave + back;
}

/// Turns on the spot by some steps.
pub fn turn_round(a: &mut Actor) {
    let count = 2 + a.rng.below(4);
    let each = any_side(a).sign() * a.rng.range(0.35, 0.8);
    let gait = Gait {
        forward: 0.05,
        lift: 0.07,
        arms: 0.06,
        period_secs: 0.5,
        ..Gait::WALK
    };
    gait::steps(a, gait, &vec![each; count]);
}

/// Gesticulates while talking: one hand wanders before the body, with beats and pauses; the other hangs, holds on
/// or joins in now and then on a way of its own. The weight is on one leg.
pub fn talk(a: &mut Actor) {
    let stop = a.now_secs + a.rng.range(3.0, 6.0);
    let (size, side) = (a.rng.range(0.4, 1.0), any_side(a));
    let (joins, aside) = (
        a.rng.range(0.0, 0.35),
        a.rng.range(0.0, 0.08) * any_side(a).sign(),
    );
    a.hips(a.now_secs, 0.8, [aside, -0.01, 0.0]);
    if a.rng.chance(0.6) {
        let hold = if a.rng.chance(0.5) {
            [0.12, -0.66, 0.1]
        } else {
            [-0.3, -0.6, 0.36]
        };
        a.hand(side.other(), a.now_secs, 0.9, hold);
    }
    while a.now_secs < stop {
        let (t, secs) = (a.now_secs, a.rng.range(0.3, 0.9));
        for (hand, share) in [(side, 0.8), (side.other(), joins)] {
            if a.rng.chance(share) {
                let (mut to, late) = (direction(a, 0.4, 0.85), a.rng.range(0.0, 0.3));
                to[1] = to[1].min(0.1);
                let centre = [0.1, -0.4, 0.5];
                a.hand(
                    hand,
                    t + late,
                    secs,
                    [0, 1, 2].map(|k| centre[k] + size * (to[k] - centre[k])),
                );
                let bend = a.rng.range(-0.5, 0.5);
                a.timeline.to(WRIST[hand.index()], t, secs, bend);
            }
        }
        let nod = [0.1, 0.25, 0.06].map(|v| v * a.rng.normal());
        a.head(t, secs, nod);
        let turn = [0.04, 0.12, 0.05].map(|v| v * a.rng.normal());
        a.spine(t, 1.3 * secs, turn);
        a.now_secs += secs * a.rng.range(0.6, 1.5);
    }
    finish(a);
}

/// Random smooth movement of arms, legs and trunk at all sizes and speeds: whatever a body can do standing.
pub fn flail(a: &mut Actor) {
    let stop = a.now_secs + a.rng.range(3.0, 6.0);
    while a.now_secs < stop {
        let (t, secs) = (a.now_secs, a.rng.range(0.42, 1.4));
        for side in LimbSide::BOTH {
            // Each arm on its own: arms raised alike are what signals are made of.
            let own = direction(a, 0.45, 1.0);
            if a.rng.chance(0.8) {
                let late = a.rng.range(0.0, 0.3);
                a.hand(side, t + late, secs, own);
                let turn = a.rng.range(-0.4, 0.6);
                a.timeline.to(SWIVEL[side.index()], t, secs, turn);
            }
        }
        let bend = [0.25, 0.3, 0.15].map(|v| v * a.rng.normal());
        a.spine(t, 1.3 * secs, bend);
        let look = [0.2, 0.35, 0.1].map(|v| v * a.rng.normal());
        a.head(t, secs, look);
        if a.rng.chance(0.3) {
            lift_foot(a, t, secs);
        }
        a.now_secs += secs * a.rng.range(0.7, 1.2);
    }
    finish(a);
}

/// Lifts one foot anywhere near and puts it down again, while the hips go over the other.
fn lift_foot(a: &mut Actor, t: f64, secs: f64) {
    let side = any_side(a);
    let at = [
        a.rng.range(-0.05, 0.35),
        a.rng.range(0.06, 0.35),
        a.rng.range(-0.4, 0.5),
    ];
    let half = secs.max(0.5) / 2.0;
    a.hips(t, half, [-0.09 * side.sign(), -0.03, 0.0]);
    let leg = a.body.leg_m();
    let (from, to) = (
        a.stance(side),
        a.point((at[0] * leg) * side.sign(), at[2] * leg),
    );
    let foot = FOOT[side.index()];
    // Up and back by the same way: the foot stands where it stood.
    a.timeline.pulse(foot, t, 2.0 * half, to[0] - from[0]);
    a.timeline.pulse(foot + 1, t, 2.0 * half, at[1] * leg);
    a.timeline.pulse(foot + 2, t, 2.0 * half, to[1] - from[1]);
    a.hips(t + half, half, [0.0; 3]);
}

/// Swings the arms to and fro, together or in turn, knees giving.
pub fn swing_arms(a: &mut Actor) {
    let (t, secs, hz) = (a.now_secs, a.rng.range(2.5, 4.5), a.hz(0.8));
    let (reach, across) = (a.rng.range(0.3, 0.8), a.rng.chance(0.35));
    let opposed = a.rng.chance(0.5);
    for side in LimbSide::BOTH {
        let phase = if opposed && side == LimbSide::Left {
            std::f64::consts::PI
        } else {
            0.0
        };
        let axis = if across { 0 } else { 2 };
        a.timeline.wave(
            HAND[side.index()] + axis,
            t,
            secs,
            (hz, phase),
            reach * a.size(),
        );
        a.timeline
            .wave(HAND[side.index()] + 1, t, secs, (2.0 * hz, 1.57), 0.08);
    }
    a.timeline.wave(
        SPINE + 1,
        t,
        secs,
        (hz, 0.0),
        if opposed { 0.2 } else { 0.02 },
    );
    a.timeline.wave(HIPS_TURN, t, secs, (hz, 0.6), 0.05);
    a.now_secs = t + secs;
}

/// Applauds: one hand held low before the belly, the other striking it from the side, small and quick.
pub fn applaud(a: &mut Actor) {
    let (up, secs, hz) = (a.secs(0.6), a.rng.range(1.5, 3.5), a.hz(3.4));
    let (t, high, side) = (a.now_secs, a.rng.range(-0.62, -0.5), any_side(a));
    let on = t + 0.8 * up;
    a.hand(side.other(), t, up, [-0.3, high, 0.34]);
    a.hand(side, t + 0.1, up, [-0.25, high + 0.2, 0.46]);
    a.timeline
        .wave(HAND[side.index()], on, secs, (hz, 0.0), 0.05);
    a.timeline.wave(HEAD, t, secs, (0.5 * hz, 0.0), 0.03);
    for hand in LimbSide::BOTH {
        a.rest_hand(hand, on + secs, 0.7);
    }
    a.now_secs = on + secs + 0.7;
}

/// Everything back to rest.
fn finish(a: &mut Actor) {
    let (t, secs) = (a.now_secs, a.secs(0.9));
    for side in LimbSide::BOTH {
        a.rest_hand(side, t, secs);
        a.timeline.to(WRIST[side.index()], t, secs, 0.0);
        a.timeline.to(SWIVEL[side.index()], t, secs, 0.0);
    }
    a.spine(t, secs, [0.0; 3]);
    a.head(t, secs, [0.0; 3]);
    a.hips(t, secs, [0.0; 3]);
    a.now_secs = t + secs;
}

/// A point a hand can reach: a direction evenly drawn from all but straight behind, `near` to `far` away.
fn direction(a: &mut Actor, near: f64, far: f64) -> [f64; 3] {
    loop {
        let v = [
            a.rng.range(-1.0, 1.0),
            a.rng.range(-1.0, 1.0),
            a.rng.range(-1.0, 1.0),
        ];
        let norm = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
        let unit = v.map(|x| x / norm.max(1e-6));
        // Hands cross the body's middle only in front, and go behind it only so far.
        let crosses = unit[0] < -0.2 && unit[2] < 0.35;
        if (0.2..=1.0).contains(&norm) && unit[0] > -0.65 && unit[2] > -0.5 && !crosses {
            let length = a.rng.range(near, far);
            return unit.map(|x| x * length);
        }
    }
}
