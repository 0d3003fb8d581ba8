//! Smoothing and velocities of a stream, frame by frame, with the edges mirrored.

use std::ops::Range;

use nalgebra::Vector4;

use mocap::math::{Vec3, portable};

use crate::layout::RowLayout;
use crate::noise::{Filter, NOISE_GAINS, NoiseMeter, PROBE, WIDEST_FRAMES, filters};
use crate::observe::{Observation, heading_from_world};
use crate::params::FeatureParams;
use crate::{BONE_WEIGHTS, BoneSet};

/// A frame as the filters want it.
#[derive(Debug, Clone, Copy)]
struct FilterInput {
    root: Vec3,
    yaw_rad: f64,
    /// Of the yaw: each frame is asked for it as often as the filter is wide.
    sin_cos: (f64, f64),
    unit_length: f64,
}

impl FilterInput {
    fn of(observation: &Observation) -> Self {
        let Observation {
            root,
            yaw_rad,
            unit_length,
            ..
        } = *observation;
        Self {
            root,
            yaw_rad,
            sin_cos: portable::sin_cos(yaw_rad),
            unit_length,
        }
    }
}

/// Keeps as many frames as the filters reach over and makes feature rows of them.
///
/// Edges follow the convention of mirrored signals, `d c b a | a b c d | d c b a`: at the start from the first
/// frame on, at the end only when [`finish`](Smoother::finish) says that no more will come.
#[derive(Debug, Clone)]
pub struct Smoother {
    bones: BoneSet,
    params: FeatureParams,
    /// For each step of the noise meter.
    kernels: Vec<Kernels>,
    /// Filter by which noise is measured.
    probe: Vec<f64>,
    noise: NoiseMeter,
    ring: Vec<FilterInput>,
    /// Bones of the same frames, from the first of the set to the last.
    directions: Vec<Vec3>,
    span: Range<usize>,
    pushed: usize,
    next_row_frame: usize,
    /// No more frames come: rows need not wait for them.
    ended: bool,
    row: Vec<f32>,
    /// Smoothed directions around the frame of a row: before it, at it and behind it.
    smoothed: [Vec<Vec3>; 3],
}

/// The filters of directions and of root motion, from their centres outwards.
#[derive(Debug, Clone)]
struct Kernels {
    directions: Vec<f64>,
    root: Vec<f64>,
    /// Frames that must follow a frame: the half width and one more for the central difference.
    look_ahead: usize,
}

impl Kernels {
    fn new(directions: Filter, root: Filter) -> Self {
        Self {
            directions: half_gaussian(directions.sigma_frames, directions.cut_frames),
            root: half_gaussian(root.sigma_frames, root.cut_frames),
            look_ahead: directions.cut_frames.max(root.cut_frames) + 1,
        }
    }

    /// One pair for each step of the noise meter.
    fn all(params: &FeatureParams) -> Vec<Self> {
        let directions = filters(Filter {
            sigma_frames: params.smooth_sigma_frames,
            cut_frames: params.smooth_cut_frames,
        });
        let root = filters(Filter {
            sigma_frames: params.root_sigma_frames,
            cut_frames: params.root_cut_frames,
        });
        let pairs = directions.into_iter().zip(root);
        pairs.map(|(d, r)| Self::new(d, r)).collect()
    }
}

/// Weights of a sampled Gaussian from its centre outwards, `cut + 1` values, the whole normalised to 1.
fn half_gaussian(sigma: f64, cut: usize) -> Vec<f64> {
    let raw: Vec<f64> = (0..=cut)
        .map(|i| portable::exp(-0.5 * (i as f64 / sigma).powi(2)))
        .collect();
    let sum = raw[0] + 2.0 * raw[1..].iter().sum::<f64>();
    raw.iter().map(|w| w / sum).collect()
}

