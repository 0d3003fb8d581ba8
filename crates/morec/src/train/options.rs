//! Options of a training run beyond the parameters of the method.

use crate::features::BoneSet;

use super::mirror::Mirror;
use super::params::TrainParams;

/// When built-in everyday motion is background too.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Everyday {
    /// If clips named as background hold less than [`ENOUGH_BACKGROUND_SECS`].
    Auto,
    /// However much background is named.
    #[default]
    Always,
    /// Only named background and unlabelled parts count.
    Never,
}

/// Options of training from clips.
#[derive(Debug, Clone, PartialEq)]
pub struct TrainOptions {
    /// The parameters of the method.
    pub params: TrainParams,
    /// True if unlabelled parts of labelled clips are background.
    pub unlabelled_is_background: bool,
    /// Use of synthetic everyday motion as background.
    pub everyday: Everyday,
    /// Use of mirrored copies of samples.
    pub mirror: Mirror,
    /// Classes whose mirror image is another motion, with [`Mirror::Yes`].
    pub one_sided: Vec<String>,
    /// The bones that count, of those that every labelled clip shows.
    pub bones: BoneSet,
}

impl Default for TrainOptions {
    fn default() -> Self {
        Self {
            params: TrainParams::default(),
            unlabelled_is_background: true,
            everyday: Everyday::default(),
            mirror: Mirror::default(),
            one_sided: Vec::new(),
            bones: BoneSet::BODY,
        }
    }
}

impl TrainOptions {
    /// An error if an option names a class that is not in `classes`.
    pub(super) fn check_names(&self, classes: &[String]) -> Result<(), String> {
        let kinds = self.params.kinds.keys();
        let mut named = kinds.chain(&self.one_sided);
        match named.find(|name| !classes.contains(name)) {
            None => Ok(()),
            Some(name) => Err(format!(
                "no class is called {name:?}; the classes are {}",
                classes.join(", ")
            )),
        }
    }
}

/// Seed of the everyday motion that indexes are trained with.
pub const EVERYDAY_SEED: u64 = 2009;

/// Named background of this length needs no made motion beside it.
pub const ENOUGH_BACKGROUND_SECS: f64 = 60.0;
