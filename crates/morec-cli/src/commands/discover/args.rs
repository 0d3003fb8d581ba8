//! The command line of `morec discover`.

use std::path::PathBuf;

use morec_ops::DiscoverSettings;

use crate::poses::PoseArgs;

/// Find motions that repeat, without labels
///
/// Repetitions of one motion, in any clips and by any people, form a set; sets are listed by the amount of motion that they
/// cover. Motions that occur once are in no set. --name-as proposes the instances as samples. Where a cycle begins (which foot,
/// up or down) is a convention; in the studio, the ends of a whole set are moved at once. The same clips always give the same
/// sets.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  morec discover clips/
  morec discover moves.mdb --report sets.html   # a page that plays the sets
  morec discover moves.mdb --name-as set        # propose them as samples
  morec discover recordings/ --runs --json > sets.json")]
pub struct Args {
    /// Clips, folders of clips, or one database
    #[arg(required = true, value_name = "CLIP|DB")]
    pub(super) inputs: Vec<PathBuf>,
    /// Clips of the database whose name matches; `*` any text, `?` one character
    #[arg(long, value_name = "CLIP")]
    pub(super) clip: Option<String>,
    #[command(flatten)]
    pub(super) settings: DiscoverSettings,
    /// Propose repetitions as samples of NAME_1, NAME_2, … (databases)
    #[arg(long, value_name = "NAME")]
    pub(super) name_as: Option<String>,
    /// Write a page that plays the sets
    #[arg(long, value_name = "HTML")]
    pub(super) report: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    pub(super) json: bool,
    #[command(flatten)]
    pub(super) poses: PoseArgs,
}
