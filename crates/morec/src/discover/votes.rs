//! Sets of different clips that are one motion, by votes: each member names the nearest member in each other clip. Sets whose members name
//! each other are joined, however far apart two people's ways of a motion are. (Reciprocal best hits, as for genes of common descent:
//! Tatusov, Koonin, Lipman, *A genomic perspective on protein families*, 1997.)

use std::cmp::Ordering;
use std::collections::{BTreeMap, BinaryHeap};

use rayon::prelude::*;

use super::shapes::ShapeTable;
use super::split::ClipPart;

/// Sums of the supports of two groups' parts, by the other group.
type SupportRow = BTreeMap<usize, f64>;

/// Two groups that may be joined, as they were when their support was counted.
#[derive(PartialEq)]
struct Join {
    support: f64,
    groups: (usize, usize),
    versions: (usize, usize),
}

impl Eq for Join {}

impl Ord for Join {
    /// The greater support, then the earlier groups.
    fn cmp(&self, other: &Self) -> Ordering {
        let by_support = self.support.total_cmp(&other.support);
        by_support.then(other.groups.cmp(&self.groups))
    }
}

impl PartialOrd for Join {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Groups of parts: average support of pairs of different clips, joined from the best down to `least`. Votes for what is `cap` or farther do
/// not count. Parts of one set begin joined if `joined` is true. Members of each group, in order.
pub(super) fn vote(
    parts: &[ClipPart],
    shapes: &ShapeTable,
    cap: f32,
    least: f64,
    joined: bool,
) -> Vec<Vec<usize>> {
    let mut groups = Groups::of(parts, supports(parts, shapes, cap));
    if joined {
        let mut first = BTreeMap::new();
        for (i, part) in parts.iter().enumerate() {
            let into = *first.entry(part.set).or_insert(i);
            if into != i {
                groups.join(into, i);
            }
        }
    }
    groups.join_down_to(least);
    let members = |group: Vec<usize>| {
        let members = group
            .into_iter()
            .flat_map(|part| parts[part].members.iter().copied());
        members.collect::<Vec<_>>()
    };
    groups
        .parts
        .into_iter()
        .filter(|g| !g.is_empty())
        .map(members)
        .collect()
}

/// Support of each pair of parts of different clips, by its first: the smaller of the shares of members that name the other.
fn supports(parts: &[ClipPart], shapes: &ShapeTable, cap: f32) -> Vec<SupportRow> {
    let mut of_clips: BTreeMap<usize, Vec<(usize, usize)>> = BTreeMap::new();
    for (i, part) in parts.iter().enumerate() {
        let of_clip = of_clips.entry(part.clip).or_default();
        of_clip.extend(part.members.iter().map(|&member| (member, i)));
    }
    let votes = |part: &ClipPart| -> SupportRow {
        let mut votes = SupportRow::new();
        for &member in &part.members {
            for (_, others) in of_clips.iter().filter(|(clip, _)| **clip != part.clip) {
                if let Some(named) = nearest(member, others, shapes, cap) {
                    *votes.entry(named).or_default() += 1.0 / part.members.len() as f64;
                }
            }
        }
        votes
    };
    let votes: Vec<SupportRow> = parts.par_iter().map(votes).collect();
    let both = |(i, of): (usize, &SupportRow)| {
        let back = of
            .iter()
            .filter_map(|(&j, share)| Some((j, share.min(*votes[j].get(&i)?))));
        back.collect()
    };
    votes.iter().enumerate().map(both).collect()
}

/// The part of the nearest of `others`, pairs of a member and its part, below `cap`.
fn nearest(of: usize, others: &[(usize, usize)], shapes: &ShapeTable, cap: f32) -> Option<usize> {
    // What is near at an even pace comes first, so that the others are soon known to be farther.
    let even = |&(other, part): &(usize, usize)| {
        (
            shapes
                .linear(of, other, f32::INFINITY)
                .unwrap_or(f32::INFINITY),
            other,
            part,
        )
    };
    let mut order: Vec<(f32, usize, usize)> = others.iter().map(even).collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut best = (cap, None);
    for (_, other, part) in order {
        if let Some(r) = shapes.elastic(of, other, best.0) {
            best = (r, Some(part));
        }
    }
    best.1
}

/// Groups of parts in the making. A group that became part of another is empty.
struct Groups {
    parts: Vec<Vec<usize>>,
    supports: Vec<SupportRow>,
    /// Parts of each group in each clip.
    clips: Vec<BTreeMap<usize, usize>>,
    versions: Vec<usize>,
}

impl Groups {
    fn of(parts: &[ClipPart], supports: Vec<SupportRow>) -> Self {
        Self {
            parts: (0..parts.len()).map(|i| vec![i]).collect(),
            supports,
            clips: parts
                .iter()
                .map(|part| BTreeMap::from([(part.clip, 1)]))
                .collect(),
            versions: vec![0; parts.len()],
        }
    }

