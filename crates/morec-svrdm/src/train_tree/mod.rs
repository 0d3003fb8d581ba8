//! Training the recogniser of the thesis (Bucur 2009, §§3.7 and 4.5): from feature vectors to a
//! [`Tree`](crate::svrdm::Tree).
//!
//! [`grow()`] does it all; the pieces can be used alone. Everything is in double precision. `m` is a number of samples,
//! `n` of values in a feature vector.

mod branch;
mod cross;
mod cross_params;
mod gram;
mod grow;
mod machines;
mod params;
mod partition;
mod qp;
mod reduce;
mod sigma;
mod signs;
mod singles;
mod sphere;
mod svrm;

#[cfg(test)]
mod tests;

pub use cross::WidthOutcome;
pub use cross_params::{CrossParams, Multiples};
pub use gram::Distances;
pub use grow::{BranchReport, FeatureSample, GrowError, Grown, grow};
pub use machines::{Machines, MacroClasses, Plane};
pub use params::{Algorithm4, MachineParams, PartitionParams, SigmaRule, Sweep, TreeParams};
pub use partition::Split;
pub use qp::{Solver, Stop};
pub use reduce::centroid_factor;
pub use sigma::{Estimate, algorithm4};
pub use signs::{SignRule, SignVector, sign_vector};
pub use singles::{Parting, sample_tree};

#[cfg(test)]
use {
    partition::{function_products, partition},
    qp::BoxQp,
    sphere::smallest_enclosing_sphere,
    svrm::{on_boundary, problem, svrdm, svrm},
};
