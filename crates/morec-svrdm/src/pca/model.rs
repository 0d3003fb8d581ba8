//! The fitted analysis: fewer dimensions and back.

use morec_features::Rows;
use multiversion::multiversion;

use super::{ComponentCount, Eigen, Moments, QualityRow};

/// Principal components of a database's rows: centre, axes, and what each axis is worth.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(try_from = "PcaParts", into = "PcaParts")]
pub struct Pca {
    /// `D` values.
    mean: Vec<f64>,
    /// `r × D`, row-major, an axis a row.
    axes: Vec<f64>,
    /// The axes side by side, [`LANES`] at a time: for each group of axes, `D` values of each.
    side_by_side: Vec<[f64; LANES]>,
    /// All `D` eigenvalues of `M`, descending.
    eigenvalues: Vec<f64>,
    dims: usize,
    rows: u64,
}

/// Why there are no principal components.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // The messages say it all.
pub enum PcaError {
    #[error("principal components need at least 2 rows, found {found}")]
    TooFewRows { found: u64 },
    #[error("all {rows} rows are equal, so they have no principal components")]
    NoVariance { rows: u64 },
    #[error("a row contains a value that is not finite")]
    NotFinite,
    #[error("{0}")]
    Keep(String),
    #[error("stored components do not fit together: {0}")]
    Parts(String),
}

impl Pca {
    /// The components of the rows that `moments` has seen (thesis Eq. 3.11, 4.3). O(D³).
    ///
    /// # Errors
    /// Fewer than two rows, rows all alike or not finite, a `keep` that makes no sense.
    pub fn fit(moments: &Moments, keep: ComponentCount) -> Result<Self, PcaError> {
        keep.check().map_err(PcaError::Keep)?;
        let rows = moments.count();
        if rows < 2 {
            return Err(PcaError::TooFewRows { found: rows });
        }
        let total = moments.total();
        if !total.is_finite() {
            return Err(PcaError::NotFinite);
        }
        if total <= 0.0 {
            return Err(PcaError::NoVariance { rows });
        }
        let eigen = Eigen::of(moments.scatter());
        let dims = keep.dims(&eigen.values);
        let axes =
            (0..dims).flat_map(|i| eigen.vectors.column(i).iter().copied().collect::<Vec<_>>());
        let axes: Vec<f64> = axes.collect();
        Ok(Self {
            mean: moments.mean().to_vec(),
            side_by_side: side_by_side(&axes, moments.mean().len()),
            axes,
            eigenvalues: eigen.values,
            dims,
            rows,
        })
    }

    /// Values in a raw row, `D`.
    #[inline]
    pub fn dim(&self) -> usize {
        self.mean.len()
    }

    /// Values in a reduced row, `r`.
    #[inline]
    pub fn dims(&self) -> usize {
        self.dims
    }

    /// Rows it was fitted to.
    pub fn rows(&self) -> u64 {
        self.rows
    }

    /// The mean row of the database, `D` values.
    pub fn mean(&self) -> &[f64] {
        &self.mean
    }

    /// Axis `index` (`vᵢ`), `D` values of length 1 together; its greatest component is positive
    /// (`Eigen::canonical_sign`).
    pub fn axis(&self, index: usize) -> &[f64] {
        &self.axes[index * self.dim()..(index + 1) * self.dim()]
    }

    /// All `D` eigenvalues of `M`, descending, those of axes left out included.
    pub fn eigenvalues(&self) -> &[f64] {
        &self.eigenvalues
    }

    /// Share of the variance that the kept dimensions hold (Eq. 3.8).
    pub fn quality(&self) -> f64 {
        self.eigenvalues[..self.dims].iter().sum::<f64>() / self.eigenvalues.iter().sum::<f64>()
    }

    /// Root mean square of what a value of the fitted rows is off after reduction and reconstruction.
    pub fn rms_error(&self) -> f64 {
        let lost: f64 = self.eigenvalues[self.dims..].iter().sum();
        (lost / (self.rows as f64 * self.dim() as f64)).sqrt()
    }

    /// Variance kept by each number of dimensions, `1..=D`.
    pub fn quality_table(&self) -> Vec<QualityRow> {
        let all: f64 = self.eigenvalues.iter().sum();
        let mut sum = 0.0;
        let line = |(index, &eigenvalue): (usize, &f64)| {
            sum += eigenvalue;
            QualityRow {
                dims: index + 1,
                quality: (sum / all).min(1.0),
                eigenvalue,
            }
        };
        self.eigenvalues.iter().enumerate().map(line).collect()
    }

    /// A raw row (`D` values) reduced to `out` (`r` values): `(x − x̄) · [v₁ | … | vᵣ]`, Eq. 3.9. Takes no memory.
    ///
    /// # Panics
    /// `row` or `out` has another width.
    pub fn project_into(&self, row: &[f32], out: &mut [f32]) {
        let dim = self.dim();
        assert!(
            row.len() == dim && out.len() == self.dims,
            "a row of another width"
        );
        let groups = self.side_by_side.chunks_exact(dim);
        for (values, axes) in out.chunks_mut(LANES).zip(groups) {
            for (value, sum) in values.iter_mut().zip(products(row, &self.mean, axes)) {
                *value = sum as f32;
            }
        }
    }

