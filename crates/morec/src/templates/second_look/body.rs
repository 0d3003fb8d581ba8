//! Rows of the second look, computed from feature rows.
//!
//! Feature rows hold bone directions in the heading frame. With the proportions of an average body (Winter, *Biomechanics and Motor
//! Control of Human Movement*, 2009, Fig. 4.1) they place hands, elbows, feet and knees, in any performer. A row has
//! [`LOOK_COLUMNS`](super::LOOK_COLUMNS) values:
//!
//! | columns | hold |
//! |---|---|
//! | 0..24 | places: hands and elbows from the middle of the shoulders in arm lengths, feet and knees from the middle of the hips in leg lengths, in the trunk frame (left before right) |
//! | 24..48 | their velocities `v` a second, saturated: `½ v / (1 + |v| / 2)` |
//! | 48..52 | velocity of the root in the heading frame in leg lengths a second, turning in rad/s; all × 0.3 |
//! | 52..73 | texture: standard deviation over ± 10 ticks of hands, elbows, feet (18) and of the root's path (3), by axis of the heading frame |
//!
//! The trunk frame has the direction from hips to neck as its up, the line of the shoulders, made orthogonal to it, as its lateral axis.

use crate::features::{BODY_BONES, BONE_WEIGHTS, BoneSet, FeatureParams, RowLayout};
use crate::math::portable;

use super::LOOK_COLUMNS;
use super::extent::LookExtent;

/// Points that are placed: hands, elbows, feet, knees, left before right.
pub(super) const POINTS: usize = 8;
/// Hands, elbows and feet have texture.
const TEXTURED: usize = 6;
/// Points whose speed is the body's pace: root, head, elbows, hands, knees, feet.
const PACED: usize = 10;
/// Ticks on each side of the texture's window.
const TEXTURE_TICKS: i64 = 10;
/// Weight of root motion.
const ROOT_WEIGHT: f32 = 0.3;
/// Ticks that the pace's filter looks ahead, its central difference included.
pub(super) const PACE_AHEAD: i64 = 7;

/// A Gaussian of two ticks.
const PACE_WEIGHTS: [f32; 13] = [
    0.002_218_196,
    0.008_773_135,
    0.027_023_158,
    0.064_825_185,
    0.121_109_39,
    0.176_213_12,
    0.199_675_63,
    0.176_213_12,
    0.121_109_39,
    0.064_825_185,
    0.027_023_158,
    0.008_773_135,
    0.002_218_196,
];

/// Columns of the first velocity, of root motion, of the first texture, and of the root's texture.
const VELOCITY: usize = 3 * POINTS;
const ROOT: usize = 2 * VELOCITY;
const TEXTURE: usize = ROOT + 4;
const ROOT_TEXTURE: usize = TEXTURE + 3 * TEXTURED;

/// Lengths in leg lengths: of the trunk from hips to neck, from neck to head, of upper arm and forearm, of half the shoulders and half the
/// hips, of thigh and shin.
const TRUNK: f32 = 0.59;
const HEAD: f32 = 0.2;
const UPPER_ARM: f32 = 0.38;
const FOREARM: f32 = 0.30;
const HALF_SHOULDERS: f32 = 0.2;
const HALF_HIPS: f32 = 0.12;
const HALF_LEG: f32 = 0.5;
const ARM: f32 = UPPER_ARM + FOREARM;

/// Places of bones among those of the body.
const THIGHS: [usize; 2] = [0, 2];
const SHINS: [usize; 2] = [1, 3];
const TORSO: usize = 4;
const SHOULDERS: usize = 5;
const ARMS: [usize; 2] = [6, 8];
const FOREARMS: [usize; 2] = [7, 9];
const HEAD_BONE: usize = 10;

type V3 = [f32; 3];

#[derive(Debug, Clone, Copy)]
struct BodyTick {
    /// In the heading frame, from shoulders or hips, in arm or leg lengths.
    points: [V3; POINTS],
    /// The same in the trunk frame.
    places: [V3; POINTS],
    root: [f32; 4],
    /// Sine and cosine of the heading.
    heading: (f64, f64),
    /// The root's path and the paced points, in the world.
    path: [f64; 3],
    paced: [[f64; 3]; PACED],
    /// Speed of the fastest points; known one tick later.
    speed: f32,
    /// The same, smoothed; it changes until [`PACE_AHEAD`] ticks have followed.
    pace: f32,
}

impl BodyTick {
    const BLANK: Self = Self {
        points: [[0.0; 3]; POINTS],
        places: [[0.0; 3]; POINTS],
        root: [0.0; 4],
        heading: (0.0, 1.0),
        path: [0.0; 3],
        paced: [[0.0; 3]; PACED],
        speed: 0.0,
        pace: 0.0,
    };
}

