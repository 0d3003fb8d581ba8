use super::super::*;
use super::cloud;
use crate::svrdm::{Acceptance, ClassCandidates, Tree};
use mocap::rng::Rng;
use morec_features::ClassId;

/// Three people's samples of classes in clouds of their own, people a little apart.
fn samples(classes: u16, each: usize, dim: usize) -> Vec<FeatureSample> {
    let mut rng = Rng::new(11);
    let mut all = vec![];
    for class in 0..classes {
        let centre: Vec<f64> = (0..dim).map(|_| 0.5 + 0.2 * rng.normal()).collect();
        let vectors = cloud(&mut rng, each, &centre, 0.04);
        let numbered = vectors.into_iter().enumerate();
        all.extend(numbered.map(|(i, vector)| FeatureSample {
            class: ClassId(class),
            group: i % 3,
            vector,
        }));
    }
    all
}

fn named(tree: &Tree, vector: &[f64]) -> Option<ClassId> {
    let mut out = ClassCandidates::default();
    tree.descend(vector, Acceptance::above(0.92), &mut out);
    out.first().map(|c| c.class)
}

fn with(sigma: SigmaRule) -> TreeParams {
    TreeParams {
        sigma,
        ..TreeParams::default()
    }
}

#[test]
fn what_was_learned_is_known_and_what_is_far_is_not() {
    let samples = samples(6, 6, 8);
    let grown = grow(&samples, &[], &TreeParams::default()).unwrap();
    assert_eq!(grown.branches.len(), 5);
    let right = samples
        .iter()
        .filter(|s| named(&grown.tree, &s.vector) == Some(s.class))
        .count();
    assert!(right >= 34, "{right} of 36");
    assert_eq!(named(&grown.tree, &[3.0; 8]), None);
    assert!(grown.branches.iter().all(|b| b.residual < 1e-6));
}

#[test]
fn cross_validated_widths_accept_more_of_what_is_new_and_still_no_background() {
    let all = samples(5, 12, 8);
    let (known, new): (Vec<_>, Vec<_>) = all.into_iter().enumerate().partition(|(i, _)| i % 2 == 0);
    let known: Vec<FeatureSample> = known.into_iter().map(|(_, s)| s).collect();
    let mut rng = Rng::new(4);
    let mut elsewhere = || {
        (0..200)
            .map(|_| (0..8).map(|_| 0.5 + 0.2 * rng.normal()).collect())
            .collect::<Vec<Vec<f64>>>()
    };
    let (background, unseen) = (elsewhere(), elsewhere());
    let counts = |params: &TreeParams| {
        let tree = grow(&known, &background, params).unwrap().tree;
        let right = new
            .iter()
            .filter(|(_, s)| named(&tree, &s.vector) == Some(s.class))
            .count();
        (
            right,
            unseen.iter().filter(|v| named(&tree, v).is_some()).count(),
        )
    };
    // Without a floor Algorithm 4 settles on narrow kernels.
    let narrow = counts(&TreeParams {
        algorithm4: Algorithm4 {
            sweep: Sweep::Geometric {
                low: 0.1,
                high: 3.0,
                count: 60,
            },
            ..Algorithm4::default()
        },
        ..TreeParams::default()
    });
    let crossed = counts(&with(SigmaRule::CrossValidated(CrossParams::default())));
    assert!(
        crossed.0 > narrow.0 && crossed.0 >= 20,
        "{crossed:?} against {narrow:?} of 30 and 200"
    );
    assert!(crossed.1 <= 10, "{crossed:?}");
}

#[test]
fn the_same_arguments_give_the_same_tree_whatever_the_rule() {
    let samples = samples(4, 5, 6);
    for rule in [
        SigmaRule::Scaled {
            full: 2.0,
            reduced: 3.0,
        },
        SigmaRule::Quantile {
            full: 0.5,
            reduced: 0.5,
        },
        SigmaRule::Fixed {
            full: 0.3,
            reduced: 0.1,
        },
        SigmaRule::CrossValidated(CrossParams::default()),
    ] {
        let first = grow(&samples, &[], &with(rule)).unwrap();
        assert_eq!(first, grow(&samples, &[], &with(rule)).unwrap());
        let text = serde_json::to_string(&with(rule)).unwrap();
        assert_eq!(
            serde_json::from_str::<TreeParams>(&text).unwrap(),
            with(rule)
        );
    }
}

