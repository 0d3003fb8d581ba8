//! The tree of single samples (thesis, ch. 6): each is a class of its own, and Algorithm 6 parts them.

use super::branch::{Space, one_width};
use super::params::TreeParams;
use super::partition::{function_products, partition};

/// Two groups of samples that are one further up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parting {
    /// A sample of the one.
    pub a: usize,
    /// A sample of the other.
    pub b: usize,
    /// Sum of the squared distances of both groups' vectors from their mean: never more than further up.
    pub scatter: f64,
}

/// Parts samples, feature vectors of equal length, in two (Alg. 6) until each is alone; one parting fewer than there are samples.
/// O(samples²) a parting.
pub fn sample_tree(vectors: &[Vec<f64>], params: &TreeParams) -> Vec<Parting> {
    let mut partings = Vec::new();
    let mut open = vec![Vec::from_iter(0..vectors.len())];
    while let Some(members) = open.pop() {
        if members.len() < 2 {
            continue;
        }
        let alone: Vec<Vec<&[f64]>> = members.iter().map(|&i| vec![&vectors[i][..]]).collect();
        let together = alone.concat();
        let sigma = one_width(&together, params, Space::Full).unwrap_or(1.0);
        let split = partition(&function_products(&alone, sigma, params), &params.partition);
        let side = |k: usize| -> Vec<usize> {
            let sides = members.iter().zip(&split.sides);
            sides
                .filter(|(_, side)| **side == k)
                .map(|(i, _)| *i)
                .collect()
        };
        let sides = [side(0), side(1)];
        if let [Some(&a), Some(&b)] = [sides[0].first(), sides[1].first()] {
            let scatter = scatter(&together);
            partings.push(Parting { a, b, scatter });
            open.extend(sides);
        }
    }
    partings
}

fn scatter(vectors: &[&[f64]]) -> f64 {
    let dim = vectors.first().map_or(0, |v| v.len());
    let mean = |i: usize| vectors.iter().map(|v| v[i]).sum::<f64>() / vectors.len() as f64;
    let of_value = |i: usize| {
        let mean = mean(i);
        vectors.iter().map(|v| (v[i] - mean).powi(2)).sum::<f64>()
    };
    (0..dim).map(of_value).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lies_together_is_parted_last() {
        let places = [0.0, 5.0, 0.1, 5.2, 0.05, 9.0];
        let vectors = places.map(|place| vec![place, 1.0]);
        let partings = sample_tree(&vectors, &TreeParams::default());
        assert_eq!(partings.len(), places.len() - 1);
        // The samples that a parting of 0.2 and more leaves together are near each other.
        let near = partings.iter().filter(|p| p.scatter < 0.2);
        for Parting { a, b, .. } in near.clone() {
            assert!(f64::abs(places[*a] - places[*b]) < 0.3, "{partings:?}");
        }
        assert_eq!(near.count(), 3);
        assert!(partings[0].scatter > 70.0);
        assert!(sample_tree(&vectors[..1], &TreeParams::default()).is_empty());
    }

    #[test]
    fn samples_that_are_the_same_are_parted_all_the_same() {
        let partings = sample_tree(&vec![vec![1.0]; 15], &TreeParams::default());
        assert_eq!(partings.len(), 14);
        assert!(partings.iter().all(|p| p.scatter == 0.0));
    }
}
