//! Confidences to detections (thesis, §4.6.5): local maxima of the map over (start, end), of which no two overlap much.

use morec_features::ClassId;

use super::{Cell, Maxima, SegmentScoring, SvrdmModel, SvrdmParams};

#[cfg(test)]
mod tests;

/// A motion recognised, in frames of the present stretch at the model's rate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrameDetection {
    /// Class of the motion.
    pub class: ClassId,
    /// First frame.
    pub start: i64,
    /// One past the last frame.
    pub stop: i64,
    /// Its confidence (thesis, Eq. 4.5), 0 … 1.
    pub score: f64,
}

/// A motion recognised, in chunks of the present stretch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChunkDetection {
    /// Class of the motion.
    pub class: ClassId,
    /// First chunk.
    pub start: i64,
    /// One past the last chunk.
    pub stop: i64,
    /// Its confidence (Eq. 4.5).
    pub score: f64,
}

impl ChunkDetection {
    /// The same in frames, of which a chunk has `chunk_frames`.
    pub fn in_frames(&self, chunk_frames: i64) -> FrameDetection {
        let (start, stop) = (self.start * chunk_frames, self.stop * chunk_frames);
        FrameDetection {
            class: self.class,
            start,
            stop,
            score: self.score,
        }
    }

    fn chunks(&self) -> i64 {
        self.stop - self.start
    }

    /// True if the two share more than `share` of the shorter one.
    fn overlaps(&self, other: &ChunkDetection, share: f64) -> bool {
        let common = self.stop.min(other.stop) - self.start.max(other.start);
        common as f64 > share * self.chunks().min(other.chunks()) as f64
    }

    /// True if this one wins where both overlap: the more certain, then the one that ended first, then the shorter.
    fn beats(&self, other: &ChunkDetection) -> bool {
        let order = other.score.total_cmp(&self.score);
        order
            .then(self.stop.cmp(&other.stop))
            .then(self.chunks().cmp(&other.chunks()))
            .is_lt()
    }
}

/// A maximum that may still overlap another.
#[derive(Debug, Clone, Copy)]
struct TrackedMaximum {
    found: ChunkDetection,
    state: MaximumState,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum MaximumState {
    /// Undecided; would be dropped if the stream ended now.
    Trails,
    /// Undecided; would be reported if the stream ended now.
    Leads,
    /// To be reported.
    Settled,
    /// Given out.
    Reported,
}

impl MaximumState {
    fn is_open(self) -> bool {
        matches!(self, MaximumState::Trails | MaximumState::Leads)
    }
}

/// Segment tracking: a column of the map for each chunk in, detections out.
///
/// A maximum is known once the column after it is: one chunk after the segment's last. Of maxima that overlap by more
/// than the allowed share, the most certain is kept; then those that overlap it go, and so on down. A detection is
/// given out as soon as nothing that can still come changes that, which follows from how certain a segment of a
/// length can be at most (the length prior), and never taken back: the outcome is that of the whole map seen at once.
/// If chains of ever better overlapping maxima drag on, the wait ends
/// [`wait_chunks`](SvrdmParams::wait_chunks) after a segment's end, and what is known then decides.
///
/// Memory is fixed at construction. A column costs O(p²) for p maxima of the last few seconds, a handful.
#[derive(Debug)]
pub struct SegmentTracking {
    min_chunks: usize,
    max_chunks: usize,
    overlap: f64,
    maxima: Maxima,
    wait: i64,
    /// For each length, the most certain that any segment can be.
    most: Vec<f64>,
    /// The last three columns, oldest first; by length.
    columns: [Vec<Cell>; 3],
    /// Columns taken.
    chunks: i64,
    /// The winning first.
    tracked: Vec<TrackedMaximum>,
}

impl Clone for SegmentTracking {
    fn clone(&self) -> Self {
        // A derived copy of a vector has room for what it holds only, and pushing must not allocate.
        let mut tracked = Vec::with_capacity(self.tracked.capacity());
        tracked.extend_from_slice(&self.tracked);
        Self {
            most: self.most.clone(),
            columns: self.columns.clone(),
            tracked,
            ..*self
        }
    }
}

impl SegmentTracking {
    /// For parameters that pass their check. `most` gives for each length, from the shortest on, a bound on the
    /// confidence of any segment that long; 1 always holds.
    ///
    /// # Panics
    /// `most` does not have a bound for each length.
    pub fn new(params: &SvrdmParams, most: Vec<f64>) -> Self {
        let lengths = params.lengths();
        assert_eq!(most.len(), lengths, "a bound for each length");
        // Peaks are no neighbours of each other: every other length of a column at most. None is kept longer than it
        // takes for the wait of something that overlaps it to end.
        let of_column = match params.maxima {
            Maxima::Peaks => lengths.div_ceil(2),
            Maxima::Plateaus => lengths,
        };
        let room = (params.wait_chunks + params.max_chunks + 2) * of_column;
        Self {
            min_chunks: params.min_chunks,
            max_chunks: params.max_chunks,
            overlap: params.overlap,
            maxima: params.maxima,
            wait: params.wait_chunks as i64,
            most,
            columns: std::array::from_fn(|_| vec![Cell::NOTHING; lengths]),
            chunks: 0,
            tracked: Vec::with_capacity(room),
        }
    }

