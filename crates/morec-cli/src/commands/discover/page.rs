//! A page with a strip of poses for repetitions of each set.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use anyhow::Result;
use morec::TimeSpan;
use morec_db::{ClipId, MotionDb, StoredClip};
use morec_ops::{DiscoverClip, DiscoveredSets};

use crate::commands::db::page::Page;

/// Strips of a set: the outermost members first, then the most central, tell what it is.
const SHOWN: usize = 12;

/// Where the motion of clips is.
pub enum ShownMotions<'a> {
    /// In a database.
    Stored(&'a MotionDb),
    /// In memory, by name.
    Read(&'a BTreeMap<&'a str, &'a StoredClip>),
}

/// The name of two clips or more, if there is one.
pub fn name_of_two(clips: &[DiscoverClip]) -> Option<&str> {
    let mut names = BTreeSet::new();
    let mut all = clips.iter().map(|clip| clip.name.as_str());
    all.find(|name| !names.insert(*name))
}

/// Writes the page.
pub fn write(path: &Path, found: &DiscoveredSets, motions: ShownMotions<'_>) -> Result<()> {
    let mut page = Page::default();
    for set in &found.sets {
        let (count, secs) = (set.instances.len(), set.length_secs);
        page.heading(&format!(
            "Set {}: {count} × {secs:.1} s in {} clips",
            set.set, set.clips
        ));
        let mut order: Vec<_> = set.instances.iter().collect();
        order.sort_by(|a, b| b.distance.total_cmp(&a.distance));
        for of in order.iter().take(SHOWN) {
            let caption = format!("{} {:.2}", of.clip, of.span);
            strip(&mut page, &motions, &of.clip, of.id, of.span, &caption)?;
        }
        if order.len() > SHOWN {
            let rest = order[SHOWN..]
                .iter()
                .map(|of| format!("{} {:.2}", of.clip, of.span));
            let rest: Vec<String> = rest.collect();
            page.folded(&format!("{} more", rest.len()), &rest);
        }
    }
    let near = |set: Option<usize>| set.map_or_else(String::new, |set| format!(", near set {set}"));
    let alone = found.alone.iter();
    let alone: Vec<String> = alone
        .map(|of| format!("{} {:.2}{}", of.clip, of.span, near(of.nearest_set)))
        .collect();
    if !alone.is_empty() {
        page.heading("Seen once");
        page.folded(&format!("{} stretches", alone.len()), &alone);
    }
    page.write(path, "Sets of the same motion", &found.summary())
}

fn strip(
    page: &mut Page,
    motions: &ShownMotions<'_>,
    clip: &str,
    id: Option<ClipId>,
    span: TimeSpan,
    caption: &str,
) -> Result<()> {
    match (motions, id) {
        (ShownMotions::Stored(db), Some(id)) => page.figure(db, id, span, caption)?,
        (ShownMotions::Read(clips), _) => {
            if let Some(stored) = clips.get(clip) {
                page.figure_of(stored, span, caption);
            }
        }
        _ => {}
    }
    Ok(())
}
