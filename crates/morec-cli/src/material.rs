//! Clips, labels and people as training and cross-validation need them, from what was typed.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, bail};
use clap::Args;
use morec::formats::Warning;
use morec::import::{ImportOptions, Take};
use morec::labels::{Label, Labels, read_people};
use morec::train::{DataError, StreamKind, TrainClip, TrainingData};
use morec_db::{BACKGROUND, ClipFilter, ClipInfo, MotionDb, hint};
use morec_ops::{TrainSettings, accepted_labels, clips_to_train};
use rayon::prelude::*;

use crate::database;
use crate::files::{ReadArgs, expand, mapping, read, some_of, takes};
use crate::labels;

/// Training data: clips, labels, background.
#[derive(Args, Debug)]
pub struct MaterialArgs {
    /// Clips, or folders of clips, that the labels refer to
    #[arg(long, value_name = "DIR|CLIP", num_args = 1.., required_unless_present = "db")]
    pub clips: Vec<PathBuf>,
    /// Clips and accepted samples of this database, in place of --clips and --labels; its clips with the tag `background` are
    /// background (`morec db clips --add-tag background`), and --background also names its clips. See `morec db`
    #[arg(long, value_name = "DB", conflicts_with_all = ["clips", "labels"])]
    pub db: Option<PathBuf>,
    /// Labels, in a form that `morec db label` reads; of tables columns clip (file stem), class, and start, stop (frames,
    /// stop exclusive) or start_secs, stop_secs, or neither: then the whole clip is one sample, its still ends trimmed
    #[arg(long, value_name = "FILE|DIR", required_unless_present = "db")]
    pub labels: Option<PathBuf>,
    /// Leave these clips out, by file stem, separated by commas
    #[arg(long, value_delimiter = ',', value_name = "CLIPS")]
    pub exclude: Vec<String>,
    /// Persons of clips: columns clip and person (or give the labels a column person)
    #[arg(long, value_name = "TSV")]
    pub people: Option<PathBuf>,
    /// Clips or folders that hold none of the classes, also by the file stem of one of --clips: what comes near
    /// the classes in them sets how near is near enough
    #[arg(long, value_name = "DIR|CLIP", num_args = 1..)]
    pub background: Vec<PathBuf>,
    /// Roles of joints, where inference fails: lines of `role<TAB>joint name`
    #[arg(long, value_name = "FILE")]
    pub roles: Option<PathBuf>,
    #[command(flatten)]
    pub settings: TrainSettings,
    #[command(flatten)]
    pub read: ReadArgs,
}

