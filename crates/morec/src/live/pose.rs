//! One instant of a stream, as recognition takes it.

use crate::clip::Skeleton;
use crate::features::KeyPose;
use crate::kinematics::WorldPose;
use crate::pivots::{PivotMap, PivotPose};
use crate::roles::RoleMap;

use super::{Model, StartError};

/// Where the role joints are, and how the model's pivots are turned if it asks for that.
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
    roles: RoleMap,
    pivots: Option<PivotMap>,
    joints: usize,
    key: KeyPose,
    pivot: PivotPose,
}

impl PoseExtractor {
    /// For poses of `skeleton`, whose joints play `roles`. Fails if nothing plays a pivot that the model cannot do
    /// without.
    pub fn new(model: &Model, skeleton: &Skeleton, roles: &RoleMap) -> Result<Self, StartError> {
        let pivots = match model {
            Model::Templates(_) => None,
            Model::Svrdm(model) => Some(PivotMap::resolve(&model.pivots, skeleton, roles)?),
        };
        let (key, pivot) = (KeyPose::default(), PivotPose::default());
        Ok(Self {
            roles: roles.clone(),
            pivots,
            joints: skeleton.len(),
            key,
            pivot,
        })
    }

    /// Names of the pivots that the skeleton lacks.
    pub fn missing_pivots(&self) -> &[String] {
        self.pivots.as_ref().map_or(&[], |pivots| pivots.missing())
    }

    /// How the pivots are turned in `world`; `None` if the model does not ask, or the source does not say.
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
        self.key = KeyPose::of(world, &self.roles);
        let turned = self.pivots(world).is_some();
        RecognizerInput {
            key: &self.key,
            pivots: turned.then_some(&self.pivot),
        }
    }
}
