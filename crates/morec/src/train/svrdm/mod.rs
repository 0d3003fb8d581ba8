//! Training the recogniser of the thesis (Bucur 2009, §§3.7 and 4.5): from feature vectors to a
//! [`Tree`](crate::svrdm::Tree).
//!
//! [`grow()`] does it all; the pieces can be used alone. Everything is in double precision. `m` is a number of samples,
//! `n` of values in a feature vector.

mod branch;
mod cross;
mod gram;
mod grow;
mod params;
mod partition;
mod qp;
mod reduce;
mod sigma;
mod signs;
mod sphere;
mod svrm;

#[cfg(test)]
pub(crate) mod tests;

pub use branch::{Machines, MacroClasses, Plane};
pub use cross::{CrossParams, Multiples, WidthOutcome};
pub use gram::Distances;
pub use grow::{BranchReport, FeatureSample, GrowError, Grown, grow};
pub use params::TreeParams;
pub use partition::{PartitionParams, Split, function_products, partition, scatter};
pub use qp::{BoxQp, Solution, Stop};
pub use reduce::centroid_factor;
pub use sigma::{Algorithm4, Estimate, SigmaRule, Sweep, algorithm4};
pub use signs::{SignRule, SignVector, sign_vector};
pub use sphere::{Sphere, enclosing};
pub use svrm::{MachinePair, MachineParams, on_boundary, problem, svrdm, svrm};
