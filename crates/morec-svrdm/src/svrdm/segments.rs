//! Chunks of a stream, and the segments that end with each (thesis, §4.6.2 and §4.6.3).

use super::{Gram, SvrdmParams};

/// A run of chunks that may be a motion: a segment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Window {
    /// First chunk.
    pub start: i64,
    /// One past the last chunk.
    pub stop: i64,
}

impl Window {
    /// Number of chunks.
    #[inline]
    pub fn chunks(self) -> usize {
        (self.stop - self.start) as usize
    }
}

/// The last rows of a stream, for as long as a segment may need them.
#[derive(Debug, Clone)]
pub struct RowRing {
    /// A ring of `capacity` rows of `dim` values.
    rows: Vec<f32>,
    dim: usize,
    capacity: usize,
    frames: usize,
}

impl RowRing {
    /// For rows of `dim` values: as many as the longest segment has.
    pub fn new(params: &SvrdmParams, dim: usize) -> Self {
        let capacity = params.max_frames();
        Self {
            rows: vec![0.0; capacity * dim],
            dim,
            capacity,
            frames: 0,
        }
    }

    /// Forgets the stream so far.
    pub fn reset(&mut self) {
        self.frames = 0;
    }

    /// Takes the next row, `r` values. No allocation.
    pub fn push(&mut self, row: &[f32]) {
        let slot = self.frames % self.capacity;
        self.rows[slot * self.dim..][..self.dim].copy_from_slice(row);
        // Whole turns of the ring may be left out: only the place in it and the kept rows matter.
        self.frames = if self.frames + 1 == 2 * self.capacity {
            self.capacity
        } else {
            self.frames + 1
        };
    }

    /// The last `frames` rows, oldest first; as many as there are, if fewer are kept.
    pub fn last(&self, frames: usize) -> impl Iterator<Item = &[f32]> {
        let kept = frames.min(self.frames).min(self.capacity);
        (self.frames - kept..self.frames).map(|at| {
            let slot = at % self.capacity;
            &self.rows[slot * self.dim..][..self.dim]
        })
    }
}

/// The second half of input assembly: projected rows in, chunks with their `AᵀA` out; the rows are kept for as long
/// as a segment may need them.
#[derive(Debug, Clone)]
pub struct ChunkAssembly {
    chunk_frames: usize,
    rows: RowRing,
    gram: Gram,
}

impl ChunkAssembly {
    /// For rows of `dim` values.
    pub fn new(params: &SvrdmParams, dim: usize) -> Self {
        Self {
            chunk_frames: params.chunk_frames,
            rows: RowRing::new(params, dim),
            gram: Gram::new(dim),
        }
    }

    /// Forgets the stream so far.
    pub fn reset(&mut self) {
        self.rows.reset();
        self.gram.clear();
    }

    /// Takes the next row, `r` values; says whether it completes a [`chunk`](Self::chunk). O(r²), no allocation.
    pub fn push(&mut self, row: &[f32]) -> bool {
        if self.gram.frames() == self.chunk_frames {
            self.gram.clear();
        }
        self.rows.push(row);
        self.gram.add_row(row);
        self.gram.frames() == self.chunk_frames
    }

    /// The sums of the newest chunk, as far as it has come.
    #[inline]
    pub fn chunk(&self) -> &Gram {
        &self.gram
    }

    /// The last `frames` rows, oldest first; as many as there are, if fewer are kept.
    pub fn last_rows(&self, frames: usize) -> impl Iterator<Item = &[f32]> {
        self.rows.last(frames)
    }
}

/// Segment assembly: chunks in, segments of every length that end with the newest chunk out.
///
/// Sums are taken anew from the last chunks each time: nothing is ever subtracted, so that errors do not grow
/// however long the stream, and a row that is no number is forgotten with its chunk.
#[derive(Debug, Clone)]
pub struct SegmentAssembly {
    min_chunks: usize,
    ring: Vec<Gram>,
    chunks: i64,
    sum: Gram,
}

