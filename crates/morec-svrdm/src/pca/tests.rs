use nalgebra::DMatrix;
use proptest::prelude::*;

use super::{ComponentCount, Eigen, Moments, Pca, PcaError};
use morec_features::Rows;

/// Rows about a mean that may be far from 0.
fn rows() -> impl Strategy<Value = Rows> {
    (1usize..7, 8usize..90, -50f32..50.0).prop_flat_map(|(dim, len, far)| {
        prop::collection::vec(-1f32..1.0, dim * len).prop_map(move |values| {
            Rows::from_values(dim, values.into_iter().map(|value| far + value).collect())
        })
    })
}

/// Centred rows as a matrix, rows × dim, in double precision.
fn centred(rows: &Rows) -> DMatrix<f64> {
    let all = DMatrix::from_fn(rows.len(), rows.dim(), |i, k| f64::from(rows.row(i)[k]));
    let mean = all.row_mean();
    DMatrix::from_fn(rows.len(), rows.dim(), |i, k| all[(i, k)] - mean[k])
}

fn moments(rows: &Rows) -> Moments {
    let mut moments = Moments::new(rows.dim());
    moments.push_rows(rows);
    moments
}

proptest! {
    #[test]
    fn eigenvalues_and_projections_are_those_of_the_svd(rows in rows()) {
        let pca = Pca::fit(&moments(&rows), ComponentCount::Quality(1.0)).unwrap();
        let a = centred(&rows);
        let svd = a.clone().svd(false, true);
        let v = svd.v_t.unwrap().transpose();
        let scale = svd.singular_values[0];
        for i in 0..pca.dims() {
            let sigma = svd.singular_values[i];
            prop_assert!((pca.eigenvalues()[i] - sigma * sigma).abs() < 1e-9 * scale * scale);
        }
        // Single axes are unique only where eigenvalues are apart; squared lengths of what projections keep are
        // for any set of leading axes: compare the whole.
        let projected = pca.project(&rows);
        for i in 0..rows.len() {
            let kept: f64 = projected.row(i).iter().map(|z| f64::from(*z).powi(2)).sum();
            let expected: f64 = (a.row(i) * v.columns(0, pca.dims())).norm_squared();
            prop_assert!((kept - expected).abs() < 1e-4, "{kept} for {expected}");
        }
    }

    #[test]
    fn all_dimensions_give_the_rows_back(rows in rows()) {
        let pca = Pca::fit(&moments(&rows), ComponentCount::Dims(99)).unwrap();
        let back = pca.reconstruct(&pca.project(&rows));
        for (a, b) in rows.values().iter().zip(back.values()) {
            prop_assert!((a - b).abs() < 1e-4);
        }
    }

    #[test]
    fn pieces_and_merged_halves_give_the_moments_of_the_whole(rows in rows(), at in 0.0f64..1.0, step in 1usize..9) {
        let (whole, dim) = (moments(&rows), rows.dim());
        let cut = (at * rows.len() as f64) as usize * dim;
        let mut first = Moments::new(dim);
        rows.values()[..cut].chunks(step * dim).for_each(|piece| first.push_values(piece));
        let mut second = Moments::new(dim);
        second.push_values(&rows.values()[cut..]);
        first.merge(&second);
        prop_assert_eq!(first.count(), rows.len() as u64);
        let a = centred(&rows);
        let direct = a.transpose() * &a;
        let scale = direct.trace();
        prop_assert!((first.scatter() - &direct).amax() < 1e-11 * scale);
        prop_assert!((whole.scatter() - &direct).amax() < 1e-11 * scale);
        prop_assert!((first.total() - scale).abs() < 1e-11 * scale);
    }

    #[test]
    fn axes_do_not_depend_on_the_sign_a_solver_gave(rows in rows()) {
        let pca = Pca::fit(&moments(&rows), ComponentCount::Quality(1.0)).unwrap();
        for i in 0..pca.dims() {
            let axis = pca.axis(i);
            let greatest = axis.iter().copied().fold(0.0, |m: f64, v| if v.abs() > m.abs() { v } else { m });
            prop_assert!(greatest > 0.0);
            prop_assert_eq!(Eigen::canonical_sign(axis.iter().copied()), 1.0);
            prop_assert_eq!(Eigen::canonical_sign(axis.iter().map(|v| -v)), -1.0);
        }
    }

    #[test]
    fn quality_asks_for_as_few_dimensions_as_hold_it(
        mut values in prop::collection::vec(0.0f64..9.0, 1..12), share in 0.01f64..1.0
    ) {
        values.sort_by(|a, b| b.total_cmp(a));
        values[0] += 0.1;
        let all: f64 = values.iter().sum();
        let kept = |dims: usize| values[..dims].iter().sum::<f64>() / all;
        let dims = ComponentCount::Quality(share).dims(&values);
        prop_assert!(kept(dims) >= share - 1e-9);
        prop_assert!(dims == 1 || kept(dims - 1) < share + 1e-9);
    }
}