    /// Mean support of the pairs of their parts that are of different clips; two parts of one clip were taken apart for a reason.
    fn offer(&self, a: usize, b: usize) -> Join {
        let in_a = &self.clips[a];
        let same = self.clips[b]
            .iter()
            .filter_map(|(clip, n)| Some(n * in_a.get(clip)?));
        let pairs = self.parts[a].len() * self.parts[b].len() - same.sum::<usize>();
        let sum = self.supports[a].get(&b).copied().unwrap_or(0.0);
        Join {
            support: sum / pairs.max(1) as f64,
            groups: (a.min(b), a.max(b)),
            versions: (self.versions[a.min(b)], self.versions[a.max(b)]),
        }
    }

    fn join_down_to(&mut self, least: f64) {
        let all = self.supports.iter().enumerate();
        let pairs = all.flat_map(|(a, row)| row.range(a + 1..).map(move |(&b, _)| (a, b)));
        let mut heap: BinaryHeap<Join> = pairs.map(|(a, b)| self.offer(a, b)).collect();
        while let Some(best) = heap.pop().filter(|best| best.support >= least) {
            let (a, b) = best.groups;
            if best.versions != (self.versions[a], self.versions[b]) {
                continue;
            }
            self.join(a, b);
            heap.extend(self.supports[a].keys().map(|&other| self.offer(a, other)));
        }
    }

    /// Group `b` becomes part of `a`.
    fn join(&mut self, a: usize, b: usize) {
        let parts = std::mem::take(&mut self.parts[b]);
        self.parts[a].extend(parts);
        for (clip, n) in std::mem::take(&mut self.clips[b]) {
            *self.clips[a].entry(clip).or_default() += n;
        }
        for (other, sum) in std::mem::take(&mut self.supports[b]) {
            self.supports[other].remove(&b);
            if other != a {
                *self.supports[other].entry(a).or_default() += sum;
                *self.supports[a].entry(other).or_default() += sum;
            }
        }
        self.versions[a] += 1;
        self.versions[b] += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Joins the best supported two until `least`, all means counted anew.
    fn plain(parts: &[ClipPart], supports: &[SupportRow], least: f64) -> Vec<Vec<usize>> {
        let mut groups: Vec<Vec<usize>> = (0..parts.len()).map(|i| vec![i]).collect();
        loop {
            let mut best = (least, None);
            for a in 0..groups.len() {
                for b in a + 1..groups.len() {
                    let pairs = groups[a]
                        .iter()
                        .flat_map(|&i| groups[b].iter().map(move |&j| (i, j)));
                    let apart = pairs.filter(|&(i, j)| parts[i].clip != parts[j].clip);
                    let of = apart.map(|(i, j)| supports[i].get(&j).copied().unwrap_or(0.0));
                    let (sum, count) = of.fold((0.0, 0), |(sum, n), s| (sum + s, n + 1));
                    let mean = sum / f64::from(count.max(1));
                    if mean > 0.0 && (mean > best.0 || best.1.is_none() && mean >= least) {
                        best = (mean, Some((a, b)));
                    }
                }
            }
            let Some((a, b)) = best.1 else { break };
            let joined = groups.remove(b);
            groups[a].extend(joined);
        }
        groups.iter_mut().for_each(|g| g.sort_unstable());
        groups.sort();
        groups
    }

    proptest! {
        #[test]
        fn the_same_groups_as_joining_the_best_two(
            clips in prop::collection::vec(0usize..4, 1..9),
            // Numbers of which no two means are the same.
            numbers in prop::collection::vec(0.01f64..1.0, 81),
            least in 0.1f64..0.6,
        ) {
            let part = |&clip: &usize| ClipPart { set: 0, clip, members: vec![] };
            let parts: Vec<ClipPart> = clips.iter().map(part).collect();
            let mut supports = vec![SupportRow::new(); parts.len()];
            for a in 0..parts.len() {
                for b in 0..a {
                    let support = numbers[9 * a + b];
                    if clips[a] != clips[b] && support > 0.3 {
                        supports[a].insert(b, support);
                        supports[b].insert(a, support);
                    }
                }
            }
            let expected = plain(&parts, &supports, least);
            let mut groups = Groups::of(&parts, supports);
            groups.join_down_to(least);
            let mut found: Vec<_> = groups.parts.into_iter().filter(|g| !g.is_empty()).collect();
            found.iter_mut().for_each(|g| g.sort_unstable());
            found.sort();
            prop_assert_eq!(found, expected);
        }
    }
}
