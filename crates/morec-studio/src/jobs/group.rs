//! Groups of samples or cuts that are alike, as a hierarchy whose depth a slider sets.

use std::path::Path;

use morec::cluster::Hierarchy;
use morec_db::MotionDb;
use morec_db::labels::SampleId;
use morec_ops::{GroupMethod, GroupSettings, Grouping, Shapes, largest_first};

use super::progress::{JobError, JobProgress};
use crate::stretch::Stretch;

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
    /// Of the items: outliers are far from the mean of their group.
    shapes: Shapes,
    pub left_out: usize,
}

/// A group at some depth: its items, those least like the others first.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    pub members: Vec<usize>,
}

impl ClusteredItems {
    /// Groups items of these shapes.
    pub fn of(items: Vec<GroupItem>, shapes: Shapes, left_out: usize) -> Self {
        Self {
            hierarchy: shapes.hierarchy(),
            items,
            shapes,
            left_out,
        }
    }

    /// Cuts the hierarchy into `count` groups, the largest first; outliers first within each.
    pub fn at(&self, count: usize) -> Vec<Group> {
        let clusters = self.hierarchy.into_clusters(count);
        let groups = largest_first(&clusters).into_iter();
        let members = groups.map(|members| self.shapes.outliers_first(members));
        members.map(|members| Group { members }).collect()
    }
}

/// What the accepted samples, or the cuts if `cuts`, are grouped by.
pub fn settings(cuts: bool) -> GroupSettings {
    GroupSettings {
        of: Some(if cuts {
            Grouping::Cuts
        } else {
            Grouping::Labels
        }),
        method: GroupMethod::Hierarchy,
        ..GroupSettings::default()
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
    let db = MotionDb::open(path)?;
    let mut stretches = settings(cuts).stretches(&db, progress)?;
    let left_out = stretches.len().saturating_sub(MOST);
    stretches.truncate(MOST);
    let shapes = Shapes::of(stretches.iter().map(|of| &of.rows));
    let item = |of: morec_ops::GroupedStretch| {
        let (sample, class) = of.sample.unzip();
        GroupItem {
            of: Stretch::new(of.clip, of.span),
            sample,
            class,
        }
    };
    let items = stretches.into_iter().map(item).collect();
    Ok(ClusteredItems::of(items, shapes, left_out))
}
