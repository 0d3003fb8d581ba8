//! A search that reads only some of many clips: chooses the next clips to read, and stops when no other clip can be better.

use rayon::prelude::*;

use super::bound::{BoundDepth, SketchedClips, lower_bounds};
use super::codes::SketchCodes;
use super::rank::windows_wanted;
use super::{Example, Hit, SearchIndex, SearchOptions};
use crate::ClipId;
use crate::rows::ClipRows;

/// One clip in this many, the likeliest, is bound closely before all others.
const LIKELY_ONE_IN: usize = 20;
/// At least this many clips are, for each window that is wanted.
const LIKELY_PER_WINDOW: usize = 8;

/// Clips that are read at once: this many may be read in vain.
const BATCH: usize = 128;
/// Batches of the likeliest clips: after these the nearest windows are so near that closer bounds exclude most clips.
const BATCHES: usize = 4;

/// Distances within this factor of the last that counts are ranked with it.
const TIES: f32 = 1.0 + 1e-4;

/// A search among clips of which there are [sketches](super::sketch_of): says which clips to read until no other can hold one of
/// the nearest windows.
///
/// First are the clips that are likeliest by their [codes](SketchCodes): these are bound closely, and the nearest of them are read.
/// The distance of the windows that are found then excludes most others, by their boxes first and what is left by close bounds.
/// After all are read that have to be, [`hits`](Self::hits) are those of a [search](SearchIndex::search) among all clips.
#[derive(Debug, Clone)]
pub struct SearchPlan {
    example: Example,
    options: SearchOptions,
    /// For each clip a lower bound of its distance.
    bounds: Vec<f32>,
    /// Places of clips that may still be read, in order, and whether they are all that may hold a window.
    left: Vec<usize>,
    has_all: bool,
    /// Places of clips that were looked at before all others, in order.
    likeliest: Vec<usize>,
    batches: usize,
    /// The nearest windows so far: their distances and clips, nearest first.
    found: Vec<(f32, ClipId)>,
    /// The clips that hold them.
    near: SearchIndex,
    /// Windows that are looked at.
    wanted: usize,
}

impl SearchPlan {
    /// A search among these clips, by `codes` if there are many. `tick_hz` rows are a second. O(codes), in parallel; without codes
    /// a bound for each clip.
    pub fn new(
        example: &Example,
        options: &SearchOptions,
        tick_hz: f64,
        clips: &impl SketchedClips,
        codes: Option<&SketchCodes>,
    ) -> Self {
        let mut plan = Self {
            example: example.clone(),
            options: options.clone(),
            bounds: vec![0.0; clips.count()],
            left: Vec::new(),
            has_all: false,
            likeliest: Vec::new(),
            batches: BATCHES,
            found: Vec::new(),
            near: SearchIndex::new(&[], tick_hz),
            wanted: windows_wanted(options),
        };
        match codes {
            Some(codes) => plan.look_at_likeliest(codes, clips),
            None => plan.look_at_all(clips),
        }
        plan
    }

    /// Bounds the clips closely that are likeliest by their codes.
    fn look_at_likeliest(&mut self, codes: &SketchCodes, clips: &impl SketchedClips) {
        let estimates = codes.estimates(&self.example, &self.options, clips);
        let is_searched = |at: &usize| estimates[*at] < f32::INFINITY;
        self.left = (0..estimates.len()).filter(is_searched).collect();
        let count = (clips.count() / LIKELY_ONE_IN).max(LIKELY_PER_WINDOW * self.wanted);
        least(&estimates, &mut self.left, count);
        self.bound(BoundDepth::Eighths, clips);
        self.likeliest.clone_from(&self.left);
    }

    /// Bounds all clips that were not looked at, and keeps those that may hold a window within reach.
    fn look_at_all(&mut self, clips: &impl SketchedClips) {
        let known = std::mem::take(&mut self.left);
        let is_new = |at: &usize| self.likeliest.binary_search(at).is_err();
        self.left = (0..clips.count()).filter(is_new).collect();
        for depth in [BoundDepth::Box, BoundDepth::Eighths] {
            self.bound(depth, clips);
        }
        self.left.extend(known);
        self.left.sort_unstable();
        self.has_all = true;
    }

    /// Bounds all that is left, and leaves what may be within reach.
    fn bound(&mut self, depth: BoundDepth, clips: &impl SketchedClips) {
        let of_these = self.left.par_iter().map(|at| clips.clip(*at));
        let reach = self.reach();
        let bounds = lower_bounds(&self.example, &self.options, depth, reach, of_these);
        for (at, bound) in self.left.iter().zip(bounds) {
            self.bounds[*at] = bound;
        }
        self.keep_within(reach);
    }

    fn keep_within(&mut self, reach: f32) {
        let bounds = &self.bounds;
        self.left
            .retain(|at| bounds[*at] <= reach && bounds[*at] < f32::INFINITY);
    }

    /// The distance beyond which no window counts, as far as it is known.
    fn reach(&self) -> f32 {
        let last = self.wanted.checked_sub(1).and_then(|at| self.found.get(at));
        last.map_or(f32::INFINITY, |(distance, _)| TIES * distance)
    }

    /// Clips, by their places, that have to be read now; none if enough has been read. They count as read. `clips` are those of
    /// [`new`](Self::new). Unless it is `exact`, the search ends with the likeliest clips, and others could hold nearer windows.
    pub fn next_to_read(&mut self, exact: bool, clips: &impl SketchedClips) -> Vec<usize> {
        let is_known = self.batches == 0 && self.reach() < f32::INFINITY;
        if exact && !self.has_all && (is_known || self.left.is_empty()) {
            self.look_at_all(clips);
        }
        let mut next = self.left.clone();
        least(&self.bounds, &mut next, BATCH);
        self.left.retain(|at| next.binary_search(at).is_err());
        self.batches = self.batches.saturating_sub(1);
        next
    }

    /// Takes the rows of clips that were read, or of others of which there is no sketch.
    pub fn take(&mut self, rows: &[ClipRows]) {
        let read = SearchIndex::new(rows, self.near.tick_hz);
        let windows = read.nearest_windows(&self.example, &self.options);
        let windows = windows.into_iter().map(|(clip, far)| (far, clip));
        self.found.extend(windows);
        self.found
            .sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let reach = self.reach();
        self.found.retain(|(distance, _)| *distance <= reach);
        // How near windows must be is never more than it was.
        self.keep_within(reach);
        // No more is held than may be needed.
        let mut chosen: Vec<ClipId> = self.found.iter().map(|(_, clip)| *clip).collect();
        chosen.sort_unstable();
        let near = &mut self.near.clips;
        near.extend(read.clips);
        near.retain(|clip| chosen.binary_search(&clip.clip).is_ok());
        near.sort_unstable_by_key(|clip| clip.clip);
    }

    /// The hits among the clips that were read, best first.
    pub fn hits(&self) -> Vec<Hit> {
        self.near.search(&self.example, &self.options)
    }
}

/// Keeps this many of some places, those of the least values, in order.
fn least(values: &[f32], places: &mut Vec<usize>, count: usize) {
    if places.len() > count {
        places.select_nth_unstable_by(count, |a, b| {
            values[*a].total_cmp(&values[*b]).then(a.cmp(b))
        });
        places.truncate(count);
        places.sort_unstable();
    }
}
