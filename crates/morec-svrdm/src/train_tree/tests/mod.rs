//! Optima against slow and outside solutions, and the whole against the prototype.

mod optima;
mod reference;
mod trees;

use mocap::rng::Rng;

/// `count` vectors of `dim` values around a centre, by chance.
fn cloud(rng: &mut Rng, count: usize, centre: &[f64], spread: f64) -> Vec<Vec<f64>> {
    (0..count)
        .map(|_| centre.iter().map(|c| c + spread * rng.normal()).collect())
        .collect()
}
