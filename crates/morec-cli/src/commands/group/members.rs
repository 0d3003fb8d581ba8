//! Items to group and their grouping by each method, for clips and databases alike.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use morec::TimeSpan;
use morec::cluster::{PairCounts, adjusted_rand_index};
use morec::features::Rows;
use morec::labels::{ClipLength, said_absent};
use morec_db::ClipId;
use morec_ops::{GroupSettings, largest_first};
use serde::Serialize;

use super::args::Args;
use crate::labels::{self, LabelArgs};
use crate::print::{print_json, print_table};
use crate::table::TextTable;

/// A stretch of a clip to be grouped.
#[derive(Debug, Clone, Serialize)]
pub struct GroupedSample {
    pub clip: String,
    #[serde(flatten)]
    pub span: TimeSpan,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub class: Option<String>,
}

impl GroupedSample {
    /// The stretches of a clip between its beginning, `cuts_secs` and `end_secs`, without classes.
    pub fn between(
        clip: &str,
        cuts_secs: impl IntoIterator<Item = f64>,
        end_secs: f64,
    ) -> impl Iterator<Item = Self> {
        let mut start_secs = 0.0;
        cuts_secs
            .into_iter()
            .chain([end_secs])
            .map(move |stop_secs| Self {
                clip: clip.to_owned(),
                span: TimeSpan::new(std::mem::replace(&mut start_secs, stop_secs), stop_secs),
                class: None,
            })
    }
}

/// A stretch to group, with its rows.
#[derive(Serialize, Clone)]
pub struct GroupMember {
    #[serde(flatten)]
    pub sample: GroupedSample,
    /// Its clip in the database, if it is in one.
    #[serde(skip)]
    pub id: Option<ClipId>,
    #[serde(skip)]
    pub rows: Rows,
}

/// Groups, the largest first.
#[derive(Serialize)]
pub struct GroupList {
    pub groups: Vec<Vec<GroupMember>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    rand_index: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    adjusted_rand_index: Option<f64>,
}

impl GroupList {
    /// Groups `items`, and holds the groups against the classes if there are any.
    pub fn of(items: &[GroupMember], settings: &GroupSettings, has_classes: bool) -> Result<Self> {
        let clusters = settings.clusters(items.iter().map(|item| &item.rows))?;
        let mut groups = Self {
            groups: Vec::new(),
            rand_index: None,
            adjusted_rand_index: None,
        };
        if has_classes {
            let names: BTreeSet<Option<&str>> =
                items.iter().map(|i| i.sample.class.as_deref()).collect();
            let classes: Vec<usize> = items
                .iter()
                .map(|i| names.range(..i.sample.class.as_deref()).count())
                .collect();
            groups.rand_index = Some(PairCounts::count(&classes, &clusters.of).rand_index());
            groups.adjusted_rand_index = Some(adjusted_rand_index(&classes, &clusters.of));
        }
        let members = largest_first(&clusters).into_iter();
        groups.groups = members
            .map(|m| m.into_iter().map(|i| items[i].clone()).collect())
            .collect();
        Ok(groups)
    }

    /// Prints the groups as a table, or as JSON with `--json`.
    pub fn print(&self, args: &Args) -> Result<()> {
        match args.json {
            true => print_json(self),
            false => print(self),
        }
    }
}

/// The samples of the table `path` that lie in clips of these lengths, of `classes` or of all.
pub fn labelled(
    path: &Path,
    (reading, files): (&LabelArgs, &[PathBuf]),
    classes: &[String],
    clips: &BTreeMap<String, ClipLength>,
) -> Result<Vec<GroupedSample>> {
    let labels = labels::read(path, reading, files)?;
    let resolved = labels.resolve(clips);
    for warning in labels.warnings.iter().chain(&resolved.warnings) {
        eprintln!("morec: {}: {warning}", path.display());
    }
    if let Some(why) = resolved.doubtful_unit() {
        bail!("{}: {why}", path.display());
    }
    if !resolved.absent.is_empty() {
        let known: Vec<String> = clips.keys().cloned().collect();
        eprintln!("morec: {}", said_absent(&resolved.absent, &known));
    }
    let wanted = |class: &String| classes.is_empty() || classes.contains(class);
    let samples: Vec<GroupedSample> = resolved
        .samples
        .into_iter()
        .filter(|s| wanted(&s.class))
        .map(|s| GroupedSample {
            clip: s.clip,
            span: s.span,
            class: Some(s.class),
        })
        .collect();
    if samples.is_empty() {
        bail!(
            "no sample to group: no label names any of these clips (labels name clips by their file name without the ending)"
        );
    }
    Ok(samples)
}

fn print(grouped: &GroupList) -> Result<()> {
    const SHOWN: usize = 6;
    let mut table = TextTable::new(["group", "members", "what"]);
    for (number, group) in grouped.groups.iter().enumerate() {
        let mut classes: BTreeMap<&str, usize> = BTreeMap::new();
        let mut what = Vec::new();
        for item in group {
            match &item.sample.class {
                Some(class) => *classes.entry(class).or_default() += 1,
                None if what.len() < SHOWN => what.push(format!(
                    "{} {:.1}",
                    item.sample.clip, item.sample.span.start_secs
                )),
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
    print_table(&table, &last)
}
