//! Ranking by the company that stretches keep: what is like what is like the example is like it, too.
//!
//! Two performances of a motion in far styles are linked by those between. Similarity spreads from the example over a
//! graph of nearest neighbours (Zhou et al., *Ranking on data manifolds*, 2004, Eq. 4 of the algorithm:
//! `f = α S f + (1 − α) y`, `S = D^(−1/2) A D^(−1/2)`), with affinities scaled by how densely others lie around
//! (Zelnik-Manor and Perona, *Self-tuning spectral clustering*, 2004, Eq. 3: `A_ij = exp(−d_ij² / σᵢσⱼ)`, `σᵢ` the
//! distance of the seventh neighbour), as retrieval of images does it (Donoser and Bischof, *Diffusion processes for
//! retrieval revisited*, 2013; Iscen et al., 2017).

use rayon::prelude::*;

/// Neighbours of a node: about as many as a class has examples at least; more would link classes.
const NEIGHBOURS: usize = 15;
/// Rank of the neighbour whose distance is a node's scale (Zelnik-Manor and Perona).
pub const SCALE_NEIGHBOUR: usize = 7;
/// Share of similarity that is passed on, `α`.
const SPREAD: f32 = 0.8;
/// Rounds of diffusion; the rest is below `α^ROUNDS`, 2 · 10⁻⁵ of the whole.
const ROUNDS: usize = 50;

/// A symmetric graph: for each node its neighbours and `S`.
struct Graph {
    edges: Vec<Vec<(usize, f32)>>,
}

/// For nodes `1..n`: what comes to them from node 0 over the graph, 0 to 1, relative to the node that gets most.
/// `distance` is symmetric. O(n²) distances, O(15 n) for each of 50 rounds, O(15 n) memory.
pub fn spread(n: usize, distance: impl Fn(usize, usize) -> f32 + Sync) -> Vec<f32> {
    if n < 2 {
        return Vec::new();
    }
    let graph = Graph::of(n, distance);
    let mut reached = vec![0f32; n];
    let mut next = vec![0f32; n];
    for _ in 0..ROUNDS {
        for (i, (next, edges)) in next.iter_mut().zip(&graph.edges).enumerate() {
            let come: f32 = edges.iter().map(|(j, s)| s * reached[*j]).sum();
            *next = SPREAD * come + if i == 0 { 1.0 - SPREAD } else { 0.0 };
        }
        std::mem::swap(&mut reached, &mut next);
    }
    let most = reached[1..]
        .iter()
        .copied()
        .fold(f32::MIN_POSITIVE, f32::max);
    reached[1..].iter().map(|r| r / most).collect()
}

impl Graph {
    fn of(n: usize, distance: impl Fn(usize, usize) -> f32 + Sync) -> Self {
        // Row by row: only distances of neighbours are kept.
        let nearest: Vec<(f32, Vec<(usize, f32)>)> = (0..n)
            .into_par_iter()
            .map(|i| nearest(n, i, &distance))
            .collect();
        let mut edges: Vec<Vec<(usize, f32)>> = vec![Vec::new(); n];
        for (i, (scale, near)) in nearest.iter().enumerate() {
            for &(j, d) in near {
                // Copies of one another have no scale: they are alike.
                let affinity = (-d * d / (scale * nearest[j].0).max(1e-12)).exp();
                edges[i].push((j, affinity));
                edges[j].push((i, affinity));
            }
        }
        // A link that both ends named is one link.
        for edges in &mut edges {
            edges.sort_by_key(|a| a.0);
            edges.dedup_by_key(|a| a.0);
        }
        let degrees: Vec<f32> = edges
            .iter()
            .map(|edges| edges.iter().map(|e| e.1).sum::<f32>().max(1e-12))
            .collect();
        for (i, edges) in edges.iter_mut().enumerate() {
            edges
                .iter_mut()
                .for_each(|(j, a)| *a /= (degrees[i] * degrees[*j]).sqrt());
        }
        Self { edges }
    }
}

