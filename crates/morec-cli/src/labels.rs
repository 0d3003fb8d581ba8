//! Labels on disk, in every form that `morec db label` reads, as the table that training and measuring take.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use morec::TimeSpan;
use morec::formats::{Place, Warning};
use morec::labels::{Extent, Label, Labels};
use morec_db::exchange::{self, Annotation, ClipLengths, LabelFormat};
use morec_db::labels::SampleState;

use crate::files;

/// The labels in a file, or in the files of labels in a folder. What was proposed or rejected is no label.
pub fn read(path: &Path) -> Result<Labels> {
    let mut all = Labels::default();
    for file in files_of_labels(std::slice::from_ref(&path.to_owned()))? {
        let mut labels = one(&file)?;
        all.rows.append(&mut labels.rows);
        all.warnings.append(&mut labels.warnings);
    }
    Ok(all)
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
            file.is_file() && LabelFormat::of_file(&file.to_string_lossy(), b"").is_some()
        });
        if inside.is_empty() {
            bail!("{}: no file of labels in this folder", path.display());
        }
        inside.sort();
        all.append(&mut inside);
    }
    Ok(all)
}

fn one(path: &Path) -> Result<Labels> {
    let shown = || path.display().to_string();
    let bytes = files::read(path)?;
    // A table of labels may have any ending: all others say their form.
    let form = match LabelFormat::of_file(&path.to_string_lossy(), &bytes) {
        Some(LabelFormat::Audacity) if is_table(&bytes) => LabelFormat::Tsv,
        form => form.unwrap_or(LabelFormat::Tsv),
    };
    if form == LabelFormat::Tsv {
        return Labels::read(&bytes).with_context(shown);
    }
    // What a file says of its clip goes before what it is called.
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let clip = exchange::clip_of_file_name(&stem);
    let clip = (form.is_of_one_clip() && !exchange::names_clip(form, &bytes)).then_some(clip);
    let read =
        exchange::read(form, &bytes, clip.as_deref(), &ClipLengths::new()).with_context(shown)?;
    if let Some((clip, count)) = read.absent.iter().next() {
        bail!(
            "{}: {count} labels of clip {clip} are in frames; expected seconds, which need no rate",
            path.display()
        );
    }
    let mut warnings = read.warnings;
    let (accepted, others): (Vec<Annotation>, Vec<Annotation>) = read
        .annotations
        .into_iter()
        .partition(|annotation| annotation.state == SampleState::Accepted);
    if !others.is_empty() {
        let text = format!("{} labels are not accepted; left out", others.len());
        warnings.push(Warning::new(Place::File, text));
    }
    let rows = (1..).zip(accepted).map(|(line, annotation)| Label {
        clip: annotation.clip,
        class: annotation.class,
        extent: match annotation.extent {
            Some((start, stop)) => Extent::Secs(TimeSpan::new(start, stop)),
            None => Extent::WholeClip,
        },
        person: annotation.person,
        line,
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
        "is `{class}` a class of motion? Where nothing happens needs no label: leave its rows out, or they are learnt as a motion"
    ))
}

/// True if text is a table of labels with its header: what Audacity writes has none.
fn is_table(bytes: &[u8]) -> bool {
    let first = bytes.split(|&byte| byte == b'\n').next().unwrap_or(bytes);
    let mut cells = first.split(|&byte| byte == b'\t');
    cells.any(|cell| cell.trim_ascii() == b"class")
}
