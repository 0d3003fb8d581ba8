//! Training an index.

use morec::features::BoneSet;
use morec::index::MotionIndex;
use morec::progress::Progress;
use morec::svrdm::SegmentDistance;
use morec::train::thesis::{Setting, SvrdmOptions, SvrdmTrainParams};
use morec::train::{
    Everyday, Mirror, Recipe, TrainOptions, TrainParams, TrainingData, TrainingReport, train_index,
};
use serde::{Deserialize, Serialize};

use crate::params::{self, Param, ParamError};
#[cfg(feature = "clap")]
use crate::words::choices;
use crate::{OperationError, text};

/// How an index is trained.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "clap", command(next_help_heading = "Training"))]
pub struct TrainSettings {
    /// Learn only these classes, separated by commas [default: all]
    #[cfg_attr(
        feature = "clap",
        arg(long, value_delimiter = ',', value_name = "CLASSES")
    )]
    pub classes: Vec<String>,
    /// Method of recognition
    #[cfg_attr(feature = "clap", arg(long, value_enum, default_value = "auto"))]
    pub method: Method,
    /// Classes that are activities, whatever their samples show
    ///
    /// Separated by commas; with --method auto.
    #[cfg_attr(
        feature = "clap",
        arg(
            hide_short_help = true,
            long,
            value_delimiter = ',',
            value_name = "CLASSES"
        )
    )]
    pub activities: Vec<String>,
    /// Classes that are gestures, whatever their samples show
    ///
    /// Separated by commas; with --method auto.
    #[cfg_attr(
        feature = "clap",
        arg(
            hide_short_help = true,
            long,
            value_delimiter = ',',
            value_name = "CLASSES"
        )
    )]
    pub gestures: Vec<String>,
    /// Parameters of --method svrdm
    #[cfg_attr(feature = "clap", arg(hide_short_help = true, long, default_value = "tuned", value_parser = choices::<Setting>([
        ("faithful", "The values of the thesis"),
        ("tuned", "Values that generalise better to other people"),
    ])))]
    pub svrdm: Setting,
    /// Use unlabelled parts of labelled clips as background, or ignore them
    #[cfg_attr(feature = "clap", arg(long, value_enum, default_value = "background"))]
    pub unlabelled: Unlabelled,
    /// Use the built-in everyday motion as background
    ///
    /// Not with --method svrdm. The motion is partly synthetic, partly recorded.
    #[cfg_attr(feature = "clap", arg(hide_short_help = true, long, default_value = "always", value_parser = choices::<Everyday>([
        ("auto", "Only if --background has less than 1 minute"),
        ("always", "Always"),
        ("never", "Never"),
    ])))]
    pub everyday: Everyday,
    /// Train on mirrored copies of samples too
    ///
    /// Not with --method svrdm.
    #[cfg_attr(feature = "clap", arg(long, default_value = "auto", value_parser = choices::<Mirror>([
        ("auto", "Between pairs of classes named for a side, such as wave_left and wave_right"),
        ("yes", "All classes but those of --one-sided"),
        ("no", "Never"),
    ])))]
    pub mirror: Mirror,
    /// Classes whose mirror image is a negative example (--mirror yes)
    ///
    /// Separated by commas. For classes such as `sweep_left`, whose mirror image is another motion.
    #[cfg_attr(
        feature = "clap",
        arg(
            hide_short_help = true,
            long,
            value_delimiter = ',',
            value_name = "CLASSES"
        )
    )]
    pub one_sided: Vec<String>,
    /// Body parts to use: all, upper, arms, hand, hands, points3 …
    ///
    /// all: the body, or else the hands; upper: nothing below the hips, for seated performers; arms; hand: a left hand
    /// counts as a mirrored right one; left_hand; hands; body_and_hands; points3: head and hands as tracked points; custom;
    /// or names of bones, separated by commas, as the report of training lists them. Not with --method svrdm.
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "PARTS", default_value = "all")
    )]
    #[serde(with = "text")]
    pub bones: BoneSet,
    /// Set a parameter, such as `rho=0.4`; can be repeated
    ///
    /// Nested parameters are given by path: `decode.lag_ticks=2`, `stages.scaling=unit_range`. docs/parameters.md lists the
    /// parameters worth changing.
    #[cfg_attr(feature = "clap", arg(long = "param", value_name = "NAME=VALUE"))]
    #[serde(
        serialize_with = "params::to_table",
        deserialize_with = "params::from_table"
    )]
    pub params: Vec<Param>,
}

impl Default for TrainSettings {
    fn default() -> Self {
        Self {
            classes: Vec::new(),
            method: Method::default(),
            activities: Vec::new(),
            gestures: Vec::new(),
            svrdm: Setting::default(),
            unlabelled: Unlabelled::default(),
            everyday: Everyday::default(),
            mirror: Mirror::default(),
            one_sided: Vec::new(),
            bones: BoneSet::BODY,
            params: Vec::new(),
        }
    }
}

/// Methods of recognition.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// Gestures by templates, activities (such as walking) by windows; training decides for each class
    #[default]
    Auto,
    /// All classes are gestures
    Templates,
    /// The method of the thesis of 2009: a tree of support vector machines
    Svrdm,
}

