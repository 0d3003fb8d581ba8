//! Quadratic programs over a box: what every support vector machine of the thesis comes down to.

use nalgebra::{Cholesky, DMatrix, DVector};

/// Minimise `½ αᵀQα − τᵀα` over `0 ≤ αᵢ ≤ C` (Eqs. 3.31 and 3.36, as corrected: they say maximise).
///
/// `Q` is symmetric and positive semidefinite with a positive diagonal.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct BoxQp {
    /// `Q`, `m × m`: `yᵢyⱼKᵢⱼ`.
    pub matrix: DMatrix<f64>,
    /// `τ`, `m` values.
    pub linear: DVector<f64>,
    /// `C`.
    pub upper: f64,
}

/// Solver of the machines' programs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Solver {
    /// An active set method: the optimum to rounding.
    #[default]
    ActiveSet,
    /// Successive over-relaxation: Algorithm 3, as printed but for the corrections of Eq. 3.32.
    Sor,
}

/// When to stop.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Stop {
    /// When the residual is at most this; of [`Solver::Sor`], when no coordinate moves by more in a pass (the
    /// threshold of Algorithm 3, which the thesis does not print).
    pub residual: f64,
    /// After this many passes over all coordinates (steps of the active set method, beside 20 a coordinate), however
    /// good.
    pub passes: usize,
}

impl Default for Stop {
    /// Outputs of a machine are about 1: eight digits of them.
    fn default() -> Self {
        Self {
            residual: 1e-8,
            passes: 1000,
        }
    }
}

/// A solution and how good it is.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Solution {
    /// The weights `α`, one for each sample.
    pub alpha: DVector<f64>,
    /// By how much the Karush-Kuhn-Tucker conditions are missed at most.
    pub residual: f64,
    /// Passes over all coordinates; of [`BoxQp::solve`], one and the steps of the active set method.
    pub passes: usize,
}

impl BoxQp {
    /// `½ αᵀQα − τᵀα`.
    #[cfg(test)]
    pub fn objective(&self, alpha: &DVector<f64>) -> f64 {
        0.5 * (&self.matrix * alpha).dot(alpha) - self.linear.dot(alpha)
    }

    /// The gradient `Qα − τ`.
    pub fn gradient(&self, alpha: &DVector<f64>) -> DVector<f64> {
        &self.matrix * alpha - &self.linear
    }

    /// By how much `α` misses the Karush-Kuhn-Tucker conditions at most: the gradient must be 0 where
    /// `0 < αᵢ < C`, not negative where `αᵢ = 0`, not positive where `αᵢ = C`. In units of a machine's output.
    pub fn residual(&self, alpha: &DVector<f64>) -> f64 {
        self.worst(alpha, &self.gradient(alpha))
    }

    fn worst(&self, alpha: &DVector<f64>, gradient: &DVector<f64>) -> f64 {
        alpha
            .iter()
            .zip(gradient)
            .map(|(a, g)| self.missed(*a, *g))
            .fold(0.0, f64::max)
    }

    fn missed(&self, alpha: f64, gradient: f64) -> f64 {
        if alpha <= 0.0 {
            (-gradient).max(0.0)
        } else if alpha >= self.upper {
            gradient.max(0.0)
        } else {
            gradient.abs()
        }
    }

    /// Distance of coordinate `i` to its optimum, all others fixed.
    fn step(&self, i: usize, alpha: &DVector<f64>, gradient: &DVector<f64>) -> f64 {
        (alpha[i] - gradient[i] / self.matrix[(i, i)]).clamp(0.0, self.upper) - alpha[i]
    }

    fn take(&self, i: usize, step: f64, alpha: &mut DVector<f64>, gradient: &mut DVector<f64>) {
        alpha[i] = (alpha[i] + step).clamp(0.0, self.upper);
        gradient.axpy(step, &self.matrix.column(i), 1.0);
    }

    /// The solution by the solver asked for.
    pub fn solved_by(&self, solver: Solver, stop: Stop) -> Solution {
        match solver {
            Solver::ActiveSet => self.solve(stop),
            Solver::Sor => self.sor(stop),
        }
    }