/// Everything loaded.
pub struct ClipMaterial {
    /// Labelled and background clips, and the samples in them.
    pub data: TrainingData,
    /// Clips that hold none of the classes, for testing.
    pub unknown: Vec<TrainClip>,
    /// Bytes that the labelled clips would take as BVH.
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
        if let Some(db) = &self.db {
            return self.load_db(db, unknown);
        }
        let (labels, people) = self.labels()?;
        let taught = expand(&self.clips)?;
        let background = self.named(&taught, &self.background)?;
        let unknown = self.named(&taught, unknown)?;
        let excluded: BTreeSet<&str> = self.exclude.iter().map(String::as_str).collect();
        let mut paths = taught.clone();
        paths.extend(background.iter().chain(&unknown).cloned());
        let mut clips = load_clips(&paths, &self.read, &self.import_options()?)?;
        clips.retain(|c| !excluded.contains(c.clip.name.as_str()));
        for loaded in &mut clips {
            loaded.clip.person = people.get(&loaded.clip.name).cloned();
        }
        sort_out(
            clips,
            &labels,
            &self.settings.classes,
            &set_of(&background),
            &set_of(&unknown),
        )
    }

    /// Clips that are only tested, with the labels that lie in them, of `classes`.
    pub fn load_tests(
        &self,
        paths: &[PathBuf],
        labels: &Path,
        classes: &[String],
    ) -> Result<ClipMaterial> {
        let text = labels::read(labels)?;
        warn(labels, &text.warnings);
        let people: BTreeMap<String, String> = text
            .rows
            .iter()
            .filter_map(|r| Some((r.clip.clone(), r.person.clone()?)))
            .collect();
        let mut clips = load_clips(&expand(paths)?, &self.read, &self.import_options()?)?;
        for loaded in &mut clips {
            loaded.clip.person = people.get(&loaded.clip.name).cloned();
        }
        let none = BTreeSet::new();
        sort_out(clips, &text, classes, &none, &none)
    }

    /// The same from a database: its clips that hold samples, and those marked or named as background, or named as unknown.
    /// A clip's path is its name here.
    fn load_db(&self, path: &Path, unknown: &[PathBuf]) -> Result<ClipMaterial> {
        let db = database::open_read_only(path)?;
        let mut infos = db.clips(&ClipFilter::default())?;
        let (mut files, mut names) = (Vec::new(), BTreeSet::new());
        let mut aside = |given: &[PathBuf]| -> Result<BTreeSet<PathBuf>> {
            let mut set = BTreeSet::new();
            for path in given {
                if infos.iter().any(|info| Path::new(&info.name) == path) {
                    names.insert(path.to_string_lossy().into_owned());
                    set.insert(path.clone());
                } else {
                    let found = expand(std::slice::from_ref(path))?;
                    set.extend(found.iter().map(|p| canonical(p)));
                    files.extend(found);
                }
            }
            Ok(set)
        };
        let (mut background, unknown) = (aside(&self.background)?, aside(unknown)?);
        for name in self.marked(&db)? {
            background.insert(PathBuf::from(&name));
            names.insert(name);
        }
        let labels = accepted_labels(&db)?;
        names.extend(labels.rows.iter().map(|row| row.clip.clone()));
        infos.retain(|info| names.contains(&info.name) && !self.exclude.contains(&info.name));
        let loaded = |(info, clip): (ClipInfo, TrainClip)| LoadedClip {
            path: PathBuf::from(&info.name),
            file_bytes: std::fs::metadata(&info.path).map_or(0, |m| m.len()),
            clip,
        };
        let stored = clips_to_train(&db, infos)?;
        let mut clips: Vec<LoadedClip> = stored.into_iter().map(loaded).collect();
        if !files.is_empty() {
            clips.extend(load_clips(&files, &self.read, &self.import_options()?)?);
        }
        sort_out(
            clips,
            &labels,
            &self.settings.classes,
            &background,
            &unknown,
        )
    }

    /// Names of the clips of a database that are marked as background. Those that hold samples of the classes are said on
    /// standard error and left out.
    fn marked(&self, db: &MotionDb) -> Result<Vec<String>> {
        let name = |info: ClipInfo| info.name;
        let marked = db.background(&self.settings.classes)?;
        if !marked.labelled.is_empty() {
            let names: Vec<String> = marked.labelled.into_iter().map(name).collect();
            eprintln!(
                "morec: {} clips have the tag {BACKGROUND}, but hold samples of the classes: they are used as labelled clips: {}",
                names.len(),
                some_of(names.iter())
            );
        }
        Ok(marked.clips.into_iter().map(name).collect())
    }

    /// The labels, and who is seen in which clip, labelled or not.
    fn labels(&self) -> Result<(Labels, BTreeMap<String, String>)> {
        let path = self.labels.as_deref().context("--labels: which?")?;
        let mut labels = labels::read(path)?;
        warn(path, &labels.warnings);
        let mut by_clip = BTreeMap::new();
        if let Some(path) = &self.people {
            let people = read_people(&read(path)?).with_context(|| shown(path))?;
            warn(path, &people.warnings);
            labels.add_people(&people);
            by_clip = people.by_clip;
        }
        let labelled = labels
            .rows
            .iter()
            .filter_map(|r| Some((r.clip.clone(), r.person.clone()?)));
        by_clip.extend(labelled);
        Ok((labels, by_clip))
    }

    fn import_options(&self) -> Result<ImportOptions> {
        Ok(ImportOptions {
            mapping: mapping(self.roles.as_deref())?,
            ..ImportOptions::default()
        })
    }

    /// Paths as they are; what is no path but the file stem of one of `taught` is that clip.
    fn named(&self, taught: &[PathBuf], given: &[PathBuf]) -> Result<Vec<PathBuf>> {
        let mut paths = Vec::new();
        for path in given {
            if path.exists() {
                paths.extend(expand(std::slice::from_ref(path))?);
                continue;
            }
            let stem = path.as_os_str();
            match taught.iter().find(|t| t.file_stem() == Some(stem)) {
                Some(clip) => paths.push(clip.clone()),
                None => bail!(
                    "{}: no such file or folder, and none of --clips is called so",
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
                "{a} and {b} are both called {}: labels could not tell them apart",
                clip.clip.name
            );
        }
    }
    Ok(clips)
}

