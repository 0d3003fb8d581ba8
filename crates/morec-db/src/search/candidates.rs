//! The first stage of a search: windows of all clips are compared with the example by their summaries.

use std::ops::Range;

use morec::features::BoneSet;
use rayon::prelude::*;

use super::learned::{Embedding, LearnedMetric};
use super::summary::{MomentVector, Summary, SummaryDistance, mirrored_summary, moments_in};
use super::{Example, Indexed, SearchIndex};

/// A window and how far it is from the example.
#[derive(Debug, Clone)]
pub struct WindowDistance {
    pub clip: usize,
    pub span: Range<usize>,
    pub distance: f32,
    pub mirrored: bool,
}

/// Example lengths that windows are tried at.
const SCALES: [f64; 3] = [0.7, 1.0, 1.4];

/// Windows of a clip of which only the best is wanted.
const A_CLIP: usize = 4;

/// Descriptor of the example, or of its mirror image, for comparison with windows.
pub struct QueryDescriptor<'a> {
    pub look: Descriptor,
    pub bones: BoneSet,
    mirrored: bool,
    metric: Option<&'a LearnedMetric>,
    rows: usize,
    /// Clips are compared as wholes: what a clip has beyond the example's length counts, too.
    pub whole: bool,
}

/// A stretch as it is compared.
pub struct Descriptor {
    pub summary: Summary,
    pub place: Option<Embedding>,
}

impl Descriptor {
    pub fn new(
        summary: Summary,
        rows: usize,
        bones: BoneSet,
        metric: Option<&LearnedMetric>,
    ) -> Self {
        Self {
            place: metric.map(|m| m.place(&summary, rows, bones)),
            summary,
        }
    }

    /// By their summaries; with a learned metric half by it.
    pub fn distance(&self, other: &Self, comparison: &SummaryDistance) -> f32 {
        let plain = comparison.distance(&self.summary, &other.summary);
        match (&self.place, &other.place) {
            (Some(a), Some(b)) => 0.5 * (plain + a.distance(b)),
            _ => plain,
        }
    }
}

impl<'a> QueryDescriptor<'a> {
    pub fn new(
        example: &Example,
        metric: Option<&'a LearnedMetric>,
        mirrored: bool,
        whole: bool,
    ) -> Self {
        let rows = example.laid.rows.len();
        let plain = super::Sums::of(&example.laid.rows).octaves(&(0..rows));
        let (summary, bones) = if mirrored {
            (
                mirrored_summary(&plain),
                super::layout::opposite_bones(example.laid.bones),
            )
        } else {
            (plain, example.laid.bones)
        };
        Self {
            look: Descriptor::new(summary, rows, bones, metric),
            bones,
            mirrored,
            metric,
            rows,
            whole,
        }
    }

    /// Distance of a stretch of a clip.
    pub fn distance_of(&self, clip: &Indexed, span: &Range<usize>) -> f32 {
        let over = SummaryDistance::over(self.bones.and(clip.laid.bones));
        self.distance(clip, span, &clip.sums.octaves(span), &over)
    }

    fn distance(
        &self,
        clip: &Indexed,
        span: &Range<usize>,
        summary: &Summary,
        over: &SummaryDistance,
    ) -> f32 {
        let look = Descriptor::new(*summary, span.len(), clip.laid.bones, self.metric);
        let excess = if self.whole {
            length_cost(self.rows, clip.laid.rows.len(), 1.4)
        } else {
            0.0
        };
        self.look.distance(&look, over) + length_cost(span.len(), self.rows, pace_range()) + excess
    }
}

/// By how much a stretch may be shorter than the example without a cost.
pub fn pace_range() -> f64 {
    1.0 / SCALES[0]
}

/// Cost of `length` being less than `other` by more than a difference in pace explains: 0 to 1.
pub fn length_cost(length: usize, other: usize, pace: f64) -> f32 {
    (1.0 - pace * length as f64 / other.max(1) as f64).max(0.0) as f32
}

