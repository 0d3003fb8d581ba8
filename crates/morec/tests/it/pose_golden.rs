//! Pose rows, components, kWAS and PPCA are those of the script beside their figures; see
//! `testdata/reference/README.md`.

use std::collections::BTreeMap;
use std::path::Path;

use morec::cluster::{KwasForm, Spectrum, kwas};
use morec::features::Rows;
use morec::pca::{ComponentCount, Moments, Pca};
use morec::pivots::{PivotMap, PivotSet, PoseParams, pose_rows_of_clip};
use morec::segment::{PassDirections, PpcaParams, segment};
use morec::train::StreamKind;

use crate::kit;

#[derive(serde::Deserialize)]
struct Golden {
    clips: Vec<String>,
    pose_rows: BTreeMap<String, Vec<Vec<f64>>>,
    pca: Components,
    samples: Vec<(String, usize, usize)>,
    kwas: Vec<(usize, usize, f64)>,
    ppca: BTreeMap<String, Distances>,
}

#[derive(serde::Deserialize)]
struct Components {
    rows: u64,
    eigenvalues: Vec<f64>,
    dims: BTreeMap<String, usize>,
}

#[derive(serde::Deserialize)]
struct Distances {
    h: Vec<(usize, f64)>,
}

fn golden() -> Golden {
    serde_json::from_str(include_str!("../../testdata/reference/pose_rows.json")).unwrap()
}

fn rows(data: &Path, name: &str) -> Rows {
    let clip = kit::referee(data, name, StreamKind::Labelled);
    let set = PivotSet::thesis();
    let map = PivotMap::resolve(&set, &clip.clip.skeleton, &clip.roles).unwrap();
    assert_eq!(map.missing().len(), 0);
    pose_rows_of_clip(&clip.clip, &set, &map, &clip.rest, &PoseParams::default())
}

fn components(rows: &BTreeMap<String, Rows>, keep: ComponentCount) -> Pca {
    let mut moments = Moments::new(64);
    rows.values().for_each(|rows| moments.push_rows(rows));
    Pca::fit(&moments, keep).unwrap()
}

#[test]
fn pose_rows_and_components_and_similarities_are_the_scripts() {
    let Some(data) = kit::data() else { return };
    let golden = golden();
    let rows: BTreeMap<String, Rows> = golden
        .clips
        .iter()
        .map(|n| (n.clone(), rows(&data, n)))
        .collect();
    for (name, expected) in &golden.pose_rows {
        let found = (100..).flat_map(|i| rows[name].row(i).to_vec());
        for (found, expected) in found.zip(expected.iter().flatten()) {
            assert!(
                (f64::from(found) - expected).abs() < 1e-6,
                "{name}: {found} for {expected}"
            );
        }
    }
    let pca = components(&rows, ComponentCount::Dims(16));
    assert_eq!(pca.rows(), golden.pca.rows);
    for (found, expected) in pca.eigenvalues().iter().zip(&golden.pca.eigenvalues) {
        assert!(
            (found / expected - 1.0).abs() < 1e-5,
            "{found} for {expected}"
        );
    }
    for (quality, dims) in &golden.pca.dims {
        let keep = ComponentCount::Quality(quality.parse().unwrap());
        assert_eq!(components(&rows, keep).dims(), *dims, "{quality}");
    }
    let cut = |(clip, start, stop): &(String, usize, usize)| {
        Spectrum::of_rows(&pca.project(&rows[clip].slice(*start..*stop)))
    };
    let spectra: Vec<Spectrum> = golden.samples.iter().map(cut).collect();
    assert!(golden.kwas.len() > 50);
    for (a, b, expected) in &golden.kwas {
        let found = kwas(&spectra[*a], &spectra[*b], 12, KwasForm::Printed);
        assert!(
            (found - expected).abs() < 1e-4,
            "{a} and {b}: {found} for {expected}"
        );
    }
}

#[test]
fn distances_ahead_are_those_of_the_whole_inverse() {
    let Some(data) = kit::data() else { return };
    for (name, expected) in golden().ppca {
        // A rise that nothing reaches: one segment from the start, as in the script.
        let params = PpcaParams {
            rise: 1e12,
            directions: PassDirections::Forward,
            ..PpcaParams::default()
        };
        let found = segment(&rows(&data, &name), 120.0, &params).unwrap();
        assert_eq!(found.forward.len(), expected.h.len(), "{name}");
        for (point, (row, h)) in found.forward.iter().zip(&expected.h) {
            assert!((point.secs * 120.0 - *row as f64).abs() < 1e-6);
            assert!(
                (point.value / h - 1.0).abs() < 1e-3,
                "{name} at {row}: {} for {h}",
                point.value
            );
        }
    }
}
