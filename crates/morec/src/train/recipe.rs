//! Options of training for either method.

use crate::live::Model;
use crate::progress::Progress;

use super::clips::train_clips;
use super::error::TrainError;
use super::from_clips::{LabelSet, TrainClip};
use super::options::TrainOptions;
use super::report::TrainingReport;
use super::thesis::{SvrdmOptions, train_svrdm};

/// A method with its options.
#[derive(Debug, Clone, PartialEq)]
pub enum Recipe {
    /// Templates matched elastically.
    Templates(Box<TrainOptions>),
    /// The method of the thesis.
    Svrdm(Box<SvrdmOptions>),
}

impl Recipe {
    /// True if unlabelled parts of labelled clips are background.
    pub fn unlabelled_is_background(&self) -> bool {
        match self {
            Recipe::Templates(options) => options.unlabelled_is_background,
            Recipe::Svrdm(options) => options.unlabelled_is_background,
        }
    }
}

impl From<TrainOptions> for Recipe {
    fn from(options: TrainOptions) -> Self {
        Recipe::Templates(Box::new(options))
    }
}

impl From<SvrdmOptions> for Recipe {
    fn from(options: SvrdmOptions) -> Self {
        Recipe::Svrdm(Box::new(options))
    }
}

/// Trains as `recipe` says.
///
/// # Errors
/// As [`train_clips`](super::train_clips) and [`train_svrdm`](super::thesis::train_svrdm).
pub fn train_model(
    clips: &[TrainClip],
    labelling: &LabelSet<'_>,
    recipe: &Recipe,
    progress: &dyn Progress,
) -> Result<(Model, TrainingReport), TrainError> {
    match recipe {
        Recipe::Templates(options) => {
            let (model, report) = train_clips(clips, labelling, options, progress)?;
            Ok((model.into(), report))
        }
        Recipe::Svrdm(options) => {
            let (model, report) = train_svrdm(clips, labelling, options, progress)?;
            Ok((model.into(), report))
        }
    }
}
