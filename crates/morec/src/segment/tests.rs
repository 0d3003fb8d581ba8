use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

use super::peaks::Peaks;
use super::*;
use crate::features::Rows;
use crate::pca::{ComponentCount, Moments};

fn values(dim: usize, len: usize) -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-1.0f64..1.0, dim * len)
}

/// Three directions of large spread in `dim`, the rest small: what motion looks like.
fn motion(dim: usize, noise: Vec<f64>) -> Vec<f64> {
    let spread = |k: usize| [3.0, 2.0, 1.0].get(k).copied().unwrap_or(0.1);
    noise
        .iter()
        .enumerate()
        .map(|(i, v)| v * spread(i % dim) + if i % dim == 1 { 5.0 } else { 0.0 })
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..Default::default() })]

    /// Closed form against the inverse of the covariance as written in Eq. 3.15 and 3.16.
    #[test]
    fn the_distance_is_that_of_the_inverse_covariance(
        noise in values(6, 40), row in values(6, 1), dims in 1usize..6, extra in 0usize..4
    ) {
        let rows = motion(6, noise);
        let mut moments = Moments::new(6);
        moments.push_values(&rows);
        let space = 6 + extra;
        let model = Ppca::fit(&moments, ComponentCount::Dims(dims), space, 1e-12);
        // By hand: eigenvalues of the covariance, those past r replaced by their mean over n - r.
        let all = DMatrix::from_row_slice(40, 6, &rows);
        let mean = all.row_mean();
        let centred = DMatrix::from_fn(40, 6, |i, k| all[(i, k)] - mean[k]);
        let eigen = ((centred.transpose() * &centred) / 39.0).symmetric_eigen();
        let mut order: Vec<usize> = (0..6).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
        let lambda = order[dims..].iter().map(|&i| eigen.eigenvalues[i]).sum::<f64>() / (space - dims) as f64;
        let mut c = DMatrix::zeros(6, 6);
        for (place, &i) in order.iter().enumerate() {
            let v = eigen.eigenvectors.column(i);
            // With extra dimensions the mean may lie above a kept eigenvalue's: not below r.
            c += v * v.transpose() * if place < dims { eigen.eigenvalues[i].max(lambda) } else { lambda };
        }
        let d = DVector::from_fn(6, |k, _| row[k] - mean[k]);
        let expected = (d.transpose() * c.clone().try_inverse().unwrap() * &d)[(0, 0)];
        let found = model.distance(&row);
        prop_assert!((found - expected).abs() < 1e-7 * expected.max(1.0), "{found} for {expected}");
        prop_assert!((model.covariance() - c).amax() < 1e-9);
    }

    /// Rows that fit lie at a mean distance of n, the trace of the identity: of the model's own rows, n (m - 1) / m.
    #[test]
    fn rows_of_the_model_lie_at_n(noise in values(5, 60)) {
        let rows = motion(5, noise);
        let mut moments = Moments::new(5);
        moments.push_values(&rows);
        let model = Ppca::fit(&moments, ComponentCount::Dims(3), 5, 1e-12);
        prop_assert!((model.mean_distance(&rows) - 5.0 * 59.0 / 60.0).abs() < 1e-6);
    }

    #[test]
    fn the_first_high_peak_is_found(
        series in prop::collection::vec(0.0f64..10.0, 0..40), rise in 1.0f64..8.0, fall in 0.0f64..1.0
    ) {
        let mut peaks = Peaks::new(rise, fall);
        let found = series.iter().enumerate().find_map(|(i, v)| peaks.push(i, *v));
        // As defined: the first end at which a peak counts, over every valley and peak before it.
        let expected = (0..series.len()).find_map(|end| {
            let begin = (0..end).find(|&i| series[i] > least(&series[..i]) + rise)?;
            let valley = least(&series[..begin]);
            let top = (begin..end).fold(begin, |top, i| if series[i] > series[top] { i } else { top });
            let fallen = series[end] <= series[top] && series[end] < series[top] - fall * (series[top] - valley);
            fallen.then_some(top)
        });
        prop_assert_eq!(found, expected);
    }
}

fn least(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::INFINITY, f64::min)
}

