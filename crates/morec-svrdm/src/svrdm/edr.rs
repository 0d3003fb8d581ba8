//! Edit distance on real sequences, divided by the length of its path (thesis, §3.8 and §4.6.5; Chen, Özsu and Oria,
//! *Robust and fast similarity search for moving object trajectories*, 2005).
//!
//! Two values match if they differ by at most ε. A path from one sequence to the other pairs values (0 if they match,
//! 1 if not) or leaves one out (1 each); its length is the number of such steps. With Eq. 3.45 as corrected: a match
//! costs nothing, and `EDR(r, ∅) = len(r)`.

use multiversion::multiversion;

use super::{MAX_PROFILE_FRAMES, Normalisation};

/// One unit of cost, in the same number that counts steps: costs first, and of equal costs the longer path is less.
///
/// Sums stay whole numbers below 2²⁴, which single precision holds exactly, up to [`MAX_PROFILE_FRAMES`].
const UNIT: f32 = 4096.0;

/// A step that costs.
const PAID: f32 = UNIT - 1.0;

/// A step that does not.
const FREE: f32 = -1.0;

/// No path.
const NONE: f32 = 1e30;

/// Costs and steps of a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Path {
    /// Values that were left out or do not match.
    pub cost: u32,
    /// Pairs of values and values left out.
    pub steps: u32,
}

impl Path {
    /// Cost a step, 0 … 1; two empty sequences are alike.
    pub fn ratio(self) -> f64 {
        f64::from(self.cost) / f64::from(self.steps.max(1))
    }
}

/// No path between sequences of these lengths has a lower ratio: with `d` pairs a path has at least `m + n − 2d`
/// costs in `m + n − d` steps.
pub fn least_ratio(m: usize, n: usize) -> f64 {
    m.abs_diff(n) as f64 / m.max(n).max(1) as f64
}

/// The dynamic program, with its memory: nothing is allocated after construction.
///
/// It runs along the diagonals that go up and right, where cells do not depend on each other and so vectorise.
#[derive(Debug, Clone)]
pub struct Edr {
    epsilon: f32,
    /// Three diagonals, by place in the first sequence; a cell of room at both ends.
    diagonals: [Vec<f32>; 3],
    /// The second sequence from its end.
    reversed: Vec<f32>,
    /// For the least ratio: two rows of values, and of the paths that have them.
    values: [Vec<f64>; 2],
    paths: [Vec<Path>; 2],
}

impl Edr {
    /// For sequences of at most `longest` values (itself at most [`MAX_PROFILE_FRAMES`]), which match within
    /// `epsilon`.
    ///
    /// # Panics
    /// `longest` is larger than that.
    pub fn new(epsilon: f32, longest: usize) -> Self {
        assert!(
            longest <= MAX_PROFILE_FRAMES,
            "sequences of {longest} values"
        );
        let none = Path { cost: 0, steps: 0 };
        Self {
            epsilon,
            diagonals: std::array::from_fn(|_| vec![NONE; longest + 3]),
            reversed: vec![0.0; longest],
            values: std::array::from_fn(|_| vec![0.0; longest + 1]),
            paths: std::array::from_fn(|_| vec![none; longest + 1]),
        }
    }

    /// Bytes of its memory.
    pub fn bytes(&self) -> usize {
        let diagonals: usize = self.diagonals.iter().map(Vec::len).sum();
        let paths: usize = self.paths.iter().map(Vec::len).sum();
        4 * (diagonals + self.reversed.len()) + (8 + size_of::<Path>()) * paths
    }

    /// The normalised distance of `r` and `s`, 0 … 1; `None` if it is not below `bound`. O(m · n), less the lower the
    /// bound is.
    pub fn normalised(
        &mut self,
        r: &[f32],
        s: &[f32],
        normalisation: Normalisation,
        bound: f64,
    ) -> Option<f64> {
        if least_ratio(r.len(), s.len()) >= bound {
            return None;
        }
        let cheapest = match normalisation {
            // A ratio below the bound has costs c in at most (m + n + c) / 2 steps.
            Normalisation::CheapestPath if bound <= 1.0 => {
                let most = bound * (r.len() + s.len()) as f64 / (2.0 - bound);
                self.cheapest(r, s, most.ceil() as usize)?.ratio()
            }
            Normalisation::CheapestPath => self.cheapest(r, s, r.len() + s.len())?.ratio(),
            Normalisation::LeastRatio => self.least(r, s),
        };
        Some(cheapest).filter(|ratio| *ratio < bound)
    }