fn load_file(path: &Path, args: &ReadArgs, options: &ImportOptions) -> Result<Vec<LoadedClip>> {
    let file_bytes = std::fs::metadata(path).map_or(0, |m| m.len());
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

/// Gives every clip its part.
fn sort_out(
    mut clips: Vec<LoadedClip>,
    labels: &Labels,
    classes: &[String],
    background: &BTreeSet<PathBuf>,
    unknown: &BTreeSet<PathBuf>,
) -> Result<ClipMaterial> {
    let mut unknown_clips = Vec::new();
    let mut tested_only = BTreeSet::new();
    for LoadedClip { clip, path, .. } in &mut clips {
        let (is_background, is_unknown) = (background.contains(path), unknown.contains(path));
        if is_unknown {
            unknown_clips.push(clip.clone());
        }
        if is_unknown && !is_background {
            tested_only.insert(clip.name.clone());
        }
        // Labels in clips that are said to hold no class do not count.
        if is_background || is_unknown {
            clip.source = StreamKind::Background;
        }
    }
    say_ignored(&clips, labels, classes);
    let bytes: BTreeMap<String, u64> = clips
        .iter()
        .map(|c| (c.clip.name.clone(), c.file_bytes))
        .collect();
    let clips = clips.into_iter().map(|loaded| loaded.clip).collect();
    let mut data = TrainingData::new(clips, labels, classes).map_err(|error| {
        let DataError::NoSampleOf(name) = &error else {
            return error.into();
        };
        let known: BTreeSet<&String> = labels.rows.iter().map(|row| &row.class).collect();
        let known: Vec<String> = known.into_iter().cloned().collect();
        anyhow!("{error}{}", hint(name, &known))
    })?;
    data.clips.retain(|clip| !tested_only.contains(&clip.name));
    data.notes
        .iter()
        .for_each(|note| eprintln!("morec: {note}"));
    if !data.unused.is_empty() {
        eprintln!(
            "morec: {} clips hold no sample of the classes and are not used (--background if they hold none): {}",
            data.unused.len(),
            some_of(data.unused.iter())
        );
    }
    let labelled_bytes = data.labelled().map(|clip| bytes[&clip.name]).sum();
    Ok(ClipMaterial {
        data,
        unknown: unknown_clips,
        labelled_bytes,
    })
}

/// Says which labels do not count because their clip is background.
fn say_ignored(clips: &[LoadedClip], labels: &Labels, classes: &[String]) {
    let background: BTreeSet<&str> = clips
        .iter()
        .filter(|loaded| loaded.clip.source == StreamKind::Background)
        .map(|loaded| loaded.clip.name.as_str())
        .collect();
    let wanted = |row: &&Label| classes.is_empty() || classes.contains(&row.class);
    let ignored = labels.rows.iter().filter(wanted);
    let ignored: Vec<&String> = ignored
        .map(|row| &row.clip)
        .filter(|clip| background.contains(clip.as_str()))
        .collect();
    if !ignored.is_empty() {
        let clips: BTreeSet<&String> = ignored.iter().copied().collect();
        eprintln!(
            "morec: {} labels do not count, because their clips are named as background or unknown: {}",
            ignored.len(),
            some_of(clips.into_iter())
        );
    }
}

fn set_of(paths: &[PathBuf]) -> BTreeSet<PathBuf> {
    paths.iter().map(|p| canonical(p)).collect()
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
