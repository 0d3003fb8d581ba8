//! Saves recordings as BVH, lines of JSON, or clips of a database.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use morec::files::FileReader;
use morec::formats::bvh;
use morec::import::ImportOptions;
use morec::live::Recording;
use morec_db::{ClipUpdate, ImportOutcome, MotionDb};
use morec_live::write_pose_lines;

use crate::output::write_whole;

/// Store of takes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum TakeStore {
    /// A BVH file.
    Bvh(PathBuf),
    /// Lines of JSON, as live recognition reads them.
    JsonLines(PathBuf),
    /// A database; the takes lie in a folder beside it, too.
    Database(PathBuf),
}

impl TakeStore {
    /// By the ending of `path`.
    pub fn of(path: &Path) -> Result<Self> {
        let ending = path
            .extension()
            .unwrap_or_default()
            .to_string_lossy()
            .to_lowercase();
        Ok(match ending.as_str() {
            "bvh" => Self::Bvh(path.to_owned()),
            "jsonl" | "ndjson" => Self::JsonLines(path.to_owned()),
            "mdb" | "db" | "sqlite" => Self::Database(path.to_owned()),
            _ => bail!(
                "{}: expected a file that ends in .bvh, .jsonl or .mdb (a database)",
                path.display()
            ),
        })
    }

    /// The file of take `number` of `of`, both from 1; the only one has the path as it was given.
    pub fn file(&self, number: u32, of: u32) -> PathBuf {
        let numbered = |path: &Path| match of {
            1 => path.to_owned(),
            _ => {
                let stem = path.file_stem().unwrap_or_default().to_string_lossy();
                let ending = path.extension().unwrap_or_default().to_string_lossy();
                path.with_file_name(format!("{stem}_{number}.{ending}"))
            }
        };
        match self {
            Self::Bvh(path) | Self::JsonLines(path) => numbered(path),
            Self::Database(path) => {
                let folder = path.with_extension("takes");
                // Others lie there already.
                (1..)
                    .map(|n| folder.join(format!("take_{n:03}.bvh")))
                    .find(|path| !path.exists())
                    .unwrap_or_default()
            }
        }
    }

    /// Writes a take into `file`; into the database as well, with `tags`, if it is one.
    pub fn keep(&self, recording: &Recording, file: &Path, tags: &[String]) -> Result<()> {
        match self {
            Self::JsonLines(_) => write_lines(recording, file),
            Self::Bvh(_) => write_bvh(recording, file),
            Self::Database(path) => {
                if let Some(folder) = file.parent() {
                    std::fs::create_dir_all(folder)
                        .with_context(|| folder.display().to_string())?;
                }
                write_bvh(recording, file)?;
                import(path, file, recording, tags)
            }
        }
    }
}

/// Writes a recording as BVH, whole or not at all.
pub fn write_bvh(recording: &Recording, file: &Path) -> Result<()> {
    let name = file.file_stem().unwrap_or_default().to_string_lossy();
    let clip = recording
        .to_clip(&name)
        .with_context(|| file.display().to_string())?;
    write_whole(file, |out| bvh::write(&clip, out)).with_context(|| file.display().to_string())
}

fn write_lines(recording: &Recording, file: &Path) -> Result<()> {
    write_whole(file, |out| write_pose_lines(recording, out))
        .with_context(|| file.display().to_string())
}

fn import(database: &Path, file: &Path, recording: &Recording, tags: &[String]) -> Result<()> {
    let mut db = if database.exists() {
        MotionDb::open(database)?
    } else {
        MotionDb::create(database)?
    };
    let about = ClipUpdate {
        add_tags: tags.to_vec(),
        ..ClipUpdate::default()
    };
    let clip = recording.to_clip("")?;
    let reader = FileReader {
        import: ImportOptions {
            mapping: recording.mapping(&clip),
            ..ImportOptions::default()
        },
        ..FileReader::default()
    };
    let report = db.import(&[file.to_owned()], &reader, &about, &())?;
    for (_, outcome) in &report.files {
        match outcome {
            ImportOutcome::Refused(refused) => bail!("{}: {}", file.display(), refused.reason),
            ImportOutcome::Copy { of } => eprintln!(
                "morec: {}: contains the same take already, from {}",
                database.display(),
                of.display()
            ),
            ImportOutcome::Imported { .. } | ImportOutcome::Known => {}
        }
    }
    Ok(())
}
