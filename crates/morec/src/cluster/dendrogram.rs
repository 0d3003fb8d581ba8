//! A hierarchy as a tree of groups, which is cut at another depth in each branch.

use std::collections::BTreeSet;

use super::{Clusters, Hierarchy, clusters::numbered};

/// Nodes of a hierarchy: items first, then merges from the nearest on.
#[derive(Debug, Clone, PartialEq)]
pub struct Dendrogram {
    items: usize,
    /// Of each merge.
    children: Vec<[usize; 2]>,
    /// Of each node but those at the top.
    parents: Vec<Option<usize>>,
}

/// Nodes that hold each item once: groups.
pub type GroupNodes = BTreeSet<usize>;

impl Dendrogram {
    /// The nodes of `hierarchy`.
    pub fn of(hierarchy: &Hierarchy) -> Self {
        let (items, merges) = (hierarchy.items(), hierarchy.merges());
        let mut parents = vec![None; items + merges.len()];
        let top = |parents: &[Option<usize>], mut node: usize| {
            while let Some(parent) = parents[node] {
                node = parent;
            }
            node
        };
        let mut children = Vec::with_capacity(merges.len());
        for (merge, node) in merges.iter().zip(items..) {
            let pair = [merge.a, merge.b].map(|item| top(&parents, item));
            pair.iter().for_each(|child| parents[*child] = Some(node));
            children.push(pair);
        }
        Self {
            items,
            children,
            parents,
        }
    }

    /// This many groups, or as many as there are items.
    pub fn cut(&self, groups: usize) -> GroupNodes {
        let merges = self.items.saturating_sub(groups.max(1));
        let first_open = self.items + merges.min(self.children.len());
        let is_open = |node: usize| node >= first_open;
        (0..first_open)
            .filter(|node| self.parents[*node].is_none_or(is_open))
            .collect()
    }

    /// Divides a group of `cut` in its two parts; an item stays.
    pub fn divide(&self, cut: &mut GroupNodes, group: usize) {
        let parts = group
            .checked_sub(self.items)
            .and_then(|at| self.children.get(at));
        if let Some(parts) = parts.filter(|_| cut.remove(&group)) {
            cut.extend(parts);
        }
    }

    /// Joins a group of `cut` with all of what it was parted from last.
    pub fn join(&self, cut: &mut GroupNodes, group: usize) {
        let Some(parent) = self.parents.get(group).copied().flatten() else {
            return;
        };
        cut.retain(|node| !self.lies_in(*node, parent));
        cut.insert(parent);
    }

    fn lies_in(&self, mut node: usize, group: usize) -> bool {
        while node != group {
            match self.parents[node] {
                Some(parent) => node = parent,
                None => return false,
            }
        }
        true
    }

    /// True if a group can be divided, and if it can be joined.
    pub fn goes_on(&self, group: usize) -> (bool, bool) {
        (group >= self.items, self.parents[group].is_some())
    }

    /// The items of a group, ascending.
    pub fn members(&self, group: usize) -> Vec<usize> {
        let (mut items, mut open) = (Vec::new(), vec![group]);
        while let Some(node) = open.pop() {
            match node.checked_sub(self.items) {
                None => items.push(node),
                Some(merge) => open.extend(self.children[merge]),
            }
        }
        items.sort_unstable();
        items
    }

    /// The groups of a cut and their items, the largest first, of equals the one with the first item.
    pub fn largest_first(&self, cut: &GroupNodes) -> Vec<(usize, Vec<usize>)> {
        let mut groups: Vec<_> = cut
            .iter()
            .map(|group| (*group, self.members(*group)))
            .collect();
        groups.sort_by_key(|(_, items)| (std::cmp::Reverse(items.len()), items.first().copied()));
        groups
    }

    /// The group of each item.
    pub fn clusters(&self, cut: &GroupNodes) -> Clusters {
        let mut of = vec![0; self.items];
        for group in cut {
            self.members(*group)
                .into_iter()
                .for_each(|item| of[item] = *group);
        }
        numbered(of.into_iter())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn tree(points: &[f64]) -> Hierarchy {
        Hierarchy::average(points.len(), |a, b| (points[a] - points[b]).abs())
    }

    proptest! {
        #[test]
        fn a_cut_is_that_of_the_hierarchy(points in prop::collection::vec(0f64..100.0, 1..24), count in 1usize..9) {
            let tree = tree(&points);
            let nodes = Dendrogram::of(&tree);
            prop_assert_eq!(nodes.clusters(&nodes.cut(count)), tree.into_clusters(count));
        }

        #[test]
        fn groups_hold_each_item_once_whatever_is_divided_and_joined(
            points in prop::collection::vec(0f64..100.0, 2..24),
            steps in prop::collection::vec((0usize..30, any::<bool>()), 0..12),
        ) {
            let nodes = Dendrogram::of(&tree(&points));
            let mut cut = nodes.cut(3);
            for (at, divides) in steps {
                let groups = nodes.largest_first(&cut);
                let (group, _) = groups[at % groups.len()];
                match divides {
                    true => nodes.divide(&mut cut, group),
                    false => nodes.join(&mut cut, group),
                }
            }
            let mut items: Vec<usize> = cut.iter().flat_map(|g| nodes.members(*g)).collect();
            items.sort_unstable();
            prop_assert_eq!(items, Vec::from_iter(0..points.len()));
        }
    }

    #[test]
    fn one_branch_is_divided_and_the_others_stay() {
        let nodes = Dendrogram::of(&tree(&[0.0, 1.0, 10.0, 11.5, 40.0]));
        let groups = |cut: &GroupNodes| -> Vec<Vec<usize>> {
            let groups = nodes.largest_first(cut).into_iter();
            groups.map(|(_, items)| items).collect()
        };
        let mut cut = nodes.cut(2);
        assert_eq!(groups(&cut), [vec![0, 1, 2, 3], vec![4]]);
        let (all, _) = nodes.largest_first(&cut)[0];
        nodes.divide(&mut cut, all);
        let (near, _) = nodes.largest_first(&cut)[0];
        nodes.divide(&mut cut, near);
        assert_eq!(groups(&cut), [vec![2, 3], vec![0], vec![1], vec![4]]);
        let (one, _) = nodes.largest_first(&cut)[1];
        assert_eq!(nodes.goes_on(one), (false, true));
        nodes.join(&mut cut, one);
        assert_eq!(groups(&cut), [vec![0, 1], vec![2, 3], vec![4]]);
        let (pair, _) = nodes.largest_first(&cut)[0];
        nodes.join(&mut cut, pair);
        assert_eq!(groups(&cut), [vec![0, 1, 2, 3], vec![4]]);
    }
}