    /// The cheapest path, and of these the longest; `None` if every path costs more than `most`.
    pub fn cheapest(&mut self, r: &[f32], s: &[f32], most: usize) -> Option<Path> {
        let (m, n) = (r.len() as isize, s.len() as isize);
        if m.abs_diff(n) > most {
            return None;
        }
        self.reversed[..s.len()]
            .iter_mut()
            .zip(s.iter().rev())
            .for_each(|(to, from)| *to = *from);
        // A path through the cell (i, j) leaves out |i − j| values before it and |(i − j) − (m − n)| after it.
        let spare = (most as isize - (m - n).abs()) / 2;
        let (low, high) = ((m - n).min(0) - spare, (m - n).max(0) + spare);
        let epsilon = self.epsilon;
        let [a, b, c] = &mut self.diagonals;
        let (mut now, mut before, mut earlier) = (a, b, c);
        for d in 0..=m + n {
            // Cells (i, d − i) in the table and in the band; the row d = 0 has one, whose cost is 0.
            let first = (d - n).max(0).max((low + d + 1).div_euclid(2));
            let last = d.min(m).min((high + d).div_euclid(2));
            let (inner_first, inner_last) = (first.max(1), last.min(d - 1));
            if inner_first <= inner_last {
                let (i, count) = (
                    inner_first as usize,
                    (inner_last - inner_first + 1) as usize,
                );
                let r = &r[i - 1..][..count];
                let s = &self.reversed[(n - d + inner_first) as usize..][..count];
                // The cell i stands at i + 1.
                let (left, up) = (&before[i + 1..][..count], &before[i..][..count]);
                let both = &earlier[i..][..count];
                advance(r, s, epsilon, left, up, both, &mut now[i + 1..][..count]);
            }
            let border = d as f32 * PAID;
            if first == 0 {
                now[1] = border;
            }
            if last == d {
                now[d as usize + 1] = border;
            }
            // What the next diagonals read beyond this one's ends.
            now[first as usize] = NONE;
            now[(last + 2) as usize] = NONE;
            (now, before, earlier) = (earlier, now, before);
        }
        path_of(before[r.len() + 1]).filter(|path| path.cost as usize <= most)
    }

    /// The least ratio of all paths (Marzal and Vidal 1993), by Dinkelbach's iteration: the path of least
    /// `cost − λ · steps`, λ being the last path's ratio, until none is below 0.
    fn least(&mut self, r: &[f32], s: &[f32]) -> f64 {
        let mut ratio = 1.0;
        loop {
            let next = self.tilted(r, s, ratio).ratio();
            // Every round but the last lowers a ratio of whole numbers: it ends.
            if next >= ratio {
                return ratio;
            }
            ratio = next;
        }
    }

    /// The path of least `cost − tilt · steps`.
    fn tilted(&mut self, r: &[f32], s: &[f32], tilt: f64) -> Path {
        let (epsilon, value) = (self.epsilon, |path: Path| {
            f64::from(path.cost) - tilt * f64::from(path.steps)
        });
        let [above, here] = &mut self.paths;
        let [above_value, here_value] = &mut self.values;
        for i in 0..=r.len() {
            for j in 0..=s.len() {
                let mut best = (f64::INFINITY, Path { cost: 0, steps: 0 });
                let mut offer = |from: f64, path: Path, cost: u32| {
                    let offered = from + f64::from(cost) - tilt;
                    if offered < best.0 {
                        best = (
                            offered,
                            Path {
                                cost: path.cost + cost,
                                steps: path.steps + 1,
                            },
                        );
                    }
                };
                if i > 0 && j > 0 {
                    let matches = (r[i - 1] - s[j - 1]).abs() <= epsilon;
                    offer(above_value[j - 1], above[j - 1], u32::from(!matches));
                }
                if i > 0 {
                    offer(above_value[j], above[j], 1);
                }
                if j > 0 {
                    offer(here_value[j - 1], here[j - 1], 1);
                }
                // The sum is taken anew, lest it drift over a thousand steps.
                (here_value[j], here[j]) = if i + j == 0 {
                    (0.0, best.1)
                } else {
                    (value(best.1), best.1)
                };
            }
            std::mem::swap(above, here);
            std::mem::swap(above_value, here_value);
        }
        above[s.len()]
    }
}

/// One diagonal: pairing comes from two diagonals before, leaving out from the one before.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn advance(
    r: &[f32],
    s: &[f32],
    epsilon: f32,
    left: &[f32],
    up: &[f32],
    both: &[f32],
    now: &mut [f32],
) {
    let count = now.len();
    let (r, s, left, up, both) = (
        &r[..count],
        &s[..count],
        &left[..count],
        &up[..count],
        &both[..count],
    );
    for k in 0..count {
        // Written as comparisons: `f32::min` minds values that are no numbers, which takes twice as long.
        let out = (if left[k] < up[k] { left[k] } else { up[k] }) + PAID;
        let pair = both[k]
            + if (r[k] - s[k]).abs() <= epsilon {
                FREE
            } else {
                PAID
            };
        now[k] = if pair < out { pair } else { out };
    }
}

