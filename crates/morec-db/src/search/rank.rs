//! The ranking of a search: candidates by summary, their neighbourhood in a graph, and exact extents by warping.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use morec::TimeSpan;
use morec::features::BoneSet;
use morec::templates::TemplateBank;
use rayon::prelude::*;

use super::candidates::{Descriptor, QueryDescriptor, WindowDistance, length_cost};
use super::graph::{SCALE_NEIGHBOUR, spread};
use super::layout::{CanonicalRows, mirrored, opposite_bones, shared_columns};
use super::learned::LearnedMetric;
use super::summary::{SummaryDistance, mirrored_summary};
use super::windows::shown;
use super::{Example, SearchIndex};
use crate::ClipId;

/// What a search returns, and how it ranks.
#[derive(Debug, Clone, PartialEq)]
pub struct SearchOptions {
    /// Most hits.
    pub limit: usize,
    /// Look for the mirror image too.
    pub mirror: bool,
    /// One hit for each clip, its best.
    pub one_a_clip: bool,
    /// Weight of the distance along the warping path against that of the summary and its neighbourhood, 0 to 1.
    pub warp_share: f32,
}

impl Default for SearchOptions {
    fn default() -> Self {
        Self {
            limit: 20,
            mirror: false,
            one_a_clip: false,
            warp_share: 0.0,
        }
    }
}

/// A stretch that is like the example.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Hit {
    /// Number of the clip.
    #[serde(rename = "clip_id")]
    pub clip: ClipId,
    /// From where to where in the clip.
    #[serde(flatten)]
    pub span: TimeSpan,
    /// 1 for the same motion, towards 0 for another.
    pub score: f32,
    /// Mean squared distance along the warping path.
    pub warp_distance: f32,
    /// True if its mirror image is what is like the example.
    pub mirrored: bool,
}

/// Windows that the graph links at least, as far as there are that many, and at most: distances of all pairs are taken.
const LINKED: std::ops::RangeInclusive<usize> = 300..=1200;

/// Weight of the neighbourhood score, which is the logarithm of its share.
const COMPANY: f32 = 0.67;

/// Least share of similarity that counts as reached.
const UNREACHED: f32 = 1e-6;

/// Costs of unlike motion are some times this.
const UNLIKE: f32 = 3.0;

impl SearchIndex {
    /// The stretches most like `example`, best first. O(rows / example rows) summaries; a graph of the nearest few
    /// hundred (of up to 1,200 for many hits), O(windows²); then exact warping of a few times `limit`.
    pub fn search(&self, example: &Example, options: &SearchOptions) -> Vec<Hit> {
        self.search_by(example, options, None)
    }

    /// The same by a learned metric and the usual one, half each.
    pub fn search_by(
        &self,
        example: &Example,
        options: &SearchOptions,
        metric: Option<&LearnedMetric>,
    ) -> Vec<Hit> {
        let probes = probes(example, options, metric);
        let candidates = self.candidates(example, &probes, options.one_a_clip);
        let mut ranked = self.ranked(candidates, example, options, &probes, metric);
        // Places move a little and may come to overlap.
        ranked.truncate(placed(options));
        let image = options.mirror.then(|| Example {
            laid: mirrored(&example.laid),
            ..example.clone()
        });
        let place = |found: &Ranked| {
            let mirrored = found.candidate.mirrored;
            let shown = image.as_ref().filter(|_| mirrored).unwrap_or(example);
            let probe = probes.last().filter(|_| mirrored).unwrap_or(&probes[0]);
            self.place(found, shown, probe, options)
        };
        let mut hits: Vec<Hit> = ranked.par_iter().map(place).collect();
        hits.sort_by(|a, b| b.score.total_cmp(&a.score).then(a.clip.cmp(&b.clip)));
        let mut kept: Vec<Hit> = Vec::new();
        for hit in hits {
            let same = |k: &Hit| {
                k.clip == hit.clip && (options.one_a_clip || k.span.overlap_share(hit.span) > 0.3)
            };
            if kept.len() < options.limit && !kept.iter().any(same) {
                kept.push(hit);
            }
        }
        kept
    }

