//! Clips on disk: from what was typed to bytes, from bytes to clips, and from a motion to its skeleton.

use std::fs;
use std::io::{self, BufWriter, Read, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, bail};
use clap::{Args, ValueEnum};
use morec::clip::Clip;
use morec::formats::acclaim::{self, AmcOptions, Asf};
use morec::formats::bvh::{self, BvhOptions, PositionChannels};
use morec::formats::probe::{Format, format_of_name, probe};
use morec::formats::{Limits, Loaded, Place, Warning, mclip};
use morec::roles::mapping::Mapping;

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

/// A file that was read.
#[derive(Debug)]
pub struct Opened {
    /// What it is.
    pub format: Format,
    /// The skeleton file that an AMC clip was read with.
    pub skeleton: Option<PathBuf>,
    /// One clip for each character; an ASF file gives one without frames.
    pub clips: Vec<Clip>,
    /// What was repaired or looks wrong.
    pub warnings: Vec<Warning>,
}

/// A rate that can be: more than nothing, and finite.
pub fn rate(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(rate) if rate.is_finite() && rate > 0.0 && rate <= 100_000.0 => Ok(rate),
        _ => Err("expected a rate in Hz, above 0 and at most 100000".to_owned()),
    }
}

/// A file's bytes; errors begin with the path.
pub fn read(path: &Path) -> Result<Vec<u8>> {
    fs::read(path).with_context(|| path.display().to_string())
}

/// Writes beside the target and renames: a failure leaves no half file under its name, and whoever reads meanwhile
/// sees the old file or the new one.
pub fn write_whole(path: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
    let mut partial = path.as_os_str().to_owned();
    partial.push(".partial");
    let partial = PathBuf::from(partial);
    let written = fs::File::create(&partial).and_then(|file| {
        let mut out = BufWriter::new(file);
        write(&mut out)?;
        out.flush()?;
        fs::rename(&partial, path)
    });
    if written.is_err() {
        // Best effort: the first error is the one to tell.
        let _ = fs::remove_file(&partial);
    }
    Ok(written?)
}

/// The mapping file of roles, if one is given; errors begin with its path.
pub fn mapping(path: Option<&Path>) -> Result<Option<Mapping>> {
    let Some(path) = path else { return Ok(None) };
    Ok(Some(Mapping::read(&read(path)?).with_context(|| path.display().to_string())?))
}

/// The first few of many names.
pub fn some_of<'a>(names: impl ExactSizeIterator<Item = &'a String>) -> String {
    const SHOWN: usize = 5;
    let more = names.len().saturating_sub(SHOWN);
    let shown: Vec<&str> = names.take(SHOWN).map(String::as_str).collect();
    if more == 0 { shown.join(", ") } else { format!("{} and {more} more", shown.join(", ")) }
}

/// Folders become the clips in them, however deep, in the order of their paths; files stay where they are named.
pub fn expand(paths: &[PathBuf]) -> Result<Vec<PathBuf>> {
    let mut clips = Vec::new();
    for path in paths {
        if !path.is_dir() {
            clips.push(path.clone());
            continue;
        }
        let before = clips.len();
        collect(path, &mut clips)?;
        clips[before..].sort();
        if clips.len() == before {
            bail!("{}: no clip (.bvh, .amc, .mclip) in this folder or below", path.display());
        }
    }
    Ok(clips)
}

fn collect(folder: &Path, clips: &mut Vec<PathBuf>) -> Result<()> {
    for entry in fs::read_dir(folder).with_context(|| folder.display().to_string())? {
        let entry = entry.with_context(|| folder.display().to_string())?;
        let path = entry.path();
        // A link to a folder could lead back here; links to files cannot.
        if entry.file_type().is_ok_and(|kind| kind.is_dir()) {
            collect(&path, clips)?;
        } else if is_clip(&path) && path.is_file() {
            clips.push(path);
        }
    }
    Ok(())
}

fn is_clip(path: &Path) -> bool {
    matches!(format_of_name(&path.to_string_lossy()), Some(Format::Bvh | Format::Amc | Format::Mclip))
}

/// Reads a clip; `-` is standard input. Errors begin with the path.
pub fn open(path: &Path, args: &ReadArgs) -> Result<Opened> {
    let bytes = if path == Path::new("-") {
        let mut bytes = Vec::new();
        std::io::stdin().lock().read_to_end(&mut bytes).context("standard input")?;
        bytes
    } else {
        read(path)?
    };
    parse(path, &bytes, args)
}

/// Reads a clip whose bytes are at hand. Errors begin with the path.
pub fn parse(path: &Path, bytes: &[u8], args: &ReadArgs) -> Result<Opened> {
    let shown = path.display();
    let stem = if path == Path::new("-") { "stdin".to_owned() } else { stem(path) };
    let limits = Limits::default();
    let format = probe(bytes, &path.to_string_lossy()).with_context(|| shown.to_string())?;
    let (loaded, skeleton) = match format {
        Format::Bvh => {
            (bvh::read(bytes, &stem, &args.bvh(), &limits).with_context(|| shown.to_string())?, None)
        }
        Format::Asf => {
            let (asf, warnings) = acclaim::read_asf(bytes, &limits).with_context(|| shown.to_string())?;
            (Loaded { clips: vec![without_frames(&asf, stem)], warnings }, None)
        }
        Format::Amc => {
            let (loaded, skeleton) = read_amc(path, bytes, &stem, args)?;
            (loaded, Some(skeleton))
        }
        Format::Mclip => (read_mclip(bytes, &stem, args).with_context(|| shown.to_string())?, None),
    };
    Ok(Opened { format, skeleton, clips: loaded.clips, warnings: loaded.warnings })
}

