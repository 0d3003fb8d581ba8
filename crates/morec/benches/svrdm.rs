//! Cost of each of the thesis's live stages: `cargo bench -p morec --bench svrdm`.
//!
//! Items are chunks of 16 frames at 120 Hz, 7.5 of which make a second, wherever a stage works chunk by chunk. The
//! model is made so that every segment is accepted and scored, which real ones never come near: 64 values a pose row,
//! 16 after projection, 10 classes of 6 samples.

// What tests share lies outside of test functions, where the lint looks for it.
#![allow(clippy::unwrap_used)]

#[path = "../tests/it/thesis.rs"]
mod thesis;

use std::sync::Arc;

use divan::Bencher;
use divan::counter::ItemsCount;
use morec::classes::{ClassId, ClassInfo};
use morec::pca::{ComponentCount, Moments, Pca};
use morec::pivots::{Pivot, PivotSet, PoseParams};
use morec::svrdm::edr::Edr;
use morec::svrdm::{
    Acceptance, Branch, Cell, Centring, ChunkAssembly, ClassCandidates, Directions, Gram, Node,
    Normalisation, Profiles, SegmentAssembly, SegmentTracking, SvrdmEngine, SvrdmModel,
    SvrdmParams, Tree, TreeParts,
};
use morec::synth::Rng;

fn main() {
    divan::main();
}

const PIVOTS: usize = 16;
const REDUCED: usize = 16;
const CLASSES: usize = 10;
const SAMPLES: usize = 6;

/// Smooth rows of `dim` values: random walks that are drawn back.
fn rows(seed: u64, count: usize, dim: usize) -> Vec<Vec<f32>> {
    let mut rng = Rng::new(seed);
    let (mut place, mut speed) = (vec![0.0; dim], vec![0.0; dim]);
    let mut row = || {
        for i in 0..dim {
            speed[i] =
                0.98 * speed[i] + 0.004 * rng.normal() / (1.0 + i as f64 / 8.0) - 0.002 * place[i];
            place[i] += speed[i];
        }
        place.iter().map(|v| *v as f32).collect()
    };
    (0..count).map(|_| row()).collect()
}

/// Ten classes below each other's branches; wide kernels accept everything, to the first side.
fn tree(dim: usize, rng: &mut Rng) -> Tree {
    let exemplars = 4;
    let mut nodes = vec![];
    for class in 0..CLASSES - 1 {
        let first = 2 * (class * exemplars) as u32;
        let side = |from: u32| (from..from + exemplars as u32).collect();
        let at = nodes.len() as u32;
        nodes.push(Node::Branch(Box::new(Branch {
            sigma_full: 1.0,
            exemplars: [side(first), side(first + exemplars as u32)],
            factor: [1.0, 0.5, 0.8],
            sigma_reduced: 1000.0,
            points: (0..60).map(|_| [rng.unit(), rng.unit()]).collect(),
            weights: [vec![1.0 / 60.0; 60], vec![1.01 / 60.0; 60]],
            children: [at + 1, at + 2],
            classes: [
                vec![ClassId(class as u16)],
                (class + 1..CLASSES).map(|c| ClassId(c as u16)).collect(),
            ],
        })));
        nodes.push(Node::Leaf(ClassId(class as u16)));
    }
    nodes.push(Node::Leaf(ClassId(CLASSES as u16 - 1)));
    let vectors = (0..2 * exemplars * (CLASSES - 1) * dim)
        .map(|_| rng.unit())
        .collect();
    Tree::new(TreeParts {
        dim,
        vectors,
        nodes,
    })
    .unwrap()
}

fn model() -> Arc<SvrdmModel> {
    let params = SvrdmParams::default();
    let mut moments = Moments::new(4 * PIVOTS);
    moments.push_values(&rows(1, 2000, 4 * PIVOTS).concat());
    let pca = Pca::fit(&moments, ComponentCount::Dims(REDUCED)).unwrap();
    let mut rng = Rng::new(2);
    let mut profiles = Profiles::new(1);
    for sample in 0..CLASSES * SAMPLES {
        let frames = 90 + rng.below(150);
        let values: Vec<f32> = rows(100 + sample as u64, frames, 1).concat();
        profiles.push(ClassId((sample / SAMPLES) as u16), &values);
    }
    let name = |index: usize| format!("pivot {index}");
    let pivot = |i: usize| Pivot {
        name: name(i),
        parent: i.checked_sub(1).map(name),
        joints: vec![],
        role: None,
    };
    Arc::new(SvrdmModel {
        classes: (0..CLASSES)
            .map(|c| ClassInfo {
                name: c.to_string(),
                samples: SAMPLES,
                people: 0,
            })
            .collect(),
        pivots: PivotSet::new((0..PIVOTS).map(pivot).collect()).unwrap(),
        pose: PoseParams::default(),
        pca,
        signs: (0..params.feature_dim(REDUCED))
            .map(|_| rng.unit() - 0.5)
            .collect(),
        tree: tree(params.feature_dim(REDUCED), &mut rng),
        mean_secs: vec![1.0; CLASSES],
        epsilon: profiles.epsilon(params.tolerance),
        profiles,
        params,
    })
}

