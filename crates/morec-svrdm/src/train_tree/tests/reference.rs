//! Against outside solvers and the prototype (`testdata/reference/svrdm_training.json`).

use nalgebra::DVector;
use serde::Deserialize;

use super::super::*;
use crate::svrdm::{Acceptance, ClassCandidates, Node};
use morec_features::ClassId;

type Rows = Vec<Vec<f64>>;

#[derive(Deserialize)]
struct Reference {
    boxes: Vec<BoxCase>,
    spheres: Vec<SphereCase>,
    widths: Vec<WidthCase>,
    branches: Vec<BranchCase>,
    trees: Vec<TreeCase>,
    signs: Vec<SignCase>,
}

#[derive(Deserialize)]
struct BoxCase {
    vectors: Rows,
    sides: Vec<usize>,
    side: usize,
    sigma: f64,
    alpha: Vec<f64>,
    objective: f64,
}

#[derive(Deserialize)]
struct SphereCase {
    vectors: Rows,
    sigma: f64,
    alpha: Vec<f64>,
    radius: f64,
}

#[derive(Deserialize)]
struct WidthCase {
    vectors: Rows,
    sigma: f64,
}

#[derive(Deserialize)]
struct BranchCase {
    sides: [Rows; 2],
    sigma_full: f64,
    exemplars: [Vec<usize>; 2],
    factor: [f64; 3],
    sigma_reduced: f64,
    points: Vec<[f64; 2]>,
    probes: Rows,
    outputs: Vec<[f64; 2]>,
}

#[derive(Deserialize)]
struct TreeCase {
    classes: Vec<Rows>,
    root: [Vec<u16>; 2],
    probes: Rows,
    named: Vec<Option<u16>>,
}

#[derive(Deserialize)]
struct SignCase {
    eigenvectors: Rows,
    direction: Vec<f64>,
}

fn reference() -> Reference {
    serde_json::from_str(include_str!(
        "../../../testdata/reference/svrdm_training.json"
    ))
    .unwrap()
}

/// Parameters of the prototype where they differ from the default: its sweep, and samples alone in their ball.
fn as_prototype() -> TreeParams {
    let sweep = Sweep::Linear {
        low: 0.02,
        high: 1.5,
        count: 75,
    };
    TreeParams {
        algorithm4: Algorithm4 {
            lone_is_boundary: false,
            sweep,
            ..Default::default()
        },
        ..Default::default()
    }
}

fn near(a: f64, b: f64, by: f64) -> bool {
    (a - b).abs() <= by
}

#[test]
fn machines_are_those_of_an_outside_solver() {
    for (number, case) in reference().boxes.iter().enumerate() {
        let kernel = Distances::new(&case.vectors).kernel(case.sigma);
        let qp = problem(&kernel, &case.sides, case.side, &MachineParams::default());
        let found = qp.solve(Stop::default());
        let outside = DVector::from_column_slice(&case.alpha);
        assert!(
            near(qp.objective(&found.alpha), case.objective, 1e-8),
            "box {number}"
        );
        // Weights are ill-determined where the kernel is wide; what the machine says is not.
        let apart = (&qp.matrix * (&found.alpha - outside)).amax();
        assert!(apart < 1e-6, "box {number}: outputs {apart} apart");
    }
}

#[test]
fn spheres_are_those_of_an_outside_solver() {
    for (number, case) in reference().spheres.iter().enumerate() {
        let sphere = smallest_enclosing_sphere(&Distances::new(&case.vectors).kernel(case.sigma));
        assert!(
            near(sphere.radius, case.radius, 1e-7),
            "sphere {number}: {} {}",
            sphere.radius,
            case.radius
        );
        let apart = (&sphere.alpha - DVector::from_column_slice(&case.alpha)).amax();
        assert!(apart < 1e-3, "sphere {number}: weights {apart} apart");
    }
}

#[test]
fn widths_are_those_of_the_prototype() {
    let params = as_prototype();
    for (number, case) in reference().widths.iter().enumerate() {
        let found = algorithm4(&case.vectors, &params).unwrap();
        assert!(
            near(found.sigma, case.sigma, 1e-9),
            "width {number}: {} {}",
            found.sigma,
            case.sigma
        );
    }
}

