//! How long clips are, from their files.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use morec::formats::{Limits, bvh};
use morec::labels::ClipLength;

/// Rate and length of every clip in `paths`, by name; a folder stands for the clips in it, not in folders below.
pub fn lengths(paths: &[PathBuf]) -> anyhow::Result<BTreeMap<String, ClipLength>> {
    let mut lengths = BTreeMap::new();
    for path in paths {
        for file in clip_files(path).with_context(|| path.display().to_string())? {
            let context = || file.display().to_string();
            let name = file.file_stem().unwrap_or_default().to_string_lossy();
            let bytes = std::fs::read(&file).with_context(context)?;
            let loaded = bvh::read(&bytes, &name, &bvh::BvhOptions::default(), &Limits::default());
            for clip in loaded.with_context(context)?.clips {
                let length = ClipLength { frames: clip.frames, rate_hz: clip.rate_hz };
                if lengths.insert(clip.name.clone(), length).is_some() {
                    bail!("{}: a second clip called {}; names must differ", file.display(), clip.name);
                }
            }
        }
    }
    Ok(lengths)
}

fn clip_files(path: &Path) -> std::io::Result<Vec<PathBuf>> {
    if !std::fs::metadata(path)?.is_dir() {
        return Ok(vec![path.to_owned()]);
    }
    let mut files = Vec::new();
    for entry in std::fs::read_dir(path)? {
        let file = entry?.path();
        if file.extension().is_some_and(|e| e.eq_ignore_ascii_case("bvh")) {
            files.push(file);
        }
    }
    files.sort();
    Ok(files)
}