impl SegmentAssembly {
    /// For rows of `dim` values.
    pub fn new(params: &SvrdmParams, dim: usize) -> Self {
        Self {
            min_chunks: params.min_chunks,
            ring: vec![Gram::new(dim); params.max_chunks],
            chunks: 0,
            sum: Gram::new(dim),
        }
    }

    /// Number of chunks whose sums are kept: those of the longest window.
    pub fn chunks_kept(&self) -> usize {
        self.ring.len()
    }

    /// Forgets the stream so far.
    pub fn reset(&mut self) {
        self.chunks = 0;
    }

    /// Takes the next chunk; calls `out` with each segment that ends with it, from the shortest to the longest, and
    /// the `AᵀA` of its rows, `M_k = Σ A(c)ᵀA(c)` over its `k` chunks (the sum of §4.6.3 has one more than the text
    /// says, as corrected). O(`max_chunks` · r²), no allocation.
    pub fn push(&mut self, chunk: &Gram, out: &mut impl FnMut(Window, &Gram)) {
        let longest = self.ring.len();
        let slot = |chunk: i64| (chunk % longest as i64) as usize;
        self.ring[slot(self.chunks)].copy_from(chunk);
        self.chunks += 1;
        self.sum.clear();
        for count in 1..=longest.min(self.chunks as usize) {
            let start = self.chunks - count as i64;
            self.sum.add(&self.ring[slot(start)]);
            if count >= self.min_chunks {
                out(
                    Window {
                        start,
                        stop: self.chunks,
                    },
                    &self.sum,
                );
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn params(chunk_frames: usize, min_chunks: usize, max_chunks: usize) -> SvrdmParams {
        SvrdmParams {
            chunk_frames,
            min_chunks,
            max_chunks,
            ..SvrdmParams::default()
        }
    }

    proptest! {
        #[test]
        fn every_segment_has_the_rows_it_says(
            rows in prop::collection::vec(prop::array::uniform2(-1.0f32..1.0), 0..120),
            chunk in 1usize..6,
            min in 1usize..4,
            more in 0usize..4,
        ) {
            let params = params(chunk, min, min + more);
            let (mut chunks, mut segments) = (ChunkAssembly::new(&params, 2), SegmentAssembly::new(&params, 2));
            let mut seen = vec![];
            for row in &rows {
                if !chunks.push(row) {
                    continue;
                }
                segments.push(chunks.chunk(), &mut |window, sum| {
                    let kept: Vec<f32> = chunks.last_rows(sum.frames()).flatten().copied().collect();
                    seen.push((window, sum.clone(), kept));
                });
            }
            let expected: Vec<Window> = (1..=(rows.len() / chunk) as i64)
                .flat_map(|stop| (min as i64..=(min + more) as i64).map(move |k| Window { start: stop - k, stop }))
                .filter(|w| w.start >= 0)
                .collect();
            prop_assert_eq!(seen.iter().map(|s| s.0).collect::<Vec<_>>(), expected);
            for (window, sum, kept) in seen {
                let rows = rows[window.start as usize * chunk..window.stop as usize * chunk].concat();
                // To the bit: it is what training sums of a sample.
                prop_assert_eq!(&sum, &Gram::of_rows(&rows, 2, chunk));
                prop_assert_eq!(kept, rows);
            }
        }
    }

    #[test]
    fn a_row_that_is_no_number_is_forgotten() {
        let params = params(2, 1, 3);
        let (mut chunks, mut segments) = (
            ChunkAssembly::new(&params, 1),
            SegmentAssembly::new(&params, 1),
        );
        let mut finite = vec![];
        for n in 0..12 {
            let row = [if n == 4 { f32::NAN } else { 1.0 }];
            if !chunks.push(&row) {
                continue;
            }
            segments.push(chunks.chunk(), &mut |_, sum| {
                finite.push(sum.product(0, 0).is_finite())
            });
        }
        assert_eq!(finite.iter().filter(|f| !**f).count(), 3 + 2 + 1);
        assert!(finite[finite.len() - 3..].iter().all(|f| *f));
    }
}
