//! The command line of `morec cut`.

use std::path::PathBuf;

use anyhow::Result;
use clap::ValueEnum;
use morec::segment::{KernelParams, PassDirections, PpcaParams};

use crate::poses::PoseArgs;

/// Cut clips, or those of a database, where their behaviour changes
///
/// No labels are needed. Kernel change points make segments as alike within as they can be, for a price a cut; the
/// thesis's method models the poses so far and cuts where those ahead stop fitting. Walking, then jumping, are cut apart;
/// one step is not cut from the next. A database keeps what is found, stillness and T-poses with it, in place of earlier
/// cuts, by whatever method; clips that were cut by hand (--at) are left as they are.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  morec cut 86_01.amc
  morec cut moves.mdb                   # every clip of a database
  morec cut moves.mdb --clip take_1 --at 1.2,4.5
  morec cut recordings/ --json > cuts.json
  morec cut long.bvh --penalty 8        # fewer cuts
  morec cut 86_01.amc --method ppca --plot cuts.svg")]
pub struct Args {
    /// Clips, folders of clips, or one database
    #[arg(required = true, value_name = "CLIP|DB")]
    pub(super) inputs: Vec<PathBuf>,
    /// Clips of a database of this name; `*` stands for any text, `?` for one character
    #[arg(long, alias = "name", value_name = "CLIP")]
    pub(super) clip: Option<String>,
    /// Cut the one clip that --clip chooses at these moments, seconds separated by commas; cutting again leaves it so
    #[arg(long, value_name = "SECS", value_delimiter = ',', requires = "clip")]
    pub(super) at: Vec<f64>,
    /// Method of cutting
    #[arg(long, value_enum, default_value = "kernel")]
    pub(super) method: CutMethod,
    /// Length of the windows whose statistics are compared, seconds (kernel)
    #[arg(long, value_name = "SECS", default_value_t = KernelParams::default().window_secs)]
    pub(super) window: f64,
    /// Price of a cut: a higher one gives fewer cuts (kernel)
    #[arg(long, value_name = "P", default_value_t = KernelParams::default().penalty)]
    pub(super) penalty: f64,
    /// No segment is shorter, seconds (kernel)
    #[arg(long, value_name = "SECS", default_value_t = KernelParams::default().least_secs)]
    pub(super) least: f64,
    /// Direction through a clip: forward finds what begins, backward what ceases (ppca)
    #[arg(long, value_enum, default_value = "both")]
    pub(super) direction: Direction,
    /// Rise of the misfit before a cut, in multiples of that of fitting poses: a higher one gives fewer cuts
    /// (ppca)
    #[arg(long, value_name = "R", default_value_t = PpcaParams::default().rise)]
    pub(super) rise: f64,
    /// Share of the variance that the model of a segment keeps (ppca)
    #[arg(long, value_name = "SHARE", default_value_t = PpcaParams::default().quality)]
    pub(super) quality: f64,
    /// Print one JSON array: of clips with their cuts and the misfit over time (ppca), of a database with its cuts and
    /// still stretches
    #[arg(long)]
    pub(super) json: bool,
    /// Draw the misfit over time with the cuts marked (ppca, one clip)
    #[arg(long, value_name = "SVG")]
    pub(super) plot: Option<PathBuf>,
    #[command(flatten)]
    pub(super) poses: PoseArgs,
}

/// A method of segmentation.
#[derive(ValueEnum, Clone, Copy, Debug)]
pub(super) enum CutMethod {
    /// Kernel change points over feature rows
    Kernel,
    /// Probabilistic principal components over joint rotations, as in the thesis of 2009 with its distance corrected
    Ppca,
}

#[derive(ValueEnum, Clone, Copy, Debug)]
pub(super) enum Direction {
    /// From start to end
    Forward,
    /// From end to start
    Backward,
    /// Both, and the cuts of either
    Both,
}

/// Method of cutting with checked parameters.
pub(super) enum CheckedCutter {
    Kernel(KernelParams),
    Ppca(PpcaParams),
}

impl CheckedCutter {
    pub(super) fn new(args: &Args) -> Result<Self> {
        let kernel = KernelParams {
            window_secs: args.window,
            penalty: args.penalty,
            least_secs: args.least,
            ..KernelParams::default()
        };
        let ppca = PpcaParams {
            rise: args.rise,
            quality: args.quality,
            directions: match args.direction {
                Direction::Forward => PassDirections::Forward,
                Direction::Backward => PassDirections::Backward,
                Direction::Both => PassDirections::Both,
            },
            ..PpcaParams::default()
        };
        kernel
            .check()
            .and_then(|()| ppca.check())
            .map_err(anyhow::Error::msg)?;
        Ok(match args.method {
            CutMethod::Kernel => Self::Kernel(kernel),
            CutMethod::Ppca => Self::Ppca(ppca),
        })
    }
}
