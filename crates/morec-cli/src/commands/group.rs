//! `morec group`: which samples are alike, and whether classes would say the same.

use std::collections::{BTreeMap, BTreeSet};
use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result, bail};
use clap::ValueEnum;
use morec::cluster::{
    Clusters, KwasForm, KwasParams, Pairs, Spectrum, adjusted_rand_index, kwas_clusters,
};
use morec::features::Rows;
use morec::labels::Labels;
use morec::pca::{Keep, Moments, Pca};
use morec::segment::{PpcaParams, segment};
use serde::Serialize;

use crate::figures::write_json;
use crate::files::{self, some_of};
use crate::poses::{PoseArgs, PoseReader, PosedClip};
use crate::table::Table;

/// Group samples that are alike
///
/// Two samples are alike if the principal directions of their poses are (kWAS, above --tau); whoever is alike, over
/// however many others, is one cluster. With labels their samples are grouped, and the clusters held against the
/// classes; without, clips are cut first (as `morec cut` does) and the segments grouped.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  morec group --clips recordings/ --labels labels.tsv
  morec group --clips recordings/ --labels labels.tsv --centre none --tau 0.995
  morec group --clips 86_01.amc")]
pub struct Args {
    /// Clips, or folders of clips
    #[arg(long, value_name = "DIR|CLIP", num_args = 1.., required = true)]
    clips: Vec<PathBuf>,
    /// Labels: tab-separated text with a header; columns clip (file stem), class, and start, stop (frames, stop
    /// exclusive) or start_secs, stop_secs, or neither: then the whole clip is one sample
    #[arg(long, value_name = "TSV")]
    labels: Option<PathBuf>,
    /// Group samples of these classes only, separated by commas [default: every class of the labels]
    #[arg(
        long,
        value_delimiter = ',',
        value_name = "CLASSES",
        requires = "labels"
    )]
    classes: Vec<String>,
    /// How alike two samples must be to be one cluster, 0 to 1
    #[arg(long, value_name = "TAU", default_value_t = KwasParams::default().tau)]
    tau: f64,
    /// Principal directions of a sample that count
    #[arg(short, long, value_name = "N", default_value_t = KwasParams::default().k)]
    k: usize,
    /// Scale similarity so that a sample is 1 like itself, however few directions count
    #[arg(long)]
    normalised: bool,
    /// What samples are centred on before they are compared
    #[arg(long, value_enum, default_value = "database")]
    centre: Centre,
    /// Share of the variance of all poses that is kept before samples are compared
    #[arg(long, value_name = "SHARE", default_value_t = 0.99)]
    quality: f64,
    /// Keep so many dimensions instead
    #[arg(long, value_name = "N", conflicts_with = "quality")]
    dims: Option<usize>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    poses: PoseArgs,
}

/// What samples are centred on.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
enum Centre {
    /// The mean of all poses, which are then reduced to --quality or --dims: samples are many small clusters
    Database,
    /// Nothing, and all dimensions are kept: the mean pose counts, samples are more alike, and --tau belongs near 1
    None,
}

/// A stretch of a clip to be grouped.
#[derive(Debug, Clone, Serialize)]
struct GroupedSample {
    clip: String,
    start_secs: f64,
    stop_secs: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    class: Option<String>,
}

#[derive(Serialize)]
struct Agreement {
    classes: usize,
    pairs: Pairs,
    rand_index: f64,
    adjusted_rand_index: f64,
}

#[derive(Serialize)]
struct Grouped {
    kwas: KwasParams,
    centre: Centre,
    dims: usize,
    quality: f64,
    clusters: Vec<Vec<GroupedSample>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    agreement: Option<Agreement>,
}

/// Reads, groups, compares and prints.
pub fn run(args: &Args) -> Result<ExitCode> {
    let keep = args.dims.map_or(Keep::Quality(args.quality), Keep::Dims);
    keep.check().map_err(anyhow::Error::msg)?;
    let kwas = args.kwas()?;
    let reader = args.poses.reader()?;
    let clips = read_clips(args, &reader)?;
    let samples = match &args.labels {
        Some(_) => labelled(args, &clips)?,
        None => cut(&reader, &clips)?,
    };
    let pca = match args.centre {
        Centre::Database => Some(components(&clips, reader.set.row_dim(), keep)?),
        Centre::None => None,
    };
    let (samples, spectra) = spectra(samples, &clips, reader.rate_hz(), pca.as_ref())?;
    let clusters = kwas_clusters(&spectra, &kwas);
    let agreement = args
        .labels
        .is_some()
        .then(|| Agreement::of(&samples, &clusters));
    let take = |members: Vec<usize>| members.into_iter().map(|i| samples[i].clone()).collect();
    let mut clusters: Vec<Vec<GroupedSample>> = clusters.members().into_iter().map(take).collect();
    clusters.sort_by_key(|cluster| std::cmp::Reverse(cluster.len()));
    let (dims, quality) = pca.map_or((reader.set.row_dim(), 1.0), |pca| {
        (pca.dims(), pca.quality())
    });
    let grouped = Grouped {
        kwas,
        centre: args.centre,
        dims,
        quality,
        clusters,
        agreement,
    };
    let mut out = std::io::stdout().lock();
    if args.json {
        write_json(&mut out, &grouped)?;
    } else {
        grouped.write(&mut out)?;
    }
    out.flush()?;
    Ok(ExitCode::SUCCESS)
}