/// The last ticks of a stream's body. Nothing is allocated after construction.
#[derive(Debug, Clone)]
pub struct BodyTrack {
    layout: RowLayout,
    /// Place in a row of each bone of the body, if it is there.
    slots: [Option<usize>; BODY_BONES],
    root_weight: f64,
    tick_secs: f64,
    ring: Vec<BodyTick>,
    mask: usize,
    pushed: i64,
    yaw_rad: f64,
}

impl BodyTrack {
    /// Of feature rows over `bones`, remembering at least the last `ticks`.
    pub fn new(bones: BoneSet, features: &FeatureParams, ticks: usize) -> Self {
        let capacity = (ticks + 2 * TEXTURE_TICKS as usize + 2).next_power_of_two();
        Self {
            layout: RowLayout::of(bones),
            slots: std::array::from_fn(|bone| bones.indices().position(|b| b == bone)),
            root_weight: features.root_weight,
            tick_secs: 1.0 / features.tick_hz(),
            ring: vec![BodyTick::BLANK; capacity],
            mask: capacity - 1,
            pushed: 0,
            yaw_rad: 0.0,
        }
    }

    /// A stream of which the pace alone is known.
    #[cfg(test)]
    pub(super) fn of_pace(pace: &[f32]) -> Self {
        let mut track = Self::new(BoneSet::BODY, &FeatureParams::default(), pace.len());
        for (tick, pace) in track.ring.iter_mut().zip(pace) {
            tick.pace = *pace;
        }
        track.pushed = pace.len() as i64;
        track
    }

    /// Columns of the rows that `bones` place: those of elbows and hands, knees and feet whose bones are there, and the root's.
    pub fn columns(bones: BoneSet) -> Vec<usize> {
        let has = |bone: usize| bones.contains(bone);
        let limb = |upper: [usize; 2], lower: [usize; 2], side: usize, whole: bool| {
            has(upper[side]) && (!whole || has(lower[side]))
        };
        let placed: [bool; POINTS] = std::array::from_fn(|point| match (point / 2, point % 2) {
            (0, side) => limb(ARMS, FOREARMS, side, true),
            (1, side) => limb(ARMS, FOREARMS, side, false),
            (2, side) => limb(THIGHS, SHINS, side, true),
            (_, side) => limb(THIGHS, SHINS, side, false),
        });
        let of_point = |column: usize| match column {
            0..ROOT => Some(column % VELOCITY / 3),
            TEXTURE..ROOT_TEXTURE => Some((column - TEXTURE) / 3),
            _ => None,
        };
        (0..LOOK_COLUMNS)
            .filter(|column| of_point(*column).is_none_or(|point| placed[point]))
            .collect()
    }

    /// Ticks taken.
    pub fn ticks(&self) -> i64 {
        self.pushed
    }

    /// The first tick that is remembered.
    pub fn first(&self) -> i64 {
        (self.pushed - self.ring.len() as i64).max(0)
    }

    /// Forgets the stream.
    pub fn reset(&mut self) {
        self.pushed = 0;
        self.yaw_rad = 0.0;
    }

    fn at(&self, tick: i64) -> &BodyTick {
        &self.ring[tick as usize & self.mask]
    }

    /// The tick nearest to `tick` among those that are remembered.
    fn held(&self, tick: i64) -> &BodyTick {
        self.at(tick.clamp(self.first(), self.pushed - 1))
    }

    /// Takes the next feature row. O(bones).
    pub fn push(&mut self, row: &[f32]) {
        let mut tick = self.placed(row);
        let last = (self.pushed > 0).then(|| *self.at(self.pushed - 1));
        self.move_root(&mut tick, last.as_ref());
        self.ring[self.pushed as usize & self.mask] = tick;
        self.pushed += 1;
        self.measure_pace();
    }

    /// Measures the speed of the last ticks, and the pace of those that it changes.
    fn measure_pace(&mut self) {
        let last = self.pushed - 1;
        if last >= 2 {
            let speed = self.speed_between(last - 2, last);
            let from = if last == 2 { 0 } else { last - 1 };
            for tick in from..=last {
                self.ring[tick as usize & self.mask].speed = speed;
            }
        }
        for tick in (last - PACE_AHEAD).max(self.first())..=last {
            let pace = self.smoothed_speed(tick);
            self.ring[tick as usize & self.mask].pace = pace;
        }
    }

    fn speed_between(&self, before: i64, after: i64) -> f32 {
        let (a, b) = (self.at(before), self.at(after));
        fastest(&a.paced, &b.paced, 2.0 * self.tick_secs)
    }

