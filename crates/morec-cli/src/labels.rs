//! Reads label files, in all supported formats, as the table that training and measuring need.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use morec::TimeSpan;
use morec::formats::{Place, Warning, c3d};
use morec::labels::{Extent, Label, Labels, names_of_clip};
use morec_db::MotionDb;
use morec_db::exchange::{self, Annotation, LabelContext, LabelFormat};
use morec_db::labels::{SampleFilter, SampleState};

use crate::files;

/// What files of labels do not say of themselves.
#[derive(clap::Args, Clone, Debug, Default)]
#[command(next_help_heading = "Reading labels")]
pub struct LabelArgs {
    /// Read only these tiers (ELAN, Praat), separated by commas
    #[arg(
        hide_short_help = true,
        long,
        value_name = "TIERS",
        value_delimiter = ','
    )]
    pub tier: Vec<String>,
    /// Seconds to add to the times of labels
    ///
    /// For labels of another recording, such as a video, that began later than the clip.
    #[arg(
        long,
        hide_short_help = true,
        value_name = "SECS",
        default_value_t = 0.0,
        allow_negative_numbers = true
    )]
    pub offset: f64,
    /// Frame rate of the labels, if it is not the clip's
    ///
    /// Such as that of a video.
    #[arg(hide_short_help = true, long, value_name = "HZ", value_parser = files::rate)]
    pub label_rate: Option<f64>,
    /// Number of the first frame in labels: 0, or `file` for that of the C3D file
    #[arg(
        long,
        hide_short_help = true,
        value_enum,
        value_name = "file|0",
        default_value = "0",
        hide_possible_values = true
    )]
    pub first_frame: FirstFrame,
}

/// The number of a clip's first frame in labels.
#[derive(clap::ValueEnum, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FirstFrame {
    /// 0.
    #[default]
    #[value(name = "0")]
    Zero,
    /// What the clip's file says.
    File,
}

impl LabelArgs {
    /// The number of the first frame of each clip in C3D files among `clips` and the folders there, by name; empty if frames count from 0.
    pub fn first_frames(&self, clips: &[PathBuf]) -> Result<BTreeMap<String, usize>> {
        let mut first = BTreeMap::new();
        if self.first_frame == FirstFrame::Zero {
            return Ok(first);
        }
        for path in files::expand(clips)? {
            let is_c3d = path
                .extension()
                .is_some_and(|end| end.eq_ignore_ascii_case("c3d"));
            if let (true, Some(stem)) = (is_c3d, path.file_stem()) {
                let time = c3d::read_time(&files::read(&path)?);
                let time = time.with_context(|| path.display().to_string())?;
                first.insert(stem.to_string_lossy().into_owned(), time.first_frame);
            }
        }
        Ok(first)
    }

    /// A stretch in seconds at its place in the clip; `None` if it lies before the clip's beginning, which is said.
    pub fn moved(&self, shown: &str, class: &str, (start, stop): (f64, f64)) -> Option<(f64, f64)> {
        let (start, stop) = (start + self.offset, stop + self.offset);
        if stop <= 0.0 {
            eprintln!("morec: {shown}: {class} lies before the clip; left out");
        }
        (stop > 0.0).then_some((start.max(0.0), stop))
    }

    /// Labels of a table at their places. Frames stay frames where nothing moves them.
    fn move_table(
        &self,
        shown: &str,
        first_frames: &BTreeMap<String, usize>,
        labels: &mut Labels,
    ) -> Result<()> {
        for row in &mut labels.rows {
            let first = names_of_clip(&row.clip).find_map(|name| first_frames.get(name));
            if let (Extent::Frames(frames), Some(&first)) = (&mut row.extent, first) {
                if frames.start < first {
                    bail!(
                        "{shown}: line {}: frame {} is before the first frame of {}, which is {first}",
                        row.line,
                        frames.start,
                        row.clip
                    );
                }
                *frames = frames.start - first..frames.end - first;
            }
        }
        if self.offset == 0.0 && self.label_rate.is_none() {
            return Ok(());
        }
        let rows = std::mem::take(&mut labels.rows);
        for mut row in rows {
            let span = match (&row.extent, self.label_rate) {
                (Extent::WholeClip, _) => {
                    labels.rows.push(row);
                    continue;
                }
                (Extent::Secs(span), _) => *span,
                (Extent::Frames(frames), Some(rate_hz)) => {
                    TimeSpan::of_frames(frames.clone(), rate_hz)
                }
                (Extent::Frames(_), None) => {
                    bail!("{shown}: --offset moves labels in frames only with --label-rate HZ")
                }
            };
            let moved = self.moved(shown, &row.class, (span.start_secs, span.stop_secs));
            if let Some((start, stop)) = moved {
                row.extent = Extent::Secs(TimeSpan::new(start, stop));
                labels.rows.push(row);
            }
        }
        Ok(())
    }
}

/// The labels in a file, or in the files of labels in a folder. What was proposed or rejected is no label.
/// `clips` are the files that frames of labels may count in.
pub fn read(path: &Path, args: &LabelArgs, clips: &[PathBuf]) -> Result<Labels> {
    let first_frames = args.first_frames(clips)?;
    let mut all = Labels::default();
    for file in files_of_labels(std::slice::from_ref(&path.to_owned()))? {
        let mut labels = one(&file, args, &first_frames)?;
        all.rows.append(&mut labels.rows);
        all.warnings.append(&mut labels.warnings);
    }
    Ok(all)
}