impl SearchIndex {
    /// The nearest windows of all clips, none of which overlap much, nearest first; of each clip a few, if only its best
    /// hit is wanted: windows lie a quarter apart, and only its exact place says which is best.
    /// O(rows / example rows) summaries.
    pub(super) fn candidates(
        &self,
        example: &Example,
        probes: &[QueryDescriptor<'_>],
        one_a_clip: bool,
    ) -> Vec<WindowDistance> {
        let of_clip = |(number, clip): (usize, &Indexed)| {
            let mut found = windows(number, clip, example, probes);
            found.sort_by(|a, b| a.distance.total_cmp(&b.distance));
            // Neighbours of a good window say the same: the best of each surroundings is enough.
            let mut kept: Vec<WindowDistance> = Vec::new();
            for candidate in found {
                let full = one_a_clip && kept.len() >= A_CLIP;
                if !full && !kept.iter().any(|k| overlaps(&k.span, &candidate.span)) {
                    kept.push(candidate);
                }
            }
            kept
        };
        let mut all: Vec<WindowDistance> = self
            .clips
            .par_iter()
            .enumerate()
            .flat_map_iter(of_clip)
            .collect();
        all.sort_by(|a, b| a.distance.total_cmp(&b.distance).then(a.clip.cmp(&b.clip)));
        all
    }
}

/// Windows of a clip at three lengths, a quarter apart, and, of wholes, the clip itself; a clip that is too short counts
/// as one window.
fn windows(
    number: usize,
    clip: &Indexed,
    example: &Example,
    probes: &[QueryDescriptor<'_>],
) -> Vec<WindowDistance> {
    let (n, rows) = (example.laid.rows.len(), clip.laid.rows.len());
    let over: Vec<SummaryDistance> = probes
        .iter()
        .map(|probe| SummaryDistance::over(probe.bones.and(clip.laid.bones)))
        .collect();
    if rows < 3
        || probes
            .iter()
            .any(|probe| probe.bones.and(clip.laid.bones).is_empty())
    {
        return Vec::new();
    }
    let whole = probes.first().filter(|probe| probe.whole).map(|_| 0..rows);
    let mut spans: Vec<Range<usize>> = spans(n, rows).chain(whole).collect();
    if !probes.iter().any(|probe| probe.whole) {
        spans = nearest_by_moments(clip, probes, &over, spans);
    }
    let mut found = Vec::new();
    for span in spans {
        let own = example
            .from
            .as_ref()
            .is_some_and(|(id, own)| *id == clip.clip && overlaps(own, &span));
        let summary = clip.sums.octaves(&span);
        for (probe, over) in probes
            .iter()
            .zip(&over)
            .filter(|(probe, _)| probe.mirrored || !own)
        {
            let distance = probe.distance(clip, &span, &summary, over);
            found.push(WindowDistance {
                clip: number,
                span: span.clone(),
                distance,
                mirrored: probe.mirrored,
            });
        }
    }
    found
}

/// Windows of a clip of `rows` rows for an example of `n`; none of less than three.
pub fn spans(n: usize, rows: usize) -> impl Iterator<Item = Range<usize>> {
    let lengths = window_lengths(n, rows.max(3)).into_iter();
    let lengths = lengths.filter(move |_| rows >= 3);
    lengths.flat_map(move |length| {
        let starts = (0..=rows - length).step_by(step(length));
        starts.map(move |start| start..start + length)
    })
}

/// Lengths of the windows of a clip of `rows` rows, three or more, for an example of `n`.
pub fn window_lengths(n: usize, rows: usize) -> [usize; SCALES.len()] {
    SCALES.map(|scale| ((n as f64 * scale).round() as usize).clamp(3, rows))
}

/// Rows from one window of a length to the next.
pub fn step(length: usize) -> usize {
    (length / 4).max(1)
}

/// Of windows in the same surroundings those that are nearest by their moments, for each probe. These cost a tenth of a
/// summary, and what they say is never more than what that says: what its octaves add is at least as long as the
/// standard deviations.
fn nearest_by_moments(
    clip: &Indexed,
    probes: &[QueryDescriptor<'_>],
    over: &[SummaryDistance],
    spans: Vec<Range<usize>>,
) -> Vec<Range<usize>> {
    let moments: Vec<MomentVector> = spans
        .iter()
        .map(|span| clip.sums.moments_of(span))
        .collect();
    let mut kept: Vec<Range<usize>> = Vec::new();
    for (probe, over) in probes.iter().zip(over) {
        let wanted = moments_in(&probe.look.summary);
        let distance = |at: usize| {
            over.by_moments(&wanted, &moments[at])
                + length_cost(spans[at].len(), probe.rows, pace_range())
        };
        let mut order: Vec<(f32, usize)> = (0..spans.len()).map(|at| (distance(at), at)).collect();
        order.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut own: Vec<Range<usize>> = Vec::new();
        for (_, at) in order {
            if !own.iter().any(|k| overlaps(k, &spans[at])) {
                own.push(spans[at].clone());
            }
        }
        kept.extend(own);
    }
    kept.sort_by_key(|span| (span.start, span.end));
    kept.dedup();
    kept
}

/// More than a third of the shorter.
fn overlaps(a: &Range<usize>, b: &Range<usize>) -> bool {
    let shared = a.end.min(b.end).saturating_sub(a.start.max(b.start));
    3 * shared > a.len().min(b.len())
}
