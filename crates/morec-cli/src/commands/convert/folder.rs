//! Writes many clips into a folder, one file for each, with the subfolders that they come from.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, bail};

use super::args::Args;
use super::form::{self, ClipForm};
use super::wanted::Wanted;
use crate::files;
use crate::progress::SlowProgress;

/// Writes every clip that `args` name. Exit code 1 if one of them could not be read or written, or a folder holds motion
/// that is not read; the others are written.
pub(super) fn convert(args: &Args, wanted: &Wanted) -> Result<ExitCode> {
    let output = &args.output;
    if args.character.is_some() {
        bail!("--character chooses from one file; in a folder, every character is written");
    }
    if output == Path::new("-") || output.is_file() {
        bail!(
            "{} is not a folder; several clips need a folder",
            output.display()
        );
    }
    let form = args.form.unwrap_or(ClipForm::Bvh);
    let mut failed = false;
    let mut from: Vec<(PathBuf, PathBuf)> = Vec::new();
    for path in &args.clips {
        let listing = files::expand_all(std::slice::from_ref(path))?;
        failed |= files::say_left_out(&listing);
        for clip in listing.clips {
            let within = clip
                .strip_prefix(path)
                .ok()
                .filter(|rest| *rest != Path::new(""));
            let name = within.or(clip.file_name().map(Path::new)).unwrap_or(&clip);
            from.push((clip.clone(), name.to_owned()));
        }
    }
    let mut progress = SlowProgress::new(from.len(), "converting clips");
    let mut taken: BTreeSet<PathBuf> = BTreeSet::new();
    for (path, name) in &from {
        let done = one(path, &output.join(name), form, args, wanted, &mut taken);
        failed |= progress.step_of(done).is_none();
    }
    drop(progress);
    eprintln!(
        "morec: {} files written to {}",
        taken.len(),
        output.display()
    );
    Ok(match failed {
        true => ExitCode::FAILURE,
        false => ExitCode::SUCCESS,
    })
}

/// Writes the clips of one file beside `target`, whose ending is that of the file they are from.
fn one(
    path: &Path,
    target: &Path,
    form: ClipForm,
    args: &Args,
    wanted: &Wanted,
    taken: &mut BTreeSet<PathBuf>,
) -> Result<()> {
    let opened = files::open(path, &args.read)?;
    for warning in &opened.warnings {
        eprintln!("morec: {}: {warning}", path.display());
    }
    let wanted = &wanted.of_file(opened.stated);
    let several = opened.clips.len() > 1;
    for (number, clip) in (1..).zip(opened.clips) {
        if clip.frames == 0 {
            eprintln!("morec: {}: no frames; left out", path.display());
            continue;
        }
        let mut target = target.to_owned();
        if several {
            let stem = target.file_stem().unwrap_or_default().to_string_lossy();
            target.set_file_name(format!("{stem}_{number}.x"));
        }
        let file = free(&target, form, path, taken);
        if let Some(folder) = file.parent() {
            fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
        }
        let clip = wanted
            .prepared(clip)
            .with_context(|| path.display().to_string())?;
        form::write(clip, form, wanted, &file)
            .with_context(|| format!("{} to {}", path.display(), file.display()))?;
        taken.insert(file);
    }
    Ok(())
}

/// `target` with the form's ending; with its own before that where another clip of this run has the name.
fn free(target: &Path, form: ClipForm, path: &Path, taken: &BTreeSet<PathBuf>) -> PathBuf {
    let plain = target.with_extension(form.ending());
    if !taken.contains(&plain) {
        return plain;
    }
    let own = path.extension().unwrap_or_default().to_string_lossy();
    (1..)
        .map(|number| match number {
            1 => target.with_extension(format!("{own}.{}", form.ending())),
            _ => target.with_extension(format!("{own}.{number}.{}", form.ending())),
        })
        .find(|name| !taken.contains(name))
        .unwrap_or(plain)
}
