//! Reads clips from the paths on the command line, with the options for reading that all commands share.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use clap::{Args, ValueEnum};
use morec::diagnosis::errors_of_clip;
use morec::files::{
    ClipFile, FileError, FileReader, Listing, is_large, list_as, read_file, read_stream,
    split_choice,
};
use morec::formats::bvh::PositionChannels;
use morec::import::{ImportOptions, Take};
use morec::roles::mapping::Mapping;

use crate::output;

/// Options of reading, for what files do not say.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Reading clips")]
pub struct ReadArgs {
    /// ASF skeleton of AMC clips, or OSIM model of MOT and STO clips
    ///
    /// By default, the clip's folder and the folders above are searched: first for the same name (a.asf for a.amc), then for the
    /// subject's name (13.asf for 13_29.amc), then for the skeleton that fits the motion best.
    #[arg(hide_short_help = true, long, value_name = "ASF")]
    pub skeleton: Option<PathBuf>,
    /// Frame rate, instead of the file's (AMC states none: 120 Hz)
    #[arg(hide_short_help = true, long, value_name = "HZ", value_parser = rate)]
    pub file_rate: Option<f64>,
    /// Meaning of BVH position channels below the root [default: inferred]
    #[arg(hide_short_help = true, long, value_enum)]
    pub positions: Option<Positions>,
}

/// Meaning of BVH position channels below the root.
#[derive(ValueEnum, Clone, Copy, Debug)]
pub enum Positions {
    /// The joint's position, instead of OFFSET
    Replace,
    /// A movement from OFFSET
    Add,
}

/// A rate that can be: more than nothing, and finite.
pub fn rate(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(rate) if rate.is_finite() && rate > 0.0 && rate <= 100_000.0 => Ok(rate),
        _ => Err("expected a rate in Hz, above 0 and at most 100000".to_owned()),
    }
}

/// A file's bytes; errors begin with the path. No output of this run may take its place.
pub fn read(path: &Path) -> Result<Vec<u8>> {
    output::mark_read(path);
    let (file, _) = split_choice(path);
    output::mark_read(&file);
    if file.is_dir() {
        bail!("{}: expected a file, found a folder", path.display());
    }
    read_file(&file).with_context(|| path.display().to_string())
}

/// The mapping file of roles, if one is given; errors begin with its path.
pub fn mapping(path: Option<&Path>) -> Result<Option<Mapping>> {
    let Some(path) = path else { return Ok(None) };
    Ok(Some(
        Mapping::read(&read(path)?).with_context(|| path.display().to_string())?,
    ))
}

/// Says on standard error what folders hold besides clips; whether motion is among it.
pub fn say_left_out(listing: &Listing) -> bool {
    for FileError { path, kind } in &listing.left_out {
        eprintln!("morec: {}: left out: {kind}", path.display());
    }
    if listing.others > 0 {
        eprintln!("morec: {} other files are not motion", listing.others);
    }
    !listing.left_out.is_empty()
}

/// Folders become the clips in them, however deep, in the order of their paths; files stay where they are named. No
/// output of this run may take the place of any of them. What folders hold that cannot be read is said.
pub fn expand(paths: &[PathBuf]) -> Result<Vec<PathBuf>> {
    expand_as(paths, false)
}

/// [`expand`]; with `planar`, tables of points in two dimensions are clips too.
pub fn expand_as(paths: &[PathBuf], planar: bool) -> Result<Vec<PathBuf>> {
    let listing = listed(paths, planar)?;
    for FileError { path, kind } in &listing.left_out {
        eprintln!("morec: {}: left out: {kind}", path.display());
    }
    Ok(listing.clips)
}

/// [`expand`] with what is left out, which is not said.
pub fn expand_all(paths: &[PathBuf]) -> Result<Listing> {
    listed(paths, false)
}

fn listed(paths: &[PathBuf], planar: bool) -> Result<Listing> {
    let all = list_as(paths, planar)?;
    all.clips.iter().for_each(|clip| output::mark_read(clip));
    Ok(all)
}

/// The takes in a file; `-` is standard input. Errors begin with the path.
pub fn takes(path: &Path, args: &ReadArgs, options: &ImportOptions) -> Result<Vec<Take>> {
    takes_as(path, args, options, false)
}

/// [`takes`]; with `planar`, of points in two dimensions too.
pub fn takes_as(
    path: &Path,
    args: &ReadArgs,
    options: &ImportOptions,
    planar: bool,
) -> Result<Vec<Take>> {
    let opened = match planar && options.mapping.is_none() {
        true => open_planar(path, args)?,
        false => open_with(path, args, options.mapping.as_ref())?,
    };
    let takes = opened.into_takes(options);
    let takes = takes.with_context(|| path.display().to_string())?;
    say_doubts(path, &takes);
    Ok(takes)
}

/// Says on standard error what cannot be true of the bodies in a file, and what `morec inspect` calls an error of them.
pub fn say_doubts(path: &Path, takes: &[Take]) {
    for take in takes {
        let errors = errors_of_clip(&take.clip, &take.roles, take.rest());
        for doubt in take.report.doubts.iter().chain(&errors) {
            eprintln!("morec: {}: {doubt}", path.display());
        }
    }
}

/// Reads a clip; `-` is standard input. Errors begin with the path.
pub fn open(path: &Path, args: &ReadArgs) -> Result<ClipFile> {
    open_with(path, args, None)
}

/// [`open`], for the roles of a mapping file.
pub fn open_with(path: &Path, args: &ReadArgs, mapping: Option<&Mapping>) -> Result<ClipFile> {
    open_by(path, &args.reader_with(mapping.cloned()))
}

/// [`open`], of points in two dimensions too.
pub fn open_planar(path: &Path, args: &ReadArgs) -> Result<ClipFile> {
    let planar = FileReader {
        planar: true,
        ..args.reader()
    };
    open_by(path, &planar)
}

fn open_by(path: &Path, reader: &FileReader) -> Result<ClipFile> {
    let (file, _) = split_choice(path);
    if path != Path::new("-") && is_large(&file) {
        // Not held as a whole, if its format allows it.
        output::mark_read(path);
        output::mark_read(&file);
        return marked(reader.read(path)?);
    }
    let bytes = if path == Path::new("-") {
        read_stream(std::io::stdin().lock()).context("standard input")?
    } else {
        read(path)?
    };
    marked(reader.parse(path, &bytes)?)
}

/// No output of this run may take the place of the skeleton that a clip was read with.
fn marked(opened: ClipFile) -> Result<ClipFile> {
    if let Some(skeleton) = &opened.skeleton {
        output::mark_read(skeleton);
    }
    Ok(opened)
}

impl ReadArgs {
    /// A reader with these options and the roles of a mapping file.
    pub fn reader_with(&self, mapping: Option<Mapping>) -> FileReader {
        FileReader {
            import: ImportOptions {
                mapping,
                ..ImportOptions::default()
            },
            ..self.reader()
        }
    }

    /// A reader with these options.
    pub fn reader(&self) -> FileReader {
        let positions = self.positions.map(|positions| match positions {
            Positions::Replace => PositionChannels::Replace,
            Positions::Add => PositionChannels::Add,
        });
        let (skeleton, rate_hz) = (self.skeleton.clone(), self.file_rate);
        FileReader {
            skeleton,
            rate_hz,
            positions,
            ..FileReader::default()
        }
    }
}
