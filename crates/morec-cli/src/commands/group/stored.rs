//! Groups samples or segments of a database.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::ExitCode;

use anyhow::{Result, bail};
use morec_db::labels::{GROUPED_BY, NewSample, SampleState};
use morec_db::{ClipFilter, ClipId, MotionDb};
use morec_ops::{GroupSettings, GroupedStretch, Grouping};

use super::args::Args;
use super::members::{GroupList, GroupMember, GroupedSample};
use crate::commands::db::page::{self, Page};
use crate::database;
use crate::progress::StageBar;

/// Clusters, prints, and proposes if asked to.
pub fn run(path: &Path, args: &Args) -> Result<ExitCode> {
    if args.labels.is_some() {
        bail!("--labels: a database contains its labels; group them with --of labels");
    }
    let mut db = if args.name_as.is_some() {
        database::open(path)?
    } else {
        database::open_read_only(path)?
    };
    if let Some(path) = &args.report {
        page::check(path)?;
    }
    let items = items(&db, &args.settings)?;
    if items.is_empty() {
        bail!("nothing to group: find segments with morec cut, or set samples with morec db label");
    }
    let has_classes = args.settings.of == Some(Grouping::Labels);
    let grouped = GroupList::of(&items, &args.settings, has_classes)?;
    if let Some(name) = &args.name_as {
        propose(&mut db, &grouped.groups, name)?;
    }
    if let Some(page) = &args.report {
        report(page, &db, path, &grouped)?;
    }
    grouped.print(args)?;
    Ok(ExitCode::SUCCESS)
}

fn items(db: &MotionDb, settings: &GroupSettings) -> Result<Vec<GroupMember>> {
    let stretches = settings.stretches(db, &StageBar::stoppable()?)?;
    let clips = db.clips(&ClipFilter::default())?;
    let names: BTreeMap<ClipId, String> = clips.into_iter().map(|c| (c.id, c.name)).collect();
    let member = |of: GroupedStretch| {
        let sample = GroupedSample {
            clip: names.get(&of.clip)?.clone(),
            span: of.span,
            class: of.sample.map(|(_, class)| class),
        };
        Some(GroupMember {
            sample,
            id: Some(of.clip),
            rows: of.rows,
        })
    };
    Ok(stretches.into_iter().filter_map(member).collect())
}

fn propose(db: &mut MotionDb, groups: &[Vec<GroupMember>], name: &str) -> Result<()> {
    let mut samples = Vec::new();
    for (number, group) in groups.iter().enumerate() {
        let kept = group.iter().filter_map(|item| Some((item.id?, item)));
        samples.extend(kept.map(|(clip, item)| NewSample {
            clip,
            class: format!("{name}_{}", number + 1),
            start_secs: item.sample.span.start_secs,
            stop_secs: item.sample.span.stop_secs,
            whole_clip: false,
            state: SampleState::Proposed,
            score: None,
        }));
    }
    db.add_samples(&samples, GROUPED_BY)?;
    Ok(())
}

fn report(path: &Path, db: &MotionDb, of: &Path, grouped: &GroupList) -> Result<()> {
    /// A page people look through: of a large group the first members tell what it is.
    const SHOWN: usize = 24;
    let mut page = Page::default();
    for (number, group) in grouped.groups.iter().enumerate() {
        page.heading(&format!("Group {}: {} members", number + 1, group.len()));
        for member in group.iter().take(SHOWN) {
            let item = &member.sample;
            let class = item
                .class
                .as_ref()
                .map_or_else(String::new, |class| format!(", {class}"));
            let caption = format!("{} {:.2}{class}", item.clip, item.span);
            let Some(id) = member.id else { continue };
            page.figure(db, id, item.span, &caption)?;
        }
        if group.len() > SHOWN {
            let rest = (group[SHOWN..].iter())
                .map(|GroupMember { sample, .. }| format!("{} {:.2}", sample.clip, sample.span));
            let rest: Vec<String> = rest.collect();
            page.folded(&format!("{} more", rest.len()), &rest);
        }
    }
    let members: usize = grouped.groups.iter().map(Vec::len).sum();
    page.write(
        path,
        &format!("Groups of {}", of.display()),
        &format!("{members} in {} groups", grouped.groups.len()),
    )
}
