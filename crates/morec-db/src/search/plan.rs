//! The order in which a search reads clips of which bounds are known, and when it has read enough.

use super::rank::windows_wanted;
use super::{BoundDepth, SearchOptions};
use crate::ClipId;

/// Clips of which the bound by eighths is taken before anything has been found.
const LOOKED_AT_FIRST: usize = 1 << 13;

/// Clips that are read at once, after the first time.
const BATCH: usize = 1024;

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
    /// The nearest windows so far: their distances and clips, nearest first.
    found: Vec<(f32, ClipId)>,
    wanted: usize,
    begun: bool,
}

impl SearchPlan {
    /// Of bounds by halves.
    pub fn new(bounds: &[f32], options: &SearchOptions) -> Self {
        Self {
            bounds: bounds.iter().map(|b| (*b, BoundDepth::Halves)).collect(),
            read: vec![false; bounds.len()],
            found: Vec::new(),
            wanted: windows_wanted(options),
            begun: false,
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
        let within = |at: &usize| {
            let (bound, depth) = self.bounds[*at];
            depth == BoundDepth::Halves && bound <= reach && bound < f32::INFINITY
        };
        let mut clips: Vec<usize> = (0..self.bounds.len()).filter(within).collect();
        if reach == f32::INFINITY && clips.len() > LOOKED_AT_FIRST {
            self.least(&mut clips, LOOKED_AT_FIRST);
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

    /// Clips, by their places, that have to be read now; none if enough has been read. They count as read.
    pub fn next_to_read(&mut self) -> Vec<usize> {
        let reach = self.reach();
        let within = |at: &usize| {
            let (bound, depth) = self.bounds[*at];
            let closely = depth == BoundDepth::Eighths;
            !self.read[*at] && closely && bound <= reach && bound < f32::INFINITY
        };
        let mut clips: Vec<usize> = (0..self.bounds.len()).filter(within).collect();
        self.least(&mut clips, if self.begun { BATCH } else { self.wanted });
        self.begun = true;
        clips.iter().for_each(|at| self.read[*at] = true);
        clips
    }

    /// So many of these clips, those of the least bounds, in the order of their places.
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
    }

    /// Clips that hold the nearest windows of those found, in order of number.
    pub fn chosen(&self) -> Vec<ClipId> {
        let mut clips: Vec<ClipId> = self.found.iter().map(|(_, clip)| *clip).collect();
        clips.sort_unstable();
        clips.dedup();
        clips
    }
}
