//! Groups of samples or cuts that are alike, as a hierarchy whose depth a slider sets.

use std::collections::BTreeMap;
use std::path::Path;

use morec::cluster::{Hierarchy, resampled, squared_distance};
use morec::features::{BoneSet, FeatureParams, RowLayout, Rows};
use morec_db::labels::{SampleFilter, SampleId, SampleState};
use morec_db::{ClipId, MotionDb, SegmentKind};

use super::progress::{JobError, JobProgress};
use crate::stretch::Stretch;

/// Rows that a sample of any length becomes.
const POINTS: usize = 16;
/// The hierarchy takes the square of this in memory; what is beyond is left out, and said.
pub const MOST: usize = 3000;

/// A stretch that is grouped.
#[derive(Debug, Clone, PartialEq)]
pub struct GroupItem {
    pub of: Stretch,
    /// Its number, if it is a sample.
    pub sample: Option<SampleId>,
    pub class: Option<String>,
}

/// The stretches that were grouped, and their hierarchy.
#[derive(Debug, Clone)]
pub struct ClusteredItems {
    pub items: Vec<GroupItem>,
    pub hierarchy: Hierarchy,
    /// The poses of each item, brought to one length: outliers are far from the mean of their group.
    shapes: Vec<Vec<f32>>,
    pub left_out: usize,
}

/// A group at some depth: its items, those least like the others first.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    pub members: Vec<usize>,
}

impl ClusteredItems {
    pub fn of(items: Vec<GroupItem>, shapes: Vec<Vec<f32>>, left_out: usize) -> Self {
        let distance = |a: usize, b: usize| squared_distance(&shapes[a], &shapes[b], POINTS);
        Self {
            hierarchy: Hierarchy::average(items.len(), distance),
            items,
            shapes,
            left_out,
        }
    }

    /// Cuts the hierarchy into `count` groups, the largest first; outliers first within each.
    pub fn at(&self, count: usize) -> Vec<Group> {
        let clusters = self.hierarchy.into_clusters(count);
        let mut groups: Vec<Group> = clusters
            .members()
            .into_iter()
            .map(|members| self.outliers_first(members))
            .collect();
        groups.sort_by_key(|g| std::cmp::Reverse(g.members.len()));
        groups
    }

    fn outliers_first(&self, mut members: Vec<usize>) -> Group {
        let mut mean = vec![0f32; self.shapes.first().map_or(0, Vec::len)];
        for &m in &members {
            let share = 1.0 / members.len() as f32;
            mean.iter_mut()
                .zip(&self.shapes[m])
                .for_each(|(a, b)| *a += share * b);
        }
        let off = |m: &usize| squared_distance(&self.shapes[*m], &mean, POINTS);
        members.sort_by(|a, b| off(b).total_cmp(&off(a)));
        Group { members }
    }
}

/// Groups the accepted samples, or the cuts if `cuts`, of the database at `path`.
pub fn group(path: &Path, cuts: bool, progress: &JobProgress) -> Result<ClusteredItems, JobError> {
    match grouped(path, cuts, progress) {
        Ok(groups) if groups.items.is_empty() => Err(JobError::Failed(
            match cuts {
                true => "Nothing to group: cut the clips first",
                false => "Nothing to group: label a few motions first",
            }
            .to_owned(),
        )),
        Ok(groups) => Ok(groups),
        Err(error) => Err(JobError::of("Grouping stopped", error)),
    }
}

fn grouped(
    path: &Path,
    cuts: bool,
    progress: &JobProgress,
) -> Result<ClusteredItems, morec_db::DbError> {
    let params = FeatureParams::default();
    let mut db = MotionDb::open(path)?;
    let clip_rows = db.rows(&params, progress)?;
    let rows: BTreeMap<ClipId, (&Rows, BoneSet)> = clip_rows
        .iter()
        .map(|r| (r.clip, (&r.rows, r.bones)))
        .collect();
    let mut items = items(&db, cuts)?;
    items.retain(|item| rows.contains_key(&item.of.clip));
    let left_out = items.len().saturating_sub(MOST);
    items.truncate(MOST);
    let of_item = |item: &GroupItem| rows.get(&item.of.clip);
    let common = items
        .iter()
        .filter_map(of_item)
        .map(|(_, bones)| *bones)
        .fold(BoneSet::BODY, BoneSet::and);
    let mut shapes = Vec::new();
    for item in &items {
        let Some((rows, bones)) = of_item(item) else {
            continue;
        };
        let rows = rows.slice((item.of.span).frames_among(rows.len(), params.tick_hz()));
        shapes.push(resampled(&only(&rows, *bones, common), POINTS));
    }
    Ok(ClusteredItems::of(items, shapes, left_out))
}

fn items(db: &MotionDb, cuts: bool) -> Result<Vec<GroupItem>, morec_db::DbError> {
    if cuts {
        let segments = db.segments()?.into_iter();
        let moving = segments.filter(|s| s.kind == SegmentKind::Motion);
        return Ok(moving
            .map(|s| GroupItem {
                of: Stretch::new(s.clip, s.span),
                sample: None,
                class: None,
            })
            .collect());
    }
    let filter = SampleFilter {
        state: Some(SampleState::Accepted),
        ..SampleFilter::default()
    };
    let samples = db.samples(&filter)?.into_iter();
    Ok(samples
        .map(|s| GroupItem {
            of: Stretch::from(&s),
            sample: Some(s.id),
            class: Some(s.class),
        })
        .collect())
}

/// Rows over `bones` as rows over those that all items have.
pub(super) fn only(rows: &Rows, bones: BoneSet, common: BoneSet) -> Rows {
    if bones == common {
        return rows.clone();
    }
    rows.columns(&RowLayout::kept_columns(bones, common))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Items whose shapes differ from one another by these numbers.
    fn grouped(places: &[f32]) -> ClusteredItems {
        let item = |at: usize| GroupItem {
            of: Stretch::new(ClipId(1), at as f64..at as f64 + 1.0),
            sample: None,
            class: None,
        };
        let shapes = places.iter().map(|&place| vec![place; POINTS]).collect();
        ClusteredItems::of((0..places.len()).map(item).collect(), shapes, 0)
    }

    fn members(groups: &[Group]) -> Vec<Vec<usize>> {
        groups.iter().map(|g| g.members.clone()).collect()
    }

    #[test]
    fn each_group_begins_with_what_is_farthest_from_its_own_mean() {
        let all = grouped(&[0.0, 0.1, 9.0, -0.8, 9.5, 0.4]);
        // The means are -0.075 and 9.25: within a group, distance from everything else does not count.
        let two = members(&all.at(2));
        assert_eq!(two[0], [3, 5, 1, 0]);
        assert_eq!(two[1].len(), 2);
        // As one group the mean is 3.03.
        assert_eq!(members(&all.at(1)), [[4, 2, 3, 0, 1, 5]]);
    }
}