/// Both sides as the samples of two classes.
fn two_classes(sides: &[Rows; 2]) -> Vec<FeatureSample> {
    let of_side = |side: usize| {
        let sample = move |v: &Vec<f64>| FeatureSample {
            class: ClassId(side as u16),
            group: 0,
            vector: v.clone(),
        };
        sides[side].iter().map(sample)
    };
    of_side(0).chain(of_side(1)).collect()
}

#[test]
fn branches_are_those_of_the_prototype() {
    for (number, case) in reference().branches.iter().enumerate() {
        let grown = grow(&two_classes(&case.sides), &[], &as_prototype()).unwrap();
        let Node::Branch(branch) = &grown.tree.nodes()[0] else {
            panic!("the root is a branch")
        };
        assert!(
            near(branch.sigma_full, case.sigma_full, 1e-9),
            "branch {number}: full width"
        );
        assert!(
            near(branch.sigma_reduced, case.sigma_reduced, 1e-6),
            "branch {number}: reduced width"
        );
        assert!(
            branch
                .factor
                .iter()
                .zip(case.factor)
                .all(|(a, b)| near(*a, b, 1e-6)),
            "branch {number}: factor"
        );
        let vectors = [0, 1].map(|k| case.sides[k].iter().map(Vec::as_slice).collect::<Vec<_>>());
        let sides = [&vectors[0][..], &vectors[1][..]];
        let plane = Plane::new(sides, branch.sigma_full);
        assert_eq!(plane.exemplars, case.exemplars, "branch {number}");
        let planar = [
            plane.reduce_all(sides, sides[0]),
            plane.reduce_all(sides, sides[1]),
        ]
        .concat();
        let same =
            |(a, b): (&[f64; 2], &[f64; 2])| near(a[0], b[0], 1e-6) && near(a[1], b[1], 1e-6);
        assert!(
            planar.iter().zip(&case.points).all(same),
            "branch {number}: points"
        );
        for (probe, expected) in case.probes.iter().zip(&case.outputs) {
            let outputs = grown.tree.outputs(branch, probe);
            let same = near(outputs[0], expected[0], 1e-4) && near(outputs[1], expected[1], 1e-4);
            assert!(same, "branch {number}: {outputs:?} {expected:?}");
        }
    }
}

#[test]
fn trees_decide_as_those_of_the_prototype() {
    for (number, case) in reference().trees.iter().enumerate() {
        let numbered = (0..)
            .zip(&case.classes)
            .flat_map(|(class, rows)| rows.iter().map(move |v| (class, v)));
        let samples: Vec<FeatureSample> = numbered
            .map(|(class, v)| FeatureSample {
                class: ClassId(class),
                group: 0,
                vector: v.clone(),
            })
            .collect();
        let tree = grow(&samples, &[], &as_prototype()).unwrap().tree;
        let Node::Branch(root) = &tree.nodes()[0] else {
            panic!("the root is a branch")
        };
        let parted = root
            .classes
            .each_ref()
            .map(|side| side.iter().map(|c| c.0).collect::<Vec<_>>());
        let mut expected = case.root.clone();
        expected.sort();
        assert_eq!(parted, expected, "tree {number}");
        let mut out = ClassCandidates::default();
        for (at, (probe, named)) in case.probes.iter().zip(&case.named).enumerate() {
            tree.descend(probe, Acceptance::above(0.92), &mut out);
            assert_eq!(
                out.first().map(|c| c.class.0),
                *named,
                "tree {number}, probe {at}"
            );
        }
    }
}

#[test]
fn sign_vectors_are_those_of_the_prototype() {
    for case in reference().signs {
        let views: Vec<&[f64]> = case.eigenvectors.iter().map(Vec::as_slice).collect();
        let found = sign_vector(&views, SignRule::Centred).unwrap();
        let product: f64 = found
            .direction
            .iter()
            .zip(&case.direction)
            .map(|(a, b)| a * b)
            .sum();
        assert!(near(product.abs(), 1.0, 1e-9), "{product}");
    }
}
