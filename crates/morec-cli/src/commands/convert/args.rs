//! The command line of `morec convert`.

use std::path::PathBuf;

use morec_measure::tables::Content;

use super::form::ClipForm;
use crate::files::{self, ReadArgs};

/// Convert clips to BVH, C3D, TRC, GLB, VRMA, lines of JSON, NumPy or CSV
///
/// The output's extension chooses the format: .bvh; .c3d, .trc and .jsonl with positions only; .glb and .vrma for other programs
/// and avatars; .npz with positions, rotations and feature rows; .csv with one of these three. BVH, C3D and TRC keep the clip's
/// lengths and axes (lengths without a named unit become millimetres in C3D and TRC); the other formats are in metres, Y up.
/// Several clips are written into a folder, in the format of --form. Repairs are reported on standard error.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  morec convert 13_29.amc -o 13_29.bvh
  morec convert walk.bvh -o walk30.bvh --rate 30
  morec convert gait.c3d -o gait.trc
  morec convert gait.c3d -o gait.bvh --fit
  morec convert dance.fbx -o dance.vrma
  morec convert walk.bvh -o walk.csv --table features
  morec convert clips/ -o arrays/ --form npz
  morec convert 13_29.amc --skeleton 13.asf -o - | head")]
pub struct Args {
    /// Clips, or folders of clips; - is standard input
    #[arg(required = true, value_name = "CLIP")]
    pub(super) clips: Vec<PathBuf>,
    /// File to write, or folder for several clips; - is BVH on standard output
    #[arg(short, long, value_name = "FILE|FOLDER")]
    pub(super) output: PathBuf,
    /// File format of clips written into a folder [default: bvh]
    #[arg(long, value_enum)]
    pub(super) form: Option<ClipForm>,
    /// Content of a CSV
    #[arg(long, value_enum, default_value_t = CsvContent::Positions)]
    pub(super) table: CsvContent,
    /// Resample to this rate [default: keep all frames]
    #[arg(long, value_name = "HZ", value_parser = files::rate)]
    pub(super) rate: Option<f64>,
    /// Fit a skeleton to clips of points, so that joints have rotations
    ///
    /// Bone lengths are constant. The remaining distance from the points is printed on standard error.
    #[arg(long)]
    pub(super) fit: bool,
    /// Character to write from a file with several, from 1
    #[arg(long, value_name = "N")]
    pub(super) character: Option<usize>,
    /// Roles of joints, where inference fails: lines of `role<TAB>joint`
    #[arg(hide_short_help = true, long, value_name = "FILE")]
    pub(super) roles: Option<PathBuf>,
    #[command(flatten)]
    pub(super) read: ReadArgs,
}

/// What the rows of a CSV hold.
#[derive(clap::ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum CsvContent {
    /// Positions of the joints, metres
    Positions,
    /// Rotation of each joint in its parent's frame, quaternions
    Rotations,
    /// Feature rows, 30 a second
    Features,
}

impl From<CsvContent> for Content {
    fn from(table: CsvContent) -> Self {
        match table {
            CsvContent::Positions => Content::Positions,
            CsvContent::Rotations => Content::Rotations,
            CsvContent::Features => Content::Features,
        }
    }
}
