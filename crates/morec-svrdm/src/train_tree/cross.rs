//! Widths by leaving groups out: what Algorithm 4 does not ask, namely whether new samples are accepted.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

use super::TreeParams;
use super::cross_params::CrossParams;
use super::gram::Distances;
use super::machines::{Machines, MacroClasses, Plane};
use super::sigma::{of_sides, quantile};

/// Acceptance under the chosen widths.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct WidthOutcome {
    /// Share of left-out samples that their own side accepts.
    pub accepted: f64,
    /// Share of left-out samples that the other side accepts, whether their own does or not.
    pub wrong: f64,
    /// Share of background that either side accepts.
    pub background: f64,
}

impl WidthOutcome {
    fn worth(&self, params: &CrossParams) -> f64 {
        self.accepted - params.other_cost * self.wrong - params.background_cost * self.background
    }
}

/// `σ_f`, `σ_r` and what they did: the pair that is worth most, of equals the larger widths. Everything is trained
/// for each pair and each fold: O(pairs · folds · m³).
///
/// If no group can be left out without emptying a side, the samples themselves are judged, which says little: all
/// are then accepted by some width.
pub fn choose(
    sides: &MacroClasses,
    params: &CrossParams,
    tree: &TreeParams,
) -> (f64, f64, WidthOutcome) {
    let folds = folds(sides, params.folds);
    let unit = of_sides(sides.vectors, |side| {
        quantile(&Distances::new(side).sorted(), 0.5)
    });
    let mut best: Option<(f64, f64, WidthOutcome)> = None;
    for full in params.full.of(unit) {
        let whole = LeaveOutSplit::new(sides, full, |_| true);
        let parts: Vec<LeaveOutSplit> = folds
            .iter()
            .map(|fold| LeaveOutSplit::new(sides, full, |g| !fold.contains(&g)))
            .collect();
        let [a, b] = &whole.planar;
        let unit = of_sides([a, b], |side| quantile(&Distances::new(side).sorted(), 0.5));
        for reduced in params.reduced.of(unit) {
            let outcome = judge(&whole, &parts, reduced, params.accept, tree);
            let better = best
                .as_ref()
                .is_none_or(|b| outcome.worth(params) >= b.2.worth(params));
            if better {
                best = Some((full, reduced, outcome));
            }
        }
    }
    best.unwrap_or((unit, 1.0, WidthOutcome::default()))
}

/// Sides without what is left out, and what is left out, in the plane of the former.
struct LeaveOutSplit {
    planar: [Vec<[f64; 2]>; 2],
    left_out: [Vec<[f64; 2]>; 2],
    background: Vec<[f64; 2]>,
}

impl LeaveOutSplit {
    fn new(sides: &MacroClasses, sigma: f64, keep: impl Fn(usize) -> bool) -> Self {
        let pick = |side: usize, kept: bool| -> Vec<&[f64]> {
            let all = sides.vectors[side].iter().zip(sides.groups[side]);
            all.filter(|(_, g)| keep(**g) == kept)
                .map(|(v, _)| *v)
                .collect()
        };
        let kept = [pick(0, true), pick(1, true)];
        let kept = [&kept[0][..], &kept[1][..]];
        let plane = Plane::new(kept, sigma);
        Self {
            planar: kept.map(|side| plane.reduce_all(kept, side)),
            left_out: [0, 1].map(|side| plane.reduce_all(kept, &pick(side, false))),
            background: plane.reduce_all(kept, sides.background),
        }
    }

    fn machines(&self, sigma: f64, params: &TreeParams) -> Machines {
        Machines::new([&self.planar[0], &self.planar[1]], sigma, params)
    }
}

fn judge(
    whole: &LeaveOutSplit,
    parts: &[LeaveOutSplit],
    sigma: f64,
    accept: f64,
    params: &TreeParams,
) -> WidthOutcome {
    let all = whole.machines(sigma, params);
    let background = share(
        whole
            .background
            .iter()
            .map(|p| all.outputs(p).iter().any(|o| *o >= accept)),
    );
    let outputs: Vec<(usize, [f64; 2])> = if parts.is_empty() {
        judged(&all, &whole.planar).collect()
    } else {
        let of_part = |part: &LeaveOutSplit| {
            judged(&part.machines(sigma, params), &part.left_out).collect::<Vec<_>>()
        };
        parts.iter().flat_map(of_part).collect()
    };
    WidthOutcome {
        accepted: share(outputs.iter().map(|(side, o)| o[*side] >= accept)),
        wrong: share(outputs.iter().map(|(side, o)| o[1 - *side] >= accept)),
        background,
    }
}

fn judged<'a>(
    machines: &'a Machines,
    planar: &'a [Vec<[f64; 2]>; 2],
) -> impl Iterator<Item = (usize, [f64; 2])> + 'a {
    (0..2).flat_map(move |side| {
        planar[side]
            .iter()
            .map(move |p| (side, machines.outputs(p)))
    })
}

fn share(all: impl Iterator<Item = bool>) -> f64 {
    let (hits, count) = all.fold((0, 0), |(hits, count), hit| {
        (hits + usize::from(hit), count + 1)
    });
    f64::from(hits as u32) / f64::from(count.max(1))
}

/// Groups dealt into at most `most` parts, without those parts that would leave a side empty.
fn folds(sides: &MacroClasses, most: usize) -> Vec<BTreeSet<usize>> {
    let groups: BTreeSet<usize> = sides
        .groups
        .iter()
        .flat_map(|g| g.iter().copied())
        .collect();
    let mut folds = vec![BTreeSet::new(); groups.len().min(most)];
    let count = folds.len().max(1);
    for (i, group) in groups.into_iter().enumerate() {
        if let Some(fold) = folds.get_mut(i % count) {
            fold.insert(group);
        }
    }
    folds.retain(|fold| {
        sides
            .groups
            .iter()
            .all(|side| side.iter().any(|g| !fold.contains(g)))
    });
    folds
}
