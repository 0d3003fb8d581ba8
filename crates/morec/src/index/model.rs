//! The model of an index, for either method.

use std::borrow::Cow;
use std::sync::Arc;

use crate::classes::{ClassId, ClassInfo};
use crate::clip::Skeleton;
use crate::features::{ALL_BONES, BoneSet};
use crate::pivots::PivotSet;
use crate::roles::{Role, RoleMap};
use crate::svrdm::SvrdmModel;
use crate::templates::{PerformerKind, TemplateModel};

/// A trained model of any method. Cheap to copy: the tables are shared.
#[derive(Debug, Clone, PartialEq)]
pub enum Model {
    /// Templates matched elastically, over the places of joints.
    Templates(Arc<TemplateModel>),
    /// The method of the thesis, over the rotations of joints.
    Svrdm(Arc<SvrdmModel>),
}

impl Model {
    /// Name of the method, as in `--method` and in the index's manifest.
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

    /// The bones whose directions recognition compares; none of a model that looks at rotations.
    pub fn bones(&self) -> BoneSet {
        match self {
            Model::Templates(model) => model.bones,
            Model::Svrdm(_) => BoneSet::NONE,
        }
    }

    /// The parts of the body that recognition looks at, some perhaps more than once.
    pub fn roles(&self) -> impl Iterator<Item = Role> {
        let pivots = self.pivots().map_or(&[][..], PivotSet::pivots);
        let ends = self
            .bones()
            .indices()
            .flat_map(|bone| [ALL_BONES[bone].from, ALL_BONES[bone].to]);
        ends.chain(pivots.iter().filter_map(|pivot| pivot.role))
    }

    /// The roles of a performer that the model asks for, with fingers if it looks at them: [`RoleMap::for_bones`].
    pub fn roles_of<'r>(&self, skeleton: &Skeleton, roles: &'r RoleMap) -> Cow<'r, RoleMap> {
        match self {
            Model::Templates(model) => roles.for_bones(skeleton, model.bones),
            Model::Svrdm(_) => Cow::Borrowed(roles),
        }
    }

    /// Comparisons of the stream a second.
    pub fn tick_hz(&self) -> f64 {
        match self {
            Model::Templates(model) => model.features.tick_hz(),
            Model::Svrdm(model) => model.rate_hz() / model.params.chunk_frames as f64,
        }
    }

    /// The model for another rate of false alarms, as background motion raised them in training, a minute. More
    /// alarms also mean fewer motions missed.
    ///
    /// # Errors
    /// A rate that is not above 0, or a model that was trained without noting rates: the method of the thesis, an
    /// index of an older version.
    pub fn with_sensitivity(&self, alarms_per_minute: f64) -> Result<Self, SensitivityError> {
        if !(alarms_per_minute.is_finite() && alarms_per_minute > 0.0) {
            return Err(SensitivityError::Rate(alarms_per_minute));
        }
        let Model::Templates(model) = self else {
            return Err(SensitivityError::Fixed);
        };
        let changed = model.with_sensitivity(alarms_per_minute);
        changed.map(Into::into).ok_or(SensitivityError::Fixed)
    }

    /// The model for the expected performer: anyone, the training subject, or auto as trained.
    ///
    /// # Errors
    /// Anyone is expected, and the model has no gate for that: three people or more taught it, an older version trained it, or
    /// it is of the method of the thesis.
    pub fn with_performer(&self, performer: PerformerKind) -> Result<Self, PerformerError> {
        let changed = match self {
            Model::Templates(model) => model.with_performer(performer).map(Into::into),
            Model::Svrdm(_) if performer == PerformerKind::Anyone => None,
            Model::Svrdm(_) => Some(self.clone()),
        };
        changed.ok_or(PerformerError)
    }

    /// True if poses must say how joints are turned; where they are is enough otherwise.
    pub fn needs_rotations(&self) -> bool {
        self.pivots().is_some()
    }

    /// The joints whose rotations recognition needs; `None` where positions are enough.
    pub(crate) fn pivots(&self) -> Option<&PivotSet> {
        match self {
            Model::Templates(_) => None,
            Model::Svrdm(model) => Some(&model.pivots),
        }
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

/// Anyone was expected, and the model cannot be set to that.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error(
    "this index has one gate for all performers, because it was trained on three people or more or by an older morec: leave the \
     option out, or train again"
)]
pub struct PerformerError;

/// Why the sensitivity of a model cannot be changed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SensitivityError {
    /// The rate makes no sense.
    #[error("sensitivity: expected false alarms a minute above 0, found {0}")]
    Rate(f64),
    /// The model does not note rates.
    #[error(
        "this index has no rates of false alarms, so the sensitivity cannot be chosen: train it again by the method templates"
    )]
    Fixed,
}
