use proptest::prelude::*;

use super::*;
use morec_features::ClassId;

/// Exemplars at the corners of a triangle, one for each of three classes: 0 | (1 | 2).
fn parts() -> TreeParts {
    let branch = |exemplars, children, classes| {
        Node::Branch(Box::new(Branch {
            sigma_full: 0.5,
            exemplars,
            factor: [1.0, 0.1, 0.9],
            sigma_reduced: 0.4,
            points: vec![[1.0, 0.0], [0.1, 1.0]],
            weights: [vec![1.0, -0.2], vec![-0.2, 1.0]],
            children,
            classes,
        }))
    };
    let [a, b, c] = [0, 1, 2].map(ClassId);
    TreeParts {
        dim: 2,
        vectors: vec![0.0, 0.0, 2.0, 0.0, 1.0, 2.0],
        nodes: vec![
            branch([vec![0], vec![1, 2]], [1, 2], [vec![a], vec![b, c]]),
            Node::Leaf(a),
            branch([vec![1], vec![2]], [3, 4], [vec![b], vec![c]]),
            Node::Leaf(b),
            Node::Leaf(c),
        ],
    }
}

fn descended(tree: &Tree, vector: &[f64], accept: f64, descent: Descent) -> ClassCandidates {
    let mut out = ClassCandidates::default();
    let acceptance = Acceptance {
        descent,
        ..Acceptance::above(accept)
    };
    tree.descend(vector, acceptance, &mut out);
    out
}

#[test]
fn reduction_is_the_inverse_of_the_factor_on_means_of_the_kernel() {
    let tree = Tree::new(parts()).unwrap();
    let Node::Branch(root) = &tree.nodes()[0] else {
        panic!("the root is a branch")
    };
    let x = [0.7, 0.2];
    let k = |row: usize| {
        (-((x[0] - parts().vectors[2 * row]).powi(2)
            + (x[1] - parts().vectors[2 * row + 1]).powi(2))
            / 0.5)
            .exp()
    };
    let reduced = tree.reduce(root, &x);
    assert!((reduced[0] * 1.0 - k(0)).abs() < 1e-15);
    assert!((reduced[0] * 0.1 + reduced[1] * 0.9 - (k(1) + k(2)) / 2.0).abs() < 1e-15);
}

#[test]
fn far_away_nothing_is_accepted() {
    let tree = Tree::new(parts()).unwrap();
    assert!(descended(&tree, &[50.0, 50.0], 0.92, Descent::Both).is_empty());
}

#[test]
fn a_leaf_is_named_with_the_least_output_on_the_way() {
    let tree = Tree::new(parts()).unwrap();
    let found = descended(&tree, &[2.0, 0.0], 0.2, Descent::Larger);
    let outputs: Vec<[f64; 2]> = tree
        .branches()
        .map(|(_, b)| tree.outputs(b, &[2.0, 0.0]))
        .collect();
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].class, ClassId(1));
    assert_eq!(found[0].output, outputs[0][1].min(outputs[1][0]));
}

#[test]
fn a_side_is_not_followed_where_the_other_machine_says_too_much() {
    let tree = Tree::new(parts()).unwrap();
    let vector = [2.0, 0.0];
    let open = descended(&tree, &vector, 0.2, Descent::Larger)[0];
    let named = |other: f64| {
        let acceptance = Acceptance {
            other: Some(other),
            ..Acceptance::above(0.2)
        };
        let mut out = ClassCandidates::default();
        tree.descend(&vector, acceptance, &mut out);
        out.first().map(|c| c.class)
    };
    assert_eq!(named(open.other + 1e-9), Some(open.class));
    assert_eq!(named(open.other - 1e-9), None);
}

#[test]
fn the_best_four_are_kept_in_order() {
    let mut all = ClassCandidates::default();
    for (class, output) in [0.3, 0.9, 0.5, 0.9, 0.1, 0.7].into_iter().enumerate() {
        all.insert(ClassCandidate {
            class: ClassId(class as u16),
            output,
            other: 0.0,
        });
    }
    let kept: Vec<(u16, f64)> = all.iter().map(|c| (c.class.0, c.output)).collect();
    assert_eq!(kept, [(1, 0.9), (3, 0.9), (5, 0.7), (2, 0.5)]);
}

