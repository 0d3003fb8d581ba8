//! Clips, labels and persons for training and cross-validation, from the command line.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use clap::Args;
use morec::formats::Warning;
use morec::import::{ImportOptions, Take};
use morec::labels::{Labels, People, read_people};
use morec::train::{StreamKind, TrainClip, TrainingData, TrainingMaterial};
use morec_db::ClipFilter;
use morec_ops::{MaterialBeside, TrainSettings, training_data};
use rayon::prelude::*;

use crate::database;
use crate::files::{ReadArgs, expand, expand_as, mapping, read, takes};
use crate::labels::{self, LabelArgs};

/// Training data: clips, labels, background.
#[derive(Args, Debug)]
#[command(next_help_heading = "Clips and labels")]
pub struct MaterialArgs {
    /// Labelled clips, or folders of clips
    #[arg(long, value_name = "DIR|CLIP", num_args = 1.., required_unless_present = "db")]
    pub clips: Vec<PathBuf>,
    /// Take clips and accepted samples from this database
    ///
    /// Replaces --clips and --labels. Clips with the tag `background` are background (`morec db clips --add-tag background`);
    /// --background accepts names of its clips, too.
    #[arg(long, value_name = "DB", conflicts_with_all = ["clips", "labels"])]
    pub db: Option<PathBuf>,
    /// Labels: a table, or a form that `morec db label` reads
    ///
    /// Columns of a table: clip (file name without extension), class, and start, stop (frames, stop exclusive) or start_secs,
    /// stop_secs. Without times, the whole clip is one sample, with still ends trimmed.
    #[arg(long, value_name = "FILE|DIR", required_unless_present = "db")]
    pub labels: Option<PathBuf>,
    /// Leave out these clips (file stems, separated by commas)
    #[arg(long, value_delimiter = ',', value_name = "CLIPS")]
    pub exclude: Vec<String>,
    /// Person of each clip: a table with the columns clip and person
    ///
    /// Alternatively, add a column person to the labels.
    #[arg(long, value_name = "TSV")]
    pub people: Option<PathBuf>,
    /// Background clips: motion of none of the classes; sets the threshold
    ///
    /// Clips, folders, or file stems of --clips.
    #[arg(long, value_name = "DIR|CLIP", num_args = 1..)]
    pub background: Vec<PathBuf>,
    /// Roles of joints, where inference fails: lines of `role<TAB>joint`
    #[arg(hide_short_help = true, long, value_name = "FILE")]
    pub roles: Option<PathBuf>,
    #[command(flatten)]
    pub settings: TrainSettings,
    #[command(flatten)]
    pub reading: LabelArgs,
    #[command(flatten)]
    pub read: ReadArgs,
}

/// Everything loaded.
pub struct ClipMaterial {
    /// Labelled and background clips, and the samples in them.
    pub data: TrainingData,
    /// Bytes of the files of the labelled clips.
    pub labelled_bytes: u64,
}

impl MaterialArgs {
    /// Origin of the labels.
    pub fn label_source(&self) -> String {
        self.db
            .as_ref()
            .or(self.labels.as_ref())
            .map_or_else(String::new, |path| path.display().to_string())
    }

    /// Loads everything; `unknown` are paths like those of `--background`. What is left out is said on standard
    /// error.
    pub fn load(&self, unknown: &[PathBuf]) -> Result<ClipMaterial> {
        let loaded = match &self.db {
            Some(db) => self.load_db(db, unknown),
            None => self.load_files(unknown),
        }?;
        say_notes(&loaded.data);
        Ok(loaded)
    }

