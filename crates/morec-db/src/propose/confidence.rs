//! From distances to how likely a proposal is right, learned from the answers so far.
//!
//! Logistic regression on three logarithmic ratios that mean the same for every class: how far a stretch is from its class
//! beside how far samples of the class are from one another, beside the nearest other class, beside the nearest rejected
//! stretch. Answers are few, so the weights are drawn to values that hold for motion at large (a Gaussian prior about
//! [`USUAL`]); the more answers, the more they say themselves.

use nalgebra::{SMatrix, SVector};

use morec::templates::Evidence;

/// Constant, own distance, other classes, rejected stretches.
const FEATURES: usize = 4;
const USUAL: [f64; FEATURES] = [-0.5, -1.5, -2.5, -1.5];
/// Standard deviations of the weights around the usual ones.
const STRAY: [f64; FEATURES] = [0.7, 0.5, 0.5, 0.5];
/// Assumed distance between samples of a class with one sample, as a share of the distance to the next class.
const APART: f64 = 0.3;
/// The same where the next class is the nearest anywhere in a clip, not at one place.
const APART_WHOLE: f64 = 0.7;
/// Distances of the classes together count as this many of a class's own.
const SHARED: f64 = 2.0;
/// Ratios beyond these say no more.
const BOUNDS: (f64, f64) = (-2.0, 2.5);

/// A stretch that was judged, as a proposal of `class`.
pub struct Judgement {
    pub class: usize,
    pub evidence: Evidence,
    pub right: bool,
    /// True if the clip as a whole was judged.
    pub whole: bool,
}

pub struct Confidence {
    /// Distance between the samples of each class.
    scales: Vec<f64>,
    weights: SVector<f64, FEATURES>,
}

/// Distances from here on are of what was not found.
pub const NEAR_NOTHING: f64 = 1e20;

impl Confidence {
    /// O(judgements).
    pub fn learn(classes: usize, judgements: &[Judgement]) -> Self {
        let scales = scales(classes, judgements);
        let mut confidence = Self {
            scales,
            weights: SVector::from(USUAL),
        };
        let examples: Vec<(SVector<f64, FEATURES>, f64)> = judgements
            .iter()
            .filter(|j| j.evidence.distance < NEAR_NOTHING)
            .map(|j| {
                (
                    confidence.features(j.class, &j.evidence),
                    if j.right { 1.0 } else { 0.0 },
                )
            })
            .collect();
        confidence.weights = fit(&examples);
        confidence
    }

    /// Probability that the stretch shows the class.
    pub fn of(&self, class: usize, evidence: &Evidence) -> f64 {
        logistic(self.weights.dot(&self.features(class, evidence)))
    }

    fn features(&self, class: usize, evidence: &Evidence) -> SVector<f64, FEATURES> {
        let distance = evidence.distance.max(1e-6);
        // What is nowhere near is as far as four times the usual.
        let far = 4.0 * self.scales[class];
        let beside = |other: f64| {
            (distance / other.clamp(1e-6, far))
                .ln()
                .clamp(BOUNDS.0, BOUNDS.1)
        };
        let own = (distance / self.scales[class])
            .ln()
            .clamp(BOUNDS.0, BOUNDS.1);
        SVector::from([1.0, own, beside(evidence.other), beside(evidence.negative)])
    }
}

fn logistic(x: f64) -> f64 {
    1.0 / (1.0 + (-x).exp())
}

/// Geometric means of the distances of accepted samples from the others of their class, each class's drawn to that of
/// all.
fn scales(classes: usize, judgements: &[Judgement]) -> Vec<f64> {
    let mut own = vec![(0.0, 0.0); classes];
    let mut others: Vec<f64> = Vec::new();
    for j in judgements.iter().filter(|j| j.right) {
        if j.evidence.distance < NEAR_NOTHING {
            own[j.class].0 += j.evidence.distance.max(1e-6).ln();
            own[j.class].1 += 1.0;
        }
        if j.evidence.other < NEAR_NOTHING {
            let apart = if j.whole { APART_WHOLE } else { APART };
            others.push((apart * j.evidence.other.max(1e-6)).ln());
        }
    }
    others.sort_by(f64::total_cmp);
    let from_others = others.get(others.len() / 2).map_or(0.5_f64.ln(), |d| *d);
    let taught = own.iter().filter(|(_, n)| *n > 0.0);
    let (sum, n) = taught.fold((from_others, 1.0), |(sum, n), (of, count)| {
        (sum + of / count, n + 1.0)
    });
    let all = sum / n;
    own.into_iter()
        .map(|(sum, n)| ((sum + SHARED * all) / (n + SHARED)).exp())
        .collect()
}

