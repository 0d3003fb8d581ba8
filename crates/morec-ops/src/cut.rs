//! Cutting clips where their behaviour changes.

use morec::discover::DiscoverParams;
use morec::pivots::PivotSet;
use morec::segment::{KernelParams, PassDirections, PpcaParams};
use morec_db::Cutter;
use serde::{Deserialize, Serialize};

use crate::OperationError;
use crate::words::choices;

/// How clips are cut.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, clap::Args)]
#[serde(default, deny_unknown_fields)]
pub struct CutSettings {
    /// Method of cutting
    #[arg(long, value_enum, default_value = "kernel")]
    pub method: CutMethod,
    /// Window length, seconds (kernel)
    #[arg(hide_short_help = true, long, value_name = "SECS", default_value_t = KernelParams::default().window_secs)]
    pub window: f64,
    /// Penalty for each cut; a higher value gives fewer cuts (kernel)
    #[arg(long, value_name = "P", default_value_t = KernelParams::default().penalty)]
    pub penalty: f64,
    /// Shortest segment, seconds (kernel)
    #[arg(long, value_name = "SECS", default_value_t = KernelParams::default().least_secs)]
    pub least: f64,
    /// Direction of the passes (ppca)
    ///
    /// The forward pass finds where behaviour begins, the backward pass where it ends.
    #[arg(hide_short_help = true, long, default_value = "both", value_parser = choices::<PassDirections>([
        ("forward", "From start to end"),
        ("backward", "From end to start"),
        ("both", "Both, and the cuts of either"),
    ]))]
    pub direction: PassDirections,
    /// Rise of the misfit before a cut; a higher value gives fewer cuts (ppca)
    ///
    /// In multiples of the misfit of poses that belong to the segment.
    #[arg(long, value_name = "R", default_value_t = PpcaParams::default().rise)]
    pub rise: f64,
    /// Share of the variance that a segment's model keeps (ppca)
    #[arg(hide_short_help = true, long, value_name = "SHARE", default_value_t = PpcaParams::default().quality)]
    pub quality: f64,
}

/// A method of cutting.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "snake_case")]
pub enum CutMethod {
    /// Kernel change points over feature rows
    #[default]
    Kernel,
    /// Probabilistic principal components over rotations, as in the thesis of 2009
    Ppca,
    /// Boundaries of repetitions that `morec discover` finds in all clips
    Repeats,
}

impl Default for CutSettings {
    fn default() -> Self {
        let (kernel, ppca) = (KernelParams::default(), PpcaParams::default());
        Self {
            method: CutMethod::default(),
            window: kernel.window_secs,
            penalty: kernel.penalty,
            least: kernel.least_secs,
            direction: ppca.directions,
            rise: ppca.rise,
            quality: ppca.quality,
        }
    }
}

impl From<CutMethod> for CutSettings {
    /// With figures as usual.
    fn from(method: CutMethod) -> Self {
        Self {
            method,
            ..Self::default()
        }
    }
}

impl CutSettings {
    /// The method with its figures; `pivots` are those that the thesis's looks at.
    ///
    /// # Errors
    /// A figure that makes no sense.
    pub fn cutter(&self, pivots: PivotSet) -> Result<Cutter, OperationError> {
        let kernel = KernelParams {
            window_secs: self.window,
            penalty: self.penalty,
            least_secs: self.least,
            ..KernelParams::default()
        };
        let ppca = PpcaParams {
            rise: self.rise,
            quality: self.quality,
            directions: self.direction,
            ..PpcaParams::default()
        };
        let checked = kernel.check().and_then(|()| ppca.check());
        checked.map_err(OperationError::Settings)?;
        Ok(match self.method {
            CutMethod::Kernel => Cutter::Kernel(kernel),
            CutMethod::Ppca => Cutter::Ppca(ppca, pivots),
            CutMethod::Repeats => Cutter::Repeats(DiscoverParams::default()),
        })
    }
}