    fn load_files(&self, unknown: &[PathBuf]) -> Result<ClipMaterial> {
        let (labels, people) = self.labels()?;
        let taught = self.expand(&self.clips)?;
        let background = self.named(&taught, &self.background)?;
        let unknown = self.named(&taught, unknown)?;
        let mut paths = taught;
        paths.extend(background.iter().chain(&unknown).cloned());
        let mut clips = load_clips(&paths, &self.read, &self.import_options()?)?;
        clips.retain(|loaded| !self.exclude.contains(&loaded.clip.name));
        let background = names_in(&clips, &background);
        for LoadedClip { clip, .. } in &mut clips {
            if background.contains(&clip.name) {
                clip.source = StreamKind::Background;
            }
        }
        let material = TrainingMaterial {
            labels: &labels,
            people: people.as_ref(),
            classes: &self.settings.classes,
            unknown: &names_in(&clips, &unknown),
        };
        let bytes = bytes_by_name(&clips);
        let data = material.sort_out(clips.into_iter().map(|loaded| loaded.clip).collect())?;
        Ok(ClipMaterial {
            labelled_bytes: data.labelled().map(|clip| bytes[&clip.name]).sum(),
            data,
        })
    }

    /// Clips that are only tested, with the labels that lie in them, of `classes`.
    pub fn load_tests(
        &self,
        paths: &[PathBuf],
        labels: &Path,
        classes: &[String],
    ) -> Result<TrainingData> {
        let text = labels::read(labels, &self.reading, paths)?;
        warn(labels, &text.warnings);
        let clips = load_clips(&self.expand(paths)?, &self.read, &self.import_options()?)?;
        let material = TrainingMaterial {
            labels: &text,
            people: None,
            classes,
            unknown: &BTreeSet::new(),
        };
        let data = material.sort_out(clips.into_iter().map(|loaded| loaded.clip).collect())?;
        say_notes(&data);
        Ok(data)
    }

    /// The same from a database: its clips that hold samples, and those marked or named as background, or named as unknown.
    fn load_db(&self, path: &Path, unknown: &[PathBuf]) -> Result<ClipMaterial> {
        let db = database::open_read_only(path)?;
        let infos = db.clips(&ClipFilter::default())?;
        let stored = |path: &PathBuf| infos.iter().any(|info| Path::new(&info.name) == path);
        let apart = |given: &[PathBuf]| -> Result<(BTreeSet<String>, Vec<PathBuf>)> {
            let (names, files): (Vec<_>, Vec<_>) = given.iter().cloned().partition(stored);
            let name = |path: PathBuf| path.to_string_lossy().into_owned();
            Ok((names.into_iter().map(name).collect(), expand(&files)?))
        };
        let (mut background, background_files) = apart(&self.background)?;
        let (mut unknown, unknown_files) = apart(unknown)?;
        let files = [background_files.as_slice(), &unknown_files].concat();
        let clips = match files.as_slice() {
            [] => Vec::new(),
            files => load_clips(files, &self.read, &self.import_options()?)?,
        };
        background.extend(names_in(&clips, &background_files));
        unknown.extend(names_in(&clips, &unknown_files));
        let beside = MaterialBeside {
            background,
            unknown,
            exclude: self.exclude.iter().cloned().collect(),
            clips: clips.into_iter().map(|loaded| loaded.clip).collect(),
        };
        let data = training_data(&db, &self.settings.classes, beside)?;
        let labelled: BTreeSet<&str> = data.labelled().map(|clip| clip.name.as_str()).collect();
        let labelled = infos.iter().filter(|i| labelled.contains(i.name.as_str()));
        Ok(ClipMaterial {
            labelled_bytes: labelled.map(|info| file_bytes(Path::new(&info.path))).sum(),
            data,
        })
    }

    /// The labels, and the table of people.
    fn labels(&self) -> Result<(Labels, Option<People>)> {
        let path = self.labels.as_deref().context("--labels is required")?;
        let labels = labels::read(path, &self.reading, &self.clips)?;
        warn(path, &labels.warnings);
        let classes = labels.rows.iter().map(|row| row.class.as_str());
        if let Some(doubt) = labels::doubt_of_none(classes) {
            eprintln!("morec: {}: {doubt}", shown(path));
        }
        let Some(path) = &self.people else {
            return Ok((labels, None));
        };
        let people = read_people(&read(path)?).with_context(|| shown(path))?;
        warn(path, &people.warnings);
        Ok((labels, Some(people)))
    }

    fn import_options(&self) -> Result<ImportOptions> {
        Ok(ImportOptions {
            mapping: mapping(self.roles.as_deref())?,
            ..ImportOptions::default()
        })
    }