/// The likeliest weights, by Newton's method; the prior keeps it convex and finite.
fn fit(examples: &[(SVector<f64, FEATURES>, f64)]) -> SVector<f64, FEATURES> {
    let usual = SVector::from(USUAL);
    let precision = SMatrix::<f64, FEATURES, FEATURES>::from_diagonal(&SVector::from(
        STRAY.map(|s| 1.0 / (s * s)),
    ));
    let mut weights = usual;
    for _ in 0..30 {
        let mut gradient = precision * (usual - weights);
        let mut curvature = precision;
        for (x, target) in examples {
            let p = logistic(weights.dot(x));
            gradient += x * (target - p);
            curvature += x * x.transpose() * (p * (1.0 - p));
        }
        let Some(step) = curvature.cholesky().map(|c| c.solve(&gradient)) else {
            break;
        };
        // A long step may overshoot where the logistic is flat.
        let step = step * (1.0 / step.norm().max(1.0));
        weights += step;
        if step.norm() < 1e-6 {
            break;
        }
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::*;

    fn judged(class: usize, distance: f64, negative: f64, right: bool) -> Judgement {
        let evidence = Evidence {
            distance,
            other: 3.0,
            negative,
        };
        Judgement {
            class,
            evidence,
            right,
            whole: false,
        }
    }

    fn at(distance: f64) -> Evidence {
        Evidence {
            distance,
            other: 3.0,
            negative: 1e30,
        }
    }

    #[test]
    fn nearer_is_likelier_and_what_is_like_a_rejected_stretch_is_not() {
        let confidence =
            Confidence::learn(1, &[judged(0, 0.5, 1e30, true), judged(0, 0.6, 1e30, true)]);
        let scores: Vec<f64> = [0.2, 0.5, 1.0, 2.0, 5.0]
            .map(|d| confidence.of(0, &at(d)))
            .to_vec();
        assert!(
            scores.windows(2).all(|pair| pair[0] > pair[1]),
            "{scores:?}"
        );
        assert!(scores[1] > 0.5 && scores[4] < 0.1, "{scores:?}");
        let beside = Evidence {
            negative: 0.2,
            ..at(0.5)
        };
        assert!(confidence.of(0, &beside) < confidence.of(0, &at(0.5)));
    }

    #[test]
    fn a_class_whose_samples_differ_more_may_be_farther() {
        let of = |class, distance| judged(class, distance, 1e30, true);
        let judgements: Vec<Judgement> = (0..6).flat_map(|_| [of(0, 0.2), of(1, 0.8)]).collect();
        let confidence = Confidence::learn(2, &judgements);
        assert!(confidence.of(1, &at(0.8)) > 0.5);
        assert!(confidence.of(0, &at(0.8)) < confidence.of(1, &at(0.8)));
    }

    #[test]
    fn answers_move_the_bar() {
        let mut judgements: Vec<Judgement> = (0..10).map(|_| judged(0, 0.5, 1e30, true)).collect();
        let before = Confidence::learn(1, &judgements).of(0, &at(0.7));
        judgements.extend((0..40).map(|_| judged(0, 0.7, 1e30, false)));
        let after = Confidence::learn(1, &judgements);
        assert!(after.of(0, &at(0.7)) < before.min(0.5));
        assert!(after.of(0, &at(0.5)) > after.of(0, &at(0.7)));
    }

    #[test]
    fn with_no_answer_there_is_still_a_guess() {
        let confidence = Confidence::learn(
            2,
            &[judged(0, 1e30, 1e30, true), judged(1, 1e30, 1e30, true)],
        );
        assert!(confidence.of(0, &at(0.1)) > 0.5 && confidence.of(1, &at(9.0)) < 0.5);
    }
}
