//! An example, and what a clip shares with it, laid out by the lanes of sketches.

use morec::features::{BoneSet, RowLayout};

use super::boxes::roots;
use super::candidates::QueryDescriptor;
use super::sketch::SketchLanes;
use super::summary::{MEAN, ROOT, Summary, SummaryDistance};
use super::windows::{TRAVEL, X};

/// Octaves that a sketch covers.
pub const OCTAVES: usize = 3;
/// Lanes that are added up side by side.
pub const SIDE: usize = 16;

/// The example or its mirror image, laid out by lanes.
pub struct SketchProbe {
    pub bones: BoneSet,
    pub octaves: [SketchLanes; OCTAVES],
    pub pose: SketchLanes,
    pub travel: [f32; TRAVEL],
    /// Lengths of the octaves of each bone.
    pub roots: [f32; SIDE],
}

impl SketchProbe {
    pub fn new(probe: &QueryDescriptor<'_>) -> Self {
        let summary: &Summary = &probe.look.summary;
        let lanes = |from: usize| {
            let mut lanes = SketchLanes::ZERO;
            lanes.0[..X].copy_from_slice(&summary[from..from + X]);
            lanes
        };
        Self {
            bones: probe.bones,
            octaves: std::array::from_fn(|octave| lanes(octave * X)),
            pose: lanes(MEAN),
            travel: std::array::from_fn(|i| summary[ROOT + i]),
            roots: roots(summary),
        }
    }
}

/// Lanes of bones that the example and a clip share, 1 in a mask, and the factor of lengths over them.
pub struct SharedLanes {
    pub bones: BoneSet,
    pub mask: SketchLanes,
    pub bone_mask: [f32; SIDE],
    pub scale: f32,
}

impl SharedLanes {
    pub fn of(bones: BoneSet) -> Self {
        let (mut mask, mut bone_mask) = (SketchLanes::ZERO, [0f32; SIDE]);
        for bone in bones.indices() {
            bone_mask[bone] = 1.0;
            mask.0[RowLayout::BODY.direction(bone)].fill(1.0);
        }
        Self {
            bones,
            mask,
            bone_mask,
            scale: SummaryDistance::over(bones).scale().sqrt(),
        }
    }
}