#[test]
fn parts_come_back_from_json() {
    let tree = Tree::new(parts()).unwrap();
    let text = serde_json::to_string(&tree).unwrap();
    assert_eq!(serde_json::from_str::<Tree>(&text).unwrap(), tree);
    let broken = text.replacen("\"sigma_full\":0.5", "\"sigma_full\":-1", 1);
    assert!(
        serde_json::from_str::<Tree>(&broken)
            .unwrap_err()
            .to_string()
            .contains("node 0: a kernel's width")
    );
}

/// Parts, something done to their root, and what is said about it.
#[test]
fn parts_that_do_not_fit_are_refused() {
    type Damage = fn(&mut TreeParts);
    fn root(parts: &mut TreeParts) -> &mut Branch {
        match &mut parts.nodes[0] {
            Node::Branch(branch) => branch,
            Node::Leaf(_) => panic!("the root is a branch"),
        }
    }
    let cases: [(Damage, &str); 12] = [
        (|p| p.dim = 0, "at least one value"),
        (|p| p.dim = 4, "no whole rows"),
        (|p| p.vectors[0] = f64::NAN, "no whole rows"),
        (
            |p| p.nodes = vec![Node::Leaf(ClassId(0))],
            "2 to 1024 classes",
        ),
        (|p| root(p).exemplars[0] = vec![3], "not among the vectors"),
        (|p| root(p).exemplars[1] = vec![], "no exemplars"),
        (|p| root(p).factor[2] = 0.0, "diagonal"),
        (|p| root(p).weights[1].push(0.0), "do not fit"),
        (|p| root(p).children = [1, 1], "missing or shared"),
        (|p| root(p).children = [0, 2], "after its parent"),
        (|p| root(p).classes[0] = vec![ClassId(1)], "listed classes"),
        (
            |p| p.nodes.push(Node::Leaf(ClassId(7))),
            "hangs on no branch",
        ),
    ];
    for (damage, said) in cases {
        let mut parts = parts();
        damage(&mut parts);
        let error = Tree::new(parts).unwrap_err().to_string();
        assert!(error.contains(said), "{error} instead of {said}");
    }
}

proptest! {
    /// Both ways find whatever the larger way finds, and all of it was accepted at every branch.
    #[test]
    fn the_larger_way_is_one_of_both(x in -1.0f64..3.0, y in -1.0f64..3.0, accept in 0.01f64..1.0) {
        let tree = Tree::new(parts()).unwrap();
        let both = descended(&tree, &[x, y], accept, Descent::Both);
        let larger = descended(&tree, &[x, y], accept, Descent::Larger);
        prop_assert!(larger.len() <= 1);
        prop_assert!(larger.iter().all(|c| both.contains(c)));
        prop_assert!(both.iter().all(|c| c.output >= accept));
        prop_assert!(both.windows(2).all(|w| w[0].output >= w[1].output));
    }
}

proptest! {
    #[test]
    fn exemplars_side_by_side_are_those_one_by_one_to_the_bit(
        sides in prop::array::uniform2(prop::collection::vec(prop::array::uniform5(-1.0f64..1.0), 1..20)),
        vector in prop::array::uniform5(-1.0f64..1.0),
    ) {
        let kernel = Gaussian::new(0.7);
        let exemplars = [0, 1].map(|side| sides[side].iter().map(|x: &[f64; 5]| &x[..]));
        let mean = |side: &Vec<[f64; 5]>| {
            let sum = side.iter().fold(0.0, |sum, x| sum + kernel.of(x, &vector));
            sum / side.len() as f64
        };
        let (along, second) = (mean(&sides[0]) / 0.9, mean(&sides[1]));
        let expected = [along, (second - 0.2 * along) / 0.8];
        prop_assert_eq!(reduce(exemplars, [0.9, 0.2, 0.8], 0.7, &vector), expected);
    }
}