    /// The points of a row, without the root's motion.
    fn placed(&self, row: &[f32]) -> BodyTick {
        let bone = |bone: usize, otherwise: V3| match self.slots[bone] {
            Some(slot) => {
                let weight = BONE_WEIGHTS[bone] as f32;
                let columns = self.layout.direction(slot);
                std::array::from_fn(|axis| row[columns.start + axis] / weight)
            }
            None => otherwise,
        };
        let (up, lateral, down) = ([0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0]);
        let torso = bone(TORSO, up);
        // The bone goes from left to right, the lateral axis from right to left.
        let shoulders = scaled(bone(SHOULDERS, scaled(lateral, -1.0)), -1.0);
        let sides = [1.0f32, -1.0];
        let mut points = [[0.0; 3]; POINTS];
        let mut paced = [[0.0f64; 3]; PACED];
        let neck = scaled(torso, TRUNK);
        paced[1] = wide(plus(neck, bone(HEAD_BONE, torso), HEAD));
        for (side, sign) in sides.into_iter().enumerate() {
            let shoulder = scaled(shoulders, sign * HALF_SHOULDERS);
            let elbow = plus(shoulder, bone(ARMS[side], down), UPPER_ARM);
            let hand = plus(elbow, bone(FOREARMS[side], down), FOREARM);
            let hip = scaled(lateral, sign * HALF_HIPS);
            let knee = plus(hip, bone(THIGHS[side], down), HALF_LEG);
            let foot = plus(knee, bone(SHINS[side], down), HALF_LEG);
            let of = [
                scaled(hand, 1.0 / ARM),
                scaled(elbow, 1.0 / ARM),
                foot,
                knee,
            ];
            for (kind, place) in of.into_iter().enumerate() {
                points[2 * kind + side] = place;
            }
            let moving = [plus(elbow, neck, 1.0), plus(hand, neck, 1.0), knee, foot];
            for (kind, place) in moving.into_iter().enumerate() {
                paced[2 + 2 * kind + side] = wide(place);
            }
        }
        let frame = trunk_frame(torso, shoulders);
        let root = self.layout.root();
        let weight = self.root_weight.max(1e-6) as f32;
        BodyTick {
            places: points.map(|p| frame.map(|axis| dot3(axis, p))),
            points,
            root: std::array::from_fn(|k| row[root.start + k] / weight),
            paced,
            ..BodyTick::BLANK
        }
    }

    /// Moves the tick's body to where its root is.
    fn move_root(&mut self, tick: &mut BodyTick, last: Option<&BodyTick>) {
        let [lateral, up, forward, turning] = tick.root.map(f64::from);
        if last.is_some() {
            self.yaw_rad += turning * self.tick_secs;
        }
        let (sin, cos) = portable::sin_cos(self.yaw_rad);
        tick.heading = (sin, cos);
        let from = last.map_or([0.0; 3], |last| last.path);
        let step = world_from_heading((sin, cos), [lateral, up, forward]);
        if last.is_some() {
            tick.path = std::array::from_fn(|k| from[k] + step[k] * self.tick_secs);
        }
        for place in &mut tick.paced {
            let turned = world_from_heading((sin, cos), *place);
            *place = std::array::from_fn(|k| tick.path[k] + turned[k]);
        }
    }

    /// The body's pace at `tick`, leg lengths a second: mean speed of its three fastest points, smoothed by a Gaussian of two ticks with
    /// the ends held. It changes until seven ticks have followed.
    pub fn pace(&self, tick: i64) -> f32 {
        self.at(tick).pace
    }

    fn smoothed_speed(&self, tick: i64) -> f32 {
        let reach = (PACE_WEIGHTS.len() / 2) as i64;
        let terms = (-reach..=reach).zip(PACE_WEIGHTS);
        terms.fold(0.0, |sum, (k, weight)| {
            sum + weight * self.held(tick + k).speed
        })
    }

    /// Places of the points at `tick`, in the trunk frame.
    pub(super) fn places(&self, tick: i64) -> &[f32] {
        self.at(tick).places.as_flattened()
    }

    /// Writes row `tick` of the second look to `out`, of [`LOOK_COLUMNS`] values. O(1).
    pub fn row(&self, tick: i64, out: &mut [f32]) {
        let (first, end) = (self.first(), self.pushed - 1);
        let here = self.at(tick);
        // At the ends the velocity is that of the neighbour.
        let inside = tick.clamp(first + 1, (end - 1).max(first + 1));
        let (before, after) = (self.held(inside - 1), self.held(inside + 1));
        let per_secs = (0.5 / self.tick_secs) as f32;
        for point in 0..POINTS {
            out[3 * point..][..3].copy_from_slice(&here.places[point]);
            let v: V3 = std::array::from_fn(|k| {
                (after.places[point][k] - before.places[point][k]) * per_secs
            });
            let length = dot3(v, v).sqrt();
            let scale = 0.5 / (1.0 + length / 2.0);
            out[VELOCITY + 3 * point..][..3].copy_from_slice(&v.map(|x| x * scale));
        }
        for (out, root) in out[ROOT..TEXTURE].iter_mut().zip(here.root) {
            *out = ROOT_WEIGHT * root;
        }
        self.texture(tick, &mut out[TEXTURE..]);
    }

