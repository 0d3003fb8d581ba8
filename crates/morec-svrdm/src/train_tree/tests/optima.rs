use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

use super::super::*;
use super::cloud;
use mocap::rng::Rng;

/// A machine's problem: samples of two clouds, any width.
fn random_problem(seed: u64, m: usize, width: f64) -> BoxQp {
    let mut rng = Rng::new(seed);
    let mut samples = cloud(&mut rng, m.div_ceil(2), &[0.0, 0.0, 0.0], 1.0);
    samples.extend(cloud(&mut rng, m / 2, &[1.0, 0.5, 0.0], 1.0));
    let sides: Vec<usize> = (0..m).map(|i| usize::from(i >= m.div_ceil(2))).collect();
    problem(
        &Distances::new(&samples).kernel(width),
        &sides,
        (seed % 2) as usize,
        &MachineParams::default(),
    )
}

/// The obvious slow way: steps against the gradient, cut off at the box.
fn projected_gradient(qp: &BoxQp) -> DVector<f64> {
    let step = 1.0
        / qp.matrix
            .row_sum()
            .amax()
            .max(qp.matrix.map(f64::abs).row_sum().amax());
    let mut alpha = DVector::zeros(qp.linear.len());
    for _ in 0..200_000 {
        alpha = (&alpha - qp.gradient(&alpha) * step).map(|a| a.clamp(0.0, qp.upper));
        if qp.residual(&alpha) < 1e-9 {
            break;
        }
    }
    alpha
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn the_conditions_hold_at_any_width(seed in any::<u64>(), m in 2usize..40, log_width in -2.5f64..2.5) {
        let qp = random_problem(seed, m, log_width.exp());
        let solution = qp.solve(Stop::default());
        prop_assert!(solution.residual <= 1e-8, "{} after {} passes", solution.residual, solution.passes);
        prop_assert!(solution.alpha.iter().all(|a| (0.0..=qp.upper).contains(a)));
    }

    #[test]
    fn greedy_slow_and_printed_ways_find_one_optimum(
        seed in any::<u64>(), m in 2usize..16, log_width in -2.0f64..0.0,
    ) {
        let qp = random_problem(seed, m, log_width.exp());
        let solution = qp.solve(Stop::default());
        let printed = qp.sor(Stop { residual: 1e-10, passes: 100_000 });
        prop_assert!(printed.residual <= 1e-8);
        let best = qp.objective(&solution.alpha);
        prop_assert!((best - qp.objective(&printed.alpha)).abs() < 1e-9);
        prop_assert!((best - qp.objective(&projected_gradient(&qp))).abs() < 1e-6);
        // A narrow kernel is well-conditioned: the weights themselves agree.
        prop_assert!((&solution.alpha - &printed.alpha).amax() < 1e-4);
    }

    /// The sphere is enclosing, and its centre is no nearer to any mixture than the optimum allows: the squared
    /// distance of every sample is at most `R²`, and those that hold it lie on it.
    #[test]
    fn the_sphere_encloses_and_rests_on_its_holders(seed in any::<u64>(), m in 1usize..40, log_width in -2.0f64..1.5) {
        let samples = cloud(&mut Rng::new(seed), m, &[0.0; 4], 1.0);
        let kernel = Distances::new(&samples).kernel(log_width.exp());
        let sphere = smallest_enclosing_sphere(&kernel);
        prop_assert!((sphere.alpha.sum() - 1.0).abs() < 1e-9 && sphere.alpha.iter().all(|a| *a >= 0.0));
        let product = &kernel * &sphere.alpha;
        let centre = sphere.alpha.dot(&product);
        let squared = |i: usize| 1.0 - 2.0 * product[i] + centre;
        let radius = sphere.radius * sphere.radius;
        prop_assert!((0..m).all(|i| squared(i) <= radius + 1e-8));
        prop_assert!(sphere.support_vectors().into_iter().all(|i| (squared(i) - radius).abs() < 1e-6));
    }
}

#[test]
fn wide_kernels_are_solved_though_coordinates_alone_crawl() {
    let qp = random_problem(5, 60, 8.0);
    let quick = qp.solve(Stop::default());
    let printed = qp.sor(Stop {
        residual: 1e-8,
        passes: 300,
    });
    assert!(
        quick.residual <= 1e-8,
        "{} after {}",
        quick.residual,
        quick.passes
    );
    assert!(
        printed.residual > 1e-5,
        "the printed way was quick: {}",
        printed.residual
    );
    assert!(qp.objective(&quick.alpha) < qp.objective(&printed.alpha));
}

#[test]
fn one_sample_alone_is_represented_exactly() {
    let solution = svrm(DMatrix::from_element(1, 1, 1.0), &TreeParams::default());
    assert!((solution.alpha[0] - 1.0).abs() < 1e-12);
    assert_eq!(
        on_boundary(&solution.alpha, &MachineParams::default()),
        [true]
    );
}

#[test]
fn each_machine_of_a_pair_speaks_for_its_own_side() {
    let mut rng = Rng::new(3);
    let mut samples = cloud(&mut rng, 8, &[0.0, 0.0], 0.2);
    samples.extend(cloud(&mut rng, 5, &[2.0, 0.0], 0.2));
    let sides: Vec<usize> = (0..13).map(|i| usize::from(i >= 8)).collect();
    let kernel = Distances::new(&samples).kernel(0.5);
    let pair = svrdm(&kernel, &sides, &TreeParams::default());
    for side in 0..2 {
        let outputs = &kernel * &pair.weights[side];
        for (i, output) in outputs.iter().enumerate() {
            let kept = if sides[i] == side {
                *output >= 1.0 - 1e-6
            } else {
                *output <= 0.4 + 1e-6
            };
            assert!(kept, "machine {side} says {output} of sample {i}");
        }
    }
}

#[test]
fn samples_in_one_place_have_a_finite_machine() {
    for place in [[0.0, 0.0], [1.0, -2.0]] {
        let (mut samples, mut sides) = (vec![place.to_vec(); 6], vec![0, 0, 0, 1, 1, 1]);
        for width in [0.01, 1.0, 100.0] {
            let pair = svrdm(
                &Distances::new(&samples).kernel(width),
                &sides,
                &TreeParams::default(),
            );
            assert!(
                pair.weights.iter().flatten().all(|w| w.is_finite()),
                "{pair:?}"
            );
        }
        samples.push(vec![5.0, 5.0]);
        sides.push(1);
        let pair = svrdm(
            &Distances::new(&samples).kernel(1e4),
            &sides,
            &TreeParams::default(),
        );
        assert!(
            pair.weights.iter().flatten().all(|w| w.is_finite()),
            "{pair:?}"
        );
    }
}
