//! `morec convert`: writes clips as BVH, points, scenes, or tables of numbers.

mod args;
mod folder;
mod form;
mod wanted;

use std::io::Write;
use std::path::Path;
use std::process::ExitCode;

use anyhow::{Context, Result, bail};
use morec::clip::Clip;
use morec::formats::bvh;
use morec::import::ImportOptions;

pub use args::{Args, CsvContent};
pub use form::{ClipForm, write_clip, write_take};
use wanted::Wanted;

use crate::files;

/// Reads, resamples if asked to, and writes.
pub fn run(args: Args) -> Result<ExitCode> {
    let wanted = Wanted {
        content: args.table.into(),
        import: ImportOptions {
            mapping: files::mapping(args.roles.as_deref())?,
            ..ImportOptions::default()
        },
        rate_hz: args.rate,
        fit: args.fit,
    };
    let into_folder =
        args.clips.len() > 1 || args.clips.iter().any(|path| path.is_dir()) || args.form.is_some();
    if into_folder {
        return folder::convert(&args, &wanted);
    }
    let (path, output) = (&args.clips[0], &args.output);
    let to_stdout = output == Path::new("-");
    let form = match to_stdout {
        true => ClipForm::Bvh,
        false => ClipForm::of(output).with_context(|| output.display().to_string())?,
    };
    if args.table != CsvContent::Positions && form != ClipForm::Csv {
        bail!("--table is for .csv output");
    }
    let opened = files::open(path, &args.read)?;
    for warning in &opened.warnings {
        eprintln!("morec: {}: {warning}", path.display());
    }
    let wanted = wanted.of_file(opened.stated);
    let clip = one_of(opened.clips, args.character).with_context(|| path.display().to_string())?;
    let clip = wanted
        .prepared(clip)
        .with_context(|| path.display().to_string())?;
    if to_stdout {
        let mut out = std::io::stdout().lock();
        bvh::write(&clip, &mut out).context("standard output")?;
        out.flush().context("standard output")?;
    } else {
        form::write(clip, form, &wanted, output).with_context(|| output.display().to_string())?;
    }
    Ok(ExitCode::SUCCESS)
}

fn one_of(mut clips: Vec<Clip>, character: Option<usize>) -> Result<Clip> {
    let count = clips.len();
    match character {
        None if count == 1 => Ok(clips.remove(0)),
        None => bail!("the file has {count} characters; choose one with --character"),
        Some(n) if (1..=count).contains(&n) => Ok(clips.remove(n - 1)),
        Some(n) => bail!("character {n} does not exist; the file has {count} characters"),
    }
}
