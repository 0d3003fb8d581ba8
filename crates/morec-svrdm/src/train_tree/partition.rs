//! Classes in two macro-classes that lie apart (thesis, Alg. 6).

use nalgebra::{DMatrix, DVector};

use crate::svrdm::kernel::Gaussian;
use mocap::rng::Rng;

use super::gram::Distances;
use super::params::{PartitionParams, TreeParams};
use super::svrm::svrm;

/// A split of classes into two.
#[derive(Debug, Clone, PartialEq)]
pub struct Split {
    /// For each class, 0 or 1; class 0 is on side 0, and neither side is empty.
    pub sides: Vec<usize>,
    /// Squared distances of all `h_j` from the centroid of their side, summed: what is made small.
    pub scatter: f64,
}

/// Products `h_iᵀh_j` of the functions of each class's machine (Eq. 3.44). O(all samples² · n).
pub(crate) fn function_products<V: AsRef<[f64]>>(
    classes: &[Vec<V>],
    sigma: f64,
    params: &TreeParams,
) -> DMatrix<f64> {
    let kernel = Gaussian::new(sigma);
    let alphas: Vec<DVector<f64>> = classes
        .iter()
        .map(|class| svrm(Distances::new(class).kernel(sigma), params).alpha)
        .collect();
    let product = |i: usize, j: usize| -> f64 {
        let pairs = classes[i]
            .iter()
            .zip(&alphas[i])
            .flat_map(|x| classes[j].iter().zip(&alphas[j]).map(move |y| (x, y)));
        pairs
            .map(|((x, a), (y, b))| a * b * kernel.of(x.as_ref(), y.as_ref()))
            .sum()
    };
    let n = classes.len();
    let mut products = DMatrix::zeros(n, n);
    for i in 0..n {
        for j in 0..=i {
            products[(i, j)] = product(i, j);
            products[(j, i)] = products[(i, j)];
        }
    }
    products
}

/// The split of at least two classes with the least scatter: of all for few classes, else of those that clustering
/// reaches (Alg. 6) from seeded random splits. `products` are those of [`function_products`].
pub(crate) fn partition(products: &DMatrix<f64>, params: &PartitionParams) -> Split {
    let products = if params.unit_length {
        to_unit_length(products)
    } else {
        products.clone()
    };
    let n = products.nrows();
    let splits: Vec<Vec<usize>> = if n <= params.exact_up_to.clamp(2, 20) {
        // Class 0 stays on side 0: the mirrored splits say the same.
        (1..1usize << (n - 1))
            .map(|bits| (0..n).map(|i| (bits << 1) >> i & 1).collect())
            .collect()
    } else {
        let restart = |r| cluster(&products, &mut Rng::for_part(params.seed, r as u64));
        (0..params.restarts.max(1)).map(restart).collect()
    };
    let rated = splits.into_iter().map(|sides| Split {
        scatter: scatter(&products, &sides),
        sides,
    });
    // Strictly better by more than rounding: of equals the first, on every platform.
    let best = rated.reduce(|best, next| {
        if next.scatter < best.scatter - 1e-12 {
            next
        } else {
            best
        }
    });
    mirrored(best.unwrap_or_else(|| Split {
        sides: vec![0; n],
        scatter: 0.0,
    }))
}

fn mirrored(mut split: Split) -> Split {
    if split.sides.first() == Some(&1) {
        split.sides.iter_mut().for_each(|side| *side = 1 - *side);
    }
    split
}

fn to_unit_length(products: &DMatrix<f64>) -> DMatrix<f64> {
    let length = |i: usize| products[(i, i)].max(f64::MIN_POSITIVE).sqrt();
    products.map_with_location(|i, j, p| p / (length(i) * length(j)))
}

/// `Σ_k (Σ_{j ∈ Q_k} ‖h_j‖² − ‖Σ_{j ∈ Q_k} h_j‖² / |Q_k|)`.
pub(crate) fn scatter(products: &DMatrix<f64>, sides: &[usize]) -> f64 {
    let of_side = |side: usize| {
        let members = members(sides, side);
        let own: f64 = members.iter().map(|&i| products[(i, i)]).sum();
        own - mutual(products, &members, &members) / members.len().max(1) as f64
    };
    of_side(0) + of_side(1)
}

fn members(sides: &[usize], side: usize) -> Vec<usize> {
    (0..sides.len()).filter(|&i| sides[i] == side).collect()
}

fn mutual(products: &DMatrix<f64>, a: &[usize], b: &[usize]) -> f64 {
    a.iter()
        .flat_map(|&i| b.iter().map(move |&j| products[(i, j)]))
        .sum()
}

/// Algorithm 6 from one random split: classes go to the nearer centroid (Eq. 3.43) in turn until none moves. The last
/// of a side stays. Every move makes the scatter smaller or leaves it, up to rounding: the number of rounds is bounded
/// all the same. O(n²) a round.
fn cluster(products: &DMatrix<f64>, rng: &mut Rng) -> Vec<usize> {
    let n = products.nrows();
    let mut sides: Vec<usize> = (0..n).map(|i| i % 2).collect();
    rng.shuffle(&mut sides);
    for _ in 0..50 {
        let mut sums = [0, 1].map(|side| SideSums::new(products, members(&sides, side)));
        let mut moved = false;
        for j in 0..n {
            let (own, other) = (sides[j], 1 - sides[j]);
            let nearer =
                usize::from(sums[1].squared_to(products, j) < sums[0].squared_to(products, j));
            if nearer != own && sums[own].count > 1.0 {
                sums[own].change(products, j, -1.0);
                sums[other].change(products, j, 1.0);
                sides[j] = nearer;
                moved = true;
            }
        }
        if !moved {
            break;
        }
    }
    sides
}

/// What is known of a side's members: their number, each one's products with all of them, and the sum of those of members.
struct SideSums {
    count: f64,
    with: Vec<f64>,
    mutual: f64,
}

impl SideSums {
    fn new(products: &DMatrix<f64>, members: Vec<usize>) -> Self {
        let with = |j: usize| members.iter().map(|&i| products[(i, j)]).sum();
        let with: Vec<f64> = (0..products.nrows()).map(with).collect();
        Self {
            count: members.len() as f64,
            mutual: members.iter().map(|&i| with[i]).sum(),
            with,
        }
    }

    /// `d_k²` of Eq. 3.43: the squared distance of `h_j` from the side's centroid.
    fn squared_to(&self, products: &DMatrix<f64>, j: usize) -> f64 {
        products[(j, j)] - 2.0 * self.with[j] / self.count + self.mutual / (self.count * self.count)
    }

    /// `h_j` comes (1) or goes (−1).
    fn change(&mut self, products: &DMatrix<f64>, j: usize, sign: f64) {
        self.count += sign;
        self.mutual += sign * 2.0 * self.with[j] + products[(j, j)];
        for (i, with) in self.with.iter_mut().enumerate() {
            *with += sign * products[(i, j)];
        }
    }
}
