//! `morec discover`: sets of the same motion in clips without labels.

mod args;
mod page;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Result, bail};
use morec::features::{FeatureParams, rows_of_clip};
use morec_db::labels::GROUPED_BY;
use morec_db::{ClipFilter, MotionDb, StoredClip};
use morec_ops::{DiscoverClip, DiscoveredSet, DiscoveredSets};

pub use args::Args;

use crate::commands::db::page as pages;
use crate::database;
use crate::print::{print_json, print_table};
use crate::progress::StageBar;
use crate::table::TextTable;
use page::ShownMotions;

/// Finds sets in clips or in a database, prints them, and proposes them if asked to.
pub fn run(args: &Args) -> Result<ExitCode> {
    if let Some(path) = &args.report {
        pages::check(path)?;
    }
    match database::only(&args.inputs)? {
        Some(path) => of_database(path, args)?,
        None => of_files(&args.inputs, args)?,
    }
    Ok(ExitCode::SUCCESS)
}

fn of_database(path: &Path, args: &Args) -> Result<()> {
    let mut db = match args.name_as {
        Some(_) => database::open(path)?,
        None => database::open_read_only(path)?,
    };
    let filter = ClipFilter {
        name: args.clip.clone(),
        ..ClipFilter::default()
    };
    let found = args
        .settings
        .of_database(&db, &filter, &StageBar::stoppable()?)?;
    if let Some(page) = &args.report {
        page::write(page, &found, ShownMotions::Stored(&db))?;
    }
    if let Some(name) = &args.name_as {
        propose(&mut db, &found, name)?;
    }
    print(&found, args)
}

fn propose(db: &mut MotionDb, found: &DiscoveredSets, name: &str) -> Result<()> {
    db.add_samples(&found.proposals(name), GROUPED_BY)?;
    Ok(())
}

fn of_files(paths: &[PathBuf], args: &Args) -> Result<()> {
    if args.name_as.is_some() || args.clip.is_some() {
        bail!("--name-as and --clip need a database (create one with morec db import)");
    }
    let params = FeatureParams::default();
    let (mut clips, mut motions) = (Vec::new(), Vec::new());
    args.poses.reader()?.each_take(paths, |take| {
        let bones = take.bones();
        clips.push(DiscoverClip {
            name: take.clip.name.clone(),
            id: None,
            person: None,
            bones,
            rows: rows_of_clip(&take.clip, &take.roles, take.rest(), bones, &params),
        });
        if args.report.is_some() {
            let rest = take.rest().clone();
            motions.push(StoredClip {
                rest,
                roles: take.roles,
                clip: take.clip,
            });
        }
        Ok(())
    })?;
    if let Some(twice) = page::name_of_two(&clips) {
        bail!("two clips are called {twice}, so sets cannot distinguish them: rename one");
    }
    let found = args.settings.of_clips(&clips, &StageBar::stoppable()?)?;
    if let Some(page) = &args.report {
        let names = clips.iter().map(|clip| clip.name.as_str());
        page::write(
            page,
            &found,
            ShownMotions::Read(&names.zip(&motions).collect()),
        )?;
    }
    print(&found, args)
}

fn print(found: &DiscoveredSets, args: &Args) -> Result<()> {
    if args.json {
        return print_json(found);
    }
    let mut table = TextTable::new(["set", "repetitions", "secs", "clips", "people", "first"]);
    for set in &found.sets {
        table.row([
            set.set.to_string(),
            set.instances.len().to_string(),
            format!("{:.1}", set.length_secs),
            set.clips.to_string(),
            match set.people {
                0 => String::new(),
                people => people.to_string(),
            },
            first(set),
        ]);
    }
    print_table(&table, &format!("{}\n", found.summary()))
}

fn first(set: &DiscoveredSet) -> String {
    const SHOWN: usize = 3;
    let shown = set.instances.iter().take(SHOWN);
    let shown = shown.map(|of| format!("{} {:.1}", of.clip, of.span.start_secs));
    shown.collect::<Vec<_>>().join(", ")
}