/// A node's scale, and its neighbours with their distances.
fn nearest(
    n: usize,
    i: usize,
    distance: &impl Fn(usize, usize) -> f32,
) -> (f32, Vec<(usize, f32)>) {
    let mut all: Vec<(usize, f32)> = (0..n)
        .filter(|&j| j != i)
        .map(|j| (j, distance(i, j)))
        .collect();
    let order = |a: &(usize, f32), b: &(usize, f32)| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0));
    if all.len() > NEIGHBOURS {
        all.select_nth_unstable_by(NEIGHBOURS - 1, order);
        all.truncate(NEIGHBOURS);
    }
    all.sort_by(order);
    (all[SCALE_NEIGHBOUR.min(all.len()) - 1].1, all)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};
    use proptest::prelude::*;

    /// The obvious slow version: whole matrices, and the system solved.
    fn solved(points: &[f64]) -> Vec<f64> {
        let n = points.len();
        let d = |i: usize, j: usize| f64::from((points[i] - points[j]).abs() as f32);
        let near = |i: usize| {
            let mut others: Vec<usize> = (0..n).filter(|j| *j != i).collect();
            others.sort_by(|&a, &b| d(i, a).total_cmp(&d(i, b)).then(a.cmp(&b)));
            others.truncate(NEIGHBOURS);
            others
        };
        let scale = |i: usize| d(i, near(i)[SCALE_NEIGHBOUR.min(near(i).len()) - 1]);
        let linked = |i: usize, j: usize| i != j && (near(i).contains(&j) || near(j).contains(&i));
        let a = DMatrix::from_fn(n, n, |i, j| {
            if linked(i, j) {
                (-d(i, j).powi(2) / (scale(i) * scale(j)).max(1e-12)).exp()
            } else {
                0.0
            }
        });
        let degrees: Vec<f64> = (0..n).map(|i| a.row(i).sum().max(1e-12)).collect();
        let alpha = f64::from(SPREAD);
        let system = DMatrix::from_fn(n, n, |i, j| {
            f64::from(i == j) - alpha * a[(i, j)] / (degrees[i] * degrees[j]).sqrt()
        });
        let mut y = DVector::zeros(n);
        y[0] = 1.0 - alpha;
        let f = system.lu().solve(&y).unwrap();
        let most = f.rows(1, n - 1).max().max(f64::from(f32::MIN_POSITIVE));
        f.rows(1, n - 1).iter().map(|v| v / most).collect()
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 32, failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn rounds_reach_the_solution(points in prop::collection::vec(-3.0f64..3.0, 2..40)) {
            let rounds = spread(points.len(), |i, j| (points[i] - points[j]).abs() as f32);
            for (fast, slow) in rounds.iter().zip(solved(&points)) {
                prop_assert!((f64::from(*fast) - slow).abs() < 1e-3, "{} {}", fast, slow);
            }
        }
    }

    /// Two rows of points side by side: what lies on the example's own row comes before what is nearer across.
    #[test]
    fn what_is_linked_comes_before_what_is_near() {
        let at = |i: usize| {
            if i < 40 {
                (0.1 * i as f32, 0.0)
            } else {
                (0.1 * (i - 40) as f32, 2.0)
            }
        };
        let distance = |i: usize, j: usize| (at(i).0 - at(j).0).hypot(at(i).1 - at(j).1);
        let reached = spread(80, distance);
        let along = reached[38]; // node 39, 3.9 away
        let across = reached[39]; // node 40, 2 away
        assert!(along > across, "{along} {across}");
        assert!(distance(0, 39) > distance(0, 40));
        assert!(spread(1, |_, _| 0.0).is_empty());
        assert_eq!(
            spread(3, |_, _| 0.0),
            [1.0, 1.0],
            "copies all reached alike"
        );
    }
}
