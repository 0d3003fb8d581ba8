//! The manifest of an index file: its description in JSON.

use std::collections::BTreeMap;

use crate::classes::{ClassId, ClassInfo};
use crate::decode::DecodeParams;
use crate::features::{BoneSet, FeatureParams};
use crate::pivots::{PivotSet, PoseParams};
use crate::roles::Role;
use crate::svrdm::SvrdmParams;
use crate::templates::{Calibration, LinearScore, OperatingPoint, PerformerKind, StrangerGate};

use super::Provenance;

/// Value of [`Manifest::format`]: says that a safetensors file is one of ours.
pub const FORMAT: &str = "morec-index";

/// Everything in an index of templates that is not a table of numbers.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Manifest {
    /// Always [`FORMAT`].
    pub format: String,
    /// Version of the layout.
    pub version: u32,
    /// The recogniser that the model is for.
    pub method: String,
    /// CRC-32 of the manifest with this field 0, then of every tensor's name, type, shape and bytes in order of
    /// names.
    pub checksum: u32,
    /// The classes, in the order of their numbers.
    pub classes: Vec<ClassInfo>,
    /// Bones that rows hold.
    pub bones: BoneSet,
    /// Parameters of feature rows.
    pub features: FeatureParams,
    /// Parameters of decoding.
    pub decode: DecodeParams,
    /// Largest distance that is reported.
    pub threshold: f32,
    /// The same for each class, if they differ.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub class_thresholds: Vec<f32>,
    /// Thresholds for other rates of false alarms.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub operating: Vec<OperatingPoint>,
    /// Meaning of margins.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub calibration: Option<Calibration>,
    /// The wider gate for performers unlike the teacher.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stranger: Option<StrangerGate>,
    /// The verifier without its tables, if there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub verifier: Option<VerifierWords>,
    /// The second look without its tables, if there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub look: Option<LookWords>,
    /// The held poses without their tables, if there are any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub held: Option<HeldWords>,
    /// The activities without their tables, if there are any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub activities: Option<ActivityWords>,
    /// Joints of the training clips, by role.
    pub roles: BTreeMap<Role, String>,
    /// Origin of the index.
    pub provenance: Provenance,
}

/// The second look without its tables.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct LookWords {
    /// See [`SecondLook::scale`](crate::templates::second_look::SecondLook::scale).
    pub scale: f32,
    /// Scores above this are reported.
    pub bound: f32,
    /// Bounds for other rates of false alarms.
    pub operating: Vec<OperatingPoint>,
    /// Matches farther than this are no candidates.
    pub reach: f32,
    /// Median score of the taught samples.
    pub own_score: f32,
    /// The performer that is expected.
    #[serde(default)]
    pub performer: PerformerKind,
}

/// Held poses without their tables.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct HeldWords {
    /// Poses farther than this from those of a class do not belong to it.
    pub reach: f32,
    /// Ticks for which a pose must be held.
    pub least_ticks: usize,
}

/// Activities without their tables.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ActivityWords {
    /// Length of a window in ticks.
    pub window_ticks: usize,
    /// See [`Activities::share`](crate::templates::Activities::share).
    pub share: f32,
}

/// A verifier without its exemplars.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct VerifierWords {
    /// Candidates farther than this are not looked at.
    pub reach: f32,
    /// Scores must be above this.
    pub bar: f64,
    /// See [`Verifier::operating`](crate::templates::Verifier::operating).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub operating: Vec<OperatingPoint>,
    /// The part common to all classes.
    pub generic: LinearScore,
}

/// Everything in an index of the thesis's method that is not a table of numbers.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct SvrdmManifest {
    /// Always [`FORMAT`].
    pub format: String,
    /// Version of the layout.
    pub version: u32,
    /// The recogniser that the model is for.
    pub method: String,
    /// As in [`Manifest::checksum`].
    pub checksum: u32,
    /// The classes, in the order of their numbers.
    pub classes: Vec<ClassInfo>,
    /// Joints of a pose row.
    pub pivots: PivotSet,
    /// Parameters of pose rows.
    pub pose: PoseParams,
    /// Parameters of the stages.
    pub params: SvrdmParams,
    /// Rows that the principal components were fitted to.
    pub pca_rows: u64,
    /// The tree, but for its tables.
    pub nodes: Vec<NodeWords>,
    /// For each class, its samples' mean length in seconds.
    pub mean_secs: Vec<f64>,
    /// Tolerance between profile values.
    pub epsilon: f32,
    /// Joints of the training clips, by role.
    pub roles: BTreeMap<Role, String>,
    /// Origin of the index.
    pub provenance: Provenance,
}

/// A node of the tree without its tables.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NodeWords {
    /// One class is left.
    Leaf(ClassId),
    /// Two macro-classes are distinguished.
    Branch(BranchWords),
}

/// A branch without its tables.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[allow(missing_docs)] // As in svrdm::Branch.
pub struct BranchWords {
    pub sigma_full: f64,
    pub sigma_reduced: f64,
    pub factor: [f64; 3],
    pub children: [u32; 2],
    pub classes: [Vec<ClassId>; 2],
}

/// The part that can be read whatever the version.
#[derive(Debug, serde::Deserialize)]
pub struct Preamble {
    /// See [`Manifest::format`].
    pub format: String,
    /// See [`Manifest::version`].
    pub version: u32,
    /// See [`Manifest::method`].
    pub method: String,
}
