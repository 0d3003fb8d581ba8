//! Segments to feature vectors and profiles (thesis, §4.6.4).

use super::leading::LeadingEigenvectors;
use super::vectors::entry;
use super::{Centring, Directions, Gram, Scaling, SegmentDistance, SvrdmParams};

/// Feature vector extraction: a segment's `AᵀA` in; its feature vector and, where asked for, its profile out.
///
/// Training describes its samples by the same struct, in the same precision.
#[derive(Debug, Clone)]
pub struct FeatureExtraction {
    scaling: Scaling,
    centring: Centring,
    comparison: SegmentDistance,
    signs: Vec<f64>,
    directions: Directions,
    leading: LeadingEigenvectors,
    feature: Vec<f64>,
    profile: Vec<f32>,
}

impl FeatureExtraction {
    /// For rows of `dim` values, `r`, and `signs` as of [`SvrdmModel::signs`](super::SvrdmModel::signs): `k × r`.
    ///
    /// # Panics
    /// `signs` has another size.
    pub fn new(params: &SvrdmParams, dim: usize, signs: &[f64]) -> Self {
        assert_eq!(
            signs.len(),
            params.feature_dim(dim),
            "sign vectors of another size"
        );
        Self {
            scaling: params.scaling,
            centring: params.centring,
            comparison: params.comparison,
            signs: signs.to_vec(),
            directions: Directions::new(params.eigenvectors, dim),
            leading: LeadingEigenvectors::new(params.eigenvectors, dim),
            feature: vec![0.0; signs.len()],
            profile: vec![
                0.0;
                params.comparison.rows(params.max_frames()) * params.comparison.width(dim)
            ],
        }
    }

    /// Bytes of its memory.
    pub fn bytes(&self) -> usize {
        let values = self.signs.len() + self.feature.len() + self.directions.len();
        8 * values + 4 * self.profile.len() + self.leading.bytes()
    }

    /// The feature vector, `k · r` values; `None` for a segment without direction ([`Directions::find`]).
    /// O(r³), no allocation.
    pub fn feature(&mut self, segment: &Gram) -> Option<&[f64]> {
        self.prepare(std::iter::once(segment));
        self.prepared(0, segment)
    }

    /// Prepares for the feature vectors of these segments, [`AT_ONCE`](super::leading::AT_ONCE) at most: faster than one by one.
    pub(super) fn prepare<'a>(&mut self, segments: impl Iterator<Item = &'a Gram>) {
        let centring = self.centring;
        let mut set = 0;
        for (lane, segment) in segments.enumerate() {
            (self.leading).set(lane, |i, j| entry(segment, centring, i, j));
            set = lane + 1;
        }
        self.leading.solve(set);
    }

    /// The [feature vector](Self::feature) of the `at`th of the segments that were prepared.
    pub(super) fn prepared(&mut self, at: usize, segment: &Gram) -> Option<&[f64]> {
        match self.leading.vectors(at) {
            Some(vector) => self.directions.set(vector, |j| self.leading.share(at, j)),
            None if self.directions.find(segment, self.centring) => {}
            None => return None,
        }
        self.directions.fix_signs(&self.signs);
        self.directions.feature(self.scaling, &mut self.feature);
        Some(&self.feature)
    }

    /// The directions that the last feature vector is of.
    pub fn directions(&self) -> &Directions {
        &self.directions
    }

    /// The profile of the segment that the last feature vector is of: a value for each of its `rows`, or some of them
    /// whole ([`SegmentDistance`]). Allocates only for segments longer than the parameters' longest, as training may have
    /// them. O(rows · r).
    pub fn profile<'a>(&mut self, segment: &Gram, rows: impl Iterator<Item = &'a [f32]>) -> &[f32] {
        let width = self.comparison.width(segment.dim());
        let values = self.comparison.rows(segment.frames()) * width;
        if self.profile.len() < values {
            self.profile.resize(values, 0.0);
        }
        let out = &mut self.profile[..values];
        match self.comparison {
            SegmentDistance::Profiles => self.directions.profile(rows, segment, self.centring, out),
            SegmentDistance::Rows { every } => {
                for (kept, row) in out.chunks_exact_mut(width).zip(rows.step_by(every)) {
                    kept.copy_from_slice(row);
                }
            }
        }
        out
    }
}
