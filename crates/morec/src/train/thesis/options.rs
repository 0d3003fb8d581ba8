//! Options of the thesis's recogniser's training.

use serde::{Deserialize, Serialize};

use crate::pca::ComponentCount;
use crate::pivots::{PivotSet, PoseParams};
use crate::svrdm::{Centring, Descent, Scaling, SegmentDistance, SvrdmParams};
use morec_svrdm::train_tree::{SigmaRule, SignRule, TreeParams};

/// Origin of the thresholds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ThresholdRule {
    /// Those that the parameters name.
    Fixed,
    /// By cross-validation over the training samples.
    Estimated {
        /// Parts into which each class's samples are dealt; each is left out in turn.
        folds: usize,
        /// `t` too: what the other machine of a branch says at most.
        #[serde(default)]
        other: bool,
    },
}

/// Joints that count.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Pivots {
    /// The 16 of Table 4.2, by name, and by role where no joint has the name.
    #[default]
    Thesis,
    /// Those that every skeleton has whose parts are known.
    Roles,
    /// These of the former two, by name, and the root; a pivot's parent is the nearest before it that is chosen
    /// (§4.2: "easy selection of relevant pivots").
    Chosen(Vec<String>),
    /// A set of one's own.
    List(PivotSet),
}

impl Pivots {
    /// The set.
    ///
    /// # Errors
    /// A name that no pivot has.
    pub fn set(&self) -> Result<PivotSet, String> {
        Ok(match self {
            Pivots::Thesis => PivotSet::thesis(),
            Pivots::Roles => PivotSet::roles(),
            Pivots::List(set) => set.clone(),
            Pivots::Chosen(names) => {
                let sets = [PivotSet::thesis(), PivotSet::roles()];
                let unknown = |name: &&String, set: &PivotSet| set.place(name).is_none();
                let fits = |set: &&PivotSet| !names.iter().any(|name| unknown(&name, set));
                let set = sets.iter().find(fits).ok_or_else(|| {
                    let name = names.iter().find(|n| unknown(n, &sets[0])).cloned();
                    let known = sets[0].pivots().iter().map(|p| p.name.as_str());
                    format!(
                        "there is no pivot {}; the pivots are {}, or the body parts of `pivots=roles`",
                        name.unwrap_or_default(),
                        known.collect::<Vec<_>>().join(", ")
                    )
                })?;
                set.keeping(|pivot| names.contains(&pivot.name))
            }
        })
    }
}

/// The parameters of training.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SvrdmTrainParams {
    /// Joints of the pose rows.
    pub pivots: Pivots,
    /// Parameters of pose rows.
    pub pose: PoseParams,
    /// Number of principal components that are kept: 16 (thesis, §4.2).
    pub keep: ComponentCount,
    /// Parameters of the stages; training describes its samples the same way.
    pub stages: SvrdmParams,
    /// Estimation of sign vectors.
    ///
    /// The printed rule depends on the signs that eigenvectors come with.
    pub sign: SignRule,
    /// Parameters of the tree's growth.
    pub tree: TreeParams,
    /// Origin of the thresholds of recognition.
    ///
    /// Tuned: `accept` and `min_confidence` from left-out samples and background (`train/thesis/thresholds.rs`).
    pub thresholds: ThresholdRule,
}

impl SvrdmTrainParams {
    /// The thesis's own parameters, with no knob turned. What it does not print is as its figures have it: see
    /// [`Sweep`](morec_svrdm::train_tree::Sweep).
    pub fn faithful() -> Self {
        Self {
            pivots: Pivots::Thesis,
            pose: PoseParams::default(),
            keep: ComponentCount::Dims(16),
            stages: SvrdmParams::default(),
            sign: SignRule::Centred,
            tree: TreeParams::default(),
            thresholds: ThresholdRule::Fixed,
        }
    }

    /// The same method, made to accept what it has not seen and still to reject motion of no class: kernels
    /// as wide as most distances between samples of a side; vectors of four directions about the segment's own mean as
    /// Eq. 3.37 scales them, their signs by what they have in common; samples compared by whole rows, which is what
    /// rejects; thresholds estimated.
    pub fn tuned() -> Self {
        let faithful = Self::faithful();
        Self {
            stages: SvrdmParams {
                eigenvectors: 4,
                scaling: Scaling::SingularShare,
                centring: Centring::Segment,
                accept: 0.8,
                descent: Descent::Larger,
                comparison: SegmentDistance::Rows { every: 4 },
                tolerance: 0.7,
                min_confidence: 0.5,
                wait_chunks: 4,
                ..faithful.stages
            },
            sign: SignRule::Common,
            tree: TreeParams {
                sigma: SigmaRule::Quantile {
                    full: 0.8,
                    reduced: 0.9,
                },
                ..faithful.tree
            },
            thresholds: ThresholdRule::Estimated {
                folds: 4,
                other: false,
            },
            ..faithful
        }
    }
}

impl Default for SvrdmTrainParams {
    fn default() -> Self {
        Self::tuned()
    }
}

/// Options of training from clips.
#[derive(Debug, Clone, PartialEq)]
pub struct SvrdmOptions {
    /// The parameters of the method.
    pub params: SvrdmTrainParams,
    /// True if unlabelled parts of labelled clips are background.
    pub unlabelled_is_background: bool,
}

impl Default for SvrdmOptions {
    fn default() -> Self {
        Self {
            params: SvrdmTrainParams::default(),
            unlabelled_is_background: true,
        }
    }
}

/// The two settings of training.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Setting {
    /// The thesis's own parameters.
    Faithful,
    /// Made to accept what was not seen.
    #[default]
    Tuned,
}

impl Setting {
    /// As it is written.
    pub fn name(self) -> &'static str {
        match self {
            Setting::Faithful => "faithful",
            Setting::Tuned => "tuned",
        }
    }

    /// The parameters of training.
    pub fn params(self) -> SvrdmTrainParams {
        match self {
            Setting::Faithful => SvrdmTrainParams::faithful(),
            Setting::Tuned => SvrdmTrainParams::tuned(),
        }
    }
}