    /// The clips of folders; of animals in pictures too, if roles name their points.
    fn expand(&self, paths: &[PathBuf]) -> Result<Vec<PathBuf>> {
        let mapping = self.import_options()?.mapping;
        expand_as(paths, mapping.is_some_and(|mapping| mapping.is_custom()))
    }

    /// Paths as they are; what is no path but the file stem of one of `taught` is that clip.
    fn named(&self, taught: &[PathBuf], given: &[PathBuf]) -> Result<Vec<PathBuf>> {
        let mut paths = Vec::new();
        for path in given {
            if path.exists() {
                paths.extend(self.expand(std::slice::from_ref(path))?);
                continue;
            }
            let stem = path.as_os_str();
            match taught.iter().find(|t| t.file_stem() == Some(stem)) {
                Some(clip) => paths.push(clip.clone()),
                None => bail!(
                    "{}: neither a file, nor a folder, nor the name of a clip of --clips",
                    path.display()
                ),
            }
        }
        Ok(paths)
    }
}

/// A clip and the file it came from.
pub struct LoadedClip {
    /// The clip, as a labelled one.
    pub clip: TrainClip,
    path: PathBuf,
    file_bytes: u64,
}

/// Reads and imports files in parallel, each once. Files that cannot be read are named on standard error and left
/// out; two clips of one name are an error, as labels could not tell them apart.
pub fn load_clips(
    paths: &[PathBuf],
    args: &ReadArgs,
    options: &ImportOptions,
) -> Result<Vec<LoadedClip>> {
    let mut seen = BTreeSet::new();
    let distinct: Vec<&PathBuf> = paths.iter().filter(|p| seen.insert(canonical(p))).collect();
    let loaded: Vec<Result<Vec<LoadedClip>>> = distinct
        .par_iter()
        .map(|p| load_file(p, args, options))
        .collect();
    let mut clips: Vec<LoadedClip> = Vec::new();
    let mut failed = 0;
    for result in loaded {
        match result {
            Ok(found) => clips.extend(found),
            Err(error) => {
                failed += 1;
                eprintln!("morec: left out: {error:#}");
            }
        }
    }
    if clips.is_empty() {
        bail!("none of the {failed} files could be read");
    }
    let mut names: BTreeMap<&str, &Path> = BTreeMap::new();
    for clip in &clips {
        if let Some(other) = names.insert(&clip.clip.name, &clip.path) {
            let (a, b) = (other.display(), clip.path.display());
            bail!(
                "{a} and {b} are both called {}, so labels cannot distinguish them: rename one",
                clip.clip.name
            );
        }
    }
    Ok(clips)
}

fn load_file(path: &Path, args: &ReadArgs, options: &ImportOptions) -> Result<Vec<LoadedClip>> {
    let file_bytes = file_bytes(path);
    let loaded = |take: Take| LoadedClip {
        clip: take.into(),
        path: canonical(path),
        file_bytes,
    };
    Ok(takes(path, args, options)?
        .into_iter()
        .map(loaded)
        .collect())
}

fn say_notes(data: &TrainingData) {
    data.notes
        .iter()
        .for_each(|note| eprintln!("morec: {note}"));
}

/// Names of the clips that come from `paths`.
fn names_in(clips: &[LoadedClip], paths: &[PathBuf]) -> BTreeSet<String> {
    let paths: BTreeSet<PathBuf> = paths.iter().map(|path| canonical(path)).collect();
    let from = clips.iter().filter(|loaded| paths.contains(&loaded.path));
    from.map(|loaded| loaded.clip.name.clone()).collect()
}

fn bytes_by_name(clips: &[LoadedClip]) -> BTreeMap<String, u64> {
    let bytes = |loaded: &LoadedClip| (loaded.clip.name.clone(), loaded.file_bytes);
    clips.iter().map(bytes).collect()
}

fn file_bytes(path: &Path) -> u64 {
    std::fs::metadata(path).map_or(0, |m| m.len())
}

fn canonical(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| path.to_owned())
}

fn shown(path: &Path) -> String {
    path.display().to_string()
}

fn warn(path: &Path, warnings: &[Warning]) {
    warnings
        .iter()
        .for_each(|warning| eprintln!("morec: {}: {warning}", path.display()));
}