impl Smoother {
    /// Allocates everything that will be needed.
    pub fn new(bones: BoneSet, params: &FeatureParams) -> Self {
        let widest = params.look_ahead_frames().max(WIDEST_FRAMES + 1);
        let reach = 2 * (widest + 1) + params.frames_per_tick;
        let empty = Observation::blank(BoneSet::NONE);
        let frames = reach.next_power_of_two();
        Self {
            bones,
            kernels: Kernels::all(params),
            probe: half_gaussian(PROBE.sigma_frames, PROBE.cut_frames),
            noise: NoiseMeter::default(),
            ring: vec![FilterInput::of(&empty); frames],
            directions: vec![Vec3::zeros(); frames * bones.span().len()],
            span: bones.span(),
            pushed: 0,
            next_row_frame: params.frames_per_tick - 1,
            ended: false,
            row: vec![0.0; RowLayout::of(bones).dim()],
            smoothed: std::array::from_fn(|_| vec![Vec3::zeros(); bones.span().len()]),
            params: params.clone(),
        }
    }

    /// Forgets the stream so far.
    pub fn reset(&mut self) {
        self.pushed = 0;
        self.ended = false;
        self.noise.reset();
        self.next_row_frame = self.params.frames_per_tick - 1;
    }

    /// Noise of the last second or so: see [`FeatureStream::noise`](crate::FeatureStream::noise).
    pub fn noise(&self) -> Option<f64> {
        self.noise.level()
    }

    /// See [`FeatureStream::noise_gain`](crate::FeatureStream::noise_gain).
    pub fn noise_gain(&self) -> f32 {
        NOISE_GAINS[self.noise.step()]
    }

    /// Takes the next frame; rows that are now complete come from [`next_row`](Self::next_row): one, or a few where a
    /// stream has become less noisy and its filter shorter.
    pub fn push(&mut self, observation: &Observation) {
        let mask = self.ring.len() - 1;
        let at = self.pushed & mask;
        self.ring[at] = FilterInput::of(observation);
        let width = self.span.len();
        self.directions[at * width..][..width].copy_from_slice(&observation.directions);
        self.pushed += 1;
        if self.params.follow_noise && self.pushed.is_multiple_of(self.params.frames_per_tick) {
            self.measure_noise();
        }
    }

    /// True if [`next_row`](Self::next_row) gives a row.
    pub fn has_row(&self) -> bool {
        let ahead = match self.ended {
            true => 0,
            false => self.kernels[self.noise.step()].look_ahead,
        };
        self.next_row_frame + ahead < self.pushed
    }

    /// Measures the noise that the filter removes at the last frame whose neighbours are known.
    fn measure_noise(&mut self) {
        if self.pushed <= 2 * PROBE.cut_frames {
            return;
        }
        let frame = (self.pushed - 1 - PROBE.cut_frames) as isize;
        let mut smoothed = std::mem::take(&mut self.smoothed);
        let smooth = &mut smoothed[0];
        self.smooth_directions(frame, &self.probe, smooth);
        let (here, first) = (self.directions_at(frame), self.span.start);
        let residual = |bone: usize| (here[bone - first] - smooth[bone - first]).norm_squared();
        let sum: f64 = self.bones.indices().map(residual).sum();
        self.smoothed = smoothed;
        self.noise.take(sum / self.bones.len().max(1) as f64);
    }

    /// Ends the stream: rows that were still waiting for frames come from [`next_row`](Self::next_row), until
    /// [`reset`](Self::reset).
    pub fn end(&mut self) {
        self.ended = true;
    }