#[test]
fn odd_samples_do_no_harm() {
    let one = |class, value: f64| FeatureSample {
        class: ClassId(class),
        group: 0,
        vector: vec![value; 3],
    };
    // A sample a class, and twins.
    for samples in [
        vec![one(0, 0.0), one(1, 1.0), one(2, 2.0)],
        vec![
            one(0, 0.0),
            one(0, 0.0),
            one(0, 0.0),
            one(1, 1.0),
            one(1, 1.0),
        ],
    ] {
        for rule in [
            SigmaRule::Algorithm4,
            SigmaRule::CrossValidated(CrossParams::default()),
        ] {
            let tree = grow(&samples, &[], &with(rule)).unwrap().tree;
            assert!(
                samples
                    .iter()
                    .all(|s| named(&tree, &s.vector) == Some(s.class))
            );
        }
    }
    // The same vector in two classes cannot be distinguished, and must not fail.
    assert!(grow(&[one(0, 0.5), one(1, 0.5)], &[], &TreeParams::default()).is_ok());
}

#[test]
fn what_cannot_be_learned_is_said() {
    let sample = |class, vector: &[f64]| FeatureSample {
        class: ClassId(class),
        group: 0,
        vector: vector.to_vec(),
    };
    let says = |samples: &[FeatureSample], background: &[Vec<f64>], params: &TreeParams| {
        grow(samples, background, params).unwrap_err().to_string()
    };
    let (a, b) = (sample(0, &[0.0, 1.0]), sample(1, &[1.0, 0.0]));
    let usual = TreeParams::default();
    assert!(says(&[], &[], &usual).contains("the samples show 0"));
    assert!(says(&[a.clone(), a.clone()], &[], &usual).contains("the samples show 1"));
    assert!(
        says(&[a.clone(), sample(1, &[1.0])], &[], &usual)
            .contains("sample 1 has 1 values where 2")
    );
    assert!(
        says(&[a.clone(), sample(1, &[1.0, f64::NAN])], &[], &usual)
            .contains("sample 1 has a value")
    );
    assert!(
        says(&[a.clone(), b.clone()], &[vec![0.0; 3]], &usual)
            .contains("background 0 has 3 values")
    );
    let zero = with(SigmaRule::Fixed {
        full: 0.0,
        reduced: 1.0,
    });
    assert!(says(&[a, b], &[], &zero).contains("width"));
}

#[test]
fn two_families_of_classes_are_parted_and_clustering_from_chance_finds_them_too() {
    let mut rng = Rng::new(21);
    let family = |i: usize| {
        if i.is_multiple_of(3) {
            [0.0; 4]
        } else {
            [1.0; 4]
        }
    };
    let by_class: Vec<Vec<Vec<f64>>> = (0..9)
        .map(|i| {
            let centre = family(i).map(|c| c + 0.15 * rng.normal());
            cloud(&mut rng, 5, &centre, 0.05)
        })
        .collect();
    let expected: Vec<usize> = (0..9usize)
        .map(|i| usize::from(!i.is_multiple_of(3)))
        .collect();
    let products = function_products(&by_class, 0.6, &TreeParams::default());
    for unit_length in [false, true] {
        let exact = partition(
            &products,
            &PartitionParams {
                unit_length,
                ..Default::default()
            },
        );
        let chance = PartitionParams {
            unit_length,
            exact_up_to: 2,
            restarts: 20,
            seed: 5,
        };
        assert_eq!(exact.sides, expected);
        assert_eq!(partition(&products, &chance), exact);
    }
}

