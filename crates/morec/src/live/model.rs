//! What an index recognises with, whatever the method.

use std::sync::Arc;

use crate::classes::{ClassId, ClassInfo};
use crate::features::{ALL_BONES, BoneSet};
use crate::pivots::NoPivots;
use crate::roles::Role;
use crate::svrdm::SvrdmModel;
use crate::templates::{TemplateModel, TemplateModelError};

/// A trained model of any method. Cheap to copy: the tables are shared.
#[derive(Debug, Clone, PartialEq)]
pub enum Model {
    /// Templates matched elastically, over the places of joints.
    Templates(Arc<TemplateModel>),
    /// The method of the thesis, over the rotations of joints.
    Svrdm(Arc<SvrdmModel>),
}

impl Model {
    /// What `--method` and an index's manifest call the method.
    pub fn method(&self) -> &'static str {
        match self {
            Model::Templates(_) => "templates",
            Model::Svrdm(_) => "svrdm",
        }
    }

    /// The classes; a [`ClassId`] is an index into this.
    pub fn classes(&self) -> &[ClassInfo] {
        match self {
            Model::Templates(model) => &model.classes,
            Model::Svrdm(model) => &model.classes,
        }
    }

    /// The name of a class of this model.
    pub fn class_name(&self, class: ClassId) -> &str {
        &self.classes()[class.index()].name
    }

    /// The parts of the body that recognition looks at, some perhaps more than once.
    pub fn roles(&self) -> impl Iterator<Item = Role> {
        let (bones, pivots) = match self {
            Model::Templates(model) => (model.bones, &[][..]),
            Model::Svrdm(model) => (BoneSet::NONE, model.pivots.pivots()),
        };
        let ends = bones
            .indices()
            .flat_map(|bone| [ALL_BONES[bone].from, ALL_BONES[bone].to]);
        ends.chain(pivots.iter().filter_map(|pivot| pivot.role))
    }

    /// How often a second the stream is compared.
    pub fn tick_hz(&self) -> f64 {
        match self {
            Model::Templates(model) => model.features.tick_hz(),
            Model::Svrdm(model) => model.rate_hz() / model.params.chunk_frames as f64,
        }
    }

    /// Whether poses must say how joints are turned; where they are is enough otherwise.
    pub fn needs_rotations(&self) -> bool {
        matches!(self, Model::Svrdm(_))
    }
}

impl From<Arc<TemplateModel>> for Model {
    fn from(model: Arc<TemplateModel>) -> Self {
        Model::Templates(model)
    }
}

impl From<TemplateModel> for Model {
    fn from(model: TemplateModel) -> Self {
        Model::Templates(Arc::new(model))
    }
}

impl From<Arc<SvrdmModel>> for Model {
    fn from(model: Arc<SvrdmModel>) -> Self {
        Model::Svrdm(model)
    }
}

impl From<SvrdmModel> for Model {
    fn from(model: SvrdmModel) -> Self {
        Model::Svrdm(Arc::new(model))
    }
}

/// Why a stream cannot be recognised with a model.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum StartError {
    /// The model's parts do not fit together, or the stream shows none of its bones.
    #[error(transparent)]
    Templates(#[from] TemplateModelError),
    /// The model's parts do not fit together.
    #[error(transparent)]
    Svrdm(#[from] crate::svrdm::ModelError),
    /// The skeleton lacks the pivot that all others hang from, or its rotations are not known.
    #[error(transparent)]
    Pivots(#[from] NoPivots),
}
