//! Affinity propagation: groups around exemplars, their number not given (Frey and Dueck, *Clustering by passing
//! messages between data points*, 2007).

use super::Clusters;

/// Parameters of [`affinity_propagation`].
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct AffinityParams {
    /// Share of the old message that stays, 0.5 to below 1.
    pub damping: f64,
    /// Readiness of an item to be an exemplar, as a quantile of all similarities: the higher, the more groups.
    pub preference: f64,
    /// Messages are passed so often at most.
    pub rounds: usize,
    /// Exemplars that stay the same for this many rounds are final.
    pub settled: usize,
}

impl Default for AffinityParams {
    /// The authors' median preference; damping a little above their 0.5, which may oscillate.
    fn default() -> Self {
        Self {
            damping: 0.5,
            preference: 0.5,
            rounds: 400,
            settled: 15,
        }
    }
}

/// Clusters of `n` items by their similarity (minus a squared distance, say). O(rounds · n²) time, O(n²) memory. If the
/// messages never settle, the exemplars of the last round count.
pub fn affinity_propagation(
    n: usize,
    similarity: impl Fn(usize, usize) -> f64,
    params: &AffinityParams,
) -> Clusters {
    if n < 2 {
        return Clusters {
            of: vec![0; n],
            count: n,
        };
    }
    let s = similarities(n, similarity, params.preference);
    let (mut r, mut a) = (vec![0.0; n * n], vec![0.0; n * n]);
    let mut exemplars = Vec::new();
    let mut unchanged = 0;
    for _ in 0..params.rounds {
        responsibilities(n, &s, &a, &mut r, params.damping);
        availabilities(n, &r, &mut a, params.damping);
        let now: Vec<usize> = (0..n)
            .filter(|&k| r[k * n + k] + a[k * n + k] > 0.0)
            .collect();
        unchanged = if now == exemplars { unchanged + 1 } else { 0 };
        exemplars = now;
        if unchanged >= params.settled && !exemplars.is_empty() {
            break;
        }
    }
    assign(n, &s, &exemplars)
}

/// The matrix with preferences on its diagonal. A hair of noise, the same every time, keeps two equal items from waiting
/// for each other for ever.
fn similarities(n: usize, similarity: impl Fn(usize, usize) -> f64, quantile: f64) -> Vec<f64> {
    let mut s = vec![0.0; n * n];
    let mut others = Vec::with_capacity(n * (n - 1));
    for i in 0..n {
        for k in 0..n {
            if i != k {
                s[i * n + k] = similarity(i, k);
                others.push(s[i * n + k]);
            }
        }
    }
    others.sort_by(f64::total_cmp);
    let at = ((others.len() - 1) as f64 * quantile.clamp(0.0, 1.0)).round() as usize;
    let scale = 1e-12 * (others[others.len() - 1] - others[0]).abs().max(1e-300);
    let mut state = 0x9E37_79B9_7F4A_7C15u64;
    for (index, value) in s.iter_mut().enumerate() {
        if index % (n + 1) == 0 {
            *value = others[at];
        }
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        *value += scale * (state >> 11) as f64 / (1u64 << 53) as f64;
    }
    s
}

/// Suitability of `k` as `i`'s exemplar, against the best other.
fn responsibilities(n: usize, s: &[f64], a: &[f64], r: &mut [f64], damping: f64) {
    for i in 0..n {
        let row = i * n..(i + 1) * n;
        let (mut best, mut best_at, mut second) = (f64::NEG_INFINITY, 0, f64::NEG_INFINITY);
        for (k, (s, a)) in s[row.clone()].iter().zip(&a[row.clone()]).enumerate() {
            let sum = s + a;
            if sum > best {
                (second, best, best_at) = (best, sum, k);
            } else if sum > second {
                second = sum;
            }
        }
        for k in 0..n {
            let other = if k == best_at { second } else { best };
            r[i * n + k] = damping * r[i * n + k] + (1.0 - damping) * (s[i * n + k] - other);
        }
    }
}

/// Support of others for `k` as an exemplar.
fn availabilities(n: usize, r: &[f64], a: &mut [f64], damping: f64) {
    let mut support = vec![0.0; n];
    for i in 0..n {
        for k in 0..n {
            support[k] += if i == k {
                r[i * n + k]
            } else {
                r[i * n + k].max(0.0)
            };
        }
    }
    for i in 0..n {
        for k in 0..n {
            let own = r[i * n + k];
            let fresh = if i == k {
                support[k] - own
            } else {
                (support[k] - own.max(0.0)).min(0.0)
            };
            a[i * n + k] = damping * a[i * n + k] + (1.0 - damping) * fresh;
        }
    }
}

/// Every item to its most similar exemplar; exemplars to themselves. Clusters in order of their first items.
fn assign(n: usize, s: &[f64], exemplars: &[usize]) -> Clusters {
    if exemplars.is_empty() {
        return Clusters {
            of: vec![0; n],
            count: 1,
        };
    }
    let nearest = |i: usize| {
        let own = exemplars.iter().position(|&k| k == i);
        own.or_else(|| {
            (0..exemplars.len())
                .max_by(|&a, &b| s[i * n + exemplars[a]].total_cmp(&s[i * n + exemplars[b]]))
        })
        .unwrap_or(0)
    };
    super::clusters::numbered((0..n).map(nearest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heaps_on_a_line_are_groups() {
        let points: Vec<f64> = [0.0, 10.0, 25.0]
            .iter()
            .flat_map(|c| (0..7).map(move |i| c + 0.1 * f64::from(i)))
            .collect();
        let near = |a: usize, b: usize| -(points[a] - points[b]).powi(2);
        let groups = affinity_propagation(points.len(), near, &AffinityParams::default());
        assert_eq!(groups.count, 3);
        assert!((0..21).all(|i| groups.of[i] == i / 7));
    }

    #[test]
    fn none_one_and_equal_items() {
        assert_eq!(
            affinity_propagation(0, |_, _| 0.0, &AffinityParams::default()).count,
            0
        );
        assert_eq!(
            affinity_propagation(1, |_, _| 0.0, &AffinityParams::default()).of,
            [0]
        );
        let same = affinity_propagation(5, |_, _| 0.0, &AffinityParams::default());
        assert!(same.count >= 1 && same.of.iter().all(|g| *g < same.count));
    }
}
