//! Writes the motion of clips, one file for each clip.

use std::path::Path;

use anyhow::{Context, Result, bail};
use morec::formats::bvh;
use morec_db::{ClipFilter, ClipInfo, MotionDb, exchange};

use super::args::Args;
use crate::commands::convert::{ClipForm, CsvContent, write_take};
use crate::print;
use crate::progress::SlowProgress;

/// What was written.
#[derive(Default)]
pub(super) struct Written {
    pub files: usize,
    pub frames: usize,
    /// Clips that could not be.
    pub failed: usize,
}

/// Writes the clips whose names match `pattern`: one as the file that `args` name, several into it as a folder.
pub(super) fn export(args: &Args, db: &MotionDb, pattern: &str) -> Result<Written> {
    let clips = match pattern.contains(['*', '?']) {
        true => db.find_clips(&ClipFilter {
            name: Some(pattern.to_owned()),
            ..ClipFilter::default()
        })?,
        false => vec![db.find_clip(pattern)?],
    };
    let form = args.form.map(|form| form.of_motion()).transpose()?;
    match clips.as_slice() {
        [] => bail!("--motion {pattern}: no clip has this name"),
        [clip] if !args.output.is_dir() => Ok(Written {
            files: 1,
            frames: one(args, db, clip, form)?,
            failed: 0,
        }),
        several => folder(args, db, several, form),
    }
}

fn one(args: &Args, db: &MotionDb, clip: &ClipInfo, form: Option<ClipForm>) -> Result<usize> {
    let output = &args.output;
    let shown = || output.display().to_string();
    let to_stdout = output == Path::new("-");
    let form = match form {
        Some(form) => form,
        None if to_stdout => ClipForm::Bvh,
        None => ClipForm::of(output).with_context(shown)?,
    };
    if args.table != CsvContent::Positions && form != ClipForm::Csv {
        bail!("--table is for .csv output");
    }
    let take = db.clip(clip.id)?.into_take()?;
    if to_stdout {
        if form != ClipForm::Bvh {
            bail!("standard output takes motion as BVH only; give a file for other formats");
        }
        let mut text = Vec::new();
        bvh::write(&take.clip, &mut text)?;
        print::print(String::from_utf8_lossy(&text))?;
    } else {
        write_take(&take, form, args.table.into(), output).with_context(shown)?;
    }
    Ok(take.clip.frames)
}

fn folder(
    args: &Args,
    db: &MotionDb,
    clips: &[ClipInfo],
    form: Option<ClipForm>,
) -> Result<Written> {
    let folder = &args.output;
    if folder == Path::new("-") || folder.is_file() {
        bail!(
            "{} is not a folder; {} clips need a folder",
            folder.display(),
            clips.len()
        );
    }
    let form = form.unwrap_or(ClipForm::Bvh);
    if args.table != CsvContent::Positions && form != ClipForm::Csv {
        bail!("--table is for .csv output; add --form csv");
    }
    std::fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    let names = exchange::file_names(clips.iter().map(|clip| clip.name.as_str()));
    let mut progress = SlowProgress::new(clips.len(), "writing clips");
    let mut written = Written::default();
    for (clip, name) in clips.iter().zip(&names) {
        let path = folder.join(format!("{name}.{}", form.ending()));
        let write = || {
            let take = db.clip(clip.id)?.into_take()?;
            write_take(&take, form, args.table.into(), &path)
                .with_context(|| path.display().to_string())?;
            anyhow::Ok(take.clip.frames)
        };
        match write() {
            Ok(frames) => {
                written.files += 1;
                written.frames += frames;
            }
            // The others do not suffer for one.
            Err(error) => {
                progress.suspend(|| eprintln!("morec: clip {} left out: {error:#}", clip.name));
                written.failed += 1;
            }
        }
        progress.step();
    }
    match written.files {
        0 => bail!("none of the {} clips could be written", clips.len()),
        _ => Ok(written),
    }
}
