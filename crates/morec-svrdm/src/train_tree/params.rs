//! The parameters of training.

use serde::{Deserialize, Serialize};

use super::partition::PartitionParams;
use super::qp::Solver;
use super::sigma::{Algorithm4, SigmaRule};
use super::svrm::MachineParams;

/// Parameters of a tree's training.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct TreeParams {
    /// `T`, `t` and `C` of the machines: 1, 0.4 and 10 (thesis, §4.5).
    pub machine: MachineParams,
    /// Solver of the machines' programs.
    #[serde(default)]
    pub solver: Solver,
    /// Rule for widths: Algorithm 4 (§4.5).
    pub sigma: SigmaRule,
    /// The parameters of Algorithm 4.
    pub algorithm4: Algorithm4,
    /// Parameters of the partition of classes in two.
    pub partition: PartitionParams,
}
