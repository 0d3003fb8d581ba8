//! The command line of `morec db export`.

use std::path::PathBuf;

use anyhow::{Context, Result};
use clap::ValueEnum;
use morec_db::exchange::LabelFormat;

use crate::commands::convert::{self, CsvContent};
use crate::commands::db::label::{FormArg, StateArg};

/// Write labels for other programs, or the motion of clips
///
/// The output's ending chooses the form: .tsv, .csv, .json, .eaf or .txt of labels; with --motion .bvh, .c3d, .trc, .jsonl,
/// .glb, .vrma, .npz with positions, rotations and feature rows, or .csv with one of these. Motion is in metres with Y up.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  morec db export moves.mdb labels.tsv
  morec db export moves.mdb proposals.csv --state proposed
  morec db export moves.mdb eaf/ --form eaf            # a file for each clip
  morec db export moves.mdb walk.bvh --motion walk_01
  morec db export moves.mdb arrays/ --motion 'walk*' --form npz
  morec db export moves.mdb features/ --motion '*' --form csv --table features")]
pub struct Args {
    /// The database
    #[arg(value_name = "DB")]
    pub(super) db: PathBuf,
    /// The file to write, `-` for standard output; a folder for forms of one clip, and for the motion of several
    #[arg(value_name = "FILE|DIR")]
    pub(super) output: PathBuf,
    /// Form to write [default: by the file's ending]
    #[arg(long, value_enum)]
    pub(super) form: Option<ExportForm>,
    /// Labels of this clip only
    #[arg(long, value_name = "CLIP")]
    pub(super) clip: Option<String>,
    /// Labels of this class only
    #[arg(long, value_name = "CLASS")]
    pub(super) class: Option<String>,
    /// State of the samples to write
    #[arg(long, value_enum, default_value = "accepted")]
    pub(super) state: StateArg,
    /// Write the motion of this clip instead of labels, or of all clips whose name matches (`*` any text, `?` one
    /// character)
    #[arg(long, value_name = "CLIP", conflicts_with_all = ["clip", "class", "state"])]
    pub(super) motion: Option<String>,
    /// Content of a CSV of motion
    #[arg(long, value_enum, default_value = "positions", requires = "motion")]
    pub(super) table: CsvContent,
    /// Print one JSON object: what was written
    #[arg(long)]
    pub(super) json: bool,
}

/// A form of labels or of motion; a CSV may be either.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub(super) enum ExportForm {
    Tsv,
    Csv,
    Json,
    Eaf,
    Audacity,
    Babel,
    LabelStudio,
    Bvh,
    C3d,
    Trc,
    Jsonl,
    Glb,
    Vrma,
    Npz,
}

impl ExportForm {
    /// The value of this name among another set of forms.
    fn among<Form: ValueEnum>(self) -> Option<Form> {
        let value = self.to_possible_value()?;
        Form::from_str(value.get_name(), false).ok()
    }

    pub(super) fn of_labels(self) -> Result<LabelFormat> {
        let form = self.among::<FormArg>().map(LabelFormat::from);
        form.context("--form: that is a form of motion; say of which clip with --motion")
    }

    pub(super) fn of_motion(self) -> Result<convert::ClipForm> {
        self.among()
            .context("--form: that is a form of labels, and --motion writes motion")
    }
}
