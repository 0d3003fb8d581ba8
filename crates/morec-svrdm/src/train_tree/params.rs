//! The parameters of training.

use serde::{Deserialize, Serialize};

use super::cross_params::CrossParams;
use super::qp::{Solver, Stop};

/// Parameters of a tree's training.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct TreeParams {
    /// `T`, `t` and `C` of the machines: 1, 0.4 and 10 (thesis, §4.5).
    pub machine: MachineParams,
    /// Solver of the machines' programs.
    ///
    /// `sor` is Algorithm 3; both find the same optimum, `active_set` sooner and whatever the kernel's width.
    #[serde(default)]
    pub solver: Solver,
    /// Rule for widths: Algorithm 4 (§4.5).
    ///
    /// Thesis, §4.5. Algorithm 4 settles on narrow kernels: it asks that samples lie on the boundary, which they do
    /// when each is alone, and new samples then fall outside. `algorithm4`, `scaled`, `quantile`, `fixed` and
    /// `cross_validated` are the alternatives.
    pub sigma: SigmaRule,
    /// The parameters of Algorithm 4.
    pub algorithm4: Algorithm4,
    /// Parameters of the partition of classes in two.
    pub partition: PartitionParams,
}

/// The parameters of a machine (thesis, §4.5).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MachineParams {
    /// `T`: what a machine should say of its own samples at least.
    pub own: f64,
    /// `t`: what it may say of the other side's at most.
    pub other: f64,
    /// `C`: the penalty for samples that miss it.
    pub penalty: f64,
    /// When the optimiser stops.
    ///
    /// Outputs are about 1: eight digits; the thesis stops when weights hardly move, which says little where the
    /// kernel is wide.
    pub stop: Stop,
}

impl Default for MachineParams {
    fn default() -> Self {
        Self {
            own: 1.0,
            other: 0.4,
            penalty: 10.0,
            stop: Stop::default(),
        }
    }
}

/// Parameters of the partition of classes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PartitionParams {
    /// Up to this many classes every split is tried (at most 20).
    ///
    /// Every split is tried for few classes; with narrow kernels nearly every split stops Algorithm 6.
    pub exact_up_to: usize,
    /// Beyond, clustering starts this often from chance.
    pub restarts: usize,
    /// Seed of that chance.
    pub seed: u64,
    /// True if the functions `h_j` are brought to length 1 first. As printed they are not, and with narrow kernels a
    /// class of many samples has a long one.
    ///
    /// As printed; without it a class of many samples tends to stand alone.
    pub unit_length: bool,
}

impl Default for PartitionParams {
    fn default() -> Self {
        Self {
            exact_up_to: 12,
            restarts: 20,
            seed: 1,
            unit_length: false,
        }
    }
}

/// Rule for the widths of a branch: `σ_f` between feature vectors and `σ_r` in the plane.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SigmaRule {
    /// Algorithm 4 for each side, and the mean of both.
    #[default]
    Algorithm4,
    /// These multiples of that.
    Scaled {
        /// Factor of `σ_f`.
        full: f64,
        /// Of `σ_r`.
        reduced: f64,
    },
    /// These quantiles (0.5 is the median) of the distances between samples of a side, and the mean of both sides.
    Quantile {
        /// Quantile that gives `σ_f`.
        full: f64,
        /// For `σ_r`.
        reduced: f64,
    },
    /// These widths.
    Fixed {
        /// `σ_f`, in the distance of feature vectors.
        full: f64,
        /// `σ_r`.
        reduced: f64,
    },
    /// Those under which samples left out of training, group by group, are accepted most while background and the
    /// other side are not.
    CrossValidated(CrossParams),
}

/// The parameters of Algorithm 4.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Algorithm4 {
    /// `R` is this times the mean distance of the nearest neighbour: 2.2 (§3.7.3).
    pub radius_factor: f64,
    /// By so much less is tried while no sample is found on the boundary: 0.1 (§5.3).
    pub radius_step: f64,
    /// True if a sample alone in its ball counts as on the boundary: its ball has radius 0 and no machine.
    ///
    /// A sample alone in its ball has no machine to ask.
    pub lone_is_boundary: bool,
    /// Widths tried.
    ///
    /// The thesis names no range but prints ten widths (Figs. 5.3 to 5.12: 0.0575 to 0.6725), each the mean of two
    /// sides': all are multiples of 0.0025, so steps are of 0.005, and the first width is at most 0.0575. That it
    /// is 0.05 and the last is 1 is inferred. `geometric` and `linear` go by the samples' distances. A side of
    /// fewer than two different samples takes the other side's width: Algorithm 4 does not cover it.
    pub sweep: Sweep,
}

impl Default for Algorithm4 {
    fn default() -> Self {
        Self {
            radius_factor: 2.2,
            radius_step: 0.1,
            lone_is_boundary: true,
            sweep: Sweep::default(),
        }
    }
}

/// The widths that Algorithm 4 tries, ascending; the thesis does not say which.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Sweep {
    /// In even ratios from a share of the smallest distance between samples to a multiple of the largest.
    Geometric {
        /// Of the smallest.
        low: f64,
        /// Of the largest.
        high: f64,
        /// Number of widths tried.
        count: usize,
    },
    /// In even steps between multiples of the largest distance: as the reference prototype has it.
    Linear {
        /// Of the largest.
        low: f64,
        /// Of the largest.
        high: f64,
        /// Number of widths tried.
        count: usize,
    },
    /// In even steps between two widths, whatever the samples.
    Absolute {
        /// The smallest width tried.
        low: f64,
        /// The largest width tried.
        high: f64,
        /// From one to the next.
        step: f64,
    },
}

impl Default for Sweep {
    /// Inferred from the ten widths that the thesis prints (Figs. 5.3 to 5.12, 0.0575 to 0.6725): all are multiples of
    /// 0.0025, which means of two sides' multiples of 0.005 are, and the smallest, mean of two widths, admits no floor
    /// above it. Upper end: nothing printed comes near it.
    fn default() -> Self {
        Self::Absolute {
            low: 0.05,
            high: 1.0,
            step: 0.005,
        }
    }
}
