//! Grouping as in the thesis of 2009, by principal directions of poses: kWAS, and the tree of single samples.

use std::collections::{BTreeMap, BTreeSet};
use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result, bail};
use morec::cluster::{Clusters, KwasParams, PairCounts, adjusted_rand_index};
use morec::features::Rows;
use morec::pca::{Moments, Pca};
use morec::segment::{PpcaParams, segment};
use morec_ops::{Centre, GroupMethod, largest_first};
use serde::Serialize;

use super::args::Args;
use super::members::{GroupedSample, labelled};
use crate::json::write_json;
use crate::poses::{PoseReader, PosedClip};
use crate::table::TextTable;

#[derive(Serialize)]
struct Agreement {
    classes: usize,
    pairs: PairCounts,
    rand_index: f64,
    adjusted_rand_index: f64,
}

#[derive(Serialize)]
struct Grouped {
    #[serde(skip_serializing_if = "Option::is_none")]
    kwas: Option<KwasParams>,
    centre: Centre,
    dims: usize,
    quality: f64,
    clusters: Vec<Vec<GroupedSample>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    agreement: Option<Agreement>,
}

/// Reads clips in files, groups, compares and prints.
pub fn run(paths: &[PathBuf], args: &Args) -> Result<ExitCode> {
    let settings = &args.settings;
    let kwas = match settings.method {
        GroupMethod::Kwas => Some(settings.kwas()?),
        _ => None,
    };
    let reader = args.poses.reader()?;
    let clips = read_clips(paths, &reader)?;
    let samples = match &args.labels {
        Some(path) => {
            let length = |(name, clip): (&String, &PosedClip)| (name.clone(), clip.length);
            labelled(
                path,
                (&args.reading, paths),
                &args.settings.classes,
                &clips.iter().map(length).collect(),
            )?
        }
        None => cut(&reader, &clips)?,
    };
    let mut moments = Moments::new(reader.set.row_dim());
    clips
        .values()
        .for_each(|clip| moments.push_rows(&clip.rows));
    let pca = settings.reduction(&moments)?;
    let (samples, rows) = reduced(samples, &clips, reader.rate_hz(), pca.as_ref())?;
    let clusters = settings.clusters(rows.iter())?;
    let agreement = args
        .labels
        .is_some()
        .then(|| Agreement::of(&samples, &clusters));
    let take = |members: Vec<usize>| members.into_iter().map(|i| samples[i].clone()).collect();
    let groups = largest_first(&clusters).into_iter();
    let clusters: Vec<Vec<GroupedSample>> = groups.map(take).collect();
    let (dims, quality) = pca.map_or((reader.set.row_dim(), 1.0), |pca| {
        (pca.dims(), pca.quality())
    });
    let grouped = Grouped {
        kwas,
        centre: settings.centre,
        dims,
        quality,
        clusters,
        agreement,
    };
    let mut out = crate::console::stdout();
    if args.json {
        write_json(&mut out, &grouped)?;
    } else {
        grouped.write(&mut out)?;
    }
    out.flush()?;
    Ok(ExitCode::SUCCESS)
}

fn read_clips(paths: &[PathBuf], reader: &PoseReader<'_>) -> Result<BTreeMap<String, PosedClip>> {
    let mut clips = BTreeMap::new();
    reader.each(paths, |clip| {
        let name = clip.name.clone();
        if clips.insert(name.clone(), clip).is_some() {
            bail!("two clips are called {name}, so labels cannot distinguish them: rename one");
        }
        Ok(())
    })?;
    Ok(clips)
}

/// The segments of all clips.
fn cut(reader: &PoseReader<'_>, clips: &BTreeMap<String, PosedClip>) -> Result<Vec<GroupedSample>> {
    let mut samples = Vec::new();
    for (name, clip) in clips {
        let found =
            segment(&clip.rows, reader.rate_hz(), &PpcaParams::default()).context(name.clone())?;
        let end_secs = clip.length.duration_secs();
        let cuts = found.cuts.iter().map(|cut| cut.secs);
        samples.extend(GroupedSample::between(name, cuts, end_secs));
    }
    Ok(samples)
}

