//! `morec db group`: samples or segments that are alike.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Result, bail};
use morec::cluster::{
    AffinityParams, Clusters, Hierarchy, KwasParams, Pairs, Spectrum, adjusted_rand_index,
    affinity_propagation, kwas_clusters, resampled, squared_distance,
};
use morec::features::{BoneSet, FeatureParams, Rows};
use morec_db::labels::{GROUPED_BY, NewSample, SampleFilter, State};
use morec_db::{ClipFilter, ClipId, MotionDb, SegmentKind};
use serde::Serialize;

use super::page::{self, Page};
use crate::database;
use crate::progress::Bar;
use crate::table::Table;

/// Group labelled samples or cuts that are alike
///
/// Affinity propagation finds the number of groups itself; --method hierarchy is cut at --groups or --height; kwas is the
/// thesis's. With --name-as the groups become classes of proposed samples: rename, merge and accept what is right.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  morec db group moves.mdb
  morec db group moves.mdb --of labels                       # and how well that agrees with the classes
  morec db group moves.mdb --method hierarchy --groups 12 --name-as group")]
pub struct Args {
    /// The database
    #[arg(value_name = "DB")]
    db: PathBuf,
    /// What is grouped
    #[arg(long, value_enum, default_value = "cuts")]
    of: Grouping,
    /// Samples of these classes only, separated by commas
    #[arg(long, value_delimiter = ',', value_name = "CLASSES")]
    classes: Vec<String>,
    /// How
    #[arg(long, value_enum, default_value = "affinity")]
    method: GroupMethod,
    /// How willing a sample is to stand for a group, as a quantile of similarities (affinity)
    #[arg(long, value_name = "Q", value_parser = super::share, default_value_t = AffinityParams::default().preference)]
    preference: f64,
    /// Cut the hierarchy into so many groups
    #[arg(long, value_name = "N", conflicts_with = "height")]
    groups: Option<usize>,
    /// Cut the hierarchy where groups are so far apart on average
    #[arg(long, value_name = "DISTANCE")]
    height: Option<f64>,
    /// Similarity above which two are of one group (kwas)
    #[arg(long, value_name = "TAU", value_parser = super::share, default_value_t = KwasParams::default().tau)]
    tau: f64,
    /// Propose each member of a group as a sample of the class NAME_1, NAME_2, …
    #[arg(long, value_name = "NAME")]
    name_as: Option<String>,
    /// Write a page with a strip of poses for each member of each group, too
    #[arg(long, value_name = "HTML")]
    report: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// What is grouped.
#[derive(clap::ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
enum Grouping {
    /// Segments that morec cut found
    Cuts,
    /// Labelled samples
    Labels,
    /// Whole clips
    Clips,
}

/// A method of grouping.
#[derive(clap::ValueEnum, Clone, Copy, Debug)]
enum GroupMethod {
    /// Affinity propagation over evenly resampled rows
    Affinity,
    /// Average linkage over evenly resampled rows
    Hierarchy,
    /// Principal directions of rows, as in the thesis
    Kwas,
}

#[derive(Serialize, Clone)]
struct Member {
    clip: String,
    start_secs: f64,
    stop_secs: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    class: Option<String>,
    #[serde(skip)]
    id: ClipId,
    #[serde(skip)]
    rows: Rows,
}

#[derive(Serialize)]
struct Groups {
    groups: Vec<Vec<Member>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    rand_index: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    adjusted_rand_index: Option<f64>,
}

/// Rows that a sample of any length becomes.
const POINTS: usize = 16;

/// Clusters, prints, and proposes if asked to.
pub fn run(args: &Args) -> Result<ExitCode> {
    let mut db = if args.name_as.is_some() {
        database::open(&args.db)?
    } else {
        database::open_read_only(&args.db)?
    };
    if let Some(path) = &args.report {
        page::check(path)?;
    }
    args.classes
        .iter()
        .try_for_each(|class| db.need_class(class))?;
    let items = items(&mut db, args)?;
    if items.is_empty() {
        bail!("nothing to group (morec cut finds segments, morec db label sets samples)");
    }
    let groups = groups(&items, args);
    let mut grouped = Groups {
        groups: Vec::new(),
        rand_index: None,
        adjusted_rand_index: None,
    };
    if args.of == Grouping::Labels {
        let names: BTreeSet<Option<&str>> = items.iter().map(|i| i.class.as_deref()).collect();
        let classes: Vec<usize> = items
            .iter()
            .map(|i| names.range(..i.class.as_deref()).count())
            .collect();
        grouped.rand_index = Some(Pairs::count(&classes, &groups.of).rand_index());
        grouped.adjusted_rand_index = Some(adjusted_rand_index(&classes, &groups.of));
    }
    grouped.groups = groups
        .members()
        .into_iter()
        .map(|m| m.into_iter().map(|i| items[i].clone()).collect())
        .collect();
    grouped
        .groups
        .sort_by_key(|group: &Vec<Member>| std::cmp::Reverse(group.len()));
    if let Some(name) = &args.name_as {
        propose(&mut db, &grouped.groups, name)?;
    }
    if let Some(path) = &args.report {
        report(path, &db, args, &grouped)?;
    }
    if args.json {
        super::print_json(&grouped)?;
    } else {
        print(&grouped)?;
    }
    Ok(ExitCode::SUCCESS)
}

fn items(db: &mut MotionDb, args: &Args) -> Result<Vec<Member>> {
    let params = FeatureParams::default();
    let rows = db.rows(&params, &Bar::stoppable()?)?;
    let clips = db.clips(&ClipFilter::default())?;
    let names: BTreeMap<ClipId, &str> = clips.iter().map(|c| (c.id, c.name.as_str())).collect();
    let spans: Vec<(ClipId, f64, f64, Option<String>)> = match args.of {
        Grouping::Clips => clips
            .iter()
            .map(|c| (c.id, 0.0, c.duration_secs(), None))
            .collect(),
        Grouping::Cuts => {
            let moving = db
                .segments()?
                .into_iter()
                .filter(|s| s.kind == SegmentKind::Motion);
            moving
                .map(|s| (s.clip, s.start_secs, s.stop_secs, None))
                .collect()
        }
        Grouping::Labels => {
            let samples = db.samples(&SampleFilter {
                state: Some(State::Accepted),
                ..Default::default()
            })?;
            let wanted = samples
                .into_iter()
                .filter(|s| args.classes.is_empty() || args.classes.contains(&s.class));
            wanted
                .map(|s| (s.clip, s.start_secs, s.stop_secs, Some(s.class)))
                .collect()
        }
    };
    let rows: BTreeMap<ClipId, _> = rows.into_iter().map(|r| (r.clip, r)).collect();
    // Only bones that every one of them shows.
    let bones = spans
        .iter()
        .filter_map(|s| rows.get(&s.0))
        .map(|r| r.bones)
        .reduce(BoneSet::and);
    let bones = bones.unwrap_or(BoneSet::NONE);
    let item = |(id, start_secs, stop_secs, class): (ClipId, f64, f64, Option<String>)| {
        let of = rows.get(&id)?;
        let tick = |secs: f64| ((secs * params.tick_hz()).round() as usize).min(of.rows.len());
        let span = tick(start_secs)..tick(stop_secs);
        let rows = (!span.is_empty()).then(|| only(&of.rows.slice(span), of.bones, bones))?;
        Some(Member {
            clip: (*names.get(&id)?).to_owned(),
            start_secs,
            stop_secs,
            class,
            id,
            rows,
        })
    };
    Ok(spans.into_iter().filter_map(item).collect())
}

/// The columns of some of the bones, and of the root.
fn only(rows: &Rows, of: BoneSet, wanted: BoneSet) -> Rows {
    let b = of.len();
    let places: Vec<usize> = of
        .indices()
        .enumerate()
        .filter(|(_, bone)| wanted.contains(*bone))
        .map(|(at, _)| at)
        .collect();
    let block = |start: usize| {
        places
            .iter()
            .flat_map(move |at| (0..3).map(move |i| start + 3 * at + i))
    };
    let columns: Vec<usize> = block(0)
        .chain(block(3 * b))
        .chain(6 * b..6 * b + 4)
        .collect();
    rows.columns(&columns)
}

fn groups(items: &[Member], args: &Args) -> Clusters {
    let points: Vec<Vec<f32>> = items
        .iter()
        .map(|item| resampled(&item.rows, POINTS))
        .collect();
    let apart = |a: usize, b: usize| squared_distance(&points[a], &points[b], POINTS);
    match args.method {
        GroupMethod::Affinity => {
            let params = AffinityParams {
                preference: args.preference,
                ..AffinityParams::default()
            };
            affinity_propagation(items.len(), |a, b| -apart(a, b), &params)
        }
        GroupMethod::Hierarchy => {
            let tree = Hierarchy::average(items.len(), |a, b| apart(a, b).sqrt());
            match (args.groups, args.height) {
                (Some(count), _) => tree.into_clusters(count),
                (None, Some(height)) => tree.at_height(height),
                (None, None) => tree.into_clusters((items.len() as f64).sqrt().ceil() as usize),
            }
        }
        GroupMethod::Kwas => {
            let spectra: Vec<Spectrum> = items
                .iter()
                .map(|item| Spectrum::of_rows(&item.rows))
                .collect();
            kwas_clusters(
                &spectra,
                &KwasParams {
                    tau: args.tau,
                    ..KwasParams::default()
                },
            )
        }
    }
}

fn propose(db: &mut MotionDb, groups: &[Vec<Member>], name: &str) -> Result<()> {
    let mut samples = Vec::new();
    for (number, group) in groups.iter().enumerate() {
        samples.extend(group.iter().map(|item| NewSample {
            clip: item.id,
            class: format!("{name}_{}", number + 1),
            start_secs: item.start_secs,
            stop_secs: item.stop_secs,
            whole_clip: false,
            state: State::Proposed,
            score: None,
        }));
    }
    db.add_samples(&samples, GROUPED_BY)?;
    Ok(())
}

fn report(path: &Path, db: &MotionDb, args: &Args, grouped: &Groups) -> Result<()> {
    /// A page people look through: of a large group the first members tell what it is.
    const SHOWN: usize = 24;
    let mut page = Page::default();
    for (number, group) in grouped.groups.iter().enumerate() {
        page.heading(&format!("Group {}: {} members", number + 1, group.len()));
        for item in group.iter().take(SHOWN) {
            let class = item
                .class
                .as_ref()
                .map_or_else(String::new, |class| format!(", {class}"));
            let caption = format!(
                "{} {:.2}–{:.2} s{class}",
                item.clip, item.start_secs, item.stop_secs
            );
            page.figure(db, item.id, item.start_secs, item.stop_secs, &caption)?;
        }
        if group.len() > SHOWN {
            page.paragraph(&format!("and {} more", group.len() - SHOWN));
        }
    }
    let members: usize = grouped.groups.iter().map(Vec::len).sum();
    page.write(
        path,
        &format!("Groups of {}", args.db.display()),
        &format!("{members} in {} groups", grouped.groups.len()),
    )
}

fn print(grouped: &Groups) -> Result<()> {
    const SHOWN: usize = 6;
    let mut table = Table::new(["group", "members", "what"]);
    for (number, group) in grouped.groups.iter().enumerate() {
        let mut classes: BTreeMap<&str, usize> = BTreeMap::new();
        let mut what = Vec::new();
        for item in group {
            match &item.class {
                Some(class) => *classes.entry(class).or_default() += 1,
                None if what.len() < SHOWN => {
                    what.push(format!("{} {:.1}", item.clip, item.start_secs))
                }
                None => {}
            }
        }
        what.extend(
            classes
                .iter()
                .map(|(class, count)| format!("{class} {count}")),
        );
        table.row([
            (number + 1).to_string(),
            group.len().to_string(),
            what.join(", "),
        ]);
    }
    let members: usize = grouped.groups.iter().map(Vec::len).sum();
    let mut last = format!("{members} in {} groups\n", grouped.groups.len());
    if let (Some(rand), Some(adjusted)) = (grouped.rand_index, grouped.adjusted_rand_index) {
        last.push_str(&format!(
            "against the classes: Rand index {rand:.3}, adjusted {adjusted:.3}\n"
        ));
    }
    super::print_table(&table, &last)
}