    /// The clips in which the nearest windows lie, nearest first, and how near these are: enough that a search among them
    /// alone gives what a search among all clips gives. For searching in parts: the nearest clips of the nearest clips of
    /// each part are those of the whole.
    pub fn nearest_clips(&self, example: &Example, options: &SearchOptions) -> Vec<(ClipId, f32)> {
        let probes = probes(example, options, None);
        let candidates = self.candidates(example, &probes, options.one_a_clip);
        let wanted = windows_wanted(options);
        let mut seen = BTreeSet::new();
        let mut nearest = Vec::new();
        for candidate in candidates {
            if nearest.len() == wanted {
                break;
            }
            if seen.insert(candidate.clip) {
                nearest.push((self.clips[candidate.clip].clip, candidate.distance));
            }
        }
        nearest
    }

    /// The clips of the nearest windows, and how near these are, nearest first: as many as a search looks at, and of one hit
    /// for each clip its nearest alone. A clip of which no window is as near as the last of these says nothing to the search,
    /// whatever part of the archive each was found in.
    pub fn nearest_windows(
        &self,
        example: &Example,
        options: &SearchOptions,
    ) -> Vec<(ClipId, f32)> {
        let probes = probes(example, options, None);
        let mut seen = BTreeSet::new();
        self.candidates(example, &probes, options.one_a_clip)
            .into_iter()
            .filter(|window| !options.one_a_clip || seen.insert(window.clip))
            .take(windows_wanted(options))
            .map(|window| (self.clips[window.clip].clip, window.distance))
            .collect()
    }

    /// Candidates with the company they keep, cheapest first.
    fn ranked(
        &self,
        candidates: Vec<WindowDistance>,
        example: &Example,
        options: &SearchOptions,
        probes: &[QueryDescriptor<'_>],
        metric: Option<&LearnedMetric>,
    ) -> Vec<Ranked> {
        // Where clips are asked for, a clip is one node, at its nearest window.
        let mut seen = BTreeSet::new();
        let node = |c: &&WindowDistance| !options.one_a_clip || seen.insert(c.clip);
        let linked = candidates.iter().filter(node).take(linked(options));
        let nodes: Vec<&WindowDistance> = linked.collect();
        let reached = self.company(&nodes, example, probes, metric);
        let of_node: BTreeMap<(usize, usize), f32> = nodes
            .iter()
            .zip(&reached)
            .map(|(c, r)| (key(c, options), *r))
            .collect();
        let scale = nodes
            .get(SCALE_NEIGHBOUR.min(nodes.len()).max(1) - 1)
            .map_or(1.0, |c| c.distance);
        let rank = |candidate: WindowDistance| {
            let reached = of_node
                .get(&key(&candidate, options))
                .map_or(UNREACHED, |r| r.max(UNREACHED));
            Ranked {
                candidate,
                reached,
                scale: scale.max(1e-6),
            }
        };
        let mut ranked: Vec<Ranked> = candidates.into_iter().map(rank).collect();
        ranked.sort_by(|a, b| {
            a.cost(a.candidate.distance)
                .total_cmp(&b.cost(b.candidate.distance))
        });
        ranked
    }

    /// Neighbourhood score of each candidate. Mirrored ones stand in the graph as the example sees them.
    fn company(
        &self,
        candidates: &[&WindowDistance],
        example: &Example,
        probes: &[QueryDescriptor<'_>],
        metric: Option<&LearnedMetric>,
    ) -> Vec<f32> {
        let whole = probes.iter().any(|probe| probe.whole);
        let node = |c: &&WindowDistance| {
            let clip = &self.clips[c.clip];
            let (summary, bones) = (clip.sums.octaves(&c.span), clip.laid.bones);
            let (summary, bones) = if c.mirrored {
                (mirrored_summary(&summary), opposite_bones(bones))
            } else {
                (summary, bones)
            };
            GraphNode {
                look: Descriptor::new(summary, c.span.len(), bones, metric),
                bones,
                rows: clip.laid.rows.len(),
            }
        };
        let nodes: Vec<GraphNode> = candidates.par_iter().map(node).collect();
        spread(nodes.len() + 1, |i, j| {
            let (i, j) = (i.min(j), i.max(j));
            if i == 0 {
                return candidates[j - 1].distance;
            }
            let (a, b) = (&nodes[i - 1], &nodes[j - 1]);
            let over = SummaryDistance::over(a.bones.and(b.bones).and(example.laid.bones));
            let lengths = if whole {
                length_cost(a.rows.min(b.rows), a.rows.max(b.rows), 1.4)
            } else {
                0.0
            };
            a.look.distance(&b.look, &over) + lengths
        })
    }

    /// Exact place of the example near a candidate.
    fn place(
        &self,
        ranked: &Ranked,
        example: &Example,
        probe: &QueryDescriptor<'_>,
        options: &SearchOptions,
    ) -> Hit {
        let candidate = &ranked.candidate;
        let clip = &self.clips[candidate.clip];
        let n = example.laid.rows.len();
        let mut around = candidate.span.start.saturating_sub(n / 3)
            ..(candidate.span.end + n / 3).min(clip.laid.rows.len());
        // The example itself is no hit: beside it, paths, of half its length at least, stay out of all but a sixth of it.
        if let Some((_, own)) = example
            .from
            .as_ref()
            .filter(|(id, _)| *id == clip.clip && !candidate.mirrored)
        {
            match candidate.span.start < own.start {
                true => around.end = around.end.min(own.start + n / 6),
                false => around.start = around.start.max(own.end - n / 6),
            }
        }
        let shared = example.laid.bones.and(clip.laid.bones);
        // A clip of less than half the example's length holds no path: its summary alone says how near it is.
        let (warp, span) = warp(&example.laid, &clip.laid, around, &shared_columns(shared))
            .unwrap_or_else(|| (candidate.distance.powi(2), candidate.span.clone()));
        let share = options.warp_share;
        // Windows lie a quarter apart: in its place the stretch may be nearer than its window was.
        let cost = ranked.cost(candidate.distance.min(probe.distance_of(clip, &span)));
        let cost = (1.0 - share) * cost + share * warp.max(0.0).sqrt();
        Hit {
            clip: clip.clip,
            span: TimeSpan::of_frames(span, self.tick_hz),
            score: (-cost / UNLIKE).exp(),
            warp_distance: warp,
            mirrored: candidate.mirrored,
        }
    }
}

/// Descriptors of the example, and of its mirror image if that is searched for.
pub fn probes<'a>(
    example: &Example,
    options: &SearchOptions,
    metric: Option<&'a LearnedMetric>,
) -> Vec<QueryDescriptor<'a>> {
    // Whoever shows a clip and asks for clips compares wholes.
    let whole = example.whole && options.one_a_clip;
    let mut probes = vec![QueryDescriptor::new(example, metric, false, whole)];
    if options.mirror {
        probes.push(QueryDescriptor::new(example, metric, true, whole));
    }
    probes
}