    /// Algorithm 3 as corrected: coordinates in turn, each to its best place (Eq. 3.32 with `yᵢyⱼKᵢⱼ`), until none
    /// moves by more than the threshold. A pass is O(m²); the number of passes grows without bound as the kernel
    /// widens, and small steps then say little about how near the solution is: the residual does.
    pub fn sor(&self, stop: Stop) -> Solution {
        let m = self.linear.len();
        let mut alpha = DVector::zeros(m);
        let mut gradient = -self.linear.clone();
        let mut passes = 0;
        let mut moved = f64::INFINITY;
        while passes < stop.passes && moved > stop.residual {
            moved = 0.0;
            for i in 0..m {
                let step = self.step(i, &alpha, &gradient);
                moved = moved.max(step.abs());
                if step != 0.0 {
                    self.take(i, step, &mut alpha, &mut gradient);
                }
            }
            passes += 1;
        }
        Solution {
            residual: self.residual(&alpha),
            alpha,
            passes,
        }
    }

    /// The same solution sooner: `m` times the coordinate that gains most, then the active set method (Nocedal and
    /// Wright, *Numerical Optimization*, 2006, §16.5), which is what makes wide kernels quick: coordinates inside the
    /// box go to their joint optimum or to the first bound on the way, and those at a bound that would gain are
    /// released one by one. Each step is O(f³ + m f) for `f` coordinates inside; some ten steps are usual.
    pub fn solve(&self, stop: Stop) -> Solution {
        let m = self.linear.len();
        let mut alpha = DVector::zeros(m);
        let mut gradient = -self.linear.clone();
        for _ in 0..m {
            let Some((i, step)) = self.best_step(&alpha, &gradient) else {
                break;
            };
            self.take(i, step, &mut alpha, &mut gradient);
        }
        let mut steps = 0;
        loop {
            // Afresh, as sums of many steps lose digits.
            gradient = self.gradient(&alpha);
            if self.worst(&alpha, &gradient) <= stop.residual || steps >= 20 * m + stop.passes {
                break;
            }
            if self.settle(&mut alpha, &gradient) {
                gradient = self.gradient(&alpha);
                let Some((i, step)) = self.best_step(&alpha, &gradient) else {
                    break;
                };
                self.take(i, step, &mut alpha, &mut gradient);
            }
            steps += 1;
        }
        Solution {
            residual: self.residual(&alpha),
            alpha,
            passes: 1 + steps,
        }
    }

    /// The coordinate step that lowers the objective most; `None` where none does.
    fn best_step(&self, alpha: &DVector<f64>, gradient: &DVector<f64>) -> Option<(usize, f64)> {
        let (mut best, mut most) = (None, 0.0);
        for i in 0..alpha.len() {
            let step = self.step(i, alpha, gradient);
            let gain = -step * (gradient[i] + 0.5 * self.matrix[(i, i)] * step);
            if gain > most {
                (best, most) = (Some((i, step)), gain);
            }
        }
        best
    }

    /// Takes the coordinates inside the box to their joint optimum, or as far on the way as the box allows; says
    /// whether they got there.
    fn settle(&self, alpha: &mut DVector<f64>, gradient: &DVector<f64>) -> bool {
        let inside: Vec<usize> = (0..alpha.len())
            .filter(|&i| alpha[i] > 0.0 && alpha[i] < self.upper)
            .collect();
        let right = DVector::from_iterator(inside.len(), inside.iter().map(|&i| -gradient[i]));
        let Some(factor) = self.factor(&inside) else {
            return true;
        };
        let direction = factor.solve(&right);
        if direction.iter().any(|d| !d.is_finite()) {
            return true;
        }
        let room = |i: usize, d: f64| match d {
            0.0 => f64::INFINITY,
            d if d > 0.0 => (self.upper - alpha[i]) / d,
            d => alpha[i] / -d,
        };
        let rooms: Vec<f64> = inside
            .iter()
            .zip(&direction)
            .map(|(&i, d)| room(i, *d))
            .collect();
        let share = rooms.iter().copied().fold(1.0, f64::min);
        for ((&i, d), room) in inside.iter().zip(&direction).zip(rooms) {
            let bound = if *d > 0.0 { self.upper } else { 0.0 };
            // Who reaches a bound is there exactly, whatever rounding says.
            alpha[i] = if room <= share {
                bound
            } else {
                (alpha[i] + share * d).clamp(0.0, self.upper)
            };
        }
        share >= 1.0
    }

    /// Wide kernels are singular to rounding: as much is added to the diagonal as makes the factor exist.
    fn factor(&self, free: &[usize]) -> Option<Cholesky<f64, nalgebra::Dyn>> {
        let part = DMatrix::from_fn(free.len(), free.len(), |i, j| {
            self.matrix[(free[i], free[j])]
        });
        [0.0, 1e-13, 1e-11, 1e-9].into_iter().find_map(|ridge| {
            let mut ridged = part.clone();
            for i in 0..free.len() {
                ridged[(i, i)] *= 1.0 + ridge;
            }
            Cholesky::new(ridged)
        })
    }
}
