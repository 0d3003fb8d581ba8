//! An actor: a synthetic person with a timeline, and the vocabulary in which motions are written.

use super::body::SyntheticBody;
use super::person::Person;
use super::timeline::{
    CHANNELS, Controls, FOOT, HAND, HEAD, HIPS, HIPS_TURN, LimbSide, PoseTimeline, SPINE,
};
use crate::rng::Rng;

/// Schedules a motion from the actor's present time on.
pub(super) type Perform = fn(&mut Actor);

/// A person on stage. Motions are scheduled from [`Actor::now_secs`] on and move it forward.
#[derive(Debug, Clone)]
pub struct Actor {
    /// Habits and proportions.
    pub person: Person,
    /// Lengths of the person's body.
    pub body: SyntheticBody,
    /// Chance, for what varies from one performance to the next.
    pub rng: Rng,
    /// Angles over time, as scheduled so far.
    pub timeline: PoseTimeline,
    /// When the next motion starts.
    pub now_secs: f64,
    /// The hand that waves now.
    pub hand: LimbSide,
    pace: f64,
    size: f64,
    rest_hands: [[f64; 3]; 2],
    /// Position of the actor, x and z.
    place: [f64; 2],
    heading_rad: f64,
}

impl Actor {
    /// `person` at rest, somewhere near the origin, facing about +Z.
    pub fn new(person: &Person, mut rng: Rng) -> Self {
        let body = SyntheticBody::of(person);
        let place = [0.2 * rng.normal(), 0.2 * rng.normal()];
        let heading_rad = 0.12 * rng.normal();
        let rest_hands = LimbSide::BOTH.map(|_| person.rest_hand.map(|v| v + 0.015 * rng.normal()));
        let mut first: Controls = [0.0; CHANNELS];
        (first[HIPS], first[HIPS + 2]) = (place[0], place[1]);
        first[HIPS_TURN + 1] = heading_rad;
        first[SPINE + 2] = person.lean_rad;
        first[HEAD + 2] = -person.lean_rad;
        for side in LimbSide::BOTH {
            first[HAND[side.index()]..HAND[side.index()] + 3]
                .copy_from_slice(&rest_hands[side.index()]);
        }
        let mut actor = Self {
            person: person.clone(),
            body,
            rng,
            timeline: PoseTimeline::new(&first),
            now_secs: 0.0,
            hand: person.hand,
            pace: 1.0,
            size: 1.0,
            rest_hands,
            place,
            heading_rad,
        };
        for side in LimbSide::BOTH {
            let [x, z] = actor.stance(side);
            let at = FOOT[side.index()];
            (first[at], first[at + 2]) = (x, z);
            first[at + 3] = heading_rad + 0.12 * side.sign();
        }
        actor.timeline = PoseTimeline::new(&first);
        actor
    }

    /// Draws the speed and size of the next performance.
    pub fn vary(&mut self) {
        self.pace = (1.0 + 0.1 * self.rng.normal()).clamp(0.78, 1.28);
        self.size = (1.0 + 0.06 * self.rng.normal()).clamp(0.85, 1.12);
    }

    /// `secs` as long as this person takes for it now, never twice the same.
    pub fn secs(&mut self, secs: f64) -> f64 {
        secs / (self.person.tempo * self.pace) * (1.0 + 0.05 * self.rng.normal())
    }

    /// `hz` as fast as this person does it now.
    pub fn hz(&mut self, hz: f64) -> f64 {
        hz * self.person.tempo * self.pace * (1.0 + 0.03 * self.rng.normal())
    }

    /// Scale of this person's movements now; 1 is average.
    pub fn size(&self) -> f64 {
        self.person.amplitude * self.size
    }

    /// Lets time pass.
    pub fn wait(&mut self, secs: f64) {
        self.now_secs += secs;
    }

    /// Moves a hand to `target` (outward, up, forward from the shoulder, in arm lengths), around the shoulder
    /// where the straight way would pass too close to it.
    pub fn hand(&mut self, side: LimbSide, start_secs: f64, secs: f64, target: [f64; 3]) {
        let rest = self.rest_hands[side.index()];
        let mut to = [0.0; 3];
        for k in 0..3 {
            to[k] = rest[k]
                + (target[k] - rest[k]) * (0.35 + 0.65 * self.size())
                + 0.02 * self.rng.normal();
        }
        self.hand_exact(side, start_secs, secs, to);
    }

    /// Moves a hand back to where it hangs.
    pub fn rest_hand(&mut self, side: LimbSide, start_secs: f64, secs: f64) {
        let rest = self.rest_hands[side.index()].map(|v| v + 0.012 * self.rng.normal());
        self.hand_exact(side, start_secs, secs, rest);
    }

