//! A hierarchy of samples by the partition of the thesis's classifier.

use crate::cluster::{Hierarchy, Merge};
use crate::features::Rows;
use crate::svrdm::{FeatureExtraction, MAX_DIM};
use crate::train::TrainError;
use morec_svrdm::train_tree::sample_tree;

use super::SvrdmTrainParams;
use super::fit::sign_vectors;
use super::sample::described;

/// The tree of single samples (thesis, ch. 6): reduced rows of each become a feature vector (Eq. 3.37), each is a class of its own, and
/// Algorithm 6 parts them in two until each is alone. Samples without motion are together, apart from the others. O(samples³) at worst.
///
/// # Errors
/// Rows of more values than the method takes, or of fewer than it finds directions.
pub fn tree_of_samples(
    samples: &[Rows],
    params: &SvrdmTrainParams,
) -> Result<Hierarchy, TrainError> {
    let dim = samples
        .first()
        .map_or(params.stages.eigenvectors, Rows::dim);
    let possible = params.stages.eigenvectors..=MAX_DIM;
    if !possible.contains(&dim) {
        let (least, most) = possible.into_inner();
        let message =
            format!("rows have {dim} values, the tree of samples needs {least} to {most}");
        return Err(TrainError::Params(message));
    }
    let described: Vec<_> = (samples.iter().enumerate())
        .filter_map(|(at, rows)| Some((at, described(rows, dim, &params.stages)?)))
        .collect();
    let directions: Vec<_> = described.iter().map(|(_, (_, d))| d).collect();
    let signs = sign_vectors(&directions, params);
    let signs: Vec<f64> = signs
        .iter()
        .flat_map(|s| s.direction.iter().copied())
        .collect();
    let mut vectors: Vec<Vec<f64>> = Vec::new();
    let mut known: Vec<usize> = Vec::new();
    if signs.len() == params.stages.feature_dim(dim) {
        let mut extraction = FeatureExtraction::new(&params.stages, dim, &signs);
        for (at, (gram, _)) in &described {
            if let Some(vector) = extraction.feature(gram) {
                vectors.push(vector.to_vec());
                known.push(*at);
            }
        }
    }
    // Later partings lie within earlier ones.
    let partings = sample_tree(&vectors, &params.tree).into_iter().rev();
    let mut merges: Vec<Merge> = partings
        .map(|p| Merge {
            a: known[p.a],
            b: known[p.b],
            height: p.scatter,
        })
        .collect();
    let widest = merges.iter().map(|m| m.height).fold(0.0, f64::max);
    let still: Vec<usize> = (0..samples.len())
        .filter(|at| !known.contains(at))
        .collect();
    merges.extend(still.windows(2).map(|pair| Merge {
        a: pair[0],
        b: pair[1],
        height: 0.0,
    }));
    if let (Some(&a), Some(&b)) = (known.first(), still.first()) {
        let height = widest + 1.0;
        merges.push(Merge { a, b, height });
    }
    Ok(Hierarchy::of_merges(samples.len(), merges))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Poses that swing along one of three directions, or that stand still.
    fn swings(way: usize, ticks: usize) -> Rows {
        let mut rows = Rows::new(4);
        for tick in 0..ticks {
            let mut row = [0.0; 4];
            row[way] = (tick as f32 / 4.0).sin();
            row[(way + 1) % 3] = 0.1 * (tick as f32 / 3.0).cos();
            rows.push(&if way < 3 { row } else { [0.0; 4] });
        }
        rows
    }

    #[test]
    fn samples_of_one_direction_are_parted_last() {
        let ways = [0, 1, 2, 0, 1, 2, 0, 3, 3];
        let samples: Vec<Rows> = (ways.iter().enumerate())
            .map(|(at, way)| swings(*way, 64 + 4 * at))
            .collect();
        let tree = tree_of_samples(&samples, &SvrdmTrainParams::default()).unwrap();
        assert_eq!(tree.merges().len(), samples.len() - 1);
        let mut groups = tree.into_clusters(4).members();
        groups.sort();
        assert_eq!(groups, [vec![0, 3, 6], vec![1, 4], vec![2, 5], vec![7, 8]]);
        assert_eq!(tree.into_clusters(2).members()[1], [7, 8]);
    }

    #[test]
    fn nothing_and_stillness_make_a_tree_too() {
        let params = SvrdmTrainParams::default();
        assert!(tree_of_samples(&[], &params).unwrap().merges().is_empty());
        let still = [swings(3, 40), swings(3, 50)];
        assert_eq!(tree_of_samples(&still, &params).unwrap().merges().len(), 1);
        let narrow = tree_of_samples(&[Rows::from_values(1, vec![0.0; 9])], &params);
        assert!(
            narrow
                .unwrap_err()
                .to_string()
                .contains("rows have 1 values")
        );
    }
}
