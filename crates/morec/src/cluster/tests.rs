use nalgebra::DMatrix;
use proptest::prelude::*;

use super::*;
use crate::features::Rows;

fn sample(dim: usize) -> impl Strategy<Value = Rows> {
    prop::collection::vec(-1f32..1.0, dim * 9).prop_map(move |v| Rows::from_values(dim, v))
}

fn labels() -> impl Strategy<Value = (Vec<usize>, Vec<usize>)> {
    (0usize..40).prop_flat_map(|n| {
        (
            prop::collection::vec(0usize..5, n),
            prop::collection::vec(0usize..6, n),
        )
    })
}

proptest! {
    #[test]
    fn kwas_is_the_sum_as_written(a in sample(5), b in sample(5), k in 1usize..7) {
        // Eigenvalues of M are squares of the singular values of A.
        let svd = |rows: &Rows| {
            let a = DMatrix::from_fn(rows.len(), 5, |i, k| f64::from(rows.row(i)[k]));
            let svd = a.svd(false, true);
            (svd.singular_values.map(|s| s * s), svd.v_t.unwrap())
        };
        let ((sigma, u), (lambda, v)) = (svd(&a), svd(&b));
        let term = |i: usize| {
            (sigma[i] / sigma.sum() + lambda[i] / lambda.sum()) * u.row(i).dot(&v.row(i)).abs() / 2.0
        };
        let expected: f64 = (0..k.min(5)).map(term).sum();
        let (a, b) = (Spectrum::of_rows(&a), Spectrum::of_rows(&b));
        let found = kwas(&a, &b, k, KwasForm::Printed);
        prop_assert!((found - expected).abs() < 1e-6, "{found} for {expected}");
        prop_assert!((found - kwas(&b, &a, k, KwasForm::Printed)).abs() < 1e-12);
        let normalised = kwas(&a, &b, k, KwasForm::Normalised);
        prop_assert!(found <= normalised + 1e-12 && normalised <= 1.0 + 1e-12);
        prop_assert!((kwas(&a, &a, k, KwasForm::Normalised) - 1.0).abs() < 1e-12);
        prop_assert!(k >= 5 || kwas(&a, &a, k, KwasForm::Printed) < 1.0);
    }

    #[test]
    fn pairs_are_those_counted_one_by_one((classes, clusters) in labels()) {
        let mut expected = PairCounts::default();
        for i in 0..classes.len() {
            for j in 0..i {
                *match (classes[i] == classes[j], clusters[i] == clusters[j]) {
                    (true, true) => &mut expected.true_positive,
                    (false, true) => &mut expected.false_positive,
                    (true, false) => &mut expected.false_negative,
                    (false, false) => &mut expected.true_negative,
                } += 1;
            }
        }
        let found = PairCounts::count(&classes, &clusters);
        prop_assert_eq!(found, expected);
        prop_assert_eq!(PairCounts::count(&clusters, &classes).rand_index(), found.rand_index());
        // The adjusted index by its pair-counting form (Hubert and Arabie 1985; Steinley 2004).
        let [tp, fp, fneg, tn] =
            [found.true_positive, found.false_positive, found.false_negative, found.true_negative]
                .map(|n| n as f64);
        let below = (tp + fp) * (fp + tn) + (tp + fneg) * (fneg + tn);
        let direct = if below == 0.0 { 1.0 } else { 2.0 * (tp * tn - fp * fneg) / below };
        prop_assert!((adjusted_rand_index(&classes, &clusters) - direct).abs() < 1e-9);
    }

    #[test]
    fn clusters_are_the_closure_of_the_links(items in 0usize..14, seed in any::<u64>()) {
        let linked = |a: usize, b: usize| (seed >> ((a * 7 + b * 5) % 64)) & 7 == 1;
        let clusters = connected(items, linked);
        // Warshall's closure.
        let mut reach: Vec<Vec<bool>> = (0..items)
            .map(|a| (0..items).map(|b| a == b || linked(a.min(b), a.max(b))).collect())
            .collect();
        for via in 0..items {
            for a in 0..items {
                for b in 0..items {
                    reach[a][b] |= reach[a][via] && reach[via][b];
                }
            }
        }
        for a in 0..items {
            for b in 0..items {
                prop_assert_eq!(clusters.of[a] == clusters.of[b], reach[a][b]);
            }
        }
        prop_assert_eq!(clusters.members().iter().map(Vec::len).sum::<usize>(), items);
        prop_assert!(clusters.members().iter().all(|m| !m.is_empty()));
    }
}

/// The thesis prints 0.47, 0.58 and 0.92; its counts (Tables 5.2–5.4, of C(122, 2) pairs) say a little more.
#[test]
fn the_printed_rand_indices_follow_from_their_counts() {
    let tables = [
        (708, 3852, 0, 2821, 0.478, 0.47),
        (708, 3042, 0, 3631, 0.588, 0.58),
        (588, 438, 120, 6235, 0.924, 0.92),
    ];
    for (true_positive, false_positive, false_negative, true_negative, index, printed) in tables {
        let pairs = PairCounts {
            true_positive,
            false_positive,
            false_negative,
            true_negative,
        };
        assert_eq!(pairs.total(), 122 * 121 / 2);
        assert!((pairs.rand_index() - index).abs() < 5e-4);
        assert!(
            (0.0..0.01).contains(&(pairs.rand_index() - printed)),
            "printed cut off, not rounded"
        );
    }
}

#[test]
fn samples_of_one_direction_are_grouped() {
    let along = |x: f32, y: f32| {
        let rows = (0..20).flat_map(|i| {
            let t = (i as f32 / 3.0).sin();
            [t * x, t * y, 0.05 * (i as f32).cos()]
        });
        Spectrum::of_rows(&Rows::from_values(3, rows.collect()))
    };
    let samples = [
        along(1.0, 0.0),
        along(0.0, 1.0),
        along(2.0, 0.1),
        along(0.1, 1.0),
    ];
    let clusters = kwas_clusters(&samples, &KwasParams::default());
    assert_eq!(
        clusters,
        Clusters {
            of: vec![0, 1, 0, 1],
            count: 2
        }
    );
    assert_eq!(
        kwas_clusters(
            &samples,
            &KwasParams {
                tau: 1.0,
                ..KwasParams::default()
            }
        )
        .count,
        4
    );
    let nothing = Spectrum::of_rows(&Rows::new(3));
    assert!(kwas(&nothing, &samples[0], 3, KwasForm::Normalised).is_finite());
}

#[test]
fn agreement_of_trivial_partitions() {
    assert_eq!(adjusted_rand_index(&[0, 0, 0], &[4, 4, 4]), 1.0);
    assert_eq!(adjusted_rand_index(&[0, 1, 2], &[2, 1, 0]), 1.0);
    assert_eq!(adjusted_rand_index(&[0, 0, 1, 1], &[7, 7, 7, 7]), 0.0);
    assert_eq!(PairCounts::count(&[], &[]).rand_index(), 1.0);
}