/// The path behind a cell of the table.
fn path_of(cell: f32) -> Option<Path> {
    if cell >= NONE / 2.0 {
        return None;
    }
    // cell = cost · UNIT − steps with 0 ≤ steps < UNIT.
    let cost = (cell / UNIT).ceil();
    Some(Path {
        cost: cost as u32,
        steps: (cost * UNIT - cell) as u32,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Every path there is.
    fn all_paths(r: &[f32], s: &[f32], epsilon: f32) -> Vec<Path> {
        if r.is_empty() && s.is_empty() {
            return vec![Path { cost: 0, steps: 0 }];
        }
        let mut found = vec![];
        let mut go = |r: &[f32], s: &[f32], cost: u32| {
            let rest = all_paths(r, s, epsilon).into_iter();
            found.extend(rest.map(|p| Path {
                cost: p.cost + cost,
                steps: p.steps + 1,
            }));
        };
        if !r.is_empty() && !s.is_empty() {
            go(&r[1..], &s[1..], u32::from((r[0] - s[0]).abs() > epsilon));
        }
        if !r.is_empty() {
            go(&r[1..], s, 1);
        }
        if !s.is_empty() {
            go(r, &s[1..], 1);
        }
        found
    }

    /// The whole table, cheapest first and then longest, as the recurrence says.
    fn plain(r: &[f32], s: &[f32], epsilon: f32) -> Path {
        let mut table = vec![vec![(0i64, 0i64); s.len() + 1]; r.len() + 1];
        for i in 0..=r.len() {
            for j in 0..=s.len() {
                let mut options = vec![];
                let mut offer = |(cost, less_steps): (i64, i64), paid: i64| {
                    options.push((cost + paid, less_steps - 1));
                };
                if i > 0 && j > 0 {
                    offer(
                        table[i - 1][j - 1],
                        i64::from((r[i - 1] - s[j - 1]).abs() > epsilon),
                    );
                }
                if i > 0 {
                    offer(table[i - 1][j], 1);
                }
                if j > 0 {
                    offer(table[i][j - 1], 1);
                }
                table[i][j] = options.into_iter().min().unwrap_or((0, 0));
            }
        }
        let (cost, less_steps) = table[r.len()][s.len()];
        Path {
            cost: cost as u32,
            steps: -less_steps as u32,
        }
    }

    /// Sequences of few values, so that many match.
    fn sequence(lengths: std::ops::Range<usize>) -> impl Strategy<Value = Vec<f32>> {
        prop::collection::vec((0i8..4).prop_map(f32::from), lengths)
    }

    proptest! {
        #[test]
        fn the_path_is_the_best_of_all(r in sequence(0..7), s in sequence(0..7)) {
            let paths = all_paths(&r, &s, 0.5);
            let cheapest = paths.iter().map(|p| (p.cost, std::cmp::Reverse(p.steps))).min().unwrap();
            let mut edr = Edr::new(0.5, 8);
            let found = edr.cheapest(&r, &s, r.len() + s.len()).unwrap();
            prop_assert_eq!((found.cost, std::cmp::Reverse(found.steps)), cheapest);
            let least = paths.iter().map(|p| p.ratio()).fold(f64::INFINITY, f64::min);
            let of_ratio = edr.normalised(&r, &s, Normalisation::LeastRatio, 2.0).unwrap();
            prop_assert_eq!(of_ratio, least);
            prop_assert!(least >= least_ratio(r.len(), s.len()));
        }

        #[test]
        fn diagonals_give_what_rows_give(r in sequence(0..90), s in sequence(0..90), most in 0usize..120) {
            let mut edr = Edr::new(0.5, 90);
            let expected = plain(&r, &s, 0.5);
            prop_assert_eq!(edr.cheapest(&r, &s, r.len() + s.len()), Some(expected));
            let bounded = Some(expected).filter(|path| path.cost as usize <= most);
            prop_assert_eq!(edr.cheapest(&r, &s, most), bounded);
        }

        #[test]
        fn a_bound_changes_nothing_below_it(r in sequence(1..60), s in sequence(1..60), bound in 0.0f64..1.1) {
            let mut edr = Edr::new(0.5, 60);
            for normalisation in [Normalisation::CheapestPath, Normalisation::LeastRatio] {
                let free = edr.normalised(&r, &s, normalisation, 2.0).unwrap();
                let bounded = edr.normalised(&r, &s, normalisation, bound);
                prop_assert_eq!(bounded, Some(free).filter(|ratio| *ratio < bound));
            }
        }
    }

    #[test]
    fn the_longest_sequences_are_counted_exactly() {
        let (r, s) = (vec![0.0; MAX_PROFILE_FRAMES], vec![9.0; MAX_PROFILE_FRAMES]);
        let mut edr = Edr::new(0.5, MAX_PROFILE_FRAMES);
        let n = MAX_PROFILE_FRAMES as u32;
        assert_eq!(
            edr.cheapest(&r, &s, 2 * r.len()),
            Some(Path { cost: n, steps: n })
        );
        assert_eq!(
            edr.cheapest(&r, &r, 2 * r.len()),
            Some(Path { cost: 0, steps: n })
        );
        assert_eq!(
            edr.cheapest(&r, &[], 2 * r.len()),
            Some(Path { cost: n, steps: n })
        );
    }
}
