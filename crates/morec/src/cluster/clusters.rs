//! Clusters as connected components.

use super::{KwasParams, Spectrum, kwas};

/// Assignment of items to clusters. Clusters are numbered by their first item.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct Clusters {
    /// Cluster of each item.
    pub of: Vec<usize>,
    /// Number of clusters.
    pub count: usize,
}

impl Clusters {
    /// The items of each cluster.
    pub fn members(&self) -> Vec<Vec<usize>> {
        let mut members = vec![Vec::new(); self.count];
        self.of
            .iter()
            .enumerate()
            .for_each(|(item, &cluster)| members[cluster].push(item));
        members
    }
}

/// Clusters from any numbers: items of one number are together.
pub(super) fn numbered(numbers: impl Iterator<Item = usize>) -> Clusters {
    let mut known = std::collections::BTreeMap::new();
    let of = numbers
        .map(|number| {
            let next = known.len();
            *known.entry(number).or_insert(next)
        })
        .collect();
    Clusters {
        of,
        count: known.len(),
    }
}

/// Clusters of `items` items: the connected components of the links. O(items² ) links asked for.
pub fn connected(items: usize, linked: impl Fn(usize, usize) -> bool) -> Clusters {
    const NONE: usize = usize::MAX;
    let mut of = vec![NONE; items];
    let mut count = 0;
    for first in 0..items {
        if of[first] != NONE {
            continue;
        }
        of[first] = count;
        let mut open = vec![first];
        while let Some(item) = open.pop() {
            for other in 0..items {
                if of[other] == NONE && linked(item.min(other), item.max(other)) {
                    of[other] = count;
                    open.push(other);
                }
            }
        }
        count += 1;
    }
    Clusters { of, count }
}

/// Clusters of samples (thesis §3.6): connected components of the pairs whose similarity is above τ. O(samples² k n).
pub fn kwas_clusters(samples: &[Spectrum], params: &KwasParams) -> Clusters {
    connected(samples.len(), |a, b| {
        kwas(&samples[a], &samples[b], params.k, params.form) > params.tau
    })
}
