//! Noise of positions, and spikes: single frames in which a joint is displaced.

use crate::features::KeyPose;
use crate::math::Vec3;

use super::histogram::Histogram;

/// Poses in a row that are looked at together.
const ROW: usize = 5;
/// Share of the values whose quantile is taken: below the median, because movement adds to the larger ones.
const SHARE: f32 = 0.4;
/// That quantile of χ² with three degrees of freedom.
const CHI2: f64 = 1.869;
/// Sum of the squares of the fourth difference's weights, 1 4 6 4 1.
const GAIN: f64 = 70.0;
/// The fastest that limbs are thrown about, m/s²; a frame of anything faster is no movement.
const HARDEST_MPS2: f64 = 300.0;
/// A joint must be thrown this far from where it belongs, metres.
const LEAST_SPIKE_M: f64 = 0.12;

/// Looks after which the noise is taken anew.
const RENEW: u32 = 8;

/// The last poses of an even stretch, and what their differences say.
#[derive(Debug, Clone)]
pub(super) struct NoiseEstimate {
    row: [KeyPose; ROW],
    /// Poses in the row; they are evenly apart.
    filled: usize,
    interval: f64,
    squares: Histogram,
    looked: f64,
    spikes: f64,
    /// The noise as it was some looks ago: to find it takes longer than a look.
    lately_m: f64,
    looks: u32,
}

impl NoiseEstimate {
    pub(super) fn new() -> Self {
        Self {
            row: [KeyPose::default(); ROW],
            filled: 0,
            interval: 0.0,
            squares: Histogram::default(),
            looked: 0.0,
            spikes: 0.0,
            lately_m: 0.0,
            looks: 0,
        }
    }

    /// Takes a pose `interval` seconds after the last, in `metres_per_unit`.
    ///
    /// The noise is what fourth differences leave of positions: movement of a few hertz vanishes in them, white noise of
    /// variance σ² keeps 70 σ² (Rice, Ann. Statist. 12, 1984, has differences as estimators of variance).
    pub(super) fn push(&mut self, interval: f64, pose: &KeyPose, metres_per_unit: f64) {
        let even = (interval - self.interval).abs() < 0.3 * self.interval;
        if self.filled > 1 && !even {
            self.row[0] = self.row[self.filled - 1];
            self.filled = 1;
        }
        if self.filled == ROW {
            self.row.copy_within(1.., 0);
            self.filled = ROW - 1;
        }
        self.row[self.filled] = *pose;
        self.filled += 1;
        self.interval = interval;
        if self.filled == ROW {
            self.look(metres_per_unit);
        }
    }

    fn look(&mut self, metres_per_unit: f64) {
        if self.looks.is_multiple_of(RENEW) {
            self.lately_m = self.metres().unwrap_or(0.0);
        }
        self.looks = self.looks.wrapping_add(1);
        let thrown_m = (HARDEST_MPS2 * self.interval * self.interval * 0.5)
            .max(LEAST_SPIKE_M)
            .max(7.0 * self.lately_m);
        let (mut known, mut spike) = (0, false);
        for role in self.row[0].roles() {
            let places = self.row.each_ref().map(|pose| pose.get(role));
            let [Some(a), Some(b), Some(c), Some(d), Some(e)] = places else {
                continue;
            };
            let fourth = (a + e) - 4.0 * (b + d) + 6.0 * c;
            let square = fourth.norm_squared() * metres_per_unit * metres_per_unit / GAIN;
            self.squares.add(square);
            known += 1;
            spike |= is_thrown(&[a, b, c, d, e], thrown_m / metres_per_unit);
        }
        if known > 0 {
            self.looked += 1.0;
            self.spikes += f64::from(u8::from(spike));
        }
    }

    pub(super) fn fade(&mut self, factor: f64) {
        self.squares.fade(factor as f32);
        self.looked *= factor;
        self.spikes *= factor;
    }

    /// Standard deviation of the noise on each coordinate, metres.
    pub(super) fn metres(&self) -> Option<f64> {
        let square = self
            .squares
            .quantile(SHARE)
            .filter(|_| self.looked >= 4.0)?;
        Some((square / CHI2).sqrt())
    }

    /// The noise as it was lately, 0 if it is not known yet. O(1).
    pub(super) fn lately_m(&self) -> f64 {
        self.lately_m
    }

    /// Share of the frames in which some joint is thrown aside; 0 if it was no more than one.
    pub(super) fn spike_share(&self) -> f64 {
        if self.spikes > 1.0 {
            self.spikes / self.looked
        } else {
            0.0
        }
    }
}

/// True if the middle place of five lies far from all others, which go on without it.
fn is_thrown([a, b, c, d, e]: &[Vec3; ROW], far: f64) -> bool {
    let aside = (c - 0.5 * (b + d)).norm();
    let way = (b - a).norm().max((d - b).norm()).max((e - d).norm());
    aside > far && aside > 3.0 * way
}