/// Use of the unlabelled parts of labelled clips.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[serde(rename_all = "snake_case")]
pub enum Unlabelled {
    /// Belongs to no class
    #[default]
    Background,
    /// May be unlabelled samples: not used
    Ignore,
}

impl TrainSettings {
    /// Settings that train the method of 2009 with `params`.
    pub fn of_svrdm(params: &SvrdmTrainParams) -> Self {
        let of = |svrdm: Setting| (svrdm, params::changed(params, &svrdm.params()));
        let (tuned, faithful) = (of(Setting::Tuned), of(Setting::Faithful));
        let (svrdm, params) = match faithful.1.len() < tuned.1.len() {
            true => faithful,
            false => tuned,
        };
        Self {
            method: Method::Svrdm,
            svrdm,
            params,
            ..Self::default()
        }
    }

    /// The method and its options.
    ///
    /// # Errors
    /// A parameter that the method does not have, or settings that are for another method.
    pub fn recipe(&self) -> Result<Recipe, OperationError> {
        if self.method == Method::Svrdm {
            self.check_kinds()?;
            return Ok(self.svrdm_options(self.svrdm, &self.params)?.into());
        }
        Ok(self.template_options()?.into())
    }

    fn check_kinds(&self) -> Result<(), OperationError> {
        let names_kinds = !self.activities.is_empty() || !self.gestures.is_empty();
        if names_kinds && self.method != Method::Auto {
            let why = "activities and gestures apply to the method auto only";
            return Err(OperationError::Settings(why.to_owned()));
        }
        Ok(())
    }

    /// The options of the methods auto and templates, for programs without the method of 2009.
    ///
    /// # Errors
    /// As [`recipe`](Self::recipe); the method of 2009.
    pub fn template_options(&self) -> Result<TrainOptions, OperationError> {
        if self.method == Method::Svrdm {
            let why = "method: expected auto or templates, found svrdm";
            return Err(OperationError::Settings(why.to_owned()));
        }
        self.check_kinds()?;
        let mut params = params::with(TrainParams::default(), &self.params)?;
        params.activities &= self.method == Method::Auto;
        params.set_kinds(&self.activities, &self.gestures);
        Ok(TrainOptions {
            unlabelled_is_background: self.unlabelled == Unlabelled::Background,
            everyday: self.everyday,
            mirror: self.mirror,
            one_sided: self.one_sided.clone(),
            bones: self.bones,
            params,
        })
    }

    /// Options of both settings of the method of 2009, for the thesis's evaluation; parameters that are set are those of the
    /// setting that is named.
    ///
    /// # Errors
    /// A parameter that the method does not have.
    pub fn both_svrdm(&self) -> Result<[(Setting, SvrdmOptions); 2], ParamError> {
        let of = |setting| {
            let given = if setting == self.svrdm {
                &self.params[..]
            } else {
                &[]
            };
            Ok((setting, self.svrdm_options(setting, given)?))
        };
        Ok([of(Setting::Faithful)?, of(Setting::Tuned)?])
    }

    fn svrdm_options(&self, of: Setting, given: &[Param]) -> Result<SvrdmOptions, ParamError> {
        let mut params = params::with(of.params(), given)?;
        let is_given = |name: &str| given.iter().any(|param| param.name.starts_with(name));
        // Chunks and rows are counted at the model's rate, and are times: at another rate they are other numbers.
        if is_given("pose.rate_hz") {
            let share = params.pose.rate_hz / of.params().pose.rate_hz;
            let scaled = |frames: usize| ((frames as f64 * share).round() as usize).max(1);
            if !is_given("stages.chunk_frames") {
                params.stages.chunk_frames = scaled(params.stages.chunk_frames);
            }
            if let SegmentDistance::Rows { every } = &mut params.stages.comparison
                && !is_given("stages.comparison")
            {
                *every = scaled(*every);
            }
        }
        Ok(SvrdmOptions {
            params,
            unlabelled_is_background: self.unlabelled == Unlabelled::Background,
        })
    }

    /// Trains an index on `data`.
    ///
    /// # Errors
    /// Settings that make no sense, too little to learn from, or `progress` cancels.
    pub fn train(
        &self,
        data: &TrainingData,
        progress: &dyn Progress,
    ) -> Result<(MotionIndex, TrainingReport), OperationError> {
        Ok(train_index(data, &self.recipe()?, progress)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_rate_brings_its_chunks_along() {
        let stages = |given: &[&str]| {
            let settings = TrainSettings {
                method: Method::Svrdm,
                params: given.iter().map(|p| p.parse().unwrap()).collect(),
                ..TrainSettings::default()
            };
            let Recipe::Svrdm(options) = settings.recipe().unwrap() else {
                panic!("another method")
            };
            let stages = options.params.stages;
            (stages.chunk_frames, stages.comparison.every())
        };
        assert_eq!(stages(&[]), (16, 4));
        assert_eq!(stages(&["pose.rate_hz=60"]), (8, 2));
        assert_eq!(
            stages(&["pose.rate_hz=60", "stages.chunk_frames=16"]),
            (16, 2)
        );
    }
}
