//! The command line of `morec group`.

use std::path::PathBuf;

use morec_ops::GroupSettings;

use crate::labels::LabelArgs;
use crate::poses::PoseArgs;

/// Group samples or segments that are alike, of clips or a database
///
/// With labels, samples are grouped and the groups compared with the classes; without labels, clips are cut first (as by `morec
/// cut`) and the segments grouped. The method affinity finds the number of groups; hierarchy is cut at --groups or --height, and
/// branch by branch with --divide and --join; kwas and tree are the thesis's methods and need joint rotations. With --name-as,
/// the groups of a database become classes of proposed samples, to be renamed, merged and accepted.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  morec group clips/ --labels labels.tsv
  morec group clips/ --labels labels.tsv --method kwas --centre none --tau 0.995
  morec group moves.mdb --of labels             # and how well classes agree
  morec group moves.mdb --method hierarchy --groups 12 --name-as group")]
pub struct Args {
    /// Clips, folders of clips, or one database
    #[arg(value_name = "CLIP|DB", required_unless_present = "clips")]
    pub(super) inputs: Vec<PathBuf>,
    /// Older spelling of the argument CLIPS
    #[arg(long, value_name = "DIR|CLIP", num_args = 1.., hide = true)]
    pub(super) clips: Vec<PathBuf>,
    /// Labels of clips in files: a table, or a form that `morec db label` reads
    ///
    /// Without times the whole clip is one sample.
    #[arg(long, value_name = "FILE|DIR")]
    pub(super) labels: Option<PathBuf>,
    #[command(flatten)]
    pub(super) settings: GroupSettings,
    /// Propose members as samples of NAME_1, NAME_2, … (databases)
    #[arg(long, value_name = "NAME")]
    pub(super) name_as: Option<String>,
    /// Write a page with strips of poses of the groups (databases)
    #[arg(long, value_name = "HTML")]
    pub(super) report: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    pub(super) json: bool,
    #[command(flatten)]
    pub(super) reading: LabelArgs,
    #[command(flatten)]
    pub(super) poses: PoseArgs,
}
