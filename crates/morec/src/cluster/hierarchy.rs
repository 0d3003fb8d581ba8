//! A hierarchy of groups that is cut where the user likes: average linkage by chains of nearest neighbours (Murtagh,
//! *A survey of recent advances in hierarchical clustering algorithms*, 1983).

use super::Clusters;

/// Two groups that became one.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Merge {
    /// An item of the one.
    pub a: usize,
    /// An item of the other.
    pub b: usize,
    /// Mean distance between their items.
    pub height: f64,
}

/// All merges of a set of items, nearest first.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Hierarchy {
    items: usize,
    merges: Vec<Merge>,
}

impl Hierarchy {
    /// Of `n` items by the mean of their distances. O(n²) time and memory.
    pub fn average(n: usize, distance: impl Fn(usize, usize) -> f64) -> Self {
        let mut d: Vec<f64> = (0..n * n).map(|at| distance(at / n, at % n)).collect();
        let mut size = vec![1usize; n];
        let mut merges = Vec::new();
        let mut chain: Vec<usize> = Vec::new();
        while merges.len() + 1 < n {
            if chain.is_empty() {
                chain.extend(size.iter().position(|s| *s > 0));
            }
            let Some(&tip) = chain.last() else { break };
            let before = chain.len().checked_sub(2).map(|at| chain[at]);
            let mut nearest = before;
            for k in (0..n).filter(|&k| k != tip && size[k] > 0) {
                if nearest.is_none_or(|b| d[tip * n + k] < d[tip * n + b]) {
                    nearest = Some(k);
                }
            }
            let Some(nearest) = nearest else { break };
            if before != Some(nearest) {
                chain.push(nearest);
                continue;
            }
            chain.truncate(chain.len() - 2);
            merges.push(Merge {
                a: tip,
                b: nearest,
                height: d[tip * n + nearest],
            });
            join(n, &mut d, &mut size, tip, nearest);
        }
        merges.sort_by(|a, b| a.height.total_cmp(&b.height));
        Self { items: n, merges }
    }

    /// Of `items` items by merges that are known, each with an item of both groups; what a merge joins was joined at no more than its
    /// height.
    pub fn of_merges(items: usize, mut merges: Vec<Merge>) -> Self {
        merges.sort_by(|a, b| a.height.total_cmp(&b.height));
        Self { items, merges }
    }

    /// Number of items.
    pub fn items(&self) -> usize {
        self.items
    }

    /// Groups whose items are on average no further apart than `height`.
    pub fn groups_at(&self, height: f64) -> usize {
        self.items - self.merges.partition_point(|m| m.height <= height)
    }

    /// The merges, nearest first.
    pub fn merges(&self) -> &[Merge] {
        &self.merges
    }

    /// The groups whose items are on average no further apart than `height`.
    pub fn at_height(&self, height: f64) -> Clusters {
        self.after(self.merges.partition_point(|m| m.height <= height))
    }

    /// This many groups, or as many as there are items.
    pub fn into_clusters(&self, count: usize) -> Clusters {
        self.after(
            self.items
                .saturating_sub(count.max(1))
                .min(self.merges.len()),
        )
    }

    fn after(&self, merges: usize) -> Clusters {
        let mut parent: Vec<usize> = (0..self.items).collect();
        fn root(parent: &mut [usize], mut i: usize) -> usize {
            while parent[i] != i {
                parent[i] = parent[parent[i]];
                i = parent[i];
            }
            i
        }
        for merge in &self.merges[..merges] {
            let (a, b) = (root(&mut parent, merge.a), root(&mut parent, merge.b));
            parent[a] = b;
        }
        let roots: Vec<usize> = (0..self.items).map(|i| root(&mut parent, i)).collect();
        super::clusters::numbered(roots.into_iter())
    }
}

/// Group `b` becomes part of `a`; distances to the rest are means over items.
fn join(n: usize, d: &mut [f64], size: &mut [usize], a: usize, b: usize) {
    let (na, nb) = (size[a] as f64, size[b] as f64);
    for k in (0..n).filter(|&k| k != a && k != b && size[k] > 0) {
        let mean = (na * d[a * n + k] + nb * d[b * n + k]) / (na + nb);
        d[a * n + k] = mean;
        d[k * n + a] = mean;
    }
    size[a] += size[b];
    size[b] = 0;
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Joins the nearest two groups until this many are left.
    fn plain(points: &[f64], count: usize) -> Vec<Vec<usize>> {
        let mut groups: Vec<Vec<usize>> = (0..points.len()).map(|i| vec![i]).collect();
        let mean = |a: &[usize], b: &[usize]| {
            let sum: f64 = a
                .iter()
                .flat_map(|i| b.iter().map(|j| (points[*i] - points[*j]).abs()))
                .sum();
            sum / (a.len() * b.len()) as f64
        };
        while groups.len() > count {
            let mut best = (f64::INFINITY, 0, 1);
            for i in 0..groups.len() {
                for j in i + 1..groups.len() {
                    let m = mean(&groups[i], &groups[j]);
                    if m < best.0 {
                        best = (m, i, j);
                    }
                }
            }
            let other = groups.remove(best.2);
            groups[best.1].extend(other);
        }
        groups.iter_mut().for_each(|g| g.sort_unstable());
        groups.sort();
        groups
    }

    proptest! {
        #[test]
        fn the_same_groups_as_joining_the_nearest_two(
            points in prop::collection::vec(0f64..100.0, 1..24),
            count in 1usize..9,
        ) {
            let tree = Hierarchy::average(points.len(), |a, b| (points[a] - points[b]).abs());
            let mut members = tree.into_clusters(count).members();
            members.sort();
            prop_assert_eq!(members, plain(&points, count.min(points.len())));
        }
    }

    #[test]
    fn heights_divide() {
        let points = [0.0, 1.0, 10.0, 11.0];
        let tree = Hierarchy::average(4, |a, b| f64::abs(points[a] - points[b]));
        assert_eq!(tree.at_height(0.5).count, 4);
        assert_eq!(tree.at_height(2.0).count, 2);
        assert_eq!(tree.at_height(20.0).count, 1);
    }
}