/// The samples of at least one pose, and the reduced rows of each.
fn reduced(
    samples: Vec<GroupedSample>,
    clips: &BTreeMap<String, PosedClip>,
    rate_hz: f64,
    pca: Option<&Pca>,
) -> Result<(Vec<GroupedSample>, Vec<Rows>)> {
    let (mut kept, mut reduced) = (Vec::new(), Vec::new());
    for sample in samples {
        let rows: &Rows = &clips.get(&sample.clip).context("a sample of no clip")?.rows;
        let of_sample = sample.span.frames_among(rows.len(), rate_hz);
        if of_sample.is_empty() {
            eprintln!(
                "morec: {}: the sample at {:.2} s contains no pose",
                sample.clip, sample.span.start_secs
            );
            continue;
        }
        let rows = rows.slice(of_sample);
        reduced.push(match pca {
            Some(pca) => pca.project(&rows),
            None => rows,
        });
        kept.push(sample);
    }
    Ok((kept, reduced))
}

impl Agreement {
    fn of(samples: &[GroupedSample], clusters: &Clusters) -> Self {
        let names: BTreeSet<Option<&str>> = samples.iter().map(|s| s.class.as_deref()).collect();
        let number = |s: &GroupedSample| names.range(..s.class.as_deref()).count();
        let classes: Vec<usize> = samples.iter().map(number).collect();
        let pairs = PairCounts::count(&classes, &clusters.of);
        Self {
            classes: names.len(),
            pairs,
            rand_index: pairs.rand_index(),
            adjusted_rand_index: adjusted_rand_index(&classes, &clusters.of),
        }
    }
}

impl Grouped {
    fn write(&self, out: &mut impl Write) -> std::io::Result<()> {
        let samples: usize = self.clusters.iter().map(Vec::len).sum();
        let (clusters, dims, percent) = (self.clusters.len(), self.dims, 100.0 * self.quality);
        let plural = if clusters == 1 { "" } else { "s" };
        let kept = format!("{dims} dimensions, {percent:.1} % of all poses");
        writeln!(
            out,
            "{samples} samples in {clusters} cluster{plural}; {kept}"
        )?;
        for (number, cluster) in self.clusters.iter().enumerate() {
            writeln!(
                out,
                "  cluster {}: {} samples: {}",
                number + 1,
                cluster.len(),
                contents(cluster)
            )?;
        }
        let Some(agreement) = &self.agreement else {
            return Ok(());
        };
        let pairs = &agreement.pairs;
        writeln!(out, "\nagainst {} classes, pair by pair", agreement.classes)?;
        let mut table = TextTable::new(["", "one class", "two classes"]);
        let row =
            |name: &str, one: u64, two: u64| [name.to_owned(), one.to_string(), two.to_string()];
        table.row(row(
            "one cluster",
            pairs.true_positive,
            pairs.false_positive,
        ));
        table.row(row(
            "two clusters",
            pairs.false_negative,
            pairs.true_negative,
        ));
        write!(out, "{table}")?;
        let (rand, adjusted) = (agreement.rand_index, agreement.adjusted_rand_index);
        writeln!(out, "Rand index {rand:.3}, adjusted {adjusted:.3}")
    }
}

/// Classes and how often, or where the segments lie.
fn contents(cluster: &[GroupedSample]) -> String {
    let mut classes: BTreeMap<&str, usize> = BTreeMap::new();
    let mut parts = Vec::new();
    for sample in cluster {
        match &sample.class {
            Some(class) => *classes.entry(class).or_default() += 1,
            None => parts.push(format!(
                "{} {:.2}-{:.2} s",
                sample.clip, sample.span.start_secs, sample.span.stop_secs
            )),
        }
    }
    parts.extend(
        classes
            .iter()
            .map(|(class, count)| format!("{class} {count}")),
    );
    parts.join(", ")
}
