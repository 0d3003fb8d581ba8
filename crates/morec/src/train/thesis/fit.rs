//! Samples to a model.

use crate::classes::ClassInfo;
use crate::pca::Pca;
use crate::svrdm::{Directions, FeatureExtraction, Gram, Profiles, SvrdmModel};
use crate::train::TrainError;
use morec_svrdm::train_tree::{BranchReport, FeatureSample, SignVector, grow, sign_vector};

use super::SvrdmTrainParams;
use super::sample::{ThesisSample, described};

/// A model and how it came about.
#[derive(Debug, Clone)]
pub struct Fitted {
    /// The model, in the precision of its file.
    pub model: SvrdmModel,
    /// Of each branch of the tree, the root first.
    pub branches: Vec<BranchReport>,
    /// Of each direction, how its signs were put right.
    pub signs: Vec<SignVector>,
}

/// Sign vectors of the samples' directions (Alg. 5).
pub(super) fn sign_vectors(found: &[&Directions], params: &SvrdmTrainParams) -> Vec<SignVector> {
    let of_direction = |j: usize| {
        let vectors: Vec<&[f64]> = found.iter().map(|d| d.vector(j)).collect();
        sign_vector(&vectors, params.sign)
    };
    (0..params.stages.eigenvectors)
        .filter_map(of_direction)
        .collect()
}

/// Trains on samples of reduced rows (§4.5): sign vectors (Alg. 5), feature vectors (Eq. 3.37), the tree (Alg. 7),
/// profiles (§3.8). O(samples³) in the largest branch.
///
/// # Errors
/// No sample, fewer than two classes, a class none of whose samples can be described, or parameters that no tree grows with.
pub fn fit(
    samples: &[ThesisSample],
    classes: &[ClassInfo],
    pca: &Pca,
    params: &SvrdmTrainParams,
) -> Result<Fitted, TrainError> {
    let stages = &params.stages;
    let dim = pca.dims();
    let described: Vec<(&ThesisSample, Gram, Directions)> = samples
        .iter()
        .filter_map(|s| described(&s.rows, dim, stages).map(|(gram, found)| (s, gram, found)))
        .collect();
    let found: Vec<&Directions> = described.iter().map(|(_, _, d)| d).collect();
    let signs = sign_vectors(&found, params);
    let directions: Vec<f64> = signs
        .iter()
        .flat_map(|s| s.direction.iter().copied())
        .collect();
    // As the file keeps them, since features depend on their sides.
    let directions: Vec<f64> = directions
        .into_iter()
        .map(|v| f64::from(v as f32))
        .collect();
    if directions.len() != stages.feature_dim(dim) {
        return Err(TrainError::NoSamples);
    }
    let mut extraction = FeatureExtraction::new(stages, dim, &directions);
    let mut profiles = Profiles::new(stages.comparison.width(dim));
    let (mut features, mut frames) = (vec![], vec![(0, 0usize); classes.len()]);
    for (sample, gram, _) in &described {
        let Some(feature) = extraction.feature(gram) else {
            continue;
        };
        features.push(FeatureSample {
            class: sample.class,
            group: sample.group,
            vector: feature.to_vec(),
        });
        profiles.push(sample.class, extraction.profile(gram, sample.rows.iter()));
        let (sum, count) = &mut frames[sample.class.index()];
        (*sum, *count) = (*sum + sample.rows.len(), *count + 1);
    }
    if let Some(class) = frames.iter().position(|(_, count)| *count == 0) {
        return Err(TrainError::NoSample {
            class: classes[class].name.clone(),
        });
    }
    let grown =
        grow(&features, &[], &params.tree).map_err(|e| TrainError::Params(e.to_string()))?;
    let mean_secs = frames
        .iter()
        .map(|(sum, count)| *sum as f64 / *count as f64 / params.pose.rate_hz);
    let model = SvrdmModel {
        classes: classes.to_vec(),
        pivots: params.pivots.set().map_err(TrainError::Params)?,
        pose: params.pose,
        pca: pca.clone(),
        params: stages.clone(),
        signs: directions,
        tree: grown.tree,
        epsilon: profiles.epsilon(stages.tolerance),
        profiles,
        mean_secs: mean_secs.collect(),
    };
    model.check().map_err(TrainError::Svrdm)?;
    let model = model.compact().map_err(TrainError::Svrdm)?;
    Ok(Fitted {
        model,
        branches: grown.branches,
        signs,
    })
}
