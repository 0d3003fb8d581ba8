//! The command line of `morec db export`.

use std::path::PathBuf;

use anyhow::{Context, Result};
use clap::ValueEnum;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use morec_db::exchange::LabelFormat;
use morec_db::labels::SampleState;

use crate::commands::convert::{ClipForm, CsvContent};
use crate::named::by_name;

/// Write labels for other programs, or the motion of clips
///
/// The output's extension chooses the form: .tsv, .csv, .json, .eaf or .txt for labels; with --motion .bvh, .c3d, .trc, .jsonl,
/// .glb, .vrma, .npz (positions, rotations and feature rows) or .csv (one of these three). Motion is in metres, Y up.
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
    /// File to write, - for standard output; a folder for several files
    #[arg(value_name = "FILE|DIR")]
    pub(super) output: PathBuf,
    /// Form to write [default: by the extension]
    #[arg(long, value_parser = ExportForm::parser())]
    pub(super) form: Option<ExportForm>,
    /// Labels of this clip only
    #[arg(long, value_name = "CLIP")]
    pub(super) clip: Option<String>,
    /// Labels of this class only
    #[arg(long, value_name = "CLASS")]
    pub(super) class: Option<String>,
    /// Labels of this annotator only
    #[arg(long, value_name = "NAME")]
    pub(super) annotator: Option<String>,
    /// State of the samples to write
    #[arg(long, default_value = "accepted", value_parser = by_name(&SampleState::ALL, SampleState::name))]
    pub(super) state: SampleState,
    /// Write the motion of these clips instead of labels
    ///
    /// `*` stands for any text, `?` for one character.
    #[arg(long, value_name = "CLIP", conflicts_with_all = ["clip", "class", "state", "annotator"])]
    pub(super) motion: Option<String>,
    /// Content of a CSV of motion
    #[arg(long, value_enum, default_value = "positions", requires = "motion")]
    pub(super) table: CsvContent,
    /// Print one JSON object: what was written
    #[arg(long)]
    pub(super) json: bool,
}

/// A form by its name: of labels, of motion or, if it is CSV, of both.
#[derive(Clone, Copy, Debug)]
pub(super) struct ExportForm {
    labels: Option<LabelFormat>,
    motion: Option<ClipForm>,
}

impl ExportForm {
    fn parser() -> impl TypedValueParser<Value = Self> {
        let mut names: Vec<&str> = LabelFormat::ALL.map(LabelFormat::name).to_vec();
        let of_motion = ClipForm::value_variants().iter().map(|form| form.ending());
        names.extend(of_motion.filter(|name| *name != LabelFormat::Csv.name()));
        PossibleValuesParser::new(names).map(|name| Self {
            labels: LabelFormat::ALL
                .into_iter()
                .find(|form| form.name() == name),
            motion: ClipForm::from_str(&name, false).ok(),
        })
    }

    pub(super) fn of_labels(self) -> Result<LabelFormat> {
        self.labels
            .context("--form: this is a format of motion; choose the clip with --motion")
    }

    pub(super) fn of_motion(self) -> Result<ClipForm> {
        self.motion
            .context("--form: this is a form of labels, but --motion writes motion")
    }
}
