//! The files that `smooth` writes, and their format.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use clap::ValueEnum;
use morec::smooth::CompressedClip;

use crate::commands::convert::write_clip;
use crate::output::write_whole;

/// Form of the output.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum MotionForm {
    /// Frames
    Bvh,
    /// Curves, the stored form
    Mclip,
}

impl MotionForm {
    fn extension(self) -> &'static str {
        match self {
            MotionForm::Bvh => "bvh",
            MotionForm::Mclip => "mclip",
        }
    }

    fn of(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?;
        [MotionForm::Bvh, MotionForm::Mclip]
            .into_iter()
            .find(|form| form.extension().eq_ignore_ascii_case(extension))
    }
}

/// Target of the output.
pub enum MotionTarget {
    Nowhere,
    File(PathBuf, MotionForm),
    Folder(PathBuf, MotionForm),
}

impl MotionTarget {
    /// The target that `output` means for these clips; a folder is made if it is not there.
    pub fn new(
        output: Option<&Path>,
        form: Option<MotionForm>,
        given: &[PathBuf],
        clips: &[PathBuf],
    ) -> Result<Self> {
        let Some(output) = output else {
            return Ok(Self::Nowhere);
        };
        let one = clips.len() == 1 && given.iter().all(|path| !path.is_dir());
        if one && !output.is_dir() {
            let form = match (form, MotionForm::of(output)) {
                (Some(form), Some(ending)) if form != ending => {
                    bail!(
                        "{}: the extension does not fit --form {}",
                        output.display(),
                        form.extension()
                    )
                }
                (form, ending) => form.or(ending),
            };
            let Some(form) = form else {
                bail!(
                    "{}: expected a file that ends in .bvh or .mclip, or a folder",
                    output.display()
                );
            };
            return Ok(Self::File(output.to_owned(), form));
        }
        let target = Self::Folder(output.to_owned(), form.unwrap_or(MotionForm::Bvh));
        let mut names: HashMap<PathBuf, &Path> = HashMap::new();
        for clip in clips {
            let Some(name) = target.path(clip, None) else {
                continue;
            };
            if let Some(other) = names.insert(name.clone(), clip) {
                bail!(
                    "{} and {} would both be written to {}",
                    other.display(),
                    clip.display(),
                    name.display()
                );
            }
            if name
                .canonicalize()
                .is_ok_and(|name| clip.canonicalize().is_ok_and(|clip| clip == name))
            {
                bail!(
                    "{} would be overwritten; choose another folder",
                    clip.display()
                );
            }
        }
        std::fs::create_dir_all(output).with_context(|| output.display().to_string())?;
        Ok(target)
    }

    /// The file that a clip becomes; characters of a file that holds several are numbered from 1.
    pub fn path(&self, clip: &Path, character: Option<usize>) -> Option<PathBuf> {
        let number = character.map_or_else(String::new, |n| format!("-{n}"));
        let beside = |folder: &Path, stem: &Path, form: MotionForm| {
            let stem = stem.file_stem().unwrap_or_default().to_string_lossy();
            folder.join(format!("{stem}{number}.{}", form.extension()))
        };
        match self {
            Self::Nowhere => None,
            Self::File(path, _) if character.is_none() => Some(path.clone()),
            Self::File(path, form) => {
                Some(beside(path.parent().unwrap_or(Path::new("")), path, *form))
            }
            Self::Folder(folder, form) => Some(beside(folder, clip, *form)),
        }
    }

    /// Writes a clip, whole or not at all.
    pub fn write(
        &self,
        path: &Path,
        clip: &CompressedClip,
        stored: &[u8],
        rate_hz: f64,
    ) -> Result<()> {
        match self {
            Self::Nowhere => Ok(()),
            Self::File(_, MotionForm::Bvh) | Self::Folder(_, MotionForm::Bvh) => {
                write_clip(&clip.sample(rate_hz)?, path)
            }
            Self::File(..) | Self::Folder(..) => write_whole(path, |out| out.write_all(stored)),
        }
    }
}