    fn hand_exact(&mut self, side: LimbSide, start_secs: f64, secs: f64, mut to: [f64; 3]) {
        let length = (to[0] * to[0] + to[1] * to[1] + to[2] * to[2]).sqrt();
        if length > 1.0 {
            to = to.map(|v| v / length);
        }
        let at = HAND[side.index()];
        let from = [0, 1, 2].map(|k| self.timeline.goal(at + k));
        let detour = detour(from, to);
        for k in 0..3 {
            self.timeline.to(at + k, start_secs, secs, to[k]);
            if detour[k] != 0.0 {
                self.timeline.pulse(at + k, start_secs, secs, detour[k]);
            }
        }
    }

    /// Bends the trunk to `[pitch, yaw, roll]`, radians over the habit.
    pub fn spine(&mut self, start_secs: f64, secs: f64, target: [f64; 3]) {
        let habit = [0.0, 0.0, self.person.lean_rad];
        for k in 0..3 {
            self.timeline.to(
                SPINE + k,
                start_secs,
                secs,
                habit[k] + target[k] * self.size(),
            );
        }
    }

    /// Turns the head to `[pitch, yaw, roll]`, radians over the habit.
    pub fn head(&mut self, start_secs: f64, secs: f64, target: [f64; 3]) {
        let habit = [0.0, 0.0, -self.person.lean_rad];
        for k in 0..3 {
            self.timeline
                .to(HEAD + k, start_secs, secs, habit[k] + target[k]);
        }
    }

    /// Positive pitch leans forward.
    pub fn hips_pitch(&mut self, start_secs: f64, secs: f64, pitch_rad: f64) {
        self.timeline
            .to(HIPS_TURN, start_secs, secs, pitch_rad * self.size());
    }

    /// Moves the hips to `left`, `up`, `forward` of where they are at rest, in leg lengths.
    pub fn hips(&mut self, start_secs: f64, secs: f64, [left, up, forward]: [f64; 3]) {
        let [x, z] = self.point(left * self.body.leg_m(), forward * self.body.leg_m());
        self.timeline.to(HIPS, start_secs, secs, x);
        self.timeline.to(HIPS + 1, start_secs, secs, up);
        self.timeline.to(HIPS + 2, start_secs, secs, z);
    }

    /// Moves a foot to `out`, `up`, `forward` of where it stands at rest, in leg lengths, toes down by `pitch_rad`.
    pub fn foot(
        &mut self,
        side: LimbSide,
        start_secs: f64,
        secs: f64,
        target: [f64; 3],
        pitch_rad: f64,
    ) {
        let leg = self.body.leg_m();
        let at = FOOT[side.index()];
        let base = self.stance_m() * side.sign();
        let [x, z] = self.point(base + target[0] * leg * side.sign(), target[2] * leg);
        self.timeline.to(at, start_secs, secs, x);
        self.timeline.to(at + 1, start_secs, secs, target[1] * leg);
        self.timeline.to(at + 2, start_secs, secs, z);
        self.timeline.to(at + 4, start_secs, secs, pitch_rad);
    }

    /// Moves the place of rest: `forward` and `left` in metres, turning by `turn_rad` first. Moves no joint.
    pub fn advance(&mut self, forward: f64, left: f64, turn_rad: f64) {
        self.heading_rad += turn_rad;
        self.place = self.point(left, forward);
    }

    /// Direction that the actor faces at rest, radians from +Z towards +X.
    pub fn heading_rad(&self) -> f64 {
        self.heading_rad
    }

    /// Position of a foot at rest, x and z in the world.
    pub fn stance(&self, side: LimbSide) -> [f64; 2] {
        self.point(self.stance_m() * side.sign(), 0.0)
    }

    /// The point `left` and `forward` metres from the place of rest, x and z in the world.
    pub fn point(&self, left: f64, forward: f64) -> [f64; 2] {
        let (sin, cos) = super::smooth::sin_cos(self.heading_rad);
        [
            self.place[0] + left * cos + forward * sin,
            self.place[1] - left * sin + forward * cos,
        ]
    }

    fn stance_m(&self) -> f64 {
        self.body.hip_m() * self.person.stance
    }
}

/// The farthest a hand has to leave the straight way from `from` to `to` so as not to pass through the shoulder.
fn detour(from: [f64; 3], to: [f64; 3]) -> [f64; 3] {
    const CLEARANCE: f64 = 0.6;
    let way = [0, 1, 2].map(|k| to[k] - from[k]);
    let length2 = dot(way, way);
    if length2 < 0.05 {
        return [0.0; 3];
    }
    let u = (-dot(from, way) / length2).clamp(0.0, 1.0);
    let nearest = [0, 1, 2].map(|k| from[k] + u * way[k]);
    let gap = CLEARANCE - dot(nearest, nearest).sqrt();
    // A way that ends near the shoulder needs no detour.
    let middle = 4.0 * u * (1.0 - u);
    if gap <= 0.0 || middle <= 0.0 {
        return [0.0; 3];
    }
    let out = [nearest[0] + 0.25, nearest[1], nearest[2] + 0.5];
    let norm = dot(out, out).sqrt().max(1e-6);
    out.map(|v| v / norm * gap * middle)
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