impl ReadArgs {
    fn bvh(&self) -> BvhOptions {
        let positions = self.positions.map(|positions| match positions {
            Positions::Replace => PositionChannels::Replace,
            Positions::Add => PositionChannels::Add,
        });
        BvhOptions { positions, rate_hz: self.file_rate, ..BvhOptions::default() }
    }
}

fn read_mclip(bytes: &[u8], stem: &str, args: &ReadArgs) -> Result<Loaded> {
    let mut loaded = mclip::read(bytes, stem, &Limits::default())?;
    for clip in &mut loaded.clips {
        clip.rate_hz = args.file_rate.unwrap_or(clip.rate_hz);
    }
    Ok(loaded)
}

fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

fn without_frames(asf: &Asf, name: String) -> Clip {
    Clip {
        name,
        skeleton: asf.skeleton(),
        rate_hz: acclaim::DEFAULT_RATE_HZ,
        rotations: Vec::new(),
        tracks: Vec::new(),
        frames: 0,
        repaired: Vec::new(),
    }
}

/// Reads a motion with the skeleton given, or with the first one near it that it fits.
fn read_amc(path: &Path, bytes: &[u8], stem: &str, args: &ReadArgs) -> Result<(Loaded, PathBuf)> {
    let read = |skeleton: &Path| -> Result<Loaded> {
        let limits = Limits::default();
        let asf = fs::read(skeleton).with_context(|| skeleton.display().to_string())?;
        let (asf, mut warnings) =
            acclaim::read_asf(&asf, &limits).with_context(|| skeleton.display().to_string())?;
        for warning in &mut warnings {
            warning.text = format!("{} {}: {}", skeleton.display(), warning.at, warning.text);
            warning.at = Place::File;
        }
        let options = AmcOptions { rate_hz: args.file_rate };
        let mut loaded = acclaim::read_amc(bytes, stem, &asf, &options, &limits)
            .with_context(|| format!("{} (with skeleton {})", path.display(), skeleton.display()))?;
        loaded.warnings.splice(0..0, warnings);
        Ok(loaded)
    };
    if let Some(skeleton) = &args.skeleton {
        return Ok((read(skeleton)?, skeleton.clone()));
    }
    let candidates = skeletons_near(path, stem);
    let mut best: Option<(Loaded, &Skeleton)> = None;
    let mut first_error = None;
    for skeleton in &candidates {
        match read(&skeleton.path) {
            // Fewer warnings: a skeleton that lacks bones of the motion is not the right one.
            Ok(loaded) if best.as_ref().is_none_or(|(b, _)| loaded.warnings.len() < b.warnings.len()) => {
                let clean = loaded.warnings.len() <= usize::from(args.file_rate.is_none());
                best = Some((loaded, skeleton));
                if clean {
                    break;
                }
            }
            Ok(_) => {}
            Err(error) => _ = first_error.get_or_insert(error),
        }
    }
    if let Some((mut loaded, skeleton)) = best {
        if skeleton.kinship == 0 && candidates.len() > 1 {
            let note =
                format!("skeleton {} is the first that fits; its name does not say", skeleton.path.display());
            loaded.warnings.push(Warning::new(Place::File, note));
        }
        return Ok((loaded, skeleton.path.clone()));
    }
    Err(first_error.unwrap_or_else(|| {
        anyhow!(
            "{}: an AMC motion needs its ASF skeleton, and none lies beside it or a folder above; give --skeleton",
            path.display()
        )
    }))
}

/// A skeleton file that may be a motion's.
struct Skeleton {
    kinship: usize,
    path: PathBuf,
}

/// Skeletons beside a motion and then those a folder above, in each the likeliest first: of the same stem, of
/// the longest part of it (`13` for `13_29`), the others.
fn skeletons_near(path: &Path, stem: &str) -> Vec<Skeleton> {
    // So many skeletons in one folder are a library's, and trying them all no way to find the right one.
    const MOST: usize = 64;
    if path == Path::new("-") {
        return Vec::new();
    }
    let beside = match path.parent() {
        Some(folder) if folder != Path::new("") => folder.to_owned(),
        _ => PathBuf::from("."),
    };
    let above = match (beside.file_name(), beside.parent()) {
        (Some(_), Some(above)) if above != Path::new("") => above.to_owned(),
        (Some(_), _) => PathBuf::from("."),
        (None, _) => beside.join(".."),
    };
    let mut found = Vec::new();
    for folder in [beside, above] {
        let mut here: Vec<Skeleton> = fs::read_dir(&folder)
            .into_iter()
            .flatten()
            .filter_map(|entry| Some(entry.ok()?.path()))
            .filter(|path| format_of_name(&path.to_string_lossy()) == Some(Format::Asf))
            .map(|path| Skeleton { kinship: kinship(&self::stem(&path), stem), path })
            .collect();
        here.sort_by(|a, b| b.kinship.cmp(&a.kinship).then_with(|| a.path.cmp(&b.path)));
        here.truncate(MOST);
        found.append(&mut here);
    }
    found
}

/// How much of a motion's stem a skeleton's stem says: its length if the motion's begins with it and a mark
/// follows, else 0.
fn kinship(skeleton: &str, motion: &str) -> usize {
    match motion.to_lowercase().strip_prefix(&skeleton.to_lowercase()) {
        Some(rest) if rest.chars().next().is_none_or(|c| !c.is_alphanumeric()) => skeleton.len() + 1,
        _ => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::kinship;

    #[test]
    fn subjects_own_their_trials() {
        assert!(kinship("13_29", "13_29") > kinship("13", "13_29"));
        assert!(kinship("13", "13_29") > 0);
        assert_eq!(kinship("1", "13_29"), 0);
        assert_eq!(kinship("skeleton", "13_29"), 0);
        assert!(kinship("HDM_dg", "hdm_dg_06-03_120") > 0);
    }
}
