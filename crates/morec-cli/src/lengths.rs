//! Lengths and frame rates of clips, from their files or from their labels.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use anyhow::{Result, bail};
use morec::labels::{ClipLength, Extent, Labels, names_of_clip};

use crate::files::{ReadArgs, expand_as, open_planar};
use crate::progress::SlowProgress;

/// Rate and length of every clip in `paths`, by name. What was repaired in them is for `morec inspect` to say.
pub fn lengths(paths: &[PathBuf], read: &ReadArgs) -> Result<BTreeMap<String, ClipLength>> {
    let files = expand_as(paths, true)?;
    let mut progress = SlowProgress::new(files.len(), "reading clips");
    let mut lengths = BTreeMap::new();
    for file in files {
        for clip in open_planar(&file, read)?.clips {
            let length = ClipLength::from(&clip);
            if lengths.insert(clip.name.clone(), length).is_some() {
                bail!(
                    "{}: another clip is called {} too; names must differ",
                    file.display(),
                    clip.name
                );
            }
        }
        progress.step();
    }
    Ok(lengths)
}

/// Rate and length of every labelled clip: of the clips in `paths`, or, without any, of clips that end with their last label.
pub fn lengths_of(
    paths: &[PathBuf],
    read: &ReadArgs,
    files: &[(&PathBuf, &Labels)],
) -> Result<BTreeMap<String, ClipLength>> {
    match paths.is_empty() {
        true => lengths_of_labels(files),
        false => lengths(paths, read),
    }
}

/// Clips that end with their last label.
fn lengths_of_labels(files: &[(&PathBuf, &Labels)]) -> Result<BTreeMap<String, ClipLength>> {
    /// Places to a second: finer than any labels.
    const RATE_HZ: f64 = 1000.0;
    let endings_count = names_with_endings(files);
    let mut lengths = BTreeMap::new();
    for (path, labels) in files {
        for row in &labels.rows {
            let Extent::Secs(span) = &row.extent else {
                bail!(
                    "{}: line {}: the label is in frames; give the clips with --clips, or the frame rate with --label-rate",
                    path.display(),
                    row.line
                );
            };
            // The annotators may have written folders and endings differently.
            let (base, stem) = base_and_stem(&row.clip);
            let name = if endings_count.contains(stem) {
                base
            } else {
                stem
            };
            let length = lengths.entry(name.to_owned()).or_insert(ClipLength {
                frames: 0,
                rate_hz: RATE_HZ,
            });
            length.frames = length
                .frames
                .max((span.stop_secs * RATE_HZ).ceil() as usize);
        }
    }
    Ok(lengths)
}

/// Stems of clips whose ending belongs to the name, because one file names two clips that differ in it alone: `rec` of `rec.1` and `rec.2`.
fn names_with_endings<'l>(files: &[(&PathBuf, &'l Labels)]) -> BTreeSet<&'l str> {
    let mut found = BTreeSet::new();
    for (_, labels) in files {
        let mut names: BTreeMap<&str, &str> = BTreeMap::new();
        for row in &labels.rows {
            let (base, stem) = base_and_stem(&row.clip);
            if base != stem && *names.entry(stem).or_insert(base) != base {
                found.insert(stem);
            }
        }
    }
    found
}

/// A clip's name without folders, and without the ending too.
fn base_and_stem(name: &str) -> (&str, &str) {
    let [.., base, stem] = names_of_clip(name).collect::<Vec<_>>()[..] else {
        return (name, name);
    };
    (base, stem)
}
