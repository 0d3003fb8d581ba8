//! Groups of samples or cuts that are alike, at the depth that the window says.

use std::path::Path;

use morec::cluster::{
    Dendrogram, GroupNodes, KwasParams, PairCounts, Spectrum, adjusted_rand_index, kwas_clusters,
};
use morec_db::MotionDb;
use morec_db::labels::SampleId;
use morec_ops::{
    GroupMethod, GroupSettings, GroupedStretch, Grouping, MOST_IN_TREE, OperationError, Shapes,
    largest_first,
};

use super::progress::{JobError, JobProgress};
use crate::stretch::Stretch;

/// Stretches that are grouped at most, of which time or memory take the square; what is beyond is left out, and said.
fn most(method: GroupMethod) -> usize {
    match method {
        GroupMethod::Tree => MOST_IN_TREE,
        GroupMethod::Kwas => 1000,
        GroupMethod::Affinity | GroupMethod::Hierarchy => 3000,
    }
}

/// A stretch that is grouped.
#[derive(Debug, Clone, PartialEq)]
pub struct GroupItem {
    pub of: Stretch,
    /// Its number, if it is a sample.
    pub sample: Option<SampleId>,
    pub class: Option<String>,
}

/// The stretches that were grouped, and how they hang together.
#[derive(Debug, Clone)]
pub struct ClusteredItems {
    pub items: Vec<GroupItem>,
    /// Labels or cuts, and the method.
    pub settings: GroupSettings,
    links: Links,
    /// Of the items: outliers are far from the mean of their group.
    shapes: Shapes,
    pub left_out: usize,
}

#[derive(Debug, Clone)]
enum Links {
    Tree(Dendrogram),
    Spectra(Vec<Spectrum>),
}

/// Where groups end.
#[derive(Debug, Clone, PartialEq)]
pub struct GroupDepth {
    /// Into how many groups a hierarchy is cut, where branches are not cut one by one.
    pub groups: usize,
    /// Its groups, once a branch was divided or joined.
    pub branches: Option<GroupNodes>,
    pub kwas: KwasParams,
}

impl Default for GroupDepth {
    fn default() -> Self {
        Self {
            groups: 1,
            branches: None,
            kwas: KwasParams::default(),
        }
    }
}

/// A group at some depth: its items, those least like the others first.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    /// Its node in the hierarchy.
    pub node: Option<usize>,
    pub members: Vec<usize>,
}

impl ClusteredItems {
    /// Groups items of these shapes by their hierarchy.
    #[cfg(test)]
    pub fn of(items: Vec<GroupItem>, shapes: Shapes, left_out: usize) -> Self {
        Self {
            links: Links::Tree(Dendrogram::of(&shapes.hierarchy())),
            settings: settings(false, GroupMethod::Hierarchy),
            items,
            shapes,
            left_out,
        }
    }

    /// The nodes of the hierarchy, if there is one.
    pub fn nodes(&self) -> Option<&Dendrogram> {
        match &self.links {
            Links::Tree(nodes) => Some(nodes),
            Links::Spectra(_) => None,
        }
    }

    /// The groups of a hierarchy at `depth`.
    pub fn cut(&self, depth: &GroupDepth) -> GroupNodes {
        let usual = || self.nodes().map(|nodes| nodes.cut(depth.groups));
        depth.branches.clone().or_else(usual).unwrap_or_default()
    }

    /// The groups, the largest first; outliers first within each.
    pub fn at(&self, depth: &GroupDepth) -> Vec<Group> {
        let groups: Vec<(Option<usize>, Vec<usize>)> = match &self.links {
            Links::Tree(nodes) => {
                let groups = nodes.largest_first(&self.cut(depth)).into_iter();
                groups
                    .map(|(node, members)| (Some(node), members))
                    .collect()
            }
            Links::Spectra(spectra) => {
                let clusters = kwas_clusters(spectra, &depth.kwas);
                let groups = largest_first(&clusters).into_iter();
                groups.map(|members| (None, members)).collect()
            }
        };
        let ordered = |(node, members)| Group {
            node,
            members: self.shapes.outliers_first(members),
        };
        groups.into_iter().map(ordered).collect()
    }

    /// How far groups agree with the classes that items had: the Rand index, and that adjusted for chance. `None` without classes.
    pub fn agreement(&self, groups: &[Group]) -> Option<(f64, f64)> {
        let names: Vec<&str> = (self.items.iter())
            .map_while(|i| i.class.as_deref())
            .collect();
        if names.len() < self.items.len() || names.is_empty() {
            return None;
        }
        let first = |name: &&str| names.iter().position(|other| other == name).unwrap_or(0);
        let classes: Vec<usize> = names.iter().map(first).collect();
        let mut of = vec![0; self.items.len()];
        for (number, group) in groups.iter().enumerate() {
            group.members.iter().for_each(|member| of[*member] = number);
        }
        let rand = PairCounts::count(&classes, &of).rand_index();
        Some((rand, adjusted_rand_index(&classes, &of)))
    }
}

/// What the accepted samples, or the cuts if `cuts`, are grouped by.
pub fn settings(cuts: bool, method: GroupMethod) -> GroupSettings {
    GroupSettings {
        of: Some(if cuts {
            Grouping::Cuts
        } else {
            Grouping::Labels
        }),
        method,
        ..GroupSettings::default()
    }
}

/// Groups the accepted samples, or the cuts, of the database at `path`.
pub fn group(
    path: &Path,
    settings: &GroupSettings,
    progress: &JobProgress,
) -> Result<ClusteredItems, JobError> {
    match grouped(path, settings, progress) {
        Ok(groups) if groups.items.is_empty() => Err(JobError::Failed(
            match settings.of {
                Some(Grouping::Cuts) => {
                    "Nothing to group: cut the clips first (Cut all clips, in Label)"
                }
                _ => "Nothing to group: label a few motions first",
            }
            .to_owned(),
        )),
        Ok(groups) => Ok(groups),
        Err(error) => Err(JobError::of("Grouping stopped", error)),
    }
}

fn grouped(
    path: &Path,
    settings: &GroupSettings,
    progress: &JobProgress,
) -> Result<ClusteredItems, OperationError> {
    let db = MotionDb::open(path)?;
    let mut stretches = settings.stretches(&db, progress)?;
    let most = most(settings.method);
    let left_out = stretches.len().saturating_sub(most);
    stretches.truncate(most);
    let rows: Vec<_> = stretches.iter().map(|of| &of.rows).collect();
    let shapes = Shapes::of(rows.iter().copied());
    let links = match settings.method {
        GroupMethod::Kwas => {
            Links::Spectra(rows.iter().map(|rows| Spectrum::of_rows(rows)).collect())
        }
        GroupMethod::Tree => Links::Tree(Dendrogram::of(&settings.tree(&rows)?)),
        _ => Links::Tree(Dendrogram::of(&shapes.hierarchy())),
    };
    let item = |of: GroupedStretch| {
        let (sample, class) = of.sample.unzip();
        GroupItem {
            of: Stretch::new(of.clip, of.span),
            sample,
            class,
        }
    };
    Ok(ClusteredItems {
        items: stretches.into_iter().map(item).collect(),
        settings: settings.clone(),
        links,
        shapes,
        left_out,
    })
}
