//! Near copies among clips, by name.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use anyhow::Result;
use morec::TimeSpan;
use morec_db::search::{NearCopy, SearchIndex, near_duplicates, near_duplicates_of};
use morec_db::{ClipFilter, ClipId, MotionDb};
use serde::Serialize;

use crate::progress::StageBar;

/// A clip that is nearly another.
#[derive(Serialize)]
pub struct Copy {
    of: String,
    copy: String,
    #[serde(flatten)]
    span: TimeSpan,
    mirrored: bool,
    distance: f32,
}

impl fmt::Display for Copy {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kind = if self.mirrored {
            "the mirror image of"
        } else {
            "a near copy of"
        };
        let (start, stop) = (self.span.start_secs, self.span.stop_secs);
        let (copy, of, distance) = (&self.copy, &self.of, self.distance);
        write!(
            out,
            "{copy} is {kind} {of}, {start:.2} to {stop:.2} s (distance {distance:.4})"
        )
    }
}

/// Every pair of near copies, or those with at least one of the clips `among` these names.
pub fn find(
    db: &mut MotionDb,
    among: Option<&BTreeSet<&str>>,
    bar: &StageBar,
) -> Result<Vec<Copy>> {
    let index = SearchIndex::of_db(db, bar)?;
    let names: BTreeMap<ClipId, String> = db
        .clips(&ClipFilter::default())?
        .into_iter()
        .map(|c| (c.id, c.name))
        .collect();
    let found = match among {
        None => near_duplicates(&index),
        Some(wanted) => {
            let of_names = names
                .iter()
                .filter(|(_, name)| wanted.contains(name.as_str()));
            near_duplicates_of(&index, &of_names.map(|(id, _)| *id).collect())
        }
    };
    let name = |id: ClipId| names.get(&id).cloned().unwrap_or_default();
    let copy = |c: NearCopy| Copy {
        of: name(c.of),
        copy: name(c.copy),
        span: c.span,
        mirrored: c.mirrored,
        distance: c.distance,
    };
    Ok(found.into_iter().map(copy).collect())
}
