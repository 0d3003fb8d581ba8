//! Samples or segments of a database that are alike.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::ExitCode;

use anyhow::{Result, bail};
use morec::TimeSpan;
use morec::features::{BoneSet, FeatureParams};
use morec_db::labels::{GROUPED_BY, NewSample, SampleFilter, SampleState};
use morec_db::{ClipFilter, ClipId, MotionDb, SegmentKind};

use super::args::{Args, Grouping};
use super::members::GroupedSample;
use super::members::{GroupList, GroupMember, only};
use crate::commands::db::page::{self, Page};
use crate::database;
use crate::progress::StageBar;

/// Clusters, prints, and proposes if asked to.
pub fn run(path: &Path, args: &Args) -> Result<ExitCode> {
    if args.labels.is_some() {
        bail!("--labels: a database has its own; --of labels groups them");
    }
    let mut db = if args.name_as.is_some() {
        database::open(path)?
    } else {
        database::open_read_only(path)?
    };
    if let Some(path) = &args.report {
        page::check(path)?;
    }
    args.classes
        .iter()
        .try_for_each(|class| db.need_class(class))?;
    let of = args.of.unwrap_or(Grouping::Cuts);
    let items = items(&db, of, args)?;
    if items.is_empty() {
        bail!("nothing to group (morec cut finds segments, morec db label sets samples)");
    }
    let grouped = GroupList::of(&items, args, of == Grouping::Labels);
    if let Some(name) = &args.name_as {
        propose(&mut db, &grouped.groups, name)?;
    }
    if let Some(page) = &args.report {
        report(page, &db, path, &grouped)?;
    }
    grouped.print(args)?;
    Ok(ExitCode::SUCCESS)
}

fn items(db: &MotionDb, of: Grouping, args: &Args) -> Result<Vec<GroupMember>> {
    let params = FeatureParams::default();
    let rows = db.rows_kept_if_writable(&params, &StageBar::stoppable()?)?;
    let clips = db.clips(&ClipFilter::default())?;
    let names: BTreeMap<ClipId, &str> = clips.iter().map(|c| (c.id, c.name.as_str())).collect();
    let spans: Vec<(ClipId, TimeSpan, Option<String>)> = match of {
        Grouping::Clips => clips
            .iter()
            .map(|c| (c.id, TimeSpan::new(0.0, c.duration_secs()), None))
            .collect(),
        Grouping::Cuts => {
            let moving = db
                .segments()?
                .into_iter()
                .filter(|s| s.kind == SegmentKind::Motion);
            moving.map(|s| (s.clip, s.span, None)).collect()
        }
        Grouping::Labels => {
            let samples = db.samples(&SampleFilter {
                state: Some(SampleState::Accepted),
                ..Default::default()
            })?;
            let wanted = samples
                .into_iter()
                .filter(|s| args.classes.is_empty() || args.classes.contains(&s.class));
            wanted.map(|s| (s.clip, s.span(), Some(s.class))).collect()
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
    let item = |(id, span, class): (ClipId, TimeSpan, Option<String>)| {
        let of = rows.get(&id)?;
        let ticks = span.frames_among(of.rows.len(), params.tick_hz());
        let rows = (!ticks.is_empty()).then(|| only(&of.rows.slice(ticks), of.bones, bones))?;
        let clip = (*names.get(&id)?).to_owned();
        Some(GroupMember {
            sample: GroupedSample { clip, span, class },
            id: Some(id),
            rows,
        })
    };
    Ok(spans.into_iter().filter_map(item).collect())
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
