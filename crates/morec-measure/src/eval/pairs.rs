//! Detections matched one to one with samples of their class, and F1 from that.

use std::collections::VecDeque;

use serde::Serialize;

use super::EvaluatedStream;
use super::figures::share;
use super::spans::reaches;

/// Precision, recall and F1 where a detection must overlap a sample of its class by an intersection over union
/// of at least `min_iou`, and each counts once.
///
/// The pairing is the largest there is, so the counts do not depend on the order in which pairs are tried.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OverlapScore {
    /// Least intersection over union.
    pub min_iou: f64,
    /// Pairs: true positives.
    pub matched: usize,
    /// Samples without a partner: false negatives.
    pub missed: usize,
    /// Detections without a partner: false positives.
    pub spurious: usize,
    /// Share of the detections that have a partner.
    pub precision: Option<f64>,
    /// Share of the samples that have a partner.
    pub recall: Option<f64>,
    /// Harmonic mean of the two, 2·matched / (samples + detections).
    pub f1: Option<f64>,
}

impl OverlapScore {
    pub(super) fn new(min_iou: f64, matched: usize, samples: usize, detections: usize) -> Self {
        Self {
            min_iou,
            matched,
            missed: samples - matched,
            spurious: detections - matched,
            precision: share(matched, detections),
            recall: share(matched, samples),
            f1: share(2 * matched, samples + detections),
        }
    }
}

/// Pairs of indices (sample, detection) of a stream, of one class each, by sample.
///
/// Pairs are taken by falling overlap first; then, as long as another pair is possible at all, partners are
/// changed along augmenting paths. The number of pairs is therefore the largest possible.
/// O(samples × possible pairs) at worst; hardly more than the sorting where detections are sparse.
pub(super) fn pair(stream: &EvaluatedStream<'_>, min_iou: f64) -> Vec<(usize, usize)> {
    let mut edges: Vec<(f64, usize, usize)> = Vec::new();
    for (t, truth) in stream.truths.iter().enumerate() {
        for (f, found) in stream.founds.iter().enumerate() {
            if truth.class == found.class && reaches(truth.span, found.span, min_iou) {
                edges.push((truth.span.iou(found.span), t, f));
            }
        }
    }
    edges.sort_by(|a, b| b.0.total_cmp(&a.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let mut pairing = Pairing::new(stream.truths.len(), stream.founds.len());
    for (_, t, f) in edges {
        pairing.edges_of_truth[t].push(f);
        if pairing.of_truth[t].is_none() && pairing.of_found[f].is_none() {
            pairing.join(t, f);
        }
    }
    for t in 0..stream.truths.len() {
        pairing.augment_from(t);
    }
    pairing
        .of_truth
        .iter()
        .enumerate()
        .filter_map(|(t, f)| Some((t, (*f)?)))
        .collect()
}

struct Pairing {
    edges_of_truth: Vec<Vec<usize>>,
    of_truth: Vec<Option<usize>>,
    of_found: Vec<Option<usize>>,
}

impl Pairing {
    fn new(truths: usize, founds: usize) -> Self {
        Self {
            edges_of_truth: vec![Vec::new(); truths],
            of_truth: vec![None; truths],
            of_found: vec![None; founds],
        }
    }

    fn join(&mut self, t: usize, f: usize) {
        self.of_truth[t] = Some(f);
        self.of_found[f] = Some(t);
    }

    /// Looks for an augmenting path from an unpaired sample, breadth first, and flips it.
    fn augment_from(&mut self, start: usize) {
        if self.of_truth[start].is_some() || self.edges_of_truth[start].is_empty() {
            return;
        }
        // From which sample each detection was reached.
        let mut reached_from: Vec<Option<usize>> = vec![None; self.of_found.len()];
        let mut queue = VecDeque::from([start]);
        while let Some(t) = queue.pop_front() {
            for &f in &self.edges_of_truth[t] {
                if reached_from[f].is_some() {
                    continue;
                }
                reached_from[f] = Some(t);
                match self.of_found[f] {
                    Some(next) => queue.push_back(next),
                    None => return self.flip(f, &reached_from),
                }
            }
        }
    }

    /// Re-pairs along the path that ends at the unpaired detection `f`.
    fn flip(&mut self, f: usize, reached_from: &[Option<usize>]) {
        let mut next = Some(f);
        while let Some(f) = next {
            let Some(t) = reached_from[f] else { return };
            next = self.of_truth[t];
            self.join(t, f);
        }
    }
}
