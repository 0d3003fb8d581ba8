//! The live stages of the thesis against its prototype, and on streams without end.

use std::collections::BTreeMap;
use std::sync::Arc;

use morec::svrdm::{
    ConfidenceMap, FeatureExtraction, FrameDetection, Gram, ModelError, SegmentScoring,
    SvrdmEngine, SvrdmModel,
};
use proptest::prelude::*;

use crate::thesis::reference;

fn recognised(engine: &mut SvrdmEngine, rows: &[Vec<f32>]) -> Vec<FrameDetection> {
    let mut found = vec![];
    rows.iter()
        .for_each(|row| engine.push(row, &mut |d| found.push(d)));
    engine.finish(&mut |d| found.push(d));
    found
}

/// The rows of some chunks after projection, end to end.
fn reduced(model: &SvrdmModel, rows: &[Vec<f32>], start: i64, stop: i64) -> Vec<f32> {
    let frames =
        start as usize * model.params.chunk_frames..stop as usize * model.params.chunk_frames;
    let mut out = vec![0.0; frames.len() * model.pca.dims()];
    for (row, out) in rows[frames]
        .iter()
        .zip(out.chunks_exact_mut(model.pca.dims()))
    {
        model.pca.project_into(row, out);
    }
    out
}

#[test]
fn feature_vectors_are_the_prototypes() {
    let reference = reference();
    let rows = reference.rows();
    for figures in &reference.models {
        let model = reference.model(figures);
        let mut extraction = FeatureExtraction::new(&model.params, model.pca.dims(), &model.signs);
        assert!(figures.features.len() > 50);
        for (start, stop, expected) in &figures.features {
            let rows = reduced(&model, &rows, *start, *stop);
            let segment = Gram::of_rows(&rows, model.pca.dims(), model.params.chunk_frames);
            let found = extraction.feature(&segment).unwrap();
            for (found, expected) in found.iter().zip(expected) {
                assert!(
                    (found - expected).abs() < 1e-6,
                    "{start}..{stop}: {found} for {expected}"
                );
            }
        }
    }
}

#[test]
fn the_map_and_its_detections_are_the_prototypes() {
    let reference = reference();
    let rows = reference.rows();
    for figures in &reference.models {
        let model = reference.model(figures);
        let mut engine = SvrdmEngine::new(&model).unwrap();
        let (mut map, mut found) = (ConfidenceMap::new(), vec![]);
        for row in &rows {
            let mut watch = |window, cell| map.record(window, cell);
            engine.push_with_observer(row, &mut watch, &mut |d| found.push(d));
        }
        engine.finish(&mut |d| found.push(d));
        assert_eq!(map.cells().len(), figures.cells.len());
        for ((window, cell), (start, stop, class, confidence)) in
            map.cells().iter().zip(&figures.cells)
        {
            assert_eq!(
                (window.start, window.stop, cell.class.0),
                (*start, *stop, *class)
            );
            assert!(
                (cell.confidence - confidence).abs() < 1e-9,
                "{window:?}: {} for {confidence}",
                cell.confidence
            );
        }
        found.sort_by_key(|d| d.start);
        assert_eq!(found.len(), figures.detections.len());
        for (d, (start, stop, class, score)) in found.iter().zip(&figures.detections) {
            assert_eq!((d.start, d.stop, d.class.0), (*start, *stop, *class));
            assert!((d.score - score).abs() < 1e-9);
        }
    }
}

#[test]
fn what_counts_for_little_can_be_left_out_beforehand() {
    let reference = reference();
    let rows = reference.rows();
    for figures in &reference.models {
        let all = recognised(
            &mut SvrdmEngine::new(&reference.model(figures)).unwrap(),
            &rows,
        );
        let mut model = SvrdmModel::clone(&reference.model(figures));
        model.params.min_confidence = 0.85;
        let mut few = recognised(&mut SvrdmEngine::new(&Arc::new(model)).unwrap(), &rows);
        few.sort_by_key(|d| d.start);
        let mut expected: Vec<_> = all.into_iter().filter(|d| d.score >= 0.85).collect();
        expected.sort_by_key(|d| d.start);
        assert!(expected.len() > 5);
        assert_eq!(few, expected);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 6, failure_persistence: None, ..Default::default() })]

    #[test]
    fn a_used_engine_is_as_good_as_new_and_a_copy_as_good_as_the_original(at in 0usize..2400) {
        let reference = reference();
        let (rows, model) = (reference.rows(), reference.model(&reference.models[0]));
        let expected = recognised(&mut SvrdmEngine::new(&model).unwrap(), &rows);
        let mut used = SvrdmEngine::new(&model).unwrap();
        let mut begun = vec![];
        rows[..at].iter().for_each(|row| used.push(row, &mut |d| begun.push(d)));
        let mut copy = used.clone();
        begun.extend(recognised(&mut copy, &rows[at..]));
        prop_assert_eq!(&begun, &expected);
        used.reset();
        prop_assert_eq!(&recognised(&mut used, &rows), &expected);
        prop_assert_eq!(&recognised(&mut copy, &rows), &expected);
    }
}

