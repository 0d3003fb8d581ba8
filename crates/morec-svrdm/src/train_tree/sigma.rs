//! The kernel's width from samples of one side (thesis, §3.7.3, Alg. 4).

use mocap::math::portable;

use super::gram::{Distances, SAME};
use super::params::{Sweep, TreeParams};
use super::svrm::{on_boundary, svrm};

/// Most widths in a sweep.
const MAX_WIDTHS: usize = 10_000;

impl Sweep {
    /// Says what is wrong with these values, if anything is.
    ///
    /// # Errors
    /// A sentence about the first value out of its range.
    pub fn check(self) -> Result<(), String> {
        let positive = |v: f64| v.is_finite() && v > 0.0;
        let (low, high, fine) = match self {
            Sweep::Geometric { low, high, count } | Sweep::Linear { low, high, count } => {
                (low, high, (1..=MAX_WIDTHS).contains(&count))
            }
            Sweep::Absolute { low, high, step } => {
                let fine = positive(step) && (high - low) / step < MAX_WIDTHS as f64;
                (low, high, fine)
            }
        };
        if !positive(low) || !positive(high) {
            return Err(format!(
                "a sweep of widths goes from {low} to {high}: both must be above 0"
            ));
        }
        match fine {
            true => Ok(()),
            false => Err(format!(
                "a sweep has 1 to {MAX_WIDTHS} widths, found {self:?}"
            )),
        }
    }

    /// The widths for samples whose distances are these, ascending.
    fn widths(self, distances: &[f64]) -> Vec<f64> {
        let (Some(least), Some(most)) = (distances.first(), distances.last()) else {
            return vec![];
        };
        let even = |i: usize, count: usize| i as f64 / count.saturating_sub(1).max(1) as f64;
        match self {
            Sweep::Geometric { low, high, count } => {
                let (from, ratio) = (low * least, high * most / (low * least));
                (0..count)
                    .map(|i| from * portable::powf(ratio, even(i, count)))
                    .collect()
            }
            Sweep::Linear { low, high, count } => (0..count)
                .map(|i| most * (low + (high - low) * even(i, count)))
                .collect(),
            Sweep::Absolute { low, high, step } => (0..MAX_WIDTHS)
                .map(|i| low + step * i as f64)
                // The last step may miss the end by a rounding.
                .take_while(|width| *width < high + 0.5 * step)
                .collect(),
        }
    }
}

/// Result of Algorithm 4.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// The width `σ` of the kernel.
    pub sigma: f64,
    /// The factor of `R` at which samples were on the boundary.
    pub radius_factor: f64,
    /// Membership of each sample in the boundary.
    pub boundary: Vec<bool>,
    /// Number of these that the machine of all samples has on its boundary.
    pub score: usize,
}

/// Algorithm 4, the factor of `R` shrunk as in §5.3 until the boundary is not empty. `None` for fewer than two
/// different samples, which have no width. O(m³) for each of some hundred machines.
pub fn algorithm4<V: AsRef<[f64]>>(samples: &[V], params: &TreeParams) -> Option<Estimate> {
    let distances = Distances::new(samples);
    let sorted = distances.sorted();
    let nearest = distances.mean_nearest();
    // Where every sample has a twin the nearest neighbours say nothing: the smallest distance there is, then.
    let nearest = if nearest > SAME {
        nearest
    } else {
        *sorted.first()?
    };
    let (radius_factor, boundary) = shrunk_boundary(samples, &distances, nearest, params);
    let widths = params.algorithm4.sweep.widths(&sorted);
    let mut best = (*widths.first()?, 0);
    for sigma in widths {
        let solution = svrm(distances.kernel(sigma), params);
        let found = on_boundary(&solution.alpha, &params.machine);
        let score = found
            .iter()
            .zip(&boundary)
            .filter(|(a, b)| **a && **b)
            .count();
        if score >= best.1 {
            best = (sigma, score);
        }
    }
    Some(Estimate {
        sigma: best.0,
        radius_factor,
        boundary,
        score: best.1,
    })
}

/// The estimated boundary, and the factor at which it is not empty.
fn shrunk_boundary<V: AsRef<[f64]>>(
    samples: &[V],
    distances: &Distances,
    nearest: f64,
    params: &TreeParams,
) -> (f64, Vec<bool>) {
    let mut factor = params.algorithm4.radius_factor;
    let step = params.algorithm4.radius_step.max(0.01);
    loop {
        let boundary: Vec<bool> = (0..samples.len())
            .map(|i| {
                let ball: Vec<usize> = (0..samples.len())
                    .filter(|&j| distances.between(i, j) < factor * nearest)
                    .collect();
                on_ball_boundary(samples, distances, &ball, i, params)
            })
            .collect();
        if boundary.contains(&true) {
            return (factor, boundary);
        }
        factor -= step;
        if factor <= 0.05 {
            // Every ball is empty but for its centre: then all of them are on the boundary.
            return (0.0, vec![true; samples.len()]);
        }
    }
}

/// True if sample `i` is on the boundary of the machine of the samples in its ball.
fn on_ball_boundary<V: AsRef<[f64]>>(
    samples: &[V],
    distances: &Distances,
    ball: &[usize],
    i: usize,
    params: &TreeParams,
) -> bool {
    let members: Vec<&[f64]> = ball.iter().map(|&j| samples[j].as_ref()).collect();
    let radius = mean_radius(&members);
    if radius < SAME {
        return params.algorithm4.lone_is_boundary;
    }
    let solution = svrm(distances.among(ball).kernel(radius), params);
    let at = ball.iter().position(|&j| j == i);
    at.is_some_and(|at| on_boundary(&solution.alpha, &params.machine)[at])
}

/// Mean distance of vectors from their centroid; 0 if there are none.
fn mean_radius(vectors: &[&[f64]]) -> f64 {
    let Some(first) = vectors.first() else {
        return 0.0;
    };
    let count = vectors.len() as f64;
    let mut centroid = vec![0.0; first.len()];
    for vector in vectors {
        centroid
            .iter_mut()
            .zip(*vector)
            .for_each(|(c, v)| *c += v / count);
    }
    let far = |v: &&[f64]| crate::svrdm::kernel::squared_distance(v, &centroid).sqrt();
    vectors.iter().map(far).sum::<f64>() / count
}

/// The `q`-quantile of ascending values, between neighbours in proportion; `None` if there are none.
pub fn quantile(sorted: &[f64], q: f64) -> Option<f64> {
    let at = q.clamp(0.0, 1.0) * sorted.len().checked_sub(1)? as f64;
    let (low, high) = (sorted[at.floor() as usize], sorted[at.ceil() as usize]);
    Some(low + (high - low) * at.fract())
}

/// The width for two sides: the mean of what `of` says of each (§3.7.3, end). A side of which it says nothing takes
/// the other's; where it says nothing of either, half the smallest distance between the sides; 1 where there is none.
pub fn of_sides<V: AsRef<[f64]>>(sides: [&[V]; 2], of: impl Fn(&[V]) -> Option<f64>) -> f64 {
    match (of(sides[0]), of(sides[1])) {
        (Some(a), Some(b)) => 0.5 * (a + b),
        (Some(one), None) | (None, Some(one)) => one,
        (None, None) => {
            let both: Vec<&[f64]> = sides
                .iter()
                .flat_map(|s| s.iter().map(AsRef::as_ref))
                .collect();
            Distances::new(&both)
                .sorted()
                .first()
                .map_or(1.0, |d| 0.5 * d)
        }
    }
}
