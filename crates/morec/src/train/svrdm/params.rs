//! The figures of training.

use serde::{Deserialize, Serialize};

use super::partition::PartitionParams;
use super::sigma::{Algorithm4, SigmaRule};
use super::svrm::MachineParams;

/// How a tree is trained.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct TreeParams {
    /// `T`, `t` and `C` of the machines: 1, 0.4 and 10 (thesis, §4.5).
    pub machine: MachineParams,
    /// How widths are chosen: Algorithm 4 (§4.5).
    pub sigma: SigmaRule,
    /// The figures of Algorithm 4.
    pub algorithm4: Algorithm4,
    /// How classes are parted in two.
    pub partition: PartitionParams,
}
