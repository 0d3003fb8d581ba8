//! The command line of `morec group`.

use std::path::PathBuf;

use clap::ValueEnum;
use morec::cluster::{AffinityParams, KwasParams};
use serde::Serialize;

use crate::poses::PoseArgs;
use crate::share::share;

/// Group samples or segments that are alike, of clips or of a database
///
/// With labels their samples are grouped, and the groups held against the classes; without, clips are cut first (as
/// `morec cut` does) and the segments grouped. Affinity propagation finds the number of groups itself; --method hierarchy
/// is cut at --groups or --height; kwas is the thesis's. With --name-as the groups of a database become classes of
/// proposed samples: rename, merge and accept what is right.
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
    /// Labels of clips in files, in a form that `morec db label` reads; of tables columns clip (file stem), class, and
    /// start, stop (frames, stop exclusive) or start_secs, stop_secs, or neither: then the whole clip is one sample
    #[arg(long, value_name = "FILE|DIR")]
    pub(super) labels: Option<PathBuf>,
    /// Stretches to group [default: labelled samples if --labels are given, else cuts]
    #[arg(long, value_enum)]
    pub(super) of: Option<Grouping>,
    /// Samples of these classes only, separated by commas
    #[arg(long, value_delimiter = ',', value_name = "CLASSES")]
    pub(super) classes: Vec<String>,
    /// Method of grouping
    #[arg(long, value_enum, default_value = "affinity")]
    pub(super) method: GroupMethod,
    /// Preference of a sample to represent a group, as a quantile of similarities (affinity)
    #[arg(long, value_name = "Q", value_parser = share, default_value_t = AffinityParams::default().preference)]
    pub(super) preference: f64,
    /// Cut the hierarchy into N groups
    #[arg(long, value_name = "N", conflicts_with = "height")]
    pub(super) groups: Option<usize>,
    /// Cut the hierarchy where groups are so far apart on average
    #[arg(long, value_name = "DISTANCE")]
    pub(super) height: Option<f64>,
    /// Similarity above which two are of one group, 0 to 1 (kwas)
    #[arg(long, value_name = "TAU", value_parser = share, default_value_t = KwasParams::default().tau)]
    pub(super) tau: f64,
    /// Principal directions of a sample that count (kwas)
    #[arg(short, long, value_name = "N", default_value_t = KwasParams::default().k)]
    pub(super) k: usize,
    /// Scale similarity so that a sample is 1 like itself, however few directions count (kwas)
    #[arg(long)]
    pub(super) normalised: bool,
    /// Point on which samples are centred before they are compared (kwas, clips in files)
    #[arg(long, value_enum, default_value = "database")]
    pub(super) centre: Centre,
    /// Share of the variance of all poses that is kept before samples are compared (kwas, clips in files)
    #[arg(long, value_name = "SHARE", default_value_t = 0.99)]
    pub(super) quality: f64,
    /// Keep N dimensions instead (kwas, clips in files)
    #[arg(long, value_name = "N", conflicts_with = "quality")]
    pub(super) dims: Option<usize>,
    /// Propose each member of a group as a sample of the class NAME_1, NAME_2, … (databases)
    #[arg(long, value_name = "NAME")]
    pub(super) name_as: Option<String>,
    /// Write a page with a strip of poses for each member of each group, too (databases)
    #[arg(long, value_name = "HTML")]
    pub(super) report: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    pub(super) json: bool,
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

/// Stretches to group.
#[derive(clap::ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grouping {
    /// Segments that morec cut found
    Cuts,
    /// Labelled samples
    Labels,
    /// Whole clips
    Clips,
}

/// A method of grouping.
#[derive(clap::ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum GroupMethod {
    /// Affinity propagation over evenly resampled rows
    Affinity,
    /// Average linkage over evenly resampled rows
    Hierarchy,
    /// Principal directions of poses, as in the thesis of 2009
    Kwas,
}
