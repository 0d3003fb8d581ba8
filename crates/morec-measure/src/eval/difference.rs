//! Where the labels of two annotators differ, one by one.

use std::collections::BTreeMap;

use super::{GroundTruth, MEASURED_OVERLAP};
use morec::TimeSpan;

/// A place where two annotators differ: labels of A and of B by their places, of which one may be missing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub struct LabelDifference {
    /// The label of A; `None` if B alone has a label.
    pub a: Option<usize>,
    /// The label of B; `None` if A alone has a label.
    pub b: Option<usize>,
}

/// How well two labels go together: the lower the better.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Fit {
    /// The same class, and they overlap by half.
    Same,
    /// Another class, and they overlap by half.
    OtherClass,
    /// The same class, and they overlap.
    OtherExtent,
}

/// The labels that differ, by clip and start. Labels are paired one to one: of the same class and overlapping by half (intersection over
/// union), then of another class and overlapping by half, then of the same class with any overlap; within each kind, by decreasing overlap.
/// Pairs of one class whose starts and stops are no further apart than `least_secs` agree and are left out. O(pairs of labels of the
/// same clip).
pub fn label_differences(
    a: &[GroundTruth],
    b: &[GroundTruth],
    least_secs: f64,
) -> Vec<LabelDifference> {
    let mut by_clip = BTreeMap::<&str, [Vec<usize>; 2]>::new();
    for (who, labels) in [a, b].into_iter().enumerate() {
        for (at, label) in labels.iter().enumerate() {
            by_clip.entry(&label.clip).or_default()[who].push(at);
        }
    }
    let of_clip = |[of_a, of_b]: [Vec<usize>; 2]| {
        let pairs = paired(a, b, &of_a, &of_b);
        let agree = |(i, j): &(usize, usize)| {
            a[*i].class == b[*j].class
                && a[*i]
                    .span
                    .is_near(b[*j].span, least_secs + TimeSpan::SAME_SECS)
        };
        let is_paired = |who: usize, at: usize| {
            pairs
                .iter()
                .any(|&(i, j)| at == if who == 0 { i } else { j })
        };
        let lone_a = of_a.iter().filter(|at| !is_paired(0, **at));
        let lone_b = of_b.iter().filter(|at| !is_paired(1, **at));
        let apart = pairs.iter().filter(|pair| !agree(pair));
        let mut differences: Vec<LabelDifference> = (apart.map(|(i, j)| (Some(*i), Some(*j))))
            .chain(lone_a.map(|at| (Some(*at), None)))
            .chain(lone_b.map(|at| (None, Some(*at))))
            .map(|(a, b)| LabelDifference { a, b })
            .collect();
        let start = |of: &LabelDifference| {
            let starts = [of.a.map(|at| &a[at]), of.b.map(|at| &b[at])];
            let starts = starts.into_iter().flatten().map(|l| l.span.start_secs);
            starts.fold(f64::INFINITY, f64::min)
        };
        differences.sort_by(|x, y| start(x).total_cmp(&start(y)));
        differences
    };
    by_clip.into_values().flat_map(of_clip).collect()
}

/// Pairs of labels of a clip, each label once, the best first.
fn paired(
    a: &[GroundTruth],
    b: &[GroundTruth],
    of_a: &[usize],
    of_b: &[usize],
) -> Vec<(usize, usize)> {
    let mut edges = Vec::new();
    for &i in of_a {
        for &j in of_b {
            let (iou, same) = (a[i].span.iou(b[j].span), a[i].class == b[j].class);
            let fit = match (same, iou >= MEASURED_OVERLAP, iou > 0.0) {
                (true, true, _) => Fit::Same,
                (false, true, _) => Fit::OtherClass,
                (true, false, true) => Fit::OtherExtent,
                _ => continue,
            };
            edges.push((fit, iou, i, j));
        }
    }
    edges.sort_by(|x, y| {
        let fits = x.0.cmp(&y.0).then(y.1.total_cmp(&x.1));
        fits.then((x.2, x.3).cmp(&(y.2, y.3)))
    });
    let mut pairs: Vec<(usize, usize)> = Vec::new();
    for (_, _, i, j) in edges {
        if !pairs.iter().any(|pair| pair.0 == i || pair.1 == j) {
            pairs.push((i, j));
        }
    }
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;
    use morec::rng::Rng;

    fn label(clip: &str, class: &str, start: f64, stop: f64) -> GroundTruth {
        GroundTruth {
            clip: clip.to_owned(),
            class: class.to_owned(),
            span: TimeSpan::new(start, stop),
        }
    }

    #[test]
    fn classes_extents_and_labels_of_one_alone_differ() {
        let a = [
            label("x", "wave", 1.0, 2.0),
            label("x", "wave", 5.0, 6.0),
            label("x", "bow", 10.0, 14.0),
            label("y", "bow", 1.0, 2.0),
        ];
        let b = [
            label("x", "wave", 1.05, 2.0),
            label("x", "clap", 5.0, 6.1),
            label("x", "bow", 13.0, 15.0),
            label("x", "clap", 20.0, 21.0),
        ];
        let of = |a, b| LabelDifference { a, b };
        let expected = [
            of(Some(1), Some(1)),
            of(Some(2), Some(2)),
            of(None, Some(3)),
            of(Some(3), None),
        ];
        assert_eq!(label_differences(&a, &b, 0.1), expected);
        assert_eq!(label_differences(&a, &b, 0.0)[0], of(Some(0), Some(0)));
        assert_eq!(label_differences(&a, &a, 0.0), []);
    }

    #[test]
    fn every_label_is_in_one_difference_at_most_and_otherwise_the_other_says_the_same() {
        for seed in 0..40 {
            let mut rng = Rng::new(seed);
            let mut labels = || -> Vec<GroundTruth> {
                let mut one = || {
                    let start = (20.0 * rng.unit()).round() / 2.0;
                    let class = ["wave", "clap"][usize::from(rng.unit() < 0.5)];
                    let clip = ["x", "y"][usize::from(rng.unit() < 0.5)];
                    label(clip, class, start, start + 0.5 + (4.0 * rng.unit()).round())
                };
                (0..12).map(|_| one()).collect()
            };
            let (a, b) = (labels(), labels());
            let differences = label_differences(&a, &b, 0.0);
            let count = |who: fn(&LabelDifference) -> Option<usize>, at| {
                differences.iter().filter(|d| who(d) == Some(at)).count()
            };
            let (of_a, of_b): (Vec<_>, Vec<_>) = (
                (0..a.len()).map(|at| count(|d| d.a, at)).collect(),
                (0..b.len()).map(|at| count(|d| d.b, at)).collect(),
            );
            assert!(of_a.iter().chain(&of_b).all(|count| *count <= 1));
            // Those that agree are as many on both sides, and the same labels.
            let agreed = |labels: &[GroundTruth], counts: &[usize]| {
                let agreed = labels.iter().zip(counts).filter(|(_, count)| **count == 0);
                let mut agreed: Vec<String> = agreed.map(|(l, _)| format!("{l:?}")).collect();
                agreed.sort();
                agreed
            };
            assert_eq!(agreed(&a, &of_a), agreed(&b, &of_b), "seed {seed}");
        }
    }
}
