//! `morec db export`: labels in other programs' forms, or the motion of clips.

mod motion;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, bail};
use clap::ValueEnum;
use morec_db::exchange::{self, Annotation, LabelFormat};
use morec_db::labels::{SampleFilter, SampleState};

use super::label::{FormArg, StateArg};
use crate::commands::convert::{self, CsvContent};
use crate::database;
use crate::output;

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
    db: PathBuf,
    /// The file to write, `-` for standard output; a folder for forms of one clip, and for the motion of several
    #[arg(value_name = "FILE|DIR")]
    output: PathBuf,
    /// What form to write [default: by the file's ending]
    #[arg(long, value_enum)]
    form: Option<ExportForm>,
    /// Labels of this clip only
    #[arg(long, value_name = "CLIP")]
    clip: Option<String>,
    /// Labels of this class only
    #[arg(long, value_name = "CLASS")]
    class: Option<String>,
    /// Which samples
    #[arg(long, value_enum, default_value = "accepted")]
    state: StateArg,
    /// Write the motion of this clip instead of labels, or of all clips whose name matches (`*` any text, `?` one
    /// character)
    #[arg(long, value_name = "CLIP", conflicts_with_all = ["clip", "class", "state"])]
    motion: Option<String>,
    /// What a CSV of motion holds
    #[arg(long, value_enum, default_value = "positions", requires = "motion")]
    table: CsvContent,
    /// Print one JSON object: what was written
    #[arg(long)]
    json: bool,
}

/// A form of labels or of motion; a CSV may be either.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
enum ExportForm {
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

    fn of_labels(self) -> Result<LabelFormat> {
        let form = self.among::<FormArg>().map(LabelFormat::from);
        form.context("--form: that is a form of motion; say of which clip with --motion")
    }

    fn of_motion(self) -> Result<convert::ClipForm> {
        self.among()
            .context("--form: that is a form of labels, and --motion writes motion")
    }
}

/// Writes what was asked for.
pub fn run(args: &Args) -> Result<ExitCode> {
    let db = database::open_read_only(&args.db)?;
    if let Some(pattern) = &args.motion {
        return motion::export(args, &db, pattern);
    }
    let clip = args
        .clip
        .as_deref()
        .map(|name| db.find_clip(name))
        .transpose()?
        .map(|info| info.id);
    if let Some(class) = &args.class {
        db.need_class(class)?;
    }
    let filter = SampleFilter {
        clip,
        class: args.class.clone(),
        state: Some(args.state.into()),
    };
    let annotations: Vec<Annotation> = db
        .samples(&filter)?
        .into_iter()
        .map(|s| Annotation {
            extent: (!s.whole_clip).then_some((s.start_secs, s.stop_secs)),
            clip: s.clip_name,
            class: s.class,
            person: s.subject,
            score: s.score,
            state: SampleState::from(args.state),
        })
        .collect();
    let shown = args.output.to_string_lossy();
    let form = match args.form {
        Some(form) => form.of_labels()?,
        None => LabelFormat::of_file(&shown, b"{\"labels\":[]}")
            .with_context(|| format!("{shown}: its ending says no form of labels; give --form"))?,
    };
    if annotations.iter().any(|a| !form.keeps(a.state)) {
        let (form, state) = (form.name(), SampleState::from(args.state).name());
        eprintln!(
            "morec: {form} does not say that these are {state}; read back, give --state {state} again"
        );
    }
    let lengths = super::lengths(&db)?;
    let mut files = 1;
    if form.is_of_one_clip() && args.clip.is_none() {
        files = a_file_a_clip(&args.output, form, &annotations, &lengths)?;
    } else {
        let text = exchange::write(form, &annotations, &lengths).map_err(anyhow::Error::msg)?;
        if args.output == Path::new("-") {
            return super::print(text).map(|()| ExitCode::SUCCESS);
        }
        output::write_whole(&args.output, |out| out.write_all(text.as_bytes()))
            .with_context(|| args.output.display().to_string())?;
    }
    said(args, files, annotations.len(), "labels")
}

fn said(args: &Args, files: usize, count: usize, what: &str) -> Result<ExitCode> {
    if args.json {
        super::print_json(&serde_json::json!({ "files": files, what: count }))?;
    } else if args.output != Path::new("-") {
        super::print(format_args!(
            "{}: {count} {what} in {files} files\n",
            args.output.display()
        ))?;
    }
    Ok(ExitCode::SUCCESS)
}

fn a_file_a_clip(
    folder: &Path,
    form: LabelFormat,
    annotations: &[Annotation],
    lengths: &exchange::ClipLengths,
) -> Result<usize> {
    if folder.is_file() {
        bail!(
            "{}: {} holds one clip: give a folder, or --clip",
            folder.display(),
            form.name()
        );
    }
    std::fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    let ending = if form == LabelFormat::Eaf {
        "eaf"
    } else {
        "txt"
    };
    let mut files = 0;
    let of_clips: Vec<&[Annotation]> = annotations.chunk_by(|a, b| a.clip == b.clip).collect();
    let names = exchange::file_names(of_clips.iter().map(|of_clip| of_clip[0].clip.as_str()));
    for (of_clip, name) in of_clips.iter().zip(&names) {
        let text = exchange::write(form, of_clip, lengths).map_err(anyhow::Error::msg)?;
        let path = folder.join(format!("{name}.{ending}"));
        output::write_whole(&path, |out| out.write_all(text.as_bytes()))
            .with_context(|| path.display().to_string())?;
        files += 1;
    }
    Ok(files)
}