/// Candidates that the graph links.
fn linked(options: &SearchOptions) -> usize {
    (8 * options.limit).clamp(*LINKED.start(), *LINKED.end())
}

/// Windows that a search looks at: what the graph links, and beyond it what is ranked by distance alone.
pub fn windows_wanted(options: &SearchOptions) -> usize {
    linked(options) + placed(options)
}

/// Candidates that are placed exactly.
fn placed(options: &SearchOptions) -> usize {
    4 * options.limit.max(8)
}

/// A candidate and the company it keeps.
struct Ranked {
    candidate: WindowDistance,
    /// Its neighbourhood score.
    reached: f32,
    /// The distance of the nearest few candidates.
    scale: f32,
}

impl Ranked {
    /// Cost of a stretch at this distance, with its neighbourhood score. What is the
    /// example over again needs no company.
    fn cost(&self, distance: f32) -> f32 {
        let apart = 1.0 - (-(distance / self.scale).powi(2)).exp();
        distance - COMPANY * apart * self.reached.ln()
    }
}

/// Key of a node: a clip, or a window of it.
fn key(c: &WindowDistance, options: &SearchOptions) -> (usize, usize) {
    (c.clip, if options.one_a_clip { 0 } else { c.span.start })
}

/// A candidate in the graph.
struct GraphNode {
    look: Descriptor,
    bones: BoneSet,
    /// Of its whole clip.
    rows: usize,
}

/// The best path of `example` through rows `within` of a clip, by these columns: mean squared distance, and where it lies.
pub fn warp(
    example: &CanonicalRows,
    clip: &CanonicalRows,
    within: Range<usize>,
    columns: &[usize],
) -> Option<(f32, Range<usize>)> {
    let shared = example.bones.and(clip.bones);
    let mut bank = TemplateBank::new(&[example.rows.columns(columns)], columns.len());
    let stream = clip.rows.slice(within.clone()).columns(columns);
    let mut best: Option<(f32, Range<usize>)> = None;
    let mut tick = within.start;
    bank.step_through(stream.iter(), |bank| {
        let found = bank.matched(0);
        tick += 1;
        if found.distance < 1e20 && best.as_ref().is_none_or(|(d, _)| found.distance < *d) {
            best = Some((found.distance, tick - 1 - found.age..tick));
        }
    });
    let (_, share) = shown(shared);
    best.map(|(distance, span)| (distance / share, span))
}
