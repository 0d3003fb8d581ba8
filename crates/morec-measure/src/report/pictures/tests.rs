use morec::train::svrdm::{FeatureSample, SigmaRule, TreeParams, grow};

use super::{branch_picture, misfit_chart, path_text, quality_chart, tree_picture};
use morec::classes::ClassId;
use morec::features::Rows;
use morec::pca::{ComponentCount, Moments, Pca};
use morec::rng::Rng;
use morec::segment::{MisfitSample, Segmentation};
use morec::svrdm::{Acceptance, Node};

/// `count` vectors around a centre, by chance.
fn cloud(rng: &mut Rng, count: usize, centre: &[f64], spread: f64) -> Vec<Vec<f64>> {
    (0..count)
        .map(|_| centre.iter().map(|c| c + spread * rng.normal()).collect())
        .collect()
}

#[test]
fn a_chart_of_quality_says_what_was_chosen() {
    let mut moments = Moments::new(2);
    moments.push_rows(&Rows::from_values(
        2,
        vec![3.0, 0.0, -3.0, 0.0, 0.0, 1.0, 0.0, -1.0],
    ));
    let pca = Pca::fit(&moments, ComponentCount::Quality(0.9)).unwrap();
    let svg = quality_chart(&pca.quality_table(), pca.dims(), "kept").svg();
    assert!(svg.contains("share of the variance") && svg.contains("chosen"));
}

#[test]
fn pictures_show_every_class_by_name_and_where_machines_accept() {
    let mut rng = Rng::new(2);
    let names: Vec<String> = ["wave", "clap", "bow & rise"].map(str::to_owned).into();
    let mut samples = vec![];
    for class in 0..3u16 {
        let vectors = cloud(
            &mut rng,
            5,
            &[f64::from(class), 0.0, f64::from(class * class)],
            0.1,
        );
        let of_class = |vector| FeatureSample {
            class: ClassId(class),
            group: 0,
            vector,
        };
        samples.extend(vectors.into_iter().map(of_class));
    }
    let params = TreeParams {
        sigma: SigmaRule::Quantile {
            full: 0.5,
            reduced: 0.5,
        },
        ..Default::default()
    };
    let tree = grow(&samples, &[], &params).unwrap().tree;
    let path = tree.path(&samples[12].vector, Acceptance::above(0.5));
    let said = path_text(&tree, &names, &path);
    assert_eq!(said.last().unwrap(), "bow & rise");
    assert!(
        said[..said.len() - 1]
            .iter()
            .all(|line| line.contains(", not ")),
        "{said:?}"
    );
    let lost = tree.path(&[90.0, 0.0, 0.0], Acceptance::above(0.5));
    assert!(path_text(&tree, &names, &lost)[0].starts_with("neither "));
    let drawn = tree_picture(&tree, &names, &path);
    assert_eq!(
        drawn.matches("stroke=\"var(--c1)\"").count(),
        path.len() - 1
    );
    assert!(
        ["wave", "clap", "bow &amp; rise"]
            .iter()
            .all(|n| drawn.contains(n))
    );
    assert_eq!(drawn.matches("class=\"box\"").count(), 5);
    let root = branch_picture(&tree, 0, &samples, &names, [0.4, 1.0]).unwrap();
    assert!(
        ["wave", "clap", "bow &amp; rise", "left ≥ 1", "right ≥ 0.4"]
            .iter()
            .all(|n| root.contains(n))
    );
    let leaf = tree
        .nodes()
        .iter()
        .position(|n| matches!(n, Node::Leaf(_)))
        .unwrap();
    assert!(
        branch_picture(&tree, leaf, &samples, &names, [0.4, 1.0]).is_none(),
        "a leaf has no plane"
    );
    assert!(branch_picture(&tree, 99, &samples, &names, [0.4, 1.0]).is_none());
}

#[test]
fn the_chart_of_misfit_shows_both_directions_and_cuts() {
    let samples = |scale: f64| {
        (0..9).map(move |i| MisfitSample {
            secs: f64::from(i),
            value: scale,
        })
    };
    let found = Segmentation {
        forward: samples(2.0).collect(),
        backward: samples(3.0).collect(),
        cuts: Vec::new(),
    };
    let svg = misfit_chart(&found, "two behaviours", &[4.0]).svg();
    for part in ["two behaviours", "forward", "backward", "cuts", "known"] {
        assert!(svg.contains(part), "{part}");
    }
    assert!(!misfit_chart(&found, "t", &[]).svg().contains("known"));
}
