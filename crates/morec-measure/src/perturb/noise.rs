//! Sequences of noise.

use morec::math::Vec3;
use morec::rng::Rng;

/// A vector of three independent values of deviation 1.
pub(super) fn normal3(rng: &mut Rng) -> Vec3 {
    Vec3::new(rng.normal(), rng.normal(), rng.normal())
}

/// `frames` vectors of deviation 1 that are smooth over `sigma_frames`: white noise through a Gaussian, scaled to
/// unit variance. O(frames · sigma).
pub(super) fn slow(frames: usize, sigma_frames: f64, rng: &mut Rng) -> Vec<Vec3> {
    let reach = (3.0 * sigma_frames).ceil() as usize;
    let kernel: Vec<f64> = (0..=2 * reach)
        .map(|i| (-0.5 * ((i as f64 - reach as f64) / sigma_frames.max(1e-6)).powi(2)).exp())
        .collect();
    // A sum of independent values of variance 1 has the variance of its squared weights.
    let scale = kernel.iter().map(|w| w * w).sum::<f64>().sqrt();
    let white: Vec<Vec3> = (0..frames + 2 * reach).map(|_| normal3(rng)).collect();
    let at = |frame: usize| {
        let window = &white[frame..frame + kernel.len()];
        let sum = kernel.iter().zip(window).map(|(w, v)| v * *w);
        sum.sum::<Vec3>() / scale
    };
    (0..frames).map(at).collect()
}