/// Behaviours of `secs` each: cyclic motion, each in planes of its own, with a little noise.
fn behaviours(secs: &[f64], rate_hz: f64) -> Rows {
    let mut rows = Rows::new(12);
    let (mut frame, mut state) = (0, 7u64);
    for (number, secs) in secs.iter().enumerate() {
        for _ in 0..(secs * rate_hz).round() as usize {
            // Each at a pace of its own, so that two at once are of more dimensions than one.
            let period_secs = 0.9 + 0.2 * (number % 3) as f64;
            let phase = frame as f64 / rate_hz * std::f64::consts::TAU / period_secs;
            let row: Vec<f32> = (0..12)
                .map(|k| {
                    state = state
                        .wrapping_mul(6_364_136_223_846_793_005)
                        .wrapping_add(1_442_695_040_888_963_407);
                    let noise = (state >> 33) as f64 / f64::from(1u32 << 31) - 0.5;
                    let own = k / 4 == number % 3;
                    let swing = if own {
                        0.4 * (phase + k as f64).sin()
                    } else {
                        0.0
                    };
                    (swing + 0.02 * noise) as f32
                })
                .collect();
            rows.push(&row);
            frame += 1;
        }
    }
    rows
}

#[test]
fn behaviours_are_cut_apart_and_cycles_are_not() {
    for rate_hz in [120.0, 60.0] {
        let found = segment(
            &behaviours(&[4.0, 5.0, 4.5], rate_hz),
            rate_hz,
            &PpcaParams::default(),
        )
        .unwrap();
        let times: Vec<f64> = found.cuts.iter().map(|c| c.secs).collect();
        assert_eq!(times.len(), 2, "{times:?}");
        assert!(
            (times[0] - 4.0).abs() < 0.2 && (times[1] - 9.0).abs() < 0.2,
            "{times:?}"
        );
        assert!(
            found
                .cuts
                .iter()
                .all(|c| c.row as f64 / rate_hz == c.secs && c.forward)
        );
        assert!(!found.forward.is_empty() && !found.backward.is_empty());
    }
    let one = segment(&behaviours(&[12.0], 120.0), 120.0, &PpcaParams::default()).unwrap();
    assert_eq!(one.cuts, []);
}

#[test]
fn going_back_notices_what_ceases() {
    // All planes move, then one alone: nothing new to a model of the former.
    let (all, one) = (
        behaviours(&[5.0, 5.0, 5.0], 120.0),
        behaviours(&[5.0], 120.0),
    );
    let mut rows = Rows::new(12);
    for i in 0..600 {
        let sum: Vec<f32> = (0..12)
            .map(|k| all.row(i)[k] + all.row(600 + i)[k])
            .collect();
        rows.push(&sum);
    }
    one.iter().for_each(|row| rows.push(row));
    let cut = |directions| {
        let found = segment(
            &rows,
            120.0,
            &PpcaParams {
                directions,
                ..PpcaParams::default()
            },
        )
        .unwrap();
        found.cuts.iter().map(|c| c.secs).collect::<Vec<_>>()
    };
    assert_eq!(cut(PassDirections::Forward), [] as [f64; 0]);
    let back = cut(PassDirections::Backward);
    assert!(back.len() == 1 && (back[0] - 5.0).abs() < 0.2, "{back:?}");
    assert_eq!(cut(PassDirections::Both), back);
}

#[test]
fn little_and_nothing_have_no_cut() {
    for secs in [0.0, 0.02, 1.0, 2.4] {
        let found = segment(&behaviours(&[secs], 120.0), 120.0, &PpcaParams::default()).unwrap();
        assert_eq!((found.cuts.len(), found.forward.len()), (0, 0));
    }
    let still = Rows::from_values(4, vec![0.5; 4 * 1000]);
    assert_eq!(
        segment(&still, 120.0, &PpcaParams::default()).unwrap().cuts,
        []
    );
}

#[test]
fn what_makes_no_sense_is_refused() {
    let rows = behaviours(&[3.0], 120.0);
    let with = |params: PpcaParams| segment(&rows, 120.0, &params).unwrap_err().to_string();
    let error = with(PpcaParams {
        step_secs: 0.0,
        ..PpcaParams::default()
    });
    assert_eq!(error, "step_secs must be above 0, found 0");
    let error = with(PpcaParams {
        quality: 1.5,
        ..PpcaParams::default()
    });
    assert_eq!(error, "quality must be above 0 and at most 1, found 1.5");
    assert!(matches!(
        segment(&rows, f64::NAN, &PpcaParams::default()),
        Err(SegmentError::Rate(_))
    ));
    let spoilt = Rows::from_values(1, vec![0.0, f32::NAN]);
    let error = segment(&spoilt, 120.0, &PpcaParams::default()).unwrap_err();
    assert_eq!(error, SegmentError::NotFinite { row: 1 });
}
