//! Pose rows of clips, for cutting, grouping and reducing.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use clap::Args;
use morec::features::Rows;
use morec::import::{ImportOptions, Take};
use morec::labels::ClipLength;
use morec::pivots::{PivotMap, PivotSet, PoseParams, pose_rows_of_clip};

use crate::files::{self, ReadArgs};
use crate::progress::SlowProgress;

/// Options of making pose rows.
#[derive(Args, Debug)]
#[command(next_help_heading = "Poses")]
pub struct PoseArgs {
    /// Joints whose rotations count: thesis, roles or a JSON file
    ///
    /// thesis: 16 joints, by the names of the CMU skeleton, by role on other skeletons; roles: 12 joints, by role only; FILE: a
    /// JSON list of {"name", "parent", "joints", "role"}.
    #[arg(
        hide_short_help = true,
        long,
        value_name = "SET|FILE",
        default_value = "thesis"
    )]
    pub pivots: String,
    /// Roles of joints, where inference fails: lines of `role<TAB>joint`
    #[arg(hide_short_help = true, long, value_name = "FILE")]
    pub roles: Option<PathBuf>,
    #[command(flatten)]
    pub read: ReadArgs,
}

/// A clip as pose rows.
pub struct PosedClip {
    /// The clip's name.
    pub name: String,
    /// Frames and rate of the clip itself.
    pub length: ClipLength,
    /// A row for each 1 / [`PoseParams::rate_hz`] s.
    pub rows: Rows,
}

/// [`PoseArgs`], read and checked.
pub struct PoseReader<'a> {
    pub set: PivotSet,
    /// Parameters of pose rows.
    pub params: PoseParams,
    options: ImportOptions,
    read: &'a ReadArgs,
}

impl PoseArgs {
    /// Reads the files that the arguments name.
    pub fn reader(&self) -> Result<PoseReader<'_>> {
        let set = match self.pivots.as_str() {
            "thesis" => PivotSet::thesis(),
            "roles" => PivotSet::roles(),
            file => serde_json::from_slice(&files::read(Path::new(file)).context("--pivots")?)
                .with_context(|| format!("--pivots {file}"))?,
        };
        let options = ImportOptions {
            mapping: files::mapping(self.roles.as_deref())?,
            ..ImportOptions::default()
        };
        Ok(PoseReader {
            set,
            params: PoseParams::default(),
            options,
            read: &self.read,
        })
    }
}

impl PoseReader<'_> {
    /// Rows a second.
    pub fn rate_hz(&self) -> f64 {
        self.params.rate_hz
    }

    /// Calls `each` with every clip of `paths` (folders: the clips in them) in turn; no two are in memory at once
    /// unless `each` keeps them. Files that cannot be read are named on standard error and left out.
    ///
    /// # Errors
    /// There is nothing to read, or no file could be; what `each` fails with.
    pub fn each(&self, paths: &[PathBuf], each: impl FnMut(PosedClip) -> Result<()>) -> Result<()> {
        self.each_made(paths, &|take, progress| self.posed(take, progress), each)
    }

    /// The same with takes as they are.
    ///
    /// # Errors
    /// As [`each`](Self::each).
    pub fn each_take(&self, paths: &[PathBuf], each: impl FnMut(Take) -> Result<()>) -> Result<()> {
        self.each_made(paths, &|take, _| Ok(take), each)
    }

    fn each_made<T>(
        &self,
        paths: &[PathBuf],
        make: &dyn Fn(Take, &SlowProgress) -> Result<T>,
        mut each: impl FnMut(T) -> Result<()>,
    ) -> Result<()> {
        let paths = files::expand(paths)?;
        let mut progress = SlowProgress::new(paths.len(), "reading clips");
        let mut failed = 0;
        for path in &paths {
            let takes = files::takes(path, self.read, &self.options);
            let shown = || path.display().to_string();
            let made = takes.and_then(|takes| {
                let made = takes
                    .into_iter()
                    .map(|take| make(take, &progress).with_context(shown));
                made.collect::<Result<Vec<T>>>()
            });
            match made {
                Ok(clips) => clips.into_iter().try_for_each(&mut each)?,
                Err(error) => {
                    failed += 1;
                    progress.suspend(|| eprintln!("morec: left out: {error:#}"));
                }
            }
            progress.step();
        }
        if failed == paths.len() {
            bail!("none of the {failed} files could be used");
        }
        Ok(())
    }

    fn posed(&self, take: Take, progress: &SlowProgress) -> Result<PosedClip> {
        let clip = &take.clip;
        let map = PivotMap::of_clip(&self.set, clip, &take.roles)?;
        if !map.missing().is_empty() {
            let missing = map.missing().join(", ");
            let what = "no joint for these pivots, which turn with their parents";
            progress.suspend(|| eprintln!("morec: {}: {what}: {missing}", clip.name));
        }
        let rows = pose_rows_of_clip(clip, &self.set, &map, take.rest(), &self.params);
        Ok(PosedClip {
            name: clip.name.clone(),
            length: clip.into(),
            rows,
        })
    }
}