/// Accepted labels of a database. A label with several annotators is there once for each of them.
pub fn of_database(db: &MotionDb) -> Result<Labels> {
    let accepted = SampleFilter {
        state: Some(SampleState::Accepted),
        ..SampleFilter::default()
    };
    let mut labels = Labels::default();
    for sample in db.samples(&accepted)? {
        for a in Annotation::of_sample(sample, LabelFormat::Tsv) {
            labels.rows.push(Label {
                clip: a.clip,
                class: a.class,
                extent: (a.extent).map_or(Extent::WholeClip, |(start, stop)| {
                    Extent::Secs(TimeSpan::new(start, stop))
                }),
                person: a.person,
                annotator: a.annotator,
                line: labels.rows.len() as u64 + 1,
            });
        }
    }
    Ok(labels)
}

/// A folder stands for the files of labels in it, by name.
pub fn files_of_labels(paths: &[PathBuf]) -> Result<Vec<PathBuf>> {
    let mut all = Vec::new();
    for path in paths {
        if !path.is_dir() {
            all.push(path.clone());
            continue;
        }
        let shown = || path.display().to_string();
        let mut inside = Vec::new();
        for entry in std::fs::read_dir(path).with_context(shown)? {
            inside.push(entry.with_context(shown)?.path());
        }
        inside.retain(|file| {
            // A C3D file in a folder is a clip; named, it stands for its events.
            let is_clip = file
                .extension()
                .is_some_and(|end| end.eq_ignore_ascii_case("c3d"));
            let form = LabelFormat::of_file(&file.to_string_lossy(), b"");
            file.is_file() && form.is_some() && !is_clip
        });
        if inside.is_empty() {
            bail!("{}: the folder contains no label file", path.display());
        }
        inside.sort();
        all.append(&mut inside);
    }
    Ok(all)
}

fn one(path: &Path, args: &LabelArgs, first_frames: &BTreeMap<String, usize>) -> Result<Labels> {
    let shown = || path.display().to_string();
    let bytes = files::read(path)?;
    // A table of labels may have any ending: all others say their form.
    let form = match LabelFormat::of_file(&path.to_string_lossy(), &bytes) {
        Some(LabelFormat::Audacity) if is_table(&bytes) => LabelFormat::Tsv,
        form => form.unwrap_or(LabelFormat::Tsv),
    };
    if form == LabelFormat::Tsv && !exchange::is_of_boris(&bytes) {
        let mut labels = Labels::read(&bytes).with_context(shown)?;
        args.move_table(&shown(), first_frames, &mut labels)?;
        return Ok(labels);
    }
    // What a file says of its clip goes before what it is called.
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let clip = exchange::clip_of_file_name(&stem);
    let clip = (form.is_of_one_clip() && !exchange::names_clip(form, &bytes)).then_some(clip);
    let context = LabelContext {
        clip: clip.as_deref(),
        lengths: None,
        label_rate_hz: args.label_rate,
        tiers: &args.tier,
        first_frames: Some(first_frames),
    };
    let read = exchange::read_with(form, &bytes, &context).with_context(shown)?;
    if let Some((clip, count)) = read.absent.iter().next() {
        bail!(
            "{}: {count} labels of clip {clip} are in frames; expected seconds, or --label-rate HZ",
            path.display()
        );
    }
    let mut warnings = read.warnings;
    let (accepted, others): (Vec<Annotation>, Vec<Annotation>) = read
        .annotations
        .into_iter()
        .partition(|annotation| annotation.state == SampleState::Accepted);
    if !others.is_empty() {
        let text = format!(
            "{} labels do not have the state accepted; left out",
            others.len()
        );
        warnings.push(Warning::new(Place::File, text));
    }
    let rows = (1..).zip(accepted).filter_map(|(line, annotation)| {
        let extent = match annotation.extent {
            Some(extent) => {
                let (start, stop) = args.moved(&shown(), &annotation.class, extent)?;
                Extent::Secs(TimeSpan::new(start, stop))
            }
            None => Extent::WholeClip,
        };
        Some(Label {
            clip: annotation.clip,
            class: annotation.class,
            extent,
            person: annotation.person,
            annotator: annotation.annotator,
            line,
        })
    });
    Ok(Labels {
        rows: rows.collect(),
        warnings,
    })
}

/// A question about a class by whose name nothing happens.
pub fn doubt_of_none<'a>(classes: impl IntoIterator<Item = &'a str>) -> Option<String> {
    const NONE: [&str; 9] = [
        "none",
        "null",
        "nothing",
        "no action",
        "no_action",
        "background",
        "no gesture",
        "no_gesture",
        "nan",
    ];
    let is_none = |class: &&str| NONE.contains(&class.to_lowercase().as_str());
    let class = classes.into_iter().find(is_none)?;
    Some(format!(
        "`{class}` does not look like a class of motion. Parts without a motion need no label: remove these rows, otherwise they \
         are learned as a class"
    ))
}

/// True if text is a table of labels with its header: what Audacity writes has none.
fn is_table(bytes: &[u8]) -> bool {
    let first = bytes.split(|&byte| byte == b'\n').next().unwrap_or(bytes);
    let mut cells = first.split(|&byte| byte == b'\t');
    cells.any(|cell| cell.trim_ascii() == b"class")
}
