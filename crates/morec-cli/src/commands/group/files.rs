//! Groups samples or segments of clips in files.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result, bail};
use morec::features::{BoneSet, FeatureParams, RowLayout, Rows, rows_of_clip};
use morec::labels::ClipLength;
use morec::segment::{KernelParams, kernel_cuts};

use morec_ops::Grouping;

use super::args::Args;
use super::members::{GroupList, GroupMember, GroupedSample, labelled};

/// A clip as feature rows.
struct RowedClip {
    length: ClipLength,
    bones: BoneSet,
    rows: Rows,
}

/// Reads, groups and prints.
pub fn run(paths: &[PathBuf], args: &Args) -> Result<ExitCode> {
    if args.name_as.is_some() || args.report.is_some() {
        bail!("--name-as and --report need a database (create one with morec db import)");
    }
    let params = FeatureParams::default();
    let mut clips = BTreeMap::new();
    args.poses.reader()?.each_take(paths, |take| {
        let bones = take.bones();
        let clip = RowedClip {
            length: (&take.clip).into(),
            bones,
            rows: rows_of_clip(&take.clip, &take.roles, take.rest(), bones, &params),
        };
        let name = take.clip.name;
        match clips.insert(name.clone(), clip) {
            None => Ok(()),
            Some(_) => {
                bail!("two clips are called {name}, so labels cannot distinguish them: rename one")
            }
        }
    })?;
    let samples = samples(paths, &clips, args, &params)?;
    let items = items(samples, &clips, &params);
    if items.is_empty() {
        bail!("nothing to group: no sample contains motion");
    }
    GroupList::of(&items, &args.settings, args.labels.is_some())?.print(args)?;
    Ok(ExitCode::SUCCESS)
}

/// Stretches to group: labelled samples, whole clips, or what lies between cuts.
fn samples(
    paths: &[PathBuf],
    clips: &BTreeMap<String, RowedClip>,
    args: &Args,
    params: &FeatureParams,
) -> Result<Vec<GroupedSample>> {
    if let Some(path) = &args.labels {
        let length = |(name, clip): (&String, &RowedClip)| (name.clone(), clip.length);
        return labelled(
            path,
            (&args.reading, paths),
            &args.settings.classes,
            &clips.iter().map(length).collect(),
        );
    }
    let mut samples = Vec::new();
    for (name, clip) in clips {
        let cuts = match args.settings.of {
            Some(Grouping::Labels) => bail!("--of labels needs --labels"),
            Some(Grouping::Clips) => Vec::new(),
            None | Some(Grouping::Cuts) => {
                kernel_cuts(&clip.rows, params, &KernelParams::default()).context(name.clone())?
            }
        };
        let end_secs = clip.length.duration_secs();
        samples.extend(GroupedSample::between(name, cuts, end_secs));
    }
    Ok(samples)
}

/// Samples with their rows, over the bones that all of them show.
fn items(
    samples: Vec<GroupedSample>,
    clips: &BTreeMap<String, RowedClip>,
    params: &FeatureParams,
) -> Vec<GroupMember> {
    let shown = samples
        .iter()
        .filter_map(|s| Some(clips.get(&s.clip)?.bones));
    let bones = shown.reduce(BoneSet::and).unwrap_or(BoneSet::NONE);
    let item = |sample: GroupedSample| {
        let clip = clips.get(&sample.clip)?;
        let ticks = (sample.span).frames_among(clip.rows.len(), params.tick_hz());
        let rows = (!ticks.is_empty()).then(|| {
            let kept = RowLayout::kept_columns(clip.bones, bones);
            clip.rows.slice(ticks).columns(&kept)
        })?;
        Some(GroupMember {
            sample,
            id: None,
            rows,
        })
    };
    samples.into_iter().filter_map(item).collect()
}
