//! `morec db export`: writes labels in other programs' formats, or the motion of clips.

mod args;
mod motion;

use std::path::Path;
use std::process::ExitCode;

use anyhow::{Context, Result, bail};
use morec_db::exchange::{self, Annotation, LabelFormat};
use morec_db::labels::SampleFilter;

pub use args::Args;

use crate::database;
use crate::output;
use crate::print;

/// Writes what was asked for.
pub fn run(args: &Args) -> Result<ExitCode> {
    let db = database::open_read_only(&args.db)?;
    if let Some(pattern) = &args.motion {
        let written = motion::export(args, &db, pattern)?;
        said(args, written.files, written.frames, "frames")?;
        return Ok(match written.failed {
            0 => ExitCode::SUCCESS,
            _ => ExitCode::FAILURE,
        });
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
    let shown = args.output.to_string_lossy();
    let form = match args.form {
        Some(form) => form.of_labels()?,
        None => LabelFormat::of_file(&shown, b"{\"labels\":[]}").with_context(|| {
            format!("{shown}: cannot infer the label format from the extension; pass --form")
        })?,
    };
    let filter = SampleFilter {
        clip,
        class: args.class.clone(),
        state: Some(args.state),
        annotator: args.annotator.clone(),
    };
    let samples = db.samples(&filter)?.into_iter();
    let annotations: Vec<Annotation> = samples
        .flat_map(|sample| Annotation::of_sample(sample, form))
        .filter(|a| {
            args.annotator.is_none() || a.annotator.is_none() || a.annotator == args.annotator
        })
        .collect();
    if annotations.iter().any(|a| !form.keeps(a.state)) {
        let (form, state) = (form.name(), args.state.name());
        eprintln!(
            "morec: {form} cannot store that these samples are {state}: give --state {state} when reading the file back"
        );
    }
    let lengths = database::lengths(&db)?;
    let mut files = 1;
    if form.is_of_one_clip() && args.clip.is_none() {
        files = a_file_a_clip(&args.output, form, &annotations, &lengths)?;
    } else {
        let text = exchange::write(form, &annotations, &lengths).map_err(anyhow::Error::msg)?;
        if args.output == Path::new("-") {
            return print::print(text).map(|()| ExitCode::SUCCESS);
        }
        output::write_whole(&args.output, |out| out.write_all(text.as_bytes()))
            .with_context(|| args.output.display().to_string())?;
    }
    said(args, files, annotations.len(), "labels")
}

fn said(args: &Args, files: usize, count: usize, what: &str) -> Result<ExitCode> {
    if args.json {
        print::print_json(&serde_json::json!({ "files": files, what: count }))?;
    } else if args.output != Path::new("-") {
        print::print(format_args!(
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
            "{}: {} can store one clip only: give a folder, or choose a clip with --clip",
            folder.display(),
            form.name()
        );
    }
    std::fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    let mut files = 0;
    let of_clips: Vec<&[Annotation]> = annotations.chunk_by(|a, b| a.clip == b.clip).collect();
    let names = exchange::file_names(of_clips.iter().map(|of_clip| of_clip[0].clip.as_str()));
    for (of_clip, name) in of_clips.iter().zip(&names) {
        let text = exchange::write(form, of_clip, lengths).map_err(anyhow::Error::msg)?;
        let path = folder.join(form.file_of_clip(name));
        output::write_whole(&path, |out| out.write_all(text.as_bytes()))
            .with_context(|| path.display().to_string())?;
        files += 1;
    }
    Ok(files)
}