    /// A reduced row (`r` values) back to `out` (`D` values), as well as its dimensions can: Eq. 3.10, with the mean
    /// added again. Takes no memory.
    ///
    /// # Panics
    /// `reduced` or `out` has another width.
    pub fn reconstruct_into(&self, reduced: &[f32], out: &mut [f32]) {
        assert!(
            out.len() == self.dim() && reduced.len() == self.dims,
            "a row of another width"
        );
        for (k, value) in out.iter_mut().enumerate() {
            let part = reduced
                .iter()
                .enumerate()
                .map(|(i, z)| f64::from(*z) * self.axes[i * self.dim() + k]);
            *value = (self.mean[k] + part.sum::<f64>()) as f32;
        }
    }

    /// [`project_into`](Pca::project_into) for a table. O(rows · D · r).
    pub fn project(&self, rows: &Rows) -> Rows {
        let mut values = vec![0.0; rows.len() * self.dims];
        for (row, out) in rows.iter().zip(values.chunks_exact_mut(self.dims)) {
            self.project_into(row, out);
        }
        Rows::from_values(self.dims, values)
    }

    /// [`reconstruct_into`](Pca::reconstruct_into) for a table. O(rows · D · r).
    pub fn reconstruct(&self, reduced: &Rows) -> Rows {
        let mut values = vec![0.0; reduced.len() * self.dim()];
        for (row, out) in reduced.iter().zip(values.chunks_exact_mut(self.dim())) {
            self.reconstruct_into(row, out);
        }
        Rows::from_values(self.dim(), values)
    }
}

/// Stored parts; checked when read.
#[derive(serde::Serialize, serde::Deserialize)]
struct PcaParts {
    mean: Vec<f64>,
    axes: Vec<f64>,
    eigenvalues: Vec<f64>,
    rows: u64,
}

impl From<Pca> for PcaParts {
    fn from(pca: Pca) -> Self {
        Self {
            mean: pca.mean,
            axes: pca.axes,
            eigenvalues: pca.eigenvalues,
            rows: pca.rows,
        }
    }
}

impl TryFrom<PcaParts> for Pca {
    type Error = PcaError;

    fn try_from(parts: PcaParts) -> Result<Self, PcaError> {
        Pca::from_parts(parts.mean, parts.axes, parts.eigenvalues, parts.rows)
    }
}

impl Pca {
    /// Components from what an index stored: `D` means, `r × D` axes, `D` eigenvalues (descending), and the number of
    /// rows they were fitted to.
    ///
    /// # Errors
    /// Sizes that do not go together, values that are not finite.
    pub fn from_parts(
        mean: Vec<f64>,
        axes: Vec<f64>,
        eigenvalues: Vec<f64>,
        rows: u64,
    ) -> Result<Self, PcaError> {
        let dim = mean.len();
        let dims = axes.len().checked_div(dim).unwrap_or(0);
        if dims == 0 || dims > dim || axes.len() != dims * dim {
            return Err(PcaError::Parts(format!(
                "{} values of axes for rows of {dim}",
                axes.len()
            )));
        }
        if eigenvalues.len() != dim {
            return Err(PcaError::Parts(format!(
                "{} eigenvalues for rows of {dim}",
                eigenvalues.len()
            )));
        }
        if mean
            .iter()
            .chain(&axes)
            .chain(&eigenvalues)
            .any(|v| !v.is_finite())
        {
            return Err(PcaError::Parts("a value is not finite".to_owned()));
        }
        let falling = eigenvalues.windows(2).all(|pair| pair[0] >= pair[1]);
        if !falling || eigenvalues[0] <= 0.0 || eigenvalues[dim - 1] < 0.0 {
            return Err(PcaError::Parts(
                "eigenvalues must fall from above 0 and not below it".to_owned(),
            ));
        }
        Ok(Self {
            side_by_side: side_by_side(&axes, dim),
            mean,
            axes,
            eigenvalues,
            dims,
            rows,
        })
    }
}

/// Axes that are multiplied together.
const LANES: usize = 8;

/// The axes of `dim` values in groups, in each group the first values of all axes, then the second, and so on.
fn side_by_side(axes: &[f64], dim: usize) -> Vec<[f64; LANES]> {
    let group = |axes: &[f64]| {
        let value = |lane: usize, at: usize| axes.get(lane * dim + at).copied().unwrap_or(0.0);
        let lanes = |at: usize| std::array::from_fn(|lane| value(lane, at));
        (0..dim).map(lanes).collect::<Vec<_>>()
    };
    axes.chunks(LANES * dim.max(1)).flat_map(group).collect()
}

/// Products of a centred row with several axes. Each sum is taken in the order of the values, as one axis alone would.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn products(row: &[f32], mean: &[f64], axes: &[[f64; LANES]]) -> [f64; LANES] {
    let mut sums = [-0.0; LANES];
    for ((x, mean), axes) in row.iter().zip(mean).zip(axes) {
        let centred = f64::from(*x) - mean;
        for (sum, axis) in sums.iter_mut().zip(axes) {
            *sum += axis * centred;
        }
    }
    sums
}
