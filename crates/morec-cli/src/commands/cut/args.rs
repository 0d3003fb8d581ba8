//! The command line of `morec cut`.

use std::path::PathBuf;

use morec_ops::CutSettings;

use crate::poses::PoseArgs;

/// Cut clips, or those of a database, where their behaviour changes
///
/// No labels are needed. The method kernel (change points) makes each segment as uniform as possible, with a penalty for each
/// cut; ppca (the method of 2009) models the poses so far and cuts where the next poses do not fit. Walking and jumping are
/// separated, two steps are not. A database stores the result, with stillness and T-poses, in place of earlier cuts; clips cut by
/// hand (--at) are not changed.
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
    /// Clips of a database with this name; `*` any text, `?` one character
    #[arg(long, alias = "name", value_name = "CLIP")]
    pub(super) clip: Option<String>,
    /// Cut the clip of --clip at these seconds, separated by commas
    #[arg(long, value_name = "SECS", value_delimiter = ',', requires = "clip")]
    pub(super) at: Vec<f64>,
    #[command(flatten)]
    pub(super) settings: CutSettings,
    /// Print one JSON array
    ///
    /// For clips: cuts, and the misfit over time (ppca). For a database: cuts and still stretches.
    #[arg(long)]
    pub(super) json: bool,
    /// Draw the misfit over time with the cuts (ppca, one clip)
    #[arg(long, value_name = "SVG")]
    pub(super) plot: Option<PathBuf>,
    #[command(flatten)]
    pub(super) poses: PoseArgs,
}
