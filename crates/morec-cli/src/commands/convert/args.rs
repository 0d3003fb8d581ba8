//! The command line of `morec convert`.

use std::path::PathBuf;

use morec::tables::Content;

use super::form::ClipForm;
use crate::files::{self, ReadArgs};

/// Write clips as BVH, C3D, TRC, GLB, VRMA, lines of JSON, NumPy archives or CSV
///
/// The ending of the output chooses: .bvh; .c3d, .trc and .jsonl with where joints and points are, without rotations; .glb
/// and .vrma for other programs and avatars; .npz with positions, rotations and feature rows by name; .csv with one of
/// these. In BVH and the formats of points lengths and axes stay as the clip has them (but lengths without a named unit in
/// C3D and TRC become millimetres); the others hold metres with Y up, as `morec inspect` understands the clip. Folders and
/// several clips are written into a folder, in the form that --form names. What was repaired in reading is said on
/// standard error.
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
    /// Clips in any format that is read, or folders of clips; - is standard input
    #[arg(required = true, value_name = "CLIP")]
    pub(super) clips: Vec<PathBuf>,
    /// The file to write, or the folder for several clips; - is BVH on standard output
    #[arg(short, long, value_name = "FILE|FOLDER")]
    pub(super) output: PathBuf,
    /// Write into a folder, in this form [default: bvh]
    #[arg(long, value_enum)]
    pub(super) form: Option<ClipForm>,
    /// Content of a CSV
    #[arg(long, value_enum, default_value_t = CsvContent::Positions)]
    pub(super) table: CsvContent,
    /// Resample to this rate; without it, every frame is kept as it is
    #[arg(long, value_name = "HZ", value_parser = files::rate)]
    pub(super) rate: Option<f64>,
    /// Lay a skeleton of fixed bone lengths into clips of points, so that joints have rotations; how far it is from the
    /// points is said on standard error
    #[arg(long)]
    pub(super) fit: bool,
    /// Number of the character to write, from 1, of a file that holds several
    #[arg(long, value_name = "N")]
    pub(super) character: Option<usize>,
    /// Roles that override those found: a file of `role<TAB>joint` lines
    #[arg(long, value_name = "FILE")]
    pub(super) roles: Option<PathBuf>,
    #[command(flatten)]
    pub(super) read: ReadArgs,
}

/// Content of a CSV.
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
