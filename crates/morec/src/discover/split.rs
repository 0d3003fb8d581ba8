//! Divides sets that contain two motions of one clip, if instances are clearly nearer to their own motion than to the other.

use std::collections::BTreeMap;

use super::candidates::MovingStretch;
use super::shapes::ShapeTable;
use crate::cluster::Hierarchy;

/// Two halves are apart if the distance between them is more than this many times that within the wider one.
const APART: f64 = 2.0;
/// Members of a half.
const LEAST: usize = 2;
/// Distances within are taken for no less.
const LEAST_WITHIN: f64 = 0.02;

/// The members of a set, or of a part of it, in one clip.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ClipPart {
    pub(super) set: usize,
    pub(super) clip: usize,
    pub(super) members: Vec<usize>,
}

/// Members of each set by clip, in order.
pub(super) fn by_clip(sets: &[Vec<usize>], stretches: &[MovingStretch]) -> Vec<ClipPart> {
    let mut parts: BTreeMap<(usize, usize), Vec<usize>> = BTreeMap::new();
    for (set, members) in sets.iter().enumerate() {
        for &member in members {
            parts
                .entry((set, stretches[member].clip))
                .or_default()
                .push(member);
        }
    }
    let part = |((set, clip), members)| ClipPart { set, clip, members };
    parts.into_iter().map(part).collect()
}

/// Each part, or the parts that it falls into.
pub(super) fn split(parts: Vec<ClipPart>, shapes: &ShapeTable) -> Vec<ClipPart> {
    let halves = |part: ClipPart| {
        let all: Vec<usize> = (0..part.members.len()).collect();
        let distance = |a: usize, b: usize| {
            let (a, b) = (part.members[a.min(b)], part.members[a.max(b)]);
            if a == b {
                0.0
            } else {
                shapes.elastic(a, b, f32::INFINITY).map_or(0.0, f64::from)
            }
        };
        let count = all.len();
        let mut table = vec![0.0; count * count];
        for a in 0..count {
            for b in 0..a {
                let r = distance(a, b);
                (table[a * count + b], table[b * count + a]) = (r, r);
            }
        }
        let pieces = pieces(all, &|a, b| table[a * count + b]);
        let piece = |piece: Vec<usize>| ClipPart {
            members: piece.into_iter().map(|i| part.members[i]).collect(),
            ..part
        };
        pieces.into_iter().map(piece).collect::<Vec<_>>()
    };
    use rayon::prelude::*;
    let split: Vec<Vec<ClipPart>> = parts.into_par_iter().map(halves).collect();
    split.into_iter().flatten().collect()
}

/// Average linkage's two halves, and theirs, while they are apart. A few outliers are set aside if what is left then falls into halves.
fn pieces(items: Vec<usize>, distance: &impl Fn(usize, usize) -> f64) -> Vec<Vec<usize>> {
    if items.len() < 2 * LEAST {
        return vec![items];
    }
    let tree = Hierarchy::average(items.len(), |a, b| distance(items[a], items[b]));
    let halves = tree.into_clusters(2).members().into_iter();
    let mut halves = halves.map(|half| half.into_iter().map(|i| items[i]).collect::<Vec<_>>());
    let (Some(a), Some(b)) = (halves.next(), halves.next()) else {
        return vec![items];
    };
    let (few, many) = if a.len() < b.len() { (a, b) } else { (b, a) };
    if few.len() < LEAST {
        let mut rest = pieces(many, distance);
        if rest.len() == 1 {
            return vec![items];
        }
        rest.push(few);
        return rest;
    }
    let mean = |pairs: &mut dyn Iterator<Item = f64>| {
        let (sum, count) = pairs.fold((0.0, 0), |(sum, count), r| (sum + r, count + 1));
        sum / f64::from(count.max(1))
    };
    let within = |half: &[usize]| {
        let pairs = half.iter().enumerate();
        mean(&mut pairs.flat_map(|(i, &a)| half[..i].iter().map(move |&b| distance(a, b))))
    };
    let between = mean(
        &mut few
            .iter()
            .flat_map(|&a| many.iter().map(move |&b| distance(a, b))),
    );
    if between <= APART * within(&few).max(within(&many)).max(LEAST_WITHIN) {
        return vec![items];
    }
    let mut apart = pieces(few, distance);
    apart.extend(pieces(many, distance));
    apart
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heaps_come_apart_and_a_lone_outlier_stays() {
        let split = |places: &[f64]| {
            let mut found = pieces((0..places.len()).collect(), &|a: usize, b: usize| {
                (places[a] - places[b]).abs()
            });
            found.iter_mut().for_each(|piece| piece.sort_unstable());
            found.sort();
            found
        };
        assert_eq!(
            split(&[0.0, 5.0, 0.2, 5.1, 0.1]),
            [vec![0, 2, 4], vec![1, 3]]
        );
        assert_eq!(
            split(&[0.0, 0.1, 0.2, 9.0]),
            [[0, 1, 2, 3]],
            "an outlier alone is no half"
        );
        assert_eq!(split(&[0.0, 0.1, 0.2, 0.3, 0.4]).len(), 1);
        let aside = split(&[0.0, 0.1, 5.0, 5.1, 90.0]);
        assert_eq!(aside, [vec![0, 1], vec![2, 3], vec![4]]);
    }
}