    fn texture(&self, tick: i64, out: &mut [f32]) {
        const WINDOW: f64 = (2 * TEXTURE_TICKS + 1) as f64;
        const COLUMNS: usize = 3 * TEXTURED;
        let here = *self.at(tick);
        let (mut sum, mut squares) = ([0.0f32; COLUMNS], [0.0f32; COLUMNS]);
        let (mut path, mut moments) = ([0.0f64; 3], [[0.0f64; 3]; 3]);
        for k in -TEXTURE_TICKS..=TEXTURE_TICKS {
            let other = self.held(tick + k);
            // About the window's middle: differences of squares of what is far from zero lose their digits.
            for point in 0..TEXTURED {
                for axis in 0..3 {
                    let value = other.points[point][axis] - here.points[point][axis];
                    sum[3 * point + axis] += value;
                    squares[3 * point + axis] += value * value;
                }
            }
            let moved: [f64; 3] = std::array::from_fn(|axis| other.path[axis] - here.path[axis]);
            for a in 0..3 {
                path[a] += moved[a];
                for b in 0..3 {
                    moments[a][b] += moved[a] * moved[b];
                }
            }
        }
        let deviation = |variance: f32| (variance.max(0.0) + 1e-6).sqrt();
        for column in 0..COLUMNS {
            let mean = sum[column] / WINDOW as f32;
            out[column] = deviation(squares[column] / WINDOW as f32 - mean * mean);
        }
        for axis in 0..3 {
            let mut unit = [0.0; 3];
            unit[axis] = 1.0;
            let along = world_from_heading(here.heading, unit);
            let mut variance = 0.0;
            for a in 0..3 {
                for b in 0..3 {
                    let covariance = moments[a][b] / WINDOW - path[a] * path[b] / (WINDOW * WINDOW);
                    variance += along[a] * covariance * along[b];
                }
            }
            out[COLUMNS + axis] = deviation(variance as f32);
        }
    }

    /// The mean pace over an extent.
    pub(super) fn mean_pace(&self, extent: LookExtent) -> f32 {
        let sum: f32 = (extent.start..extent.stop).map(|t| self.pace(t)).sum();
        sum / (extent.stop - extent.start).max(1) as f32
    }
}

/// Mean speed of the three points that moved most between two ticks.
fn fastest(a: &[[f64; 3]; PACED], b: &[[f64; 3]; PACED], secs: f64) -> f32 {
    let mut squares: [f64; PACED] = std::array::from_fn(|point| {
        let apart = (0..3).map(|k| a[point][k] - b[point][k]);
        apart.fold(0.0, |sum, d| sum + d * d)
    });
    squares.sort_unstable_by(|x, y| y.total_cmp(x));
    let sum = squares[..3]
        .iter()
        .fold(0.0, |sum, square| sum + square.sqrt());
    (sum / 3.0 / secs) as f32
}

fn world_from_heading((sin, cos): (f64, f64), v: [f64; 3]) -> [f64; 3] {
    [v[0] * cos + v[2] * sin, v[1], v[2] * cos - v[0] * sin]
}

fn scaled(v: V3, by: f32) -> V3 {
    v.map(|x| x * by)
}

fn plus(v: V3, direction: V3, length: f32) -> V3 {
    std::array::from_fn(|k| v[k] + direction[k] * length)
}

fn wide(v: V3) -> [f64; 3] {
    v.map(f64::from)
}

fn dot3(a: V3, b: V3) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn unit(v: V3) -> V3 {
    let length = dot3(v, v).sqrt().max(1e-9);
    v.map(|x| x / length)
}

/// Axes of the trunk frame: lateral, up, forward.
fn trunk_frame(torso: V3, shoulders: V3) -> [V3; 3] {
    let up = unit(torso);
    let along = dot3(shoulders, up);
    let lateral = unit(std::array::from_fn(|k| shoulders[k] - along * up[k]));
    let forward = [
        lateral[1] * up[2] - lateral[2] * up[1],
        lateral[2] * up[0] - lateral[0] * up[2],
        lateral[0] * up[1] - lateral[1] * up[0],
    ];
    [lateral, up, forward]
}
