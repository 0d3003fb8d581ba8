//! Weighted interval scheduling: the best choice of stretches that do not overlap.

use super::candidates::MovingStretch;

/// Of stretches of one clip with what each is worth, above 0, those that together are worth most: weighted interval scheduling, exact
/// (Kleinberg and Tardos, *Algorithm Design*, 6.1). In the order of their ends. O(n log n).
pub(super) fn schedule(mut offers: Vec<(usize, f64)>, stretches: &[MovingStretch]) -> Vec<usize> {
    offers.sort_by_key(|&(i, _)| (stretches[i].stop, i));
    let stops: Vec<usize> = offers.iter().map(|&(i, _)| stretches[i].stop).collect();
    // best[n]: worth of the best choice among the first n; a tick in common is allowed.
    let mut best = vec![0.0; offers.len() + 1];
    let before = |n: usize| {
        let start = stretches[offers[n].0].start;
        stops[..n].partition_point(|&stop| stop <= start + 1)
    };
    for n in 0..offers.len() {
        best[n + 1] = f64::max(best[n], best[before(n)] + offers[n].1);
    }
    let mut chosen = Vec::new();
    let mut n = offers.len();
    while n > 0 {
        if best[n] > best[n - 1] {
            chosen.push(offers[n - 1].0);
            n = before(n - 1);
        } else {
            n -= 1;
        }
    }
    chosen.reverse();
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn no_other_choice_is_worth_more(
            spans in prop::collection::vec((0usize..30, 2usize..9, 0.1f64..2.0), 0..10),
        ) {
            let stretch = |&(start, ticks, _): &(usize, usize, f64)| MovingStretch {
                clip: 0,
                start,
                stop: start + ticks,
                moving_secs: 1.0,
            };
            let stretches: Vec<MovingStretch> = spans.iter().map(stretch).collect();
            let fits = |chosen: &[usize]| {
                let mut pairs = chosen.iter().flat_map(|&a| chosen.iter().map(move |&b| (a, b)));
                pairs.all(|(a, b)| a == b || !stretches[a].overlaps(&stretches[b]))
            };
            let worth = |chosen: &[usize]| chosen.iter().map(|&i| spans[i].2).sum::<f64>();
            let all = 0..1usize << spans.len();
            let subsets = all.map(|bits| (0..spans.len()).filter(|i| bits >> i & 1 == 1).collect::<Vec<_>>());
            let most = subsets.filter(|s| fits(s)).map(|s| worth(&s)).fold(0.0, f64::max);
            let offers = spans.iter().enumerate().map(|(i, s)| (i, s.2)).collect();
            let chosen = schedule(offers, &stretches);
            prop_assert!(fits(&chosen));
            prop_assert!((worth(&chosen) - most).abs() < 1e-9);
        }
    }
}