/// Rows on two axes of known spread: 3 along (1, 1, 0), 1 along (0, 0, 1), about (5, 6, 7).
fn cross() -> Rows {
    let half = std::f32::consts::FRAC_1_SQRT_2 * 3.0;
    Rows::from_values(
        3,
        vec![
            5.0 + half,
            6.0 + half,
            7.0,
            5.0 - half,
            6.0 - half,
            7.0,
            5.0,
            6.0,
            8.0,
            5.0,
            6.0,
            6.0,
        ],
    )
}

#[test]
fn known_axes_are_found() {
    let pca = Pca::fit(&moments(&cross()), ComponentCount::Quality(0.9)).unwrap();
    assert_eq!((pca.dims(), pca.rows()), (1, 4));
    assert!((pca.quality() - 0.9).abs() < 1e-6);
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let apart: f64 = pca
        .axis(0)
        .iter()
        .zip([half, half, 0.0])
        .map(|(a, b)| (a - b).abs())
        .sum();
    assert!(apart < 1e-6);
    let table = pca.quality_table();
    assert_eq!(table.len(), 3);
    assert!((table[1].quality - 1.0).abs() < 1e-6 && (table[1].eigenvalue - 2.0).abs() < 1e-5);
    assert!((pca.project(&cross()).row(0)[0] - 3.0).abs() < 1e-5);
    assert!((pca.mean()[2] - 7.0).abs() < 1e-12);
    // What one dimension loses: 1 twice, of twelve values.
    assert!((pca.rms_error() - (2.0f64 / 12.0).sqrt()).abs() < 1e-6);
}

#[test]
fn what_has_no_components_is_refused() {
    let fit = |rows: &Rows, keep| Pca::fit(&moments(rows), keep);
    let one = Rows::from_values(2, vec![1.0, 2.0]);
    assert_eq!(
        fit(&one, ComponentCount::Dims(1)),
        Err(PcaError::TooFewRows { found: 1 })
    );
    let alike = Rows::from_values(1, vec![0.25; 5]);
    assert_eq!(
        fit(&alike, ComponentCount::Dims(1)),
        Err(PcaError::NoVariance { rows: 5 })
    );
    assert_eq!(
        fit(
            &Rows::from_values(1, vec![1.0, f32::NAN]),
            ComponentCount::Dims(1)
        ),
        Err(PcaError::NotFinite)
    );
    for keep in [
        ComponentCount::Dims(0),
        ComponentCount::Quality(0.0),
        ComponentCount::Quality(1.5),
        ComponentCount::Quality(f64::NAN),
    ] {
        assert!(matches!(fit(&cross(), keep), Err(PcaError::Keep(_))));
    }
}

#[test]
fn what_was_stored_comes_back_and_is_checked() {
    let pca = Pca::fit(&moments(&cross()), ComponentCount::Dims(2)).unwrap();
    let text = serde_json::to_string(&pca).unwrap();
    assert_eq!(serde_json::from_str::<Pca>(&text).unwrap(), pca);
    for spoilt in [
        r#"{"mean":[0],"axes":[],"eigenvalues":[1],"rows":3}"#,
        r#"{"mean":[0,0],"axes":[1,0,0],"eigenvalues":[2,1],"rows":3}"#,
        r#"{"mean":[0,0],"axes":[1,0],"eigenvalues":[2],"rows":3}"#,
        r#"{"mean":[0,0],"axes":[1,0],"eigenvalues":[1,2],"rows":3}"#,
    ] {
        let error = serde_json::from_str::<Pca>(spoilt).unwrap_err().to_string();
        assert!(error.contains("do not fit together"), "{error}");
    }
}