impl Args {
    fn kwas(&self) -> Result<KwasParams> {
        if !(0.0..=1.0).contains(&self.tau) {
            bail!("--tau {}: expected 0 to 1", self.tau);
        }
        if self.k == 0 {
            bail!("--k 0: at least one direction must count");
        }
        let form = if self.normalised {
            KwasForm::Normalised
        } else {
            KwasForm::Printed
        };
        Ok(KwasParams {
            k: self.k,
            tau: self.tau,
            form,
        })
    }
}

fn read_clips(args: &Args, reader: &PoseReader<'_>) -> Result<BTreeMap<String, PosedClip>> {
    let mut clips = BTreeMap::new();
    reader.each(&args.clips, |clip| {
        let name = clip.name.clone();
        if clips.insert(name.clone(), clip).is_some() {
            bail!("two clips are called {name}: labels could not tell them apart");
        }
        Ok(())
    })?;
    Ok(clips)
}

/// The samples of the labels that lie in `clips`.
fn labelled(args: &Args, clips: &BTreeMap<String, PosedClip>) -> Result<Vec<GroupedSample>> {
    let Some(path) = &args.labels else {
        return Ok(Vec::new());
    };
    let labels = Labels::read(&files::read(path)?).with_context(|| path.display().to_string())?;
    let resolved = labels.resolve(
        &clips
            .iter()
            .map(|(name, clip)| (name.clone(), clip.length))
            .collect(),
    );
    for warning in labels.warnings.iter().chain(&resolved.warnings) {
        eprintln!("morec: {}: {warning}", path.display());
    }
    if !resolved.absent.is_empty() {
        let (rows, names) = (
            resolved.absent.values().sum::<usize>(),
            some_of(resolved.absent.keys()),
        );
        eprintln!("morec: {rows} labels are of clips that are not there: {names}");
    }
    let wanted = |class: &String| args.classes.is_empty() || args.classes.contains(class);
    let samples: Vec<GroupedSample> = resolved
        .samples
        .into_iter()
        .filter(|s| wanted(&s.class))
        .map(|s| GroupedSample {
            clip: s.clip,
            start_secs: s.start_secs,
            stop_secs: s.stop_secs,
            class: Some(s.class),
        })
        .collect();
    if samples.is_empty() {
        bail!(
            "no sample to group: no label names any of these clips (labels name clips by file stem)"
        );
    }
    Ok(samples)
}

/// The segments of all clips.
fn cut(reader: &PoseReader<'_>, clips: &BTreeMap<String, PosedClip>) -> Result<Vec<GroupedSample>> {
    let mut samples = Vec::new();
    for (name, clip) in clips {
        let found =
            segment(&clip.rows, reader.rate_hz(), &PpcaParams::default()).context(name.clone())?;
        let mut start_secs = 0.0;
        let end_secs = clip.length.duration_secs();
        for stop_secs in found.cuts.iter().map(|c| c.secs).chain([end_secs]) {
            samples.push(GroupedSample {
                clip: name.clone(),
                start_secs,
                stop_secs,
                class: None,
            });
            start_secs = stop_secs;
        }
    }
    Ok(samples)
}

fn components(clips: &BTreeMap<String, PosedClip>, dim: usize, keep: Keep) -> Result<Pca> {
    let mut moments = Moments::new(dim);
    clips
        .values()
        .for_each(|clip| moments.push_rows(&clip.rows));
    Ok(Pca::fit(&moments, keep)?)
}

/// The samples of at least one pose, and what kWAS knows of each.
fn spectra(
    samples: Vec<GroupedSample>,
    clips: &BTreeMap<String, PosedClip>,
    rate_hz: f64,
    pca: Option<&Pca>,
) -> Result<(Vec<GroupedSample>, Vec<Spectrum>)> {
    let (mut kept, mut spectra) = (Vec::new(), Vec::new());
    for sample in samples {
        let rows: &Rows = &clips.get(&sample.clip).context("a sample of no clip")?.rows;
        let row = |secs: f64| ((secs * rate_hz).round() as usize).min(rows.len());
        let (start, stop) = (row(sample.start_secs), row(sample.stop_secs));
        if start >= stop {
            eprintln!(
                "morec: {}: a sample at {:.2} s holds no pose",
                sample.clip, sample.start_secs
            );
            continue;
        }
        let rows = rows.slice(start..stop);
        spectra.push(Spectrum::of_rows(
            &pca.map_or_else(|| rows.clone(), |pca| pca.project(&rows)),
        ));
        kept.push(sample);
    }
    Ok((kept, spectra))
}

impl Agreement {
    fn of(samples: &[GroupedSample], clusters: &Clusters) -> Self {
        let names: BTreeSet<Option<&str>> = samples.iter().map(|s| s.class.as_deref()).collect();
        let number = |s: &GroupedSample| names.range(..s.class.as_deref()).count();
        let classes: Vec<usize> = samples.iter().map(number).collect();
        let pairs = Pairs::count(&classes, &clusters.of);
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
        let mut table = Table::new(["", "one class", "two classes"]);
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
                sample.clip, sample.start_secs, sample.stop_secs
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