    /// For what `scoring` gives the segments of a model's stream.
    pub fn of_model(model: &SvrdmModel, scoring: &SegmentScoring) -> Self {
        let params = &model.params;
        let most = (params.min_chunks..=params.max_chunks).map(|chunks| {
            let classes = (0..model.classes.len()).map(|class| ClassId(class as u16));
            // A hair more, lest the exponential's rounding makes a bound of what is none.
            let bounds = classes
                .map(|class| scoring.most(class, chunks * params.chunk_frames) * (1.0 + 1e-9));
            bounds.fold(0.0, f64::max)
        });
        Self::new(params, most.collect())
    }

    /// Bytes of its memory.
    pub fn bytes(&self) -> usize {
        let cells: usize = self.columns.iter().map(Vec::len).sum();
        size_of::<Cell>() * cells
            + size_of::<TrackedMaximum>() * self.tracked.capacity()
            + 8 * self.most.len()
    }

    /// Forgets the stream so far.
    pub fn reset(&mut self) {
        self.columns
            .iter_mut()
            .for_each(|column| column.fill(Cell::NOTHING));
        self.chunks = 0;
        self.tracked.clear();
    }

    /// Takes the segments that end with the next chunk, from the shortest to the longest, [`Cell::NOTHING`] for those
    /// that begin before the stream; calls `out` with what is now certain, in order of time.
    pub fn push(&mut self, column: &[Cell], out: &mut impl FnMut(ChunkDetection)) {
        self.columns.rotate_left(1);
        self.columns[2].copy_from_slice(column);
        self.chunks += 1;
        self.collect();
        self.decide(self.wait, out);
    }

    /// Ends the stretch: calls `out` with all that is left.
    pub fn finish(&mut self, out: &mut impl FnMut(ChunkDetection)) {
        self.columns.rotate_left(1);
        self.columns[2].fill(Cell::NOTHING);
        self.chunks += 1;
        self.collect();
        self.decide(i64::MIN, out);
        self.reset();
    }

    /// True if a segment of this length, counted from the shortest, may be as certain as `least`.
    pub(super) fn may_reach(&self, length: usize, least: f64) -> bool {
        self.most[length] >= least
    }

    /// Most maxima kept at once so far could be: what memory is there for.
    pub fn room(&self) -> usize {
        self.tracked.capacity()
    }

    /// Maxima kept.
    pub fn tracked(&self) -> usize {
        self.tracked.len()
    }

    /// Takes up the maxima of the last column but one.
    fn collect(&mut self) {
        let stop = self.chunks - 1;
        for length in 0..self.most.len() {
            if !self.is_maximum(length) {
                continue;
            }
            let Cell { class, confidence } = self.columns[1][length];
            let start = stop - (self.min_chunks + length) as i64;
            let found = ChunkDetection {
                class,
                start,
                stop,
                score: confidence,
            };
            let at = self.tracked.partition_point(|t| t.found.beats(&found));
            // There is room: see `new`. Were there none, a push must still not allocate.
            if self.tracked.len() < self.tracked.capacity() {
                self.tracked.insert(
                    at,
                    TrackedMaximum {
                        found,
                        state: MaximumState::Trails,
                    },
                );
            }
        }
    }

    /// True if the segment of this length in the last column but one is more certain than its eight neighbours (or as
    /// certain, where plateaus count), start and end moved by one chunk; one that is not there counts as lower.
    fn is_maximum(&self, length: usize) -> bool {
        let cell = self.columns[1][length].confidence;
        let at = |column: usize, offset: isize| {
            let length = length.checked_add_signed(offset);
            length
                .and_then(|l| self.columns[column].get(l))
                .map_or(0.0, |c| c.confidence)
        };
        // A chunk earlier or later at the same end is a length more or less; at the end moved by one, the start moves
        // the length by one to either side of that.
        let same = [-1, 1].map(|offset| at(1, offset));
        let before = [-2, -1, 0].map(|offset| at(0, offset));
        let after = [0, 1, 2].map(|offset| at(2, offset));
        let highest = same
            .into_iter()
            .chain(before)
            .chain(after)
            .fold(0.0, f64::max);
        match self.maxima {
            Maxima::Peaks => cell > highest,
            Maxima::Plateaus => cell > 0.0 && cell >= highest,
        }
    }

