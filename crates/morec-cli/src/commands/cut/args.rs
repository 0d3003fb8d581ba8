//! The command line of `morec cut`.

use std::path::PathBuf;

use morec_ops::CutSettings;

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
    #[command(flatten)]
    pub(super) settings: CutSettings,
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
