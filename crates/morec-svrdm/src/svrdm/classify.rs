//! Cut-out samples through the tree: classification without segmentation (thesis, §5.3).

use std::sync::Arc;

use morec_features::ClassId;
use morec_features::Rows;

use super::{
    Acceptance, ClassCandidates, FeatureExtraction, Gram, ModelError, SegmentScoring, SvrdmModel,
};

/// Classification of a cut-out sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Classified {
    /// The class at the leaf.
    pub class: ClassId,
    /// The least output on the way there; rejected if below `T`.
    pub output: f64,
    /// The largest output of another side on the way; rejected if above `t`, where there is one.
    pub other: f64,
    /// Likeness of these frames to the class's samples, 0 … 1: confidence without the prior on length, as somebody else
    /// has said where the sample begins and ends.
    pub likeness: f64,
    /// Confidence of the recogniser in a segment of just these frames (Eq. 4.5).
    pub confidence: f64,
}

impl Classified {
    /// True if the branches on the way are followed.
    pub fn passes(&self, acceptance: Acceptance) -> bool {
        let rejects = |other: f64| self.other > other;
        self.output >= acceptance.accept && !acceptance.other.is_some_and(rejects)
    }
}

/// Classifies cut-out samples.
#[derive(Debug, Clone)]
pub struct SampleClassifier {
    model: Arc<SvrdmModel>,
    extraction: FeatureExtraction,
    scoring: SegmentScoring,
    candidates: ClassCandidates,
}

impl SampleClassifier {
    /// For a model whose parts fit together.
    ///
    /// # Errors
    /// As [`SvrdmModel::check`].
    pub fn new(model: &Arc<SvrdmModel>) -> Result<Self, ModelError> {
        Ok(Self {
            extraction: FeatureExtraction::new(&model.params, model.pca.dims(), &model.signs),
            scoring: SegmentScoring::new(model)?,
            candidates: ClassCandidates::default(),
            model: model.clone(),
        })
    }

    /// The feature vector of reduced rows, `frames × r`; `None` if they do not move.
    pub fn feature(&mut self, rows: &Rows) -> Option<Vec<f64>> {
        let gram = Gram::of_rows(rows.values(), rows.dim(), self.model.params.chunk_frames);
        self.extraction.feature(&gram).map(<[f64]>::to_vec)
    }

    /// Down the tree the way of the larger output, to its end; `None` if the rows do not move.
    pub fn classify(&mut self, rows: &Rows) -> Option<Classified> {
        let gram = Gram::of_rows(rows.values(), rows.dim(), self.model.params.chunk_frames);
        let feature = self.extraction.feature(&gram)?;
        self.model.tree.descend(
            feature,
            Acceptance::above(f64::NEG_INFINITY),
            &mut self.candidates,
        );
        let found = *self.candidates.first()?;
        let profile = self.extraction.profile(&gram, rows.iter());
        let edr = self.scoring.distance(found.class, profile);
        let likeness = self.scoring.likeness(edr);
        let confidence = self.scoring.confidence(found.class, edr, gram.frames());
        Some(Classified {
            class: found.class,
            output: found.output,
            other: found.other,
            likeness,
            confidence,
        })
    }
}