    /// Reports and drops what can be; nothing waits longer than `wait` chunks.
    fn decide(&mut self, wait: i64, out: &mut impl FnMut(ChunkDetection)) {
        for at in 0..self.tracked.len() {
            let TrackedMaximum { found, state } = self.tracked[at];
            if !state.is_open() {
                continue;
            }
            let rivals = self.rivals(at);
            let settled = !rivals.open && !self.may_be_beaten(&found);
            self.tracked[at].state = match () {
                _ if rivals.led => MaximumState::Trails,
                _ if settled || self.is_late(&found, wait) => MaximumState::Settled,
                _ => MaximumState::Leads,
            };
            // What a late one is dropped for must stand, or in a chain of ever better ones each would go for the next
            // and none be reported.
            if rivals.led && self.is_late(&found, wait) {
                self.settle_winner(&found);
            }
        }
        self.report(out);
        self.drop_decided(wait);
    }

    fn is_late(&self, found: &ChunkDetection, wait: i64) -> bool {
        self.chunks - found.stop >= wait
    }

    /// Settles the best that wins over `found`, unless that is reported already.
    fn settle_winner(&mut self, found: &ChunkDetection) {
        let overlap = self.overlap;
        let winner = |t: &&mut TrackedMaximum| {
            t.state != MaximumState::Trails && t.found.overlaps(found, overlap)
        };
        if let Some(winner) = self.tracked.iter_mut().find(winner)
            && winner.state == MaximumState::Leads
        {
            winner.state = MaximumState::Settled;
        }
    }

    /// Cells that overlap a maximum and win over it; one that is reported stands, be it the lesser.
    fn rivals(&self, at: usize) -> Rivals {
        let found = &self.tracked[at].found;
        let mut rivals = Rivals {
            led: false,
            open: false,
        };
        for (index, other) in self.tracked.iter().enumerate() {
            let counts = index < at || (index > at && !other.state.is_open());
            if counts && found.overlaps(&other.found, self.overlap) {
                rivals.led |= other.state != MaximumState::Trails;
                rivals.open |= other.state.is_open();
            }
        }
        rivals
    }

    /// Gives out what is settled, the earliest first.
    fn report(&mut self, out: &mut impl FnMut(ChunkDetection)) {
        let settled = |t: &&mut TrackedMaximum| t.state == MaximumState::Settled;
        while let Some(next) = self
            .tracked
            .iter_mut()
            .filter(settled)
            .min_by_key(|t| t.found.start)
        {
            next.state = MaximumState::Reported;
            out(next.found);
        }
    }

    /// True if a segment that is no known maximum yet can become one, win over `found` and overlap it.
    fn may_be_beaten(&self, found: &ChunkDetection) -> bool {
        (0..self.most.len()).any(|length| {
            let chunks = (self.min_chunks + length) as i64;
            let rival = |stop: i64, score: f64| {
                let rival = ChunkDetection {
                    class: found.class,
                    start: stop - chunks,
                    stop,
                    score,
                };
                rival.score > found.score && rival.overlaps(found, self.overlap)
            };
            // Of those still to come the next overlaps most.
            rival(self.chunks, self.columns[2][length].confidence)
                || rival(self.chunks + 1, self.most[length])
        })
    }

    /// Drops maxima that lost for good, and reported ones that nothing can overlap any more.
    fn drop_decided(&mut self, wait: i64) {
        let open = self.tracked.iter().filter(|t| t.state.is_open());
        let first = open
            .map(|t| t.found.start)
            .fold(self.chunks - self.max_chunks as i64, i64::min);
        let mut at = 0;
        while at < self.tracked.len() {
            let TrackedMaximum { found, state } = self.tracked[at];
            let over = match state {
                MaximumState::Reported | MaximumState::Settled => found.stop <= first,
                MaximumState::Leads | MaximumState::Trails => {
                    self.is_late(&found, wait) || self.lost(&found)
                }
            };
            if over {
                self.tracked.remove(at);
            } else {
                at += 1;
            }
        }
    }

    /// True if one that overlaps it has been reported.
    fn lost(&self, found: &ChunkDetection) -> bool {
        let reported = |t: &&TrackedMaximum| t.state == MaximumState::Reported;
        self.tracked
            .iter()
            .filter(reported)
            .any(|t| found.overlaps(&t.found, self.overlap))
    }
}

/// Cells that overlap a maximum and win over it.
struct Rivals {
    /// One of them is reported, or would be if the stream ended now.
    led: bool,
    /// One of them is undecided.
    open: bool,
}
