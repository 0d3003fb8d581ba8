//! The order in which a search reads clips of which bounds are known, and when it has read enough.

use super::rank::windows_wanted;
use super::{BoundDepth, SearchOptions};
use crate::ClipId;

/// Clips for each window that is wanted of which the bound by eighths is taken before anything has been found.
const LOOKED_AT_FIRST: usize = 4;

/// Clips that are read at once: this many may be read in vain.
const BATCH: usize = 128;

/// Distances within this factor of the last that counts are ranked with it.
const TIES: f32 = 1.0 + 1e-4;

/// A search among clips of which [lower bounds](super::lower_bounds) are known: says which clips are looked at more closely,
/// then which are read, until no other can hold one of the nearest windows.
///
/// The hits of a [search](super::SearchIndex::search) among [`chosen`](Self::chosen) are those of a search among all.
#[derive(Debug, Clone)]
pub struct SearchPlan {
    /// For each clip its bound, and how it was taken.
    bounds: Vec<(f32, BoundDepth)>,
    read: Vec<bool>,
    /// Places of clips that may still be read, in order.
    left: Vec<usize>,
    /// The nearest windows so far: their distances and clips, nearest first.
    found: Vec<(f32, ClipId)>,
    wanted: usize,
}

impl SearchPlan {
    /// Of bounds by halves.
    pub fn new(bounds: &[f32], options: &SearchOptions) -> Self {
        Self::of(bounds, BoundDepth::Halves, options)
    }

    /// Of bounds by eighths: none is wanted any more.
    pub fn by_eighths(bounds: &[f32], options: &SearchOptions) -> Self {
        Self::of(bounds, BoundDepth::Eighths, options)
    }

    fn of(bounds: &[f32], depth: BoundDepth, options: &SearchOptions) -> Self {
        Self {
            bounds: bounds.iter().map(|b| (*b, depth)).collect(),
            read: vec![false; bounds.len()],
            left: (0..bounds.len())
                .filter(|at| bounds[*at] < f32::INFINITY)
                .collect(),
            found: Vec::new(),
            wanted: windows_wanted(options),
        }
    }

    /// Clips in it.
    pub fn len(&self) -> usize {
        self.bounds.len()
    }

    /// True if there is no clip in it.
    pub fn is_empty(&self) -> bool {
        self.bounds.is_empty()
    }

    /// The distance beyond which no window counts, as far as it is known.
    pub fn reach(&self) -> f32 {
        let last = self.wanted.checked_sub(1).and_then(|at| self.found.get(at));
        last.map_or(f32::INFINITY, |(distance, _)| TIES * distance)
    }

    /// Clips, by their places, of which bounds by eighths are wanted now.
    pub fn next_to_bound(&self) -> Vec<usize> {
        let reach = self.reach();
        let mut clips = self.left_within(reach, BoundDepth::Halves);
        if reach == f32::INFINITY {
            self.least(&mut clips, LOOKED_AT_FIRST * self.wanted);
        }
        clips
    }

    /// Takes the bounds of these clips.
    pub fn bound(&mut self, clips: &[usize], bounds: &[f32]) {
        for (at, bound) in clips.iter().zip(bounds) {
            // Both are bounds.
            self.bounds[*at] = (bound.max(self.bounds[*at].0), BoundDepth::Eighths);
        }
    }

    /// Takes what another plan, for some of the clips, has found: windows of clips that were read, by their places in this one.
    pub fn known(&mut self, read: &[usize], windows: &[(ClipId, f32)]) {
        read.iter().for_each(|at| self.read[*at] = true);
        self.found(windows);
    }

    /// Clips, by their places, that have to be read now; none if enough has been read. They count as read.
    pub fn next_to_read(&mut self) -> Vec<usize> {
        let mut clips = self.left_within(self.reach(), BoundDepth::Eighths);
        self.least(&mut clips, BATCH);
        clips.iter().for_each(|at| self.read[*at] = true);
        clips
    }

    /// Clips that are not read and whose bounds, taken like this, are within a distance.
    fn left_within(&self, reach: f32, taken: BoundDepth) -> Vec<usize> {
        let within = |at: &&usize| {
            let (bound, depth) = self.bounds[**at];
            depth == taken && bound <= reach && !self.read[**at]
        };
        self.left.iter().filter(within).copied().collect()
    }

    /// This many of these clips, those of the least bounds, in the order of their places.
    fn least(&self, clips: &mut Vec<usize>, count: usize) {
        if clips.len() > count {
            let bound = |at: &usize| self.bounds[*at].0;
            clips
                .select_nth_unstable_by(count, |a, b| bound(a).total_cmp(&bound(b)).then(a.cmp(b)));
            clips.truncate(count);
            clips.sort_unstable();
        }
    }

    /// Takes [the nearest windows](super::SearchIndex::nearest_windows) of clips that were read.
    pub fn found(&mut self, windows: &[(ClipId, f32)]) {
        self.found
            .extend(windows.iter().map(|(clip, distance)| (*distance, *clip)));
        self.found
            .sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let reach = self.reach();
        self.found.retain(|(distance, _)| *distance <= reach);
        // How near windows must be is never more than it was.
        let (bounds, read) = (&self.bounds, &self.read);
        self.left.retain(|at| bounds[*at].0 <= reach && !read[*at]);
    }

    /// Clips that hold the nearest windows of those found, in order of number.
    pub fn chosen(&self) -> Vec<ClipId> {
        let mut clips: Vec<ClipId> = self.found.iter().map(|(_, clip)| *clip).collect();
        clips.sort_unstable();
        clips.dedup();
        clips
    }
}
