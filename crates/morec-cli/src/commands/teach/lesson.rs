//! The state of teaching: takes and labels in a folder beside the index, and the index trained on them.

use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use clap::Parser;
use morec::index::MotionIndex;
use morec::live::Recording;

use crate::commands::train::trained;
use crate::live::keep::write_bvh;
use crate::material::MaterialArgs;
use crate::output::write_whole;

/// Takes, labels, and the index of them.
pub struct Lessons {
    path: PathBuf,
    folder: PathBuf,
    index: Option<MotionIndex>,
    kept: usize,
}

/// Training as `morec train` does it, with what it takes for granted.
#[derive(Parser)]
struct Training {
    #[command(flatten)]
    material: MaterialArgs,
}

impl Lessons {
    /// The lesson for the index at `path`.
    ///
    /// # Errors
    /// The index is there but was not taught: training it anew without its clips would lose what it knows.
    pub fn open(path: &Path) -> Result<Self> {
        let folder = path.with_extension("takes");
        let taught = folder.join("labels.tsv").is_file();
        if path.exists() && !taught {
            bail!(
                "{}: this index was trained on clips that are not in {}, and teaching would lose its classes; give another index \
                 file",
                path.display(),
                folder.display()
            );
        }
        let index = path.exists().then(|| own_index(path)).transpose()?;
        Ok(Self {
            path: path.to_owned(),
            folder,
            index,
            kept: 0,
        })
    }

    /// The index as it was trained last.
    pub fn index(&self) -> Option<&MotionIndex> {
        self.index.as_ref()
    }

    /// Keeps a take of the gesture `name` and labels it; returns its file.
    pub fn keep(&mut self, name: &str, recording: &Recording) -> Result<PathBuf> {
        fs::create_dir_all(&self.folder).with_context(|| self.folder.display().to_string())?;
        let clip = (1..)
            .map(|n| format!("{name}_{n:03}"))
            .find(|clip| !self.folder.join(format!("{clip}.bvh")).exists())
            .unwrap_or_default();
        let file = self.folder.join(format!("{clip}.bvh"));
        write_bvh(recording, &file)?;
        let labels = self.labels();
        let mut text = if labels.exists() {
            String::new()
        } else {
            "clip\tclass\n".to_owned()
        };
        text += &format!("{clip}\t{name}\n");
        let mut out = OpenOptions::new().create(true).append(true).open(&labels);
        out.as_mut()
            .map_err(|error| std::io::Error::new(error.kind(), error.to_string()))
            .and_then(|out| out.write_all(text.as_bytes()))
            .with_context(|| labels.display().to_string())?;
        self.kept += 1;
        Ok(file)
    }

    fn labels(&self) -> PathBuf {
        self.folder.join("labels.tsv")
    }

    /// Trains from everything that was taught, and writes the index. Says what of.
    pub fn train(&mut self) -> Result<String> {
        let labels = self.labels();
        let args = [
            "teach".as_ref(),
            "--clips".as_ref(),
            self.folder.as_os_str(),
            "--labels".as_ref(),
            labels.as_os_str(),
        ];
        let (index, report, _) = trained(&Training::try_parse_from(args)?.material, &self.path)?;
        let bytes = index.to_bytes()?;
        write_whole(&self.path, |out| out.write_all(&bytes))
            .with_context(|| self.path.display().to_string())?;
        let classes: Vec<String> = report
            .classes
            .iter()
            .map(|class| format!("{} ({})", class.name, class.samples))
            .collect();
        for note in &report.notes {
            eprintln!("morec:   {note}");
        }
        self.index = Some(index);
        Ok(format!(
            "{} knows {}",
            self.path.display(),
            classes.join(", ")
        ))
    }

    /// Summary of the files at the end.
    pub fn summary(&self) -> String {
        match self.kept {
            0 => "no gesture was taught".to_owned(),
            kept => format!(
                "{kept} takes were kept in {}, the index is {}",
                self.folder.display(),
                self.path.display()
            ),
        }
    }
}

/// The index that teaching made and will replace: unlike other inputs of a run, it may be written again.
fn own_index(path: &Path) -> Result<MotionIndex> {
    let bytes = fs::read(path).with_context(|| path.display().to_string())?;
    MotionIndex::from_bytes(&bytes).with_context(|| path.display().to_string())
}
