//! The command line of `morec group`.

use std::path::PathBuf;

use clap::ValueEnum;
use morec_ops::GroupSettings;
use serde::Serialize;

use crate::labels::LabelArgs;
use crate::poses::PoseArgs;

/// Group samples or segments that are alike, of clips or a database
///
/// With labels, samples are grouped and the groups compared with the classes; without, clips are cut first (as by
/// `morec cut`) and segments grouped. Affinity propagation finds the number of groups; --method hierarchy is cut at
/// --groups or --height; kwas is the thesis's. With --name-as, groups of a database become classes of proposed samples
/// to rename, merge and accept.
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
    /// The spelling of old for clips
    #[arg(long, value_name = "DIR|CLIP", num_args = 1.., hide = true)]
    pub(super) clips: Vec<PathBuf>,
    /// Labels of clips in files: a table, or a form that `morec db label` reads
    ///
    /// Without times the whole clip is one sample.
    #[arg(long, value_name = "FILE|DIR")]
    pub(super) labels: Option<PathBuf>,
    #[command(flatten)]
    pub(super) settings: GroupSettings,
    /// Centre of samples before comparison (kwas, files)
    #[arg(hide_short_help = true, long, value_enum, default_value = "database")]
    pub(super) centre: Centre,
    /// Share of the variance to keep (kwas, files)
    #[arg(
        hide_short_help = true,
        long,
        value_name = "SHARE",
        default_value_t = 0.99
    )]
    pub(super) quality: f64,
    /// Keep N dimensions instead (kwas, files)
    #[arg(
        hide_short_help = true,
        long,
        value_name = "N",
        conflicts_with = "quality"
    )]
    pub(super) dims: Option<usize>,
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

/// Point on which samples are centred.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Centre {
    /// The mean of all poses, which are then reduced to --quality or --dims: samples are many small clusters
    Database,
    /// Nothing, and all dimensions are kept: the mean pose counts, samples are more alike, and --tau belongs near 1
    None,
}
