//! A pose at one instant, in the form that recognition uses.

use crate::clip::{Clip, Skeleton};
use crate::features::{BoneSet, KeyPose};
use crate::kinematics::{PartialSkeleton, WorldPose};
use crate::pivots::{PivotMap, PivotPose};
use crate::roles::{Role, RoleMap};

use super::{Model, StartError};

/// Positions of the role joints, and rotations of the model's pivots if it asks for them.
#[derive(Debug, Clone, Copy)]
pub struct RecognizerInput<'p> {
    /// Places of the role joints.
    pub key: &'p KeyPose,
    /// Rotations of the pivots; a model that [needs them](Model::needs_rotations) recognises nothing without.
    pub pivots: Option<&'p PivotPose>,
}

impl<'p> From<&'p KeyPose> for RecognizerInput<'p> {
    fn from(key: &'p KeyPose) -> Self {
        Self { key, pivots: None }
    }
}

/// Takes from a posed skeleton what a model's recogniser needs.
#[derive(Debug, Clone)]
pub struct PoseExtractor {
    /// The roles that the model looks at, with their joints.
    played: Vec<(Role, usize)>,
    pivots: Option<PivotMap>,
    joints: usize,
    key: KeyPose,
    pivot: PivotPose,
}

impl PoseExtractor {
    /// For poses of `skeleton`, whose joints play `roles`. Fails if nothing plays a pivot that the model cannot do
    /// without.
    ///
    /// # Errors
    /// A pivot that the model cannot do without has no joint.
    pub fn new(model: &Model, skeleton: &Skeleton, roles: &RoleMap) -> Result<Self, StartError> {
        let pivots = model.pivots();
        let pivots = pivots.map(|set| PivotMap::resolve(set, skeleton, roles));
        let (key, pivot) = (KeyPose::default(), PivotPose::default());
        let shows_hands = !model.bones().and(BoneSet::HANDS).is_empty();
        let looked_at = |role: Role| shows_hands || pivots.is_some() || !role.is_of_hand();
        let played = roles.played().filter(|(role, _)| looked_at(*role));
        Ok(Self {
            played: played.collect(),
            pivots: pivots.transpose()?,
            joints: skeleton.len(),
            key,
            pivot,
        })
    }

    /// The part of `clip`'s skeleton whose poses are read.
    pub(super) fn part_of<'c>(&self, clip: &'c Clip) -> PartialSkeleton<'c> {
        match self.pivots {
            Some(_) => PartialSkeleton::of(clip, 0..self.joints),
            None => PartialSkeleton::of(clip, self.played.iter().map(|(_, joint)| *joint)),
        }
    }

    /// Names of the pivots that the skeleton lacks.
    pub fn missing_pivots(&self) -> &[String] {
        self.pivots.as_ref().map_or(&[], |pivots| pivots.missing())
    }

    /// Rotations of the pivots in `world`; `None` if the model asks for none, or the source has none.
    pub fn pivots(&mut self, world: &WorldPose) -> Option<&PivotPose> {
        let pivots = self
            .pivots
            .as_ref()
            .filter(|_| world.rotations.len() == self.joints)?;
        self.pivot = pivots.pose(world);
        Some(&self.pivot)
    }

    /// The pose, valid until the next is read. No allocation.
    pub fn read(&mut self, world: &WorldPose) -> RecognizerInput<'_> {
        self.key.update(world, self.played.iter().copied());
        let turned = self.pivots(world).is_some();
        RecognizerInput {
            key: &self.key,
            pivots: turned.then_some(&self.pivot),
        }
    }
}