#[test]
fn sign_vectors_turn_eigenvectors_one_way() {
    let mut rng = Rng::new(8);
    let mut vectors = cloud(&mut rng, 40, &[1.0, 0.3, -0.2, 0.0], 0.1);
    for (i, v) in vectors.iter_mut().enumerate() {
        let length = v.iter().map(|x| x * x).sum::<f64>().sqrt()
            * if i.is_multiple_of(3) { -1.0 } else { 1.0 };
        v.iter_mut().for_each(|x| *x /= length);
    }
    let views: Vec<&[f64]> = vectors.iter().map(Vec::as_slice).collect();
    for rule in [SignRule::Centred, SignRule::Common] {
        let found = sign_vector(&views, rule).unwrap();
        let turned: Vec<bool> = found.products.iter().map(|p| *p < 0.0).collect();
        let expected: Vec<bool> = (0..40usize).map(|i| i.is_multiple_of(3)).collect();
        assert_eq!(turned, expected, "{rule:?}");
        assert_eq!(found.unsure(0.5), 0.0);
        assert_eq!(found.unsure(1.1), 1.0);
    }
    assert_eq!(sign_vector(&[], SignRule::Centred), None);
}

#[test]
fn the_printed_solver_grows_the_same_tree() {
    let samples = samples(6, 6, 8);
    let by = |solver| {
        let params = TreeParams {
            solver,
            machine: MachineParams {
                stop: Stop {
                    residual: 1e-8,
                    passes: 100_000,
                },
                ..MachineParams::default()
            },
            ..TreeParams::default()
        };
        grow(&samples, &[], &params).unwrap()
    };
    let (exact, printed) = (by(Solver::ActiveSet), by(Solver::Sor));
    for (a, b) in exact.branches.iter().zip(&printed.branches) {
        assert_eq!((a.samples, a.exemplars), (b.samples, b.exemplars));
        assert_eq!(a.sigma_reduced, b.sigma_reduced);
    }
    let (mut rng, mut far) = (Rng::new(9), 0.0f64);
    for _ in 0..200 {
        let vector: Vec<f64> = (0..8).map(|_| 0.5 + 0.2 * rng.normal()).collect();
        for ((_, a), (_, b)) in exact.tree.branches().zip(printed.tree.branches()) {
            let (a, b) = (
                exact.tree.outputs(a, &vector),
                printed.tree.outputs(b, &vector),
            );
            far = far.max((a[0] - b[0]).abs()).max((a[1] - b[1]).abs());
        }
    }
    assert!(far < 1e-4, "outputs {far} apart");
}

#[test]
fn widths_of_a_sweep_are_those_it_names() {
    let samples = samples(2, 6, 8);
    let vectors: Vec<&[f64]> = samples[..6].iter().map(|s| &s.vector[..]).collect();
    let with = |sweep| TreeParams {
        algorithm4: Algorithm4 {
            sweep,
            ..Algorithm4::default()
        },
        ..TreeParams::default()
    };
    let printed = algorithm4(&vectors, &TreeParams::default()).unwrap().sigma;
    let steps = (printed - 0.05) / 0.005;
    assert!(
        (steps - steps.round()).abs() < 1e-9 && (0.05..=1.0).contains(&printed),
        "{printed}"
    );
    let absolute = |low, high, step| Sweep::Absolute { low, high, step };
    let one = algorithm4(&vectors, &with(absolute(0.3, 0.3, 0.1))).unwrap();
    assert_eq!(one.sigma, 0.3);
    for wrong in [
        absolute(0.0, 1.0, 0.1),
        absolute(0.1, 1.0, 0.0),
        absolute(0.1, 1.0, f64::NAN),
        absolute(0.1, f64::INFINITY, 0.1),
        absolute(0.1, 1.0, 1e-9),
        Sweep::Linear {
            low: 0.1,
            high: 1.0,
            count: 0,
        },
    ] {
        let error = grow(&samples, &[], &with(wrong)).unwrap_err().to_string();
        assert!(error.contains("sweep"), "{error}");
    }
}
