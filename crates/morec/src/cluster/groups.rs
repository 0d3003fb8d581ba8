//! Groups as connected components.

use super::{KwasParams, Spectrum, kwas};

/// Which group each item is in. Groups are numbered by their first item.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct Groups {
    /// Group of each item.
    pub of: Vec<usize>,
    /// Number of groups.
    pub count: usize,
}

impl Groups {
    /// The items of each group.
    pub fn members(&self) -> Vec<Vec<usize>> {
        let mut members = vec![Vec::new(); self.count];
        self.of.iter().enumerate().for_each(|(item, &group)| members[group].push(item));
        members
    }
}

/// Groups from any numbers: items of one number are together.
pub(super) fn numbered(numbers: impl Iterator<Item = usize>) -> Groups {
    let mut known = std::collections::BTreeMap::new();
    let of = numbers
        .map(|number| {
            let next = known.len();
            *known.entry(number).or_insert(next)
        })
        .collect();
    Groups { of, count: known.len() }
}

/// Groups of `items` items: whoever is linked, over however many others, is together. O(items² ) links asked for.
pub fn connected(items: usize, linked: impl Fn(usize, usize) -> bool) -> Groups {
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
    Groups { of, count }
}

/// Groups of samples (thesis §3.6): connected components of the pairs whose similarity is above τ. O(samples² k n).
pub fn kwas_groups(samples: &[Spectrum], params: &KwasParams) -> Groups {
    connected(samples.len(), |a, b| kwas(&samples[a], &samples[b], params.k, params.form) > params.tau)
}
