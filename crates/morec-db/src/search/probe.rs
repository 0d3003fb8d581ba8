//! The example of a search, laid out for comparison with the sketch of a clip over the bones that both have.

use morec::features::{BoneSet, RowLayout};

use super::boxes::roots;
use super::candidates::{QueryDescriptor, length_cost};
use super::rank::probes;
use super::sketch::SketchLanes;
use super::summary::{MEAN, ROOT, Summary, SummaryDistance};
use super::windows::{TRAVEL, X};
use super::{Example, SearchOptions};

/// Octaves that a sketch covers.
pub const OCTAVES: usize = 3;
/// Lanes that are added up side by side.
pub const SIDE: usize = 16;

/// The example, and its mirror image if that is searched for, as sketches are compared with them.
pub struct SketchProbes {
    pub probes: Vec<SketchProbe>,
    /// Of the example.
    pub rows: usize,
    /// Clips are compared as wholes.
    pub whole: bool,
}

impl SketchProbes {
    pub fn of(example: &Example, options: &SearchOptions) -> Self {
        let probes = probes(example, options, None);
        Self {
            probes: probes.iter().map(SketchProbe::new).collect(),
            rows: example.laid.rows.len(),
            whole: probes.iter().any(|probe| probe.whole),
        }
    }

    /// What a clip of this many rows costs beyond its windows.
    pub fn excess(&self, rows: usize) -> f32 {
        match self.whole {
            true => length_cost(self.rows, rows, 1.4),
            false => 0.0,
        }
    }

    /// What clips of these bones share with each probe; nothing if they share no bone with one.
    pub fn shared(&self, bones: BoneSet) -> Vec<SharedLanes> {
        let shared = self.probes.iter().map(|probe| probe.bones.and(bones));
        let shared: Vec<BoneSet> = shared.collect();
        match shared.iter().any(|bones| bones.is_empty()) {
            true => Vec::new(),
            false => shared.into_iter().map(SharedLanes::of).collect(),
        }
    }
}

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
            mask,
            bone_mask,
            scale: SummaryDistance::over(bones).scale().sqrt(),
        }
    }
}
