//! Grouping samples that are alike without knowing their classes, and how well that agrees with the classes (thesis
//! §3.6, §4.4, §5.2).
//!
//! Notation: `M = AᵀA` of a sample's reduced rows, centred on the mean of the database; `σᵢ, λᵢ` the eigenvalues of two
//! such matrices (of `M`, not of `A`: Eq. 3.17), `uᵢ, vᵢ` their eigenvectors.
//!
//! ```
//! use morec::cluster::Hierarchy;
//!
//! let places: [f64; 5] = [0.0, 0.2, 5.0, 5.1, 0.1];
//! let tree = Hierarchy::average(places.len(), |a, b| (places[a] - places[b]).abs());
//! assert_eq!(tree.into_clusters(2).members(), [vec![0, 1, 4], vec![2, 3]]);
//! ```

mod affinity;
mod agreement;
mod clusters;
mod dendrogram;
mod hierarchy;
mod kwas;
mod shape;

pub use affinity::{AffinityParams, affinity_propagation};
pub use agreement::{PairCounts, adjusted_rand_index};
pub use clusters::{Clusters, connected, kwas_clusters};
pub use dendrogram::{Dendrogram, GroupNodes};
pub use hierarchy::{Hierarchy, Merge};
pub use kwas::{KwasForm, KwasParams, Spectrum, kwas};
pub use shape::{resampled, squared_distance};

#[cfg(test)]
mod tests;