/// Rows of 16 values summed up to a chunk.
#[divan::bench]
fn chunk_assembly(bencher: Bencher) {
    let rows = rows(3, 16, REDUCED);
    let mut chunks = ChunkAssembly::new(&SvrdmParams::default(), REDUCED);
    bencher
        .counter(ItemsCount::new(1usize))
        .bench_local(|| rows.iter().filter(|row| chunks.push(row)).count());
}

/// Seventeen sums of the last 4 to 20 chunks.
#[divan::bench]
fn segment_assembly(bencher: Bencher) {
    let chunk = Gram::of_rows(&rows(3, 16, REDUCED).concat(), REDUCED, 16);
    let mut segments = SegmentAssembly::new(&SvrdmParams::default(), REDUCED);
    bencher.counter(ItemsCount::new(1usize)).bench_local(|| {
        let mut sum = 0.0;
        segments.push(&chunk, &mut |_, gram| sum += gram.product(0, 0));
        sum
    });
}

/// The first two directions of one segment.
#[divan::bench(args = [8, 16, 24])]
fn directions(bencher: Bencher, dim: usize) {
    let gram = Gram::of_rows(&rows(3, 192, dim).concat(), dim, 16);
    let mut directions = Directions::new(2, dim);
    bencher.bench_local(|| directions.find(&gram, Centring::Database));
}

/// One way down a tree of ten classes.
#[divan::bench]
fn descent(bencher: Bencher) {
    let model = model();
    let (vector, mut found) = (vec![0.5; model.tree.dim()], ClassCandidates::default());
    bencher.bench_local(|| {
        model
            .tree
            .descend(&vector, Acceptance::above(0.92), &mut found);
        found.len()
    });
}

/// One edit distance of 192 and 150 values, without bound; items are cells of the table.
#[divan::bench(args = [Normalisation::CheapestPath, Normalisation::LeastRatio])]
fn edit_distance(bencher: Bencher, normalisation: Normalisation) {
    let (r, s) = (rows(5, 192, 1).concat(), rows(6, 150, 1).concat());
    let mut edr = Edr::new(0.05, 256);
    bencher
        .counter(ItemsCount::new(192usize * 150))
        .bench_local(|| edr.normalised(&r, &s, normalisation, 2.0));
}

/// A column of 17 confidences, a maximum in most.
#[divan::bench]
fn tracking(bencher: Bencher) {
    let params = SvrdmParams::default();
    let mut rng = Rng::new(7);
    let mut column = || -> Vec<Cell> {
        (0..17)
            .map(|_| Cell {
                class: ClassId(0),
                confidence: rng.unit(),
            })
            .collect()
    };
    let columns: Vec<Vec<Cell>> = (0..64).map(|_| column()).collect();
    let mut tracking = SegmentTracking::new(&params, vec![1.0; 17]);
    bencher
        .counter(ItemsCount::new(columns.len()))
        .bench_local(|| {
            let mut found = 0;
            columns
                .iter()
                .for_each(|column| tracking.push(column, &mut |_| found += 1));
            found
        });
}

/// Number of detections as rows come.
fn pushed(rows: &[Vec<f32>], engine: &mut SvrdmEngine) -> usize {
    let mut found = 0;
    rows.iter()
        .for_each(|row| engine.push(row, &mut |_| found += 1));
    found
}

/// Rows to detections where every segment is accepted.
#[divan::bench]
fn all_accepted(bencher: Bencher) {
    let (rows, mut engine) = (
        rows(8, 640, 4 * PIVOTS),
        SvrdmEngine::new(&model()).unwrap(),
    );
    bencher
        .counter(ItemsCount::new(rows.len() / 16))
        .bench_local(|| pushed(&rows, &mut engine));
}

/// Rows to detections as the reference stream has them: five values after projection, a tenth accepted.
#[divan::bench]
fn reference_stream(bencher: Bencher) {
    let reference = thesis::reference();
    let (rows, model) = (reference.rows(), reference.model(&reference.models[0]));
    let mut engine = SvrdmEngine::new(&model).unwrap();
    bencher
        .counter(ItemsCount::new(rows.len() / 16))
        .bench_local(|| {
            let mut found = pushed(&rows, &mut engine);
            engine.finish(&mut |_| found += 1);
            found
        });
}
