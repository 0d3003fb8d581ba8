//! The structs of parameters, in the order of the page.

use morec::cluster::{AffinityParams, KwasParams};
use morec::decode::DecodeParams;
use morec::features::FeatureParams;
use morec::segment::{CycleParams, KernelParams, PpcaParams, StillParams};
use morec::smooth::SmoothParams;
use morec::templates::EarlyDetectionParams;
use morec::train::thesis::SvrdmTrainParams;
use morec::train::{StrangerParams, TrainParams};

use super::{Group, printed, serialised};

/// All of them.
pub fn all() -> Vec<Group> {
    let mut groups = templates();
    groups.extend(svrdm());
    groups.extend(offline());
    groups
}

/// The template recogniser.
fn templates() -> Vec<Group> {
    let (now, then) = (TrainParams::default(), TrainParams::reference());
    vec![
        Group {
            intro: "## The template recogniser\n\n### Training (`TrainParams`)",
            source: include_str!("../../../src/train/params.rs"),
            name: "TrainParams",
            prefix: "",
            values: vec![
                ("default", serialised(&now)),
                ("prototype", serialised(&then)),
            ],
        },
        Group {
            intro: "### The wider gate for performers unlike the teacher (`StrangerParams`)",
            source: include_str!("../../../src/train/params.rs"),
            name: "StrangerParams",
            prefix: "stranger.",
            values: vec![
                ("default", serialised(&StrangerParams::default())),
                ("prototype", serialised(&StrangerParams::NONE)),
            ],
        },
        Group {
            intro: "### Feature rows (`FeatureParams`)",
            source: include_str!("../../../../morec-features/src/params.rs"),
            name: "FeatureParams",
            prefix: "features.",
            values: vec![
                ("default", serialised(&FeatureParams::default())),
                ("prototype", serialised(&FeatureParams::reference())),
            ],
        },
        Group {
            intro: "### Decoding (`DecodeParams`)",
            source: include_str!("../../../src/decode/params.rs"),
            name: "DecodeParams",
            prefix: "decode.",
            values: vec![
                ("default", serialised(&DecodeParams::default())),
                ("prototype", serialised(&DecodeParams::reference())),
            ],
        },
        Group {
            intro: "### Tentative events (`EarlyDetectionParams`)\n\nThese are not stored in the index and cannot be set with \
                    `--param`. Chosen with `examples/early.rs` on referee signals and sessions before a Kinect.",
            source: include_str!("../../../src/templates/early.rs"),
            name: "EarlyDetectionParams",
            prefix: "EarlyDetectionParams.",
            values: vec![("default", printed(&EarlyDetectionParams::default()))],
        },
    ]
}

/// The method of 2009, as the thesis has it and tuned.
fn svrdm() -> Vec<Group> {
    let (faithful, tuned) = (SvrdmTrainParams::faithful(), SvrdmTrainParams::tuned());
    macro_rules! group {
        ($intro:expr, $source:literal, $name:literal, $prefix:literal $(, $field:ident)*) => {
            Group {
                intro: $intro,
                source: include_str!($source),
                name: $name,
                prefix: $prefix,
                values: vec![
                    ("faithful", serialised(&faithful$(.$field)*)),
                    ("tuned", serialised(&tuned$(.$field)*)),
                ],
            }
        };
    }
    vec![
        group!(
            "## The method of 2009 (`--method svrdm`)\n\n`--svrdm tuned` is the default, `--svrdm faithful` has the \
             values of the thesis. Where the column \"tuned\" is empty, both are the same. The tuned values were chosen \
             on half splits of the referee clips (10 classes, seeds 1 to 6).\n\n### Training (`SvrdmTrainParams`)",
            "../../../src/train/thesis/options.rs",
            "SvrdmTrainParams",
            ""
        ),
        group!(
            "### Pose rows (`PoseParams`)",
            "../../../../morec-svrdm/src/pivots/params.rs",
            "PoseParams",
            "pose.",
            pose
        ),
        group!(
            "### Live stages (`SvrdmParams`)",
            "../../../../morec-svrdm/src/svrdm/params.rs",
            "SvrdmParams",
            "stages.",
            stages
        ),
        group!(
            "### The tree (`TreeParams`)",
            "../../../../morec-svrdm/src/train_tree/params.rs",
            "TreeParams",
            "tree.",
            tree
        ),
        group!(
            "### Machines (`MachineParams`)",
            "../../../../morec-svrdm/src/train_tree/params.rs",
            "MachineParams",
            "tree.machine.",
            tree,
            machine
        ),
        group!(
            "### Algorithm 4 (`Algorithm4`)",
            "../../../../morec-svrdm/src/train_tree/params.rs",
            "Algorithm4",
            "tree.algorithm4.",
            tree,
            algorithm4
        ),
        group!(
            "### Partition of classes (`PartitionParams`)",
            "../../../../morec-svrdm/src/train_tree/params.rs",
            "PartitionParams",
            "tree.partition.",
            tree,
            partition
        ),
    ]
}

/// Parameters that no index holds: cuts, cycles, rests, groups, compression.
fn offline() -> Vec<Group> {
    macro_rules! group {
        ($intro:expr, $source:literal, $name:literal, $prefix:literal, $params:expr) => {
            Group {
                intro: $intro,
                source: include_str!($source),
                name: $name,
                prefix: $prefix,
                values: vec![("default", printed(&$params))],
            }
        };
    }
    vec![
        group!(
            "## Cutting, grouping, compressing\n\nNo index holds these; where a command has an option for one, its \
             `--help` says so.\n\n### Cuts by probabilistic components (`PpcaParams`)",
            "../../../src/segment/params.rs",
            "PpcaParams",
            "PpcaParams.",
            PpcaParams::default()
        ),
        group!(
            "### Cuts by kernel change points (`KernelParams`)",
            "../../../src/segment/kernel.rs",
            "KernelParams",
            "KernelParams.",
            KernelParams::default()
        ),
        group!(
            "### Repetitions (`CycleParams`)",
            "../../../src/periodicity.rs",
            "CycleParams",
            "CycleParams.",
            CycleParams::default()
        ),
        group!(
            "### Stillness and T-poses (`StillParams`)",
            "../../../src/segment/still.rs",
            "StillParams",
            "StillParams.",
            StillParams::default()
        ),
        group!(
            "### Groups by affinity propagation (`AffinityParams`)",
            "../../../src/cluster/affinity.rs",
            "AffinityParams",
            "AffinityParams.",
            AffinityParams::default()
        ),
        group!(
            "### Clusters by kWAS (`KwasParams`)",
            "../../../src/cluster/kwas.rs",
            "KwasParams",
            "KwasParams.",
            KwasParams::default()
        ),
        group!(
            "### Compression (`SmoothParams`)",
            "../../../../mocap/src/smooth/params.rs",
            "SmoothParams",
            "SmoothParams.",
            SmoothParams::default()
        ),
    ]
}