/// A million rows: the same two thousand again and again give the same detections again and again, to the bit.
#[test]
fn a_stream_without_end_keeps_its_precision() {
    let reference = reference();
    let (rows, model) = (reference.rows(), reference.model(&reference.models[0]));
    let mut model = SvrdmModel::clone(&model);
    // Long chunks and few lengths: with the thesis's, the test would take twenty times as long.
    model.params = morec::svrdm::SvrdmParams {
        chunk_frames: 64,
        min_chunks: 2,
        max_chunks: 4,
        ..model.params
    };
    let mut engine = SvrdmEngine::new(&Arc::new(model)).unwrap();
    let period = rows.len() / 64 * 64;
    let mut by_round: BTreeMap<i64, Vec<(i64, i64, u16, f64)>> = BTreeMap::new();
    for row in rows[..period].iter().cycle().take(1_000_000) {
        engine.push(row, &mut |d| {
            let round = d.start / period as i64;
            let shift = round * period as i64;
            by_round.entry(round).or_default().push((
                d.start - shift,
                d.stop - shift,
                d.class.0,
                d.score,
            ));
        });
    }
    assert!(by_round[&1].len() > 3);
    let whole = 1_000_000 / period as i64 - 1;
    for round in 2..whole {
        assert_eq!(by_round[&round], by_round[&1], "round {round}");
    }
}

#[test]
fn a_model_comes_back_from_its_words() {
    let reference = reference();
    let model = reference.model(&reference.models[1]);
    let words = serde_json::to_string(&*model).unwrap();
    assert_eq!(serde_json::from_str::<SvrdmModel>(&words).unwrap(), *model);
}

#[test]
fn parts_that_do_not_fit_are_refused() {
    let reference = reference();
    let good = reference.model(&reference.models[0]);
    assert_eq!(good.check(), Ok(()));
    let wrong = |change: fn(&mut SvrdmModel)| {
        let mut model = SvrdmModel::clone(&good);
        change(&mut model);
        assert!(SegmentScoring::new(&model).is_err());
        SvrdmEngine::new(&Arc::new(model)).map(|_| ()).unwrap_err()
    };
    let size = |what, expected, found| ModelError::Size {
        what,
        expected,
        found,
    };
    assert_eq!(
        wrong(|m| m.signs.truncate(9)),
        size("values in the sign vectors", 10, 9)
    );
    assert_eq!(
        wrong(|m| m.mean_secs.truncate(4)),
        size("mean lengths of classes", 5, 4)
    );
    assert_eq!(
        wrong(|m| m.profiles.classes.truncate(3)),
        size("classes of profiles", 25, 3)
    );
    assert!(
        wrong(|m| m.params.eigenvectors = 3)
            .to_string()
            .starts_with("values in the sign vectors")
    );
    let message = |change| wrong(change).to_string();
    assert!(message(|m| m.profiles.lengths[0] -= 1).contains("values of profiles"));
    assert!(message(|m| m.profiles.lengths[0] = 0).contains("1 to 2047 frames, found 0"));
    assert!(message(|m| m.profiles.lengths.fill(usize::MAX)).contains("1 to 2047 frames"));
    assert!(message(|m| m.profiles.values[7] = f32::NAN).contains("not finite"));
    assert!(
        message(|m| m.profiles.classes.fill(morec::classes::ClassId(1)))
            .contains("class 0 has no profile")
    );
    assert!(message(|m| m.profiles.classes[0].0 = 9).contains("class 9, of 5"));
    assert!(message(|m| m.epsilon = -1.0).contains("epsilon"));
    assert!(message(|m| m.mean_secs[2] = 0.0).contains("mean length"));
}
