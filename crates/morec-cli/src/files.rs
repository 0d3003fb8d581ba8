//! Clips on disk: from what was typed to bytes, and from bytes to clips.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use clap::{Args, ValueEnum};
use morec::formats::bvh::PositionChannels;
use morec::formats::probe::{Format, format_of_name, probe};
use morec::roles::mapping::Mapping;
use morec_db::{FileReader, OpenedFile, read_file, read_stream};

use crate::output;

/// What files do not say about themselves.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Reading clips")]
pub struct ReadArgs {
    /// The ASF skeleton of AMC clips. Without it, the one beside the clip or a folder above is taken: of the same
    /// stem (a.asf for a.amc), of the subject (13.asf for 13_29.amc), or the one that fits.
    #[arg(long, value_name = "ASF")]
    pub skeleton: Option<PathBuf>,
    /// Frames a second, in place of what the file says (AMC files say nothing: 120 is assumed).
    #[arg(long, value_name = "HZ", value_parser = rate)]
    pub file_rate: Option<f64>,
    /// What BVH position channels below the root mean; decided from the data if not given.
    #[arg(long, value_enum)]
    pub positions: Option<Positions>,
}

/// What BVH position channels below the root mean.
#[derive(ValueEnum, Clone, Copy, Debug)]
pub enum Positions {
    /// The joint's position; OFFSET is not used.
    Replace,
    /// A movement from OFFSET.
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
    let (file, _) = morec_db::split_choice(path);
    output::mark_read(&file);
    read_file(&file).with_context(|| path.display().to_string())
}

/// The mapping file of roles, if one is given; errors begin with its path.
pub fn mapping(path: Option<&Path>) -> Result<Option<Mapping>> {
    let Some(path) = path else { return Ok(None) };
    Ok(Some(
        Mapping::read(&read(path)?).with_context(|| path.display().to_string())?,
    ))
}

/// The first few of many names.
pub fn some_of<'a>(names: impl ExactSizeIterator<Item = &'a String>) -> String {
    const SHOWN: usize = 5;
    let more = names.len().saturating_sub(SHOWN);
    let shown: Vec<&str> = names.take(SHOWN).map(String::as_str).collect();
    if more == 0 {
        shown.join(", ")
    } else {
        format!("{} and {more} more", shown.join(", "))
    }
}

/// The clips that paths stand for, and what folders hold besides.
#[derive(Debug, Default)]
pub struct Expanded {
    /// In the order of the paths; those of a folder in the order of theirs.
    pub clips: Vec<PathBuf>,
    /// Motion in folders that cannot be read, with the reason.
    pub left_out: Vec<(PathBuf, String)>,
    /// How many files in folders are no motion at all.
    pub others: usize,
}

impl Expanded {
    /// Says on standard error what folders hold besides clips; whether motion is among it.
    pub fn say_left_out(&self) -> bool {
        for (path, reason) in &self.left_out {
            eprintln!("morec: {}: left out: {reason}", path.display());
        }
        if self.others > 0 {
            eprintln!("morec: {} other files are no motion", self.others);
        }
        !self.left_out.is_empty()
    }
}

/// Folders become the clips in them, however deep, in the order of their paths; files stay where they are named. No
/// output of this run may take the place of any of them.
pub fn expand(paths: &[PathBuf]) -> Result<Vec<PathBuf>> {
    Ok(expand_all(paths)?.clips)
}

/// [`expand`] with what is left out.
pub fn expand_all(paths: &[PathBuf]) -> Result<Expanded> {
    let mut all = Expanded::default();
    for path in paths {
        if !path.is_dir() {
            all.clips.push(path.clone());
            continue;
        }
        let before = all.clips.len();
        collect(path, &mut all)?;
        all.clips[before..].sort();
        if all.clips.len() == before {
            let reasons: Vec<String> = all
                .left_out
                .iter()
                .take(5)
                .map(|(path, reason)| format!("\n{}: {reason}", path.display()))
                .collect();
            bail!(
                "{}: no clip that can be read in this folder or below{}",
                path.display(),
                reasons.concat()
            );
        }
    }
    all.left_out.sort();
    all.clips.iter().for_each(|clip| output::mark_read(clip));
    Ok(all)
}

fn collect(folder: &Path, all: &mut Expanded) -> Result<()> {
    for entry in fs::read_dir(folder).with_context(|| folder.display().to_string())? {
        let entry = entry.with_context(|| folder.display().to_string())?;
        let path = entry.path();
        // A link to a folder could lead back here; links to files cannot.
        if entry.file_type().is_ok_and(|kind| kind.is_dir()) {
            // A folder that cannot be read refuses itself only.
            if let Err(error) = collect(&path, all) {
                all.left_out.push((path, format!("{error:#}")));
            }
        } else if path.is_file() {
            match look_at(&path) {
                Found::Clip => all.clips.push(path),
                Found::LeftOut(reason) => all.left_out.push((path, reason)),
                Found::Other => all.others += 1,
                Found::Needed => {}
            }
        }
    }
    Ok(())
}

/// What a file in a folder is.
enum Found {
    Clip,
    /// Motion, but in a format that is not read.
    LeftOut(String),
    /// Skeletons of motions, hidden files.
    Needed,
    Other,
}

fn look_at(path: &Path) -> Found {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    if name.starts_with('.') {
        return Found::Needed;
    }
    let packed = ["zip", "gz"].iter();
    let ending = path.extension().unwrap_or_default();
    if packed
        .into_iter()
        .any(|known| ending.eq_ignore_ascii_case(known))
    {
        return Found::Clip;
    }
    match format_of_name(&name) {
        Some(Format::Asf) => Found::Needed,
        // Tables and JSON hold labels, too: what is in them decides.
        Some(Format::Table | Format::Jsonl) | None => by_content(path),
        Some(_) => Found::Clip,
    }
}

fn by_content(path: &Path) -> Found {
    const HEAD: u64 = 64 * 1024;
    let mut head = Vec::new();
    let read = fs::File::open(path).and_then(|file| file.take(HEAD).read_to_end(&mut head));
    if let Err(error) = read {
        return Found::LeftOut(error.to_string());
    }
    match probe(&head, "") {
        Ok(Format::Asf) => Found::Needed,
        Ok(_) => Found::Clip,
        Err(error) if error.found.starts_with("what looks like") && !is_media(&error.found) => {
            Found::LeftOut(error.found)
        }
        Err(_) => Found::Other,
    }
}

/// Pictures and videos lie beside motion without being any.
fn is_media(found: &str) -> bool {
    found.contains("video,") || found.contains("a picture,")
}

/// Reads a clip; `-` is standard input. Errors begin with the path.
pub fn open(path: &Path, args: &ReadArgs) -> Result<OpenedFile> {
    let bytes = if path == Path::new("-") {
        read_stream(std::io::stdin().lock()).context("standard input")?
    } else {
        read(path)?
    };
    parse(path, &bytes, args)
}

/// Reads a clip whose bytes are at hand. Errors begin with the path.
pub fn parse(path: &Path, bytes: &[u8], args: &ReadArgs) -> Result<OpenedFile> {
    let opened = args
        .reader()
        .open(path, bytes)
        .with_context(|| path.display().to_string())?;
    if let Some(skeleton) = &opened.skeleton {
        output::mark_read(skeleton);
    }
    Ok(opened)
}

impl ReadArgs {
    /// What reads files so.
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
