//! How well clusters agree with classes.

use std::collections::BTreeMap;

/// Pairs of samples by whether they are of one class and in one cluster (thesis Table 3.1, Tables 5.2–5.4).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
pub struct PairCounts {
    /// One class, one cluster.
    pub true_positive: u64,
    /// Two classes, one cluster.
    pub false_positive: u64,
    /// One class, two clusters.
    pub false_negative: u64,
    /// Two classes, two clusters.
    pub true_negative: u64,
}

impl PairCounts {
    /// Every pair of samples, whose classes and clusters have any numbers; what one list has more than the other is left
    /// out. O(samples · log samples).
    pub fn count(classes: &[usize], clusters: &[usize]) -> Self {
        let counts = ContingencyTable::of(classes, clusters);
        let (both, class, cluster) = (counts.both(), counts.one_class(), counts.one_cluster());
        Self {
            true_positive: both,
            false_positive: cluster - both,
            false_negative: class - both,
            true_negative: pairs(counts.samples) + both - class - cluster,
        }
    }

    /// All pairs.
    pub fn total(&self) -> u64 {
        self.true_positive + self.false_positive + self.false_negative + self.true_negative
    }

    /// Share of pairs decided rightly (Rand 1971; thesis Eq. 3.18): `(TP + TN) / all`; 1 if there is no pair.
    pub fn rand_index(&self) -> f64 {
        match self.total() {
            0 => 1.0,
            all => (self.true_positive + self.true_negative) as f64 / all as f64,
        }
    }
}

/// Rand index corrected for chance (Hubert and Arabie 1985): 1 for the same partition, about 0 for one at random. 1 if
/// both partitions are trivial in the same way. O(samples · log samples).
pub fn adjusted_rand_index(classes: &[usize], clusters: &[usize]) -> f64 {
    let counts = ContingencyTable::of(classes, clusters);
    let (class, cluster) = (counts.one_class() as f64, counts.one_cluster() as f64);
    let expected = class * cluster / pairs(counts.samples).max(1) as f64;
    let most = (class + cluster) / 2.0;
    if most == expected {
        1.0
    } else {
        (counts.both() as f64 - expected) / (most - expected)
    }
}

/// Pairs among `n` things.
fn pairs(n: u64) -> u64 {
    n * n.saturating_sub(1) / 2
}

/// Samples by class, by cluster and by both.
struct ContingencyTable {
    classes: BTreeMap<usize, u64>,
    clusters: BTreeMap<usize, u64>,
    cells: BTreeMap<(usize, usize), u64>,
    samples: u64,
}

impl ContingencyTable {
    fn of(classes: &[usize], clusters: &[usize]) -> Self {
        let mut counts = Self {
            classes: BTreeMap::new(),
            clusters: BTreeMap::new(),
            cells: BTreeMap::new(),
            samples: 0,
        };
        for (&class, &cluster) in classes.iter().zip(clusters) {
            *counts.classes.entry(class).or_default() += 1;
            *counts.clusters.entry(cluster).or_default() += 1;
            *counts.cells.entry((class, cluster)).or_default() += 1;
            counts.samples += 1;
        }
        counts
    }

    fn both(&self) -> u64 {
        self.cells.values().copied().map(pairs).sum()
    }

    fn one_class(&self) -> u64 {
        self.classes.values().copied().map(pairs).sum()
    }

    fn one_cluster(&self) -> u64 {
        self.clusters.values().copied().map(pairs).sum()
    }
}