    /// The next complete row.
    pub fn next_row(&mut self) -> Option<&[f32]> {
        if !self.has_row() {
            return None;
        }
        let frame = self.next_row_frame as isize;
        let mut row = std::mem::take(&mut self.row);
        let layout = RowLayout::of(self.bones);
        let rate = self.params.rate_hz;
        // np.gradient's convention: central inside, one-sided at an edge.
        let (before, after) = (
            (frame - 1).max(0),
            (frame + 1).min(self.pushed as isize - 1),
        );
        let per_secs = rate / ((after - before).max(1) as f64);
        let kernels = &self.kernels[self.noise.step()];
        let mut smoothed = std::mem::take(&mut self.smoothed);
        for (frame, smoothed) in [before, frame, after].into_iter().zip(&mut smoothed) {
            self.smooth_directions(frame, &kernels.directions, smoothed);
        }
        let [then, here, soon] = &smoothed;
        for (slot, bone) in self.bones.indices().enumerate() {
            let weight = BONE_WEIGHTS[bone];
            let at = bone - self.span.start;
            let position = here[at] * weight;
            let velocity = (soon[at] - then[at]) * (weight * per_secs);
            let saturated = velocity / (1.0 + velocity.norm() / self.params.velocity_saturation);
            for (out, value) in row[layout.direction(slot)].iter_mut().zip(&position) {
                *out = *value as f32;
            }
            for (out, value) in row[layout.velocity(slot)].iter_mut().zip(&saturated) {
                *out = (value * self.params.velocity_weight) as f32;
            }
        }
        let root = self.root_motion(frame, &kernels.root);
        for (out, value) in row[layout.root()].iter_mut().zip(&root) {
            *out = (value * self.params.root_weight) as f32;
        }
        (self.row, self.smoothed) = (row, smoothed);
        self.next_row_frame += self.params.frames_per_tick;
        Some(&self.row)
    }

    /// The frame that a possibly mirrored index stands for.
    fn mirrored(&self, index: isize) -> isize {
        let (mut i, n) = (index, self.pushed as isize);
        while !(0..n).contains(&i) {
            i = if i < 0 { -1 - i } else { 2 * n - 1 - i };
        }
        i
    }

    fn place(&self, index: isize) -> usize {
        self.mirrored(index) as usize & (self.ring.len() - 1)
    }

    fn at(&self, index: isize) -> &FilterInput {
        &self.ring[self.place(index)]
    }

    fn directions_at(&self, index: isize) -> &[Vec3] {
        let width = self.span.len();
        &self.directions[self.place(index) * width..][..width]
    }

    /// Directions of the bones of the span, as many as `sums`, smoothed with `kernel`.
    fn smooth_directions(&self, frame: isize, kernel: &[f64], sums: &mut [Vec3]) {
        for (sum, direction) in sums.iter_mut().zip(self.directions_at(frame)) {
            *sum = direction * kernel[0];
        }
        for (k, weight) in kernel.iter().enumerate().skip(1) {
            let a = self.directions_at(frame - k as isize);
            let b = self.directions_at(frame + k as isize);
            for ((sum, a), b) in sums.iter_mut().zip(a).zip(b) {
                *sum += (a + b) * *weight;
            }
        }
    }

    /// Velocity in the heading frame in the performer's unit of length a second (lateral, up, forward) and yaw rate, smoothed.
    fn root_motion(&self, frame: isize, kernel: &[f64]) -> Vector4<f64> {
        let raw = |k: isize| self.raw_root_motion(self.mirrored(frame + k));
        let outwards = kernel.iter().enumerate().skip(1);
        outwards.fold(raw(0) * kernel[0], |sum, (k, weight)| {
            sum + (raw(-(k as isize)) + raw(k as isize)) * *weight
        })
    }

    fn raw_root_motion(&self, frame: isize) -> Vector4<f64> {
        let (before, after) = (
            (frame - 1).max(0),
            (frame + 1).min(self.pushed as isize - 1),
        );
        let per_secs = self.params.rate_hz / ((after - before).max(1) as f64);
        let (a, b, here) = (self.at(before), self.at(after), self.at(frame));
        let (sin, cos) = here.sin_cos;
        let velocity = heading_from_world(
            sin,
            cos,
            &((b.root - a.root) * (per_secs / here.unit_length)),
        );
        velocity.push((b.yaw_rad - a.yaw_rad) * per_secs)
    }
}
